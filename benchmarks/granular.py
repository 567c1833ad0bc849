"""The co-simulation of a rover on grains against bare LAMMPS with the same bed, in particle-steps per second.

Both wake the same settled bed and take the same number of steps on one thread, in turn, several times; the bare one has
no wheels and no callback. Settling, loading and compiling are not timed. Run on a machine that does nothing else:

    python benchmarks/granular.py --out granular.json
    python benchmarks/granular.py --grains 3000 --steps 300 --repeat 3      # a quick look

Needs the extra `granular`: pip install 'pneumorph[granular]'.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import time
from pathlib import Path

from pneumorph.errors import PneumorphError
from pneumorph.terrain import Drive
from pneumorph.terrain.granular import SANDS, Bed, Settled, Vehicle, drive_over, limbed, settled
from pneumorph.terrain.granular.engine import Session
from pneumorph.terrain.granular.settling import wake

TARGET = 0.9  # of bare LAMMPS's particle-steps per second, at least
WHOLE = 32_500  # grains of the study; fewer lie in a shorter box


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--grains", type=int, default=WHOLE, help="grains of the bed (default: %(default)s)")
    parser.add_argument("--steps", type=int, default=1000, help="steps of a turn (default: %(default)s)")
    parser.add_argument("--repeat", type=int, default=5, help="turns of each (default: %(default)s)")
    parser.add_argument("--sand", choices=list(SANDS), default="dry", help="default: %(default)s")
    parser.add_argument("--out", type=Path, help="JSON file for everything that was measured")
    chosen = parser.parse_args()
    for name, least in (("repeat", 1), ("steps", 50), ("grains", 1000)):
        if getattr(chosen, name) < least:
            parser.error(f"--{name} = {getattr(chosen, name)}: expected at least {least}")
    if chosen.out is not None and not chosen.out.resolve().parent.is_dir():
        parser.error(f"--out = {chosen.out}: there is no folder {chosen.out.resolve().parent}")
    return chosen


def bare(still: Settled, steps: int) -> float:
    """Return the time, s, that LAMMPS alone takes."""
    with Session() as session:
        wake(session, still)
        start = time.perf_counter()
        session.commands(f"run {steps} post no")
        return time.perf_counter() - start


def main() -> int:
    """Return 0, or 2 with a message where something is missing."""
    chosen = arguments()
    try:
        size = {} if chosen.grains == WHOLE else {"length": 2_400.0, "width": 3_000.0 * chosen.grains / WHOLE / 0.6}
        bed = Bed(SANDS[chosen.sand], chosen.grains, **size)
        vehicle = Vehicle(limbed("full", 280.0), single=chosen.grains < WHOLE)
        steps = 50 * round(chosen.steps / 50)
        drive = Drive(step=bed.step, duration=steps * bed.step, record=50 * bed.step)
        still = settled(bed)
        drive_over(still, vehicle, Drive(step=bed.step, duration=0.01, record=0.01))  # compiles what is not yet
        ours, theirs = [], []
        for _ in range(chosen.repeat):
            ours.append(drive_over(still, vehicle, drive).wall)
            theirs.append(bare(still, steps))
    except PneumorphError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    speeds = [1e-6 * bed.grains * steps / statistics.median(walls) for walls in (ours, theirs)]
    ratio = speeds[0] / speeds[1]
    wheels = "one wheel" if vehicle.single else "rover on four wheels"
    print(f"{bed.grains} grains, {bed.sand.name}, {wheels}, {steps} steps, median of {chosen.repeat}")
    print(f"co-simulation {speeds[0]:.2f} M particle-steps/s, bare LAMMPS {speeds[1]:.2f} M particle-steps/s")
    print(f"ratio {ratio:.3f}, target: at least {TARGET:g}, {'met' if ratio >= TARGET else 'not met'}")
    if chosen.out is not None:
        machine = {"platform": platform.platform(), "cores": os.cpu_count(), "load": os.getloadavg()}
        data = {"grains": bed.grains, "steps": steps, "co-simulation": ours, "bare": theirs, "machine": machine}
        chosen.out.write_text(json.dumps(data, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
