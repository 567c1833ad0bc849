"""The skinned tube: wall time and memory of one inflation against unknowns, layered cells against tetrahedra.

Four layered meshes of a half tube (hexahedra and wedges that go through wall and skin) and tetrahedral ones are
inflated by the same volume, each in a process of its own. The exponent of time and of memory over unknowns is fitted
to the layered ones; the finest of them is the measure of the curvature's error. The tetrahedra are the layered cells
split, three to a wedge and six to a hexahedron, so that both see the same geometry. Run on a machine that does nothing
else:

    python benchmarks/skin.py --out skin.json
    python benchmarks/skin.py --quick

This process imports the standard library alone: a child inherits the peak memory of its parent.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import os
import platform
import sys
import tempfile
from pathlib import Path
from typing import Any

import measured

WORKER = Path(__file__).resolve().with_name("skin_worker.py")
# (largest edge over the height of a cell, cells through the wall)
LAYERED = [(0.5, 1), (0.34, 1), (0.2, 1), (0.125, 1)]
TETRAHEDRA = [(0.5, 1), (0.2, 1), (0.125, 1)]


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a tube of one cell along, for a look")
    parser.add_argument("--along", type=int, default=3, help="cells along the tube (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, help="threads (default: %(default)s)")
    parser.add_argument("--out", type=Path, help="JSON file for everything that was measured")
    chosen = parser.parse_args()
    for name in ("along", "threads"):
        if getattr(chosen, name) < 1:
            parser.error(f"--{name} = {getattr(chosen, name)}: expected at least 1")
    if chosen.out is not None and not chosen.out.resolve().parent.is_dir():
        parser.error(f"--out = {chosen.out}: there is no folder {chosen.out.resolve().parent}")
    return chosen


def inflate(case: dict[str, Any], threads: int, folder: Path) -> dict[str, Any]:
    """Return the case with its wall time (s), memory (MiB) and results."""
    given, found, log = folder / "case.json", folder / "result.json", folder / "log"
    given.write_text(json.dumps(case))
    names = ("PNEUMORPH_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    command = [sys.executable, str(WORKER), str(given), str(found)]
    cost = measured.run(command, folder, dict.fromkeys(names, str(threads)), log)
    if cost.code != 0:
        raise SystemExit(f"{case} ended with exit code {cost.code}:\n{log.read_text(errors='replace')[-2000:]}")
    times = {"wall": cost.wall, "processor": cost.processor, "memory": cost.memory}
    return case | times | json.loads(found.read_text())


def exponent(runs: list[dict[str, Any]], name: str) -> float:
    """Return the slope of log(name) over log(unknowns), by least squares."""
    x = [math.log(run["unknowns"]) for run in runs]
    y = [math.log(run[name]) for run in runs]
    middle = sum(x) / len(x)
    return sum((a - middle) * b for a, b in zip(x, y, strict=True)) / sum((a - middle) ** 2 for a in x)


def cost_at(runs: list[dict[str, Any]], error: float, name: str) -> float | None:
    """Return the cost at an error of the curvature, between the two runs whose errors enclose it, log over log."""
    for one, other in itertools.pairwise(runs):
        high, low = abs(one["error"]), abs(other["error"])
        if high >= error >= low > 0.0:
            share = math.log(high / error) / math.log(high / low) if high > low else 0.0
            return float(one[name] ** (1.0 - share) * other[name] ** share)
    return None


def main() -> None:
    chosen = arguments()
    along = 1 if chosen.quick else chosen.along
    added = 0.5 * 40e3 * along / 7.0  # as much for each cell along as 40 mL in the study's tube of seven; half a tube
    runs: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        base = {"along": along, "added": added}
        for kind in ("layered", "tetrahedra"):  # compile what is not yet compiled, so that no run pays for it
            warm = base | {"along": 1, "added": 1.0, "kind": kind, "size": 0.5, "layers": 1}
            inflate(warm, chosen.threads, folder)
        for kind, meshes in (("layered", LAYERED), ("tetrahedra", TETRAHEDRA)):
            for size, layers in meshes:
                run = inflate(base | {"kind": kind, "size": size, "layers": layers}, chosen.threads, folder)
                runs.append(run)
                print(
                    f"{kind}, size {size:g} h: {run['cells']} cells, {run['unknowns']} unknowns, {run['wall']:.1f} s "
                    f"({run['processor']:.1f} s of processor), {run['memory']:.0f} MiB, {run['iterations']} "
                    f"iterations, kappa {run['curvature']:.6f} /mm, D {run['diameter']:.3f} mm",
                    flush=True,
                )
    print("\n".join(summary := summarise(runs)))
    if chosen.out is not None:
        machine = {"platform": platform.platform(), "cores": os.cpu_count(), "load": os.getloadavg()}
        data = {"runs": runs, "summary": summary, "threads": chosen.threads, "machine": machine}
        chosen.out.write_text(json.dumps(data, indent=1))


def summarise(runs: list[dict[str, Any]]) -> list[str]:
    """Return the lines of the result; adds to each run the error of its curvature."""
    layered, tetrahedra = ([run for run in runs if run["kind"] == kind] for kind in ("layered", "tetrahedra"))
    best = layered[-1]["curvature"]
    for run in runs:
        run["error"] = run["curvature"] / best - 1.0
    lines = [
        f"layered: time goes with unknowns^{exponent(layered, 'wall'):.2f}, "
        f"memory with unknowns^{exponent(layered, 'memory'):.2f}",
        "error of kappa against the finest layered mesh: "
        + ", ".join(f"{run['kind']} {run['unknowns']}: {100 * run['error']:+.2f} %" for run in runs),
    ]
    for run in layered[:-1]:
        wall, memory = (cost_at(tetrahedra, abs(run["error"]), name) for name in ("wall", "memory"))
        if wall is not None and memory is not None:
            lines.append(
                f"at the error of the layered mesh of {run['unknowns']} unknowns ({100 * run['error']:+.2f} %) "
                f"tetrahedra take {wall / run['wall']:.1f} times its time, {memory / run['memory']:.1f} times its "
                "memory"
            )
            break
    else:
        lines.append("no tetrahedral mesh here is as accurate as a layered one")
    return lines


if __name__ == "__main__":
    main()
