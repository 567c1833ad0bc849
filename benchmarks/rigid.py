"""pneumorph's runs over rigid terrain against bare MuJoCo stepping of the same model.

Both step one compiled model with the same controls from the same start, on one thread, in turn; the bare loop records
nothing and looks at nothing. Their last states must be equal to the last bit, so that the same is compared. Building
the terrain and compiling the model are timed apart. Run on a machine that does nothing else:

    python benchmarks/rigid.py --out rigid.json
    python benchmarks/rigid.py --repeat 1      # a quick look

Needs the extra `terrain`: pip install 'pneumorph[terrain]'.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pneumorph.errors import PneumorphError
from pneumorph.studies.reproductions.soft_wheel import RigidStudy
from pneumorph.studies.rolling import RollingRun
from pneumorph.terrain import ground_bytes, load, simulate
from pneumorph.terrain.rigid import engine

TARGET = 0.9  # of bare MuJoCo's simulated seconds per second, at least
RUNS = ("plain_flat", "straight-1_flat", "curved-4_smooth-1", "curved-3_terraced-1")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--repeat", type=int, default=7, help="turns of each (default: %(default)s)")
    parser.add_argument("--runs", nargs="+", default=RUNS, help="names of runs (default: %(default)s)")
    parser.add_argument("--out", type=Path, help="JSON file for everything that was measured")
    chosen = parser.parse_args()
    if chosen.repeat < 1:
        parser.error(f"--repeat = {chosen.repeat}: expected at least 1")
    known = {run.name for run in RigidStudy().runs}
    for name in chosen.runs:
        if name not in known:
            parser.error(f"--runs: unknown run '{name}', such as {', '.join(RUNS)}")
    if chosen.out is not None and not chosen.out.resolve().parent.is_dir():
        parser.error(f"--out = {chosen.out}: there is no folder {chosen.out.resolve().parent}")
    return chosen


def bare(model: Any, run: RollingRun) -> np.ndarray:
    """Step a model with MuJoCo alone; return its last coordinates."""
    mujoco, drive = engine(), run.drive
    data = mujoco.MjData(model)
    steps, ramp = round(drive.duration / drive.step), round(drive.ramp / drive.step)
    for number in range(ramp):
        data.ctrl[:] = drive.wanted_speed(number * drive.step)
        mujoco.mj_step(model, data)
    data.ctrl[:] = drive.speed
    mujoco.mj_step(model, data, steps - ramp)
    return np.array(data.qpos)


def timed(function: Callable[[], Any]) -> tuple[float, Any]:
    start = time.perf_counter()
    result = function()
    return time.perf_counter() - start, result


def measure(run: RollingRun, repeat: int) -> dict[str, Any]:
    """Return the wall times of one run, ours and bare."""
    built, model = timed(lambda: load(run.model_text(), {run.ground_file: ground_bytes(run.ground.field)}))
    bare(model, run)  # caches are warm for both
    walls: dict[str, list[float]] = {"pneumorph": [], "bare": []}
    for _ in range(repeat):
        ours, way = timed(lambda: simulate(model, run.drive))
        theirs, pose = timed(lambda: bare(model, run))
        if not np.array_equal(way.pose[-1], pose):
            raise PneumorphError(f"{run.name}: the last states differ, so the times cannot be compared")
        walls["pneumorph"].append(ours)
        walls["bare"].append(theirs)
    return {"run": run.name, "simulated": run.drive.duration, "build": built, "walls": walls}


def main() -> int:
    """Return 0, or 2 with a message where something is missing or differs."""
    chosen = arguments()
    runs = {run.name: run for run in RigidStudy().runs}
    try:
        found = [measure(runs[name], chosen.repeat) for name in chosen.runs]
    except PneumorphError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"{'simulated seconds per second':32}{'pneumorph':>12}{'bare MuJoCo':>14}{'ratio':>8}{'build [s]':>11}")
    ratios = []
    for item in found:
        ours, theirs = (statistics.median(item["walls"][key]) for key in ("pneumorph", "bare"))
        ratios.append(theirs / ours)
        speeds = (item["simulated"] / ours, item["simulated"] / theirs)
        print(f"{item['run']:32}{speeds[0]:12.1f}{speeds[1]:14.1f}{ratios[-1]:8.3f}{item['build']:11.2f}")
    met = "met" if min(ratios) >= TARGET else "not met"
    print(f"smallest ratio {min(ratios):.3f}, target: at least {TARGET:g}, {met}")
    if chosen.out is not None:
        machine = {"platform": platform.platform(), "cores": os.cpu_count(), "load": os.getloadavg()}
        data = {"runs": found, "mujoco": engine().__version__, "python": platform.python_version(), "machine": machine}
        chosen.out.write_text(json.dumps(data, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
