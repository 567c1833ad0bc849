"""Sweeps: one study with many values of its parameters, computed by a cluster of workers into one table."""

from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.studies.sweeps.designs import Design
from pneumorph.studies.sweeps.running import SweepProgress, run_sweep, stored_table
from pneumorph.studies.sweeps.store import SweepFolder
from pneumorph.studies.sweeps.sweep import Sweep, load_sweep, sweep_from
from pneumorph.studies.sweeps.table import SweepTable

__all__ = [
    "Design", "Sweep", "SweepFolder", "SweepProgress", "SweepTable", "Workers", "load_sweep", "run_sweep",
    "stored_table", "sweep_from",
]  # fmt: skip
