import pytest

from pneumorph.cli import checks
from pneumorph.errors import EngineError


def test_everything_that_pneumorph_needs_works_here(pneumorph):
    result = pneumorph("doctor")
    assert result.exit_code == 0, result.stdout
    assert "->" not in result.stdout
    for name in (
        "versions",
        "threads",
        "netgen",
        "basix",
        "numba",
        "linear solver",
        "tiny problem",
        "rendering",
        "video",
    ):
        assert name in result.stdout
    assert "from its closed form" in result.stdout


def test_a_broken_engine_is_named_with_what_to_do(pneumorph, monkeypatch):
    def fail():
        raise OSError("libGL.so.1 is missing")

    broken = checks.Check("rendering", fail, "apt-get install libgl1")
    monkeypatch.setattr(checks, "CHECKS", (checks.Check("versions", checks.versions, ""), broken))
    result = pneumorph("doctor")
    assert result.exit_code == 1
    assert "problem" in result.stdout
    assert "libGL.so.1 is missing" in result.stdout
    assert "-> apt-get install libgl1" in result.stdout


def test_wrong_results_are_problems(monkeypatch):
    from pneumorph.closed_form import thick_wall
    from pneumorph.materials import NeoHookean
    from pneumorph.mechanics import linear, tables

    monkeypatch.setattr(thick_wall, "sphere_inner_radius", lambda *arguments: 11.0)
    with pytest.raises(EngineError, match="off its closed form"):
        checks.tiny_problem()
    monkeypatch.setattr(linear.Pardiso, "solve", lambda self, right: right)
    monkeypatch.setattr(linear.SuperLU, "solve", lambda self, right: right)
    with pytest.raises(EngineError, match="does not solve two equations"):
        checks.linear_solver()
    monkeypatch.setattr(NeoHookean, "energy", lambda self, c: [2.0])
    with pytest.raises(EngineError, match="a compiled kernel returned"):
        checks.numba()
    table = tables.cell_table("tetra10")
    monkeypatch.setattr(tables, "cell_table", lambda kind: type("Table", (), {"shape": 1.1 * table.shape}))
    with pytest.raises(EngineError, match="shape functions"):
        checks.basix()


def test_the_fall_back_solver_is_named(monkeypatch):
    from pneumorph.mechanics import linear

    monkeypatch.setattr(linear, "linear_solver", linear.SuperLU)
    assert checks.linear_solver().startswith("SuperLU: slower than PARDISO")
