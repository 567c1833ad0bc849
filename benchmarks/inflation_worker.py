"""What `inflation.py` runs in processes of their own: mesh, solve, or time the assembly. Writes JSON beside the case.

`python inflation_worker.py mesh|solve|assembly FOLDER`, with FOLDER/case.json written by `inflation.py`.
"""

from __future__ import annotations

import time

STARTED = time.perf_counter()

import json  # noqa: E402
import statistics  # noqa: E402
import sys  # noqa: E402
from collections.abc import Callable  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402

import pneumorph  # noqa: E402, F401  (first: it limits the threads of the numerical libraries)
from pneumorph.exchange import write_inp  # noqa: E402
from pneumorph.materials import Yeoh  # noqa: E402
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, linear, march  # noqa: E402
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh  # noqa: E402

Case = dict[str, Any]
FACES = ("clamp", "tip", "cavity")


def make_mesh(folder: Path, case: Case) -> Case:
    """Mesh a PneuNet with about case['cells'] cells; save it for pneumorph and write CalculiX's input."""
    from pneumorph.geometry import PneuNet
    from pneumorph.mesh.generate import generate

    actuator = PneuNet(chambers=case["chambers"], layer=0.0)
    size, best = actuator.default_size * (2000.0 / case["cells"]) ** 0.4, None
    for _ in range(8):
        mesh = generate(actuator, size, coarse=case["cells"] < 1500)
        off = abs(mesh.cell_count / case["cells"] - 1.0)
        if best is None or off < best[0]:
            best = (off, size, mesh)
        if off < 0.03:
            break
        size *= (mesh.cell_count / case["cells"]) ** 0.35  # cells grow a little more slowly than size**-3
    assert best is not None
    _, size, mesh = best
    cells = mesh.blocks[0].nodes
    arrays = {name: np.concatenate([b.nodes for b in mesh.face_blocks(name)]) for name in FACES}
    np.savez(folder / "mesh.npz", points=mesh.points, cells=cells, **arrays)
    phase = Phase("inflation", {"cavity": case["pressure"]}, first=case["calculix_first"], largest=1.0, smallest=1e-6)
    model, programme = _model(folder, case), Programme((phase,))
    write_inp(folder / "inflation.inp", model, programme, title="benchmark", fields=False, printed=("tip",))
    return {
        "actuator": repr(actuator),
        "size": size,
        "cells": len(cells),
        "nodes": len(mesh.points),
        "length": actuator.length,
    }


def solve(folder: Path, case: Case) -> Case:
    """Inflate; return times, iterations and the mean displacement of the tip face."""
    times = {"factorise": 0.0, "solve": 0.0}
    calls = {"factorise": 0, "solve": 0}

    def timed(name: str, method: Callable[..., Any]) -> Callable[..., Any]:
        def call(self: linear.Pardiso, *arguments: Any) -> Any:
            start = time.perf_counter()
            try:
                return method(self, *arguments)
            finally:
                times[name] += time.perf_counter() - start
                calls[name] += 1

        return call

    for name in times:
        setattr(linear.Pardiso, name, timed(name, getattr(linear.Pardiso, name)))
    model = _model(folder, case)
    ready = time.perf_counter()
    programme = Programme((Phase("inflation", {"cavity": case["pressure"]}),))
    increments = converged = 0
    for last in march(model, programme):  # the first state is the one at rest
        increments += last.index > 0
        converged += last.iterations
    end = time.perf_counter()
    if not calls["factorise"]:
        raise SystemExit("pneumorph did not use PARDISO: the benchmark needs it (pypardiso)")
    np.savez(folder / "state.npz", displacement=last.displacement, modes=last.pressure_modes[0])
    tip = last.displacement[model.mesh.face_nodes("tip")].mean(axis=0)
    return {
        "start": ready - STARTED,
        "solve": end - ready,
        "pardiso": sum(times.values()),
        "factorise": times["factorise"],
        "substitute": times["solve"],
        "increments": increments,
        "iterations": converged,
        "factorisations": calls["factorise"],
        "pressure": last.pressure["cavity"],
        "tip": tip.tolist(),
        "smallest_volume_ratio": last.smallest_volume_ratio,
        "viscous_loss": last.energies.viscous,
    }


def time_assembly(folder: Path, case: Case) -> Case:
    """Return microseconds a cell for the residual with the tangent, and alone, in the last inflated state."""
    model = _model(folder, case)
    with np.load(folder / "state.npz") as state:
        position, modes = model.mesh.points + state["displacement"], [state["modes"]]
    result = {}
    for name, tangent in (("tangent_and_residual", True), ("residual", False)):
        model.body.assemble(position, modes, tangent)
        samples = []
        for _ in range(9):
            start = time.perf_counter()
            model.body.assemble(position, modes, tangent)
            samples.append((time.perf_counter() - start) / model.mesh.cell_count * 1e6)
        result[name] = statistics.median(samples)
    return result


def _model(folder: Path, case: Case) -> Model:
    with np.load(folder / "mesh.npz") as data:
        mesh = Mesh(
            data["points"],
            (CellBlock("tetra10", "body", data["cells"]),),
            {name: (FaceBlock("triangle6", data[name]),) for name in FACES},
        )
    material = Yeoh(case["c10"], case["c20"], bulk=case["bulk"])
    model = Model(mesh, {"body": material}, supports=(Clamp("clamp"),), cavities=(Cavity("cavity", ("cavity",)),))
    _ = model.body
    return model


def main() -> None:
    """Do one job; exit with a message where the solver stops."""
    from pneumorph.errors import NotConvergedError

    job, folder = sys.argv[1], Path(sys.argv[2])
    case = json.loads((folder / "case.json").read_text())
    try:
        result = {"mesh": make_mesh, "solve": solve, "assembly": time_assembly}[job](folder, case)
    except NotConvergedError as error:
        raise SystemExit(f"pneumorph: {error}") from error
    (folder / f"{job}.json").write_text(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
