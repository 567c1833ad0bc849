"""What `pneumorph doctor` looks at: each check returns what it found, or raises with what is wrong."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version

from pneumorph.errors import EngineError
from pneumorph.threads import thread_count

ENGINES = ("netgen-mesher", "fenics-basix", "numba", "pypardiso", "pyvista", "vtk", "imageio-ffmpeg")


@dataclass(frozen=True)
class Check:
    """name: what is looked at; look: the look; advice: what to do where it fails."""

    name: str
    look: Callable[[], str]
    advice: str


def versions() -> str:
    """Return the versions of Python and pneumorph."""
    return f"pneumorph {version('pneumorph')}, Python {platform.python_version()}, {platform.platform(terse=True)}"


def threads() -> str:
    """Return how many threads are used."""
    busy = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    return f"{thread_count()} threads on {os.cpu_count()} processors{busy}"


def netgen() -> str:
    """Mesh a small solid."""
    from pneumorph.geometry import ThickSphere
    from pneumorph.mesh import generate

    cells = generate(ThickSphere(octant=True), coarse=True).cell_count
    return f"netgen-mesher {version('netgen-mesher')}: a sphere meshed with {cells} cells"


def basix() -> str:
    """Tabulate an element whose shape functions must add up to one."""
    from pneumorph.mechanics.tables import cell_table

    if abs(cell_table("tetra10").shape.sum(axis=1) - 1.0).max() > 1e-12:
        raise EngineError("the shape functions of basix do not add up to 1")
    return f"fenics-basix {version('fenics-basix')}"


def numba() -> str:
    """Run a compiled kernel against a known value."""
    import numpy as np

    from pneumorph.materials import NeoHookean

    energy = NeoHookean(1.0).energy(np.array([[4.0, 0.5, 0.5, 0.0, 0.0, 0.0]]))[0]
    if abs(energy - 1.0) > 1e-12:
        raise EngineError(f"a compiled kernel returned {energy!r}, expected 1.0")
    return f"numba {version('numba')}"


def linear_solver() -> str:
    """Solve two equations with the solver that a run would take."""
    import numpy as np
    import scipy.sparse as sparse

    from pneumorph.mechanics import linear

    solver = linear.linear_solver()
    solver.factorise(sparse.csr_matrix(np.array([[2.0, 1.0], [0.0, 3.0]])))
    if abs(solver.solve(np.array([3.0, 4.0])) - 1.0).max() > 1e-12:
        raise EngineError(f"{solver.name} does not solve two equations")
    solver.free()
    return solver.name if solver.name == "PARDISO" else f"{solver.name}: slower than PARDISO, and no stability check"


def tiny_problem() -> str:
    """Inflate a thick-walled sphere and compare its volume with the closed form."""
    from math import pi

    from pneumorph.closed_form.thick_wall import sphere_inner_radius
    from pneumorph.geometry import ThickSphere
    from pneumorph.materials import NeoHookean
    from pneumorph.mechanics import Cavity, Model, Phase, Programme, Symmetry
    from pneumorph.mesh import generate
    from pneumorph.solution import solve

    sphere, material, pressure = ThickSphere(octant=True), NeoHookean(0.1), 0.03
    planes = tuple(name for name in sphere.face_names if name.startswith("symmetry"))
    model = Model(
        generate(sphere, coarse=True),
        {"body": material},
        tuple(Symmetry(name) for name in planes),
        cavities=(Cavity("cavity", ("cavity",), mirrors=planes),),
    )
    phase = Phase("inflate", {"cavity": pressure}, first=0.5, largest=0.5)
    volume = solve(model, Programme((phase,))).states[-1].volume["cavity"]
    exact = pi / 6.0 * sphere_inner_radius(material, sphere.inner_radius, sphere.outer_radius, pressure) ** 3
    difference = volume / exact - 1.0
    if abs(difference) > 0.01:
        raise EngineError(f"the volume of an inflated sphere is {difference:+.2%} off its closed form, expected 1 %")
    return f"inflated sphere: {difference:+.2%} from its closed form"


def rendering() -> str:
    """Draw one picture off the screen."""
    from pneumorph.report import render

    return render.check()


def video() -> str:
    """Find the encoder of animations."""
    import imageio_ffmpeg

    return f"ffmpeg {imageio_ffmpeg.get_ffmpeg_version()}"


CHECKS = (
    Check("versions", versions, "install the package again"),
    Check("threads", threads, "set PNEUMORPH_THREADS to a whole number of at least 1, or unset it"),
    Check("netgen", netgen, "pip install --force-reinstall netgen-mesher"),
    Check("basix", basix, "pip install --force-reinstall fenics-basix"),
    Check("numba", numba, "pip install --force-reinstall numba; remove __pycache__ folders that cannot be written"),
    Check("linear solver", linear_solver, "pip install --force-reinstall pypardiso (without it SciPy's solver runs)"),
    Check("tiny problem", tiny_problem, "run the tests: make test"),
    Check(
        "rendering", rendering, "apt-get install libegl1 libgl1-mesa-dri; reports go without pictures until it works"
    ),
    Check("video", video, "pip install --force-reinstall imageio-ffmpeg"),
)
