"""The linear solvers on small matrices whose answers are known."""

import logging
import sys

import numpy as np
import pytest
import scipy.sparse as sparse

from pneumorph.errors import EngineError
from pneumorph.mechanics.linear import Pardiso, SuperLU, linear_solver


@pytest.fixture
def pardiso():
    pytest.importorskip("pypardiso")
    solver = Pardiso()
    yield solver
    solver.free()


def indefinite(negative, size=40):
    """Return a symmetric matrix with `negative` negative eigenvalues, and its upper triangle."""
    rng = np.random.default_rng(4)
    axes, _ = np.linalg.qr(rng.standard_normal((size, size)))
    values = rng.uniform(1.0, 3.0, size)
    values[:negative] *= -1.0
    full = axes * values @ axes.T
    full = 0.5 * (full + full.T)
    return full, sparse.csr_matrix(np.triu(full))


@pytest.mark.parametrize("negative", [0, 1, 7])
def test_pardiso_solves_and_counts_negative_eigenvalues(pardiso, negative):
    full, upper = indefinite(negative)
    assert int(np.sum(np.linalg.eigvalsh(full) < 0.0)) == negative
    right = np.random.default_rng(5).standard_normal((40, 3))
    pardiso.factorise(upper)
    assert pardiso.negative_pivots() == negative
    assert pardiso.solve(right) == pytest.approx(np.linalg.solve(full, right), rel=1e-9)
    assert pardiso.solve(right[:, 0]).ravel() == pytest.approx(np.linalg.solve(full, right[:, 0]), rel=1e-9)


def test_pardiso_follows_new_values_and_new_patterns(pardiso):
    full, upper = indefinite(2)
    right = np.ones(40)
    pardiso.factorise(upper)
    upper.data *= 2.0
    pardiso.factorise(upper)
    assert pardiso.solve(right).ravel() == pytest.approx(np.linalg.solve(2.0 * full, right), rel=1e-9)
    other = sparse.diags(np.arange(1.0, 31.0)).tocsr()
    pardiso.factorise(other)
    assert pardiso.solve(np.ones(30)).ravel() == pytest.approx(1.0 / np.arange(1.0, 31.0), rel=1e-12)
    assert pardiso.negative_pivots() == 0


def test_superlu_gives_the_same_solution_and_no_inertia():
    full, upper = indefinite(3)
    right = np.random.default_rng(6).standard_normal((40, 2))
    solver = SuperLU()
    solver.factorise(upper)
    assert solver.solve(right) == pytest.approx(np.linalg.solve(full, right), rel=1e-9)
    assert solver.negative_pivots() is None
    solver.free()


def test_superlu_names_a_singular_matrix():
    with pytest.raises(EngineError, match="SuperLU failed"):
        SuperLU().factorise(sparse.csr_matrix((3, 3)))


def test_pardiso_names_the_phase_that_fails(pardiso, monkeypatch):
    _, upper = indefinite(0)
    pardiso.factorise(upper)

    def refuse(*_):
        raise ValueError("zero pivot")

    with monkeypatch.context() as patch:
        patch.setattr(pardiso._solver, "_call_pardiso", refuse)
        with pytest.raises(EngineError, match="PARDISO failed in phase 33: zero pivot"):
            pardiso.solve(np.ones(40))


def test_without_pardiso_superlu_takes_over_and_says_so(monkeypatch, caplog):
    monkeypatch.setitem(sys.modules, "pypardiso", None)
    with pytest.raises(EngineError, match="PARDISO is not available"):
        Pardiso()
    with caplog.at_level(logging.WARNING, "pneumorph"):
        assert isinstance(linear_solver(), SuperLU)
    assert "falling back on SuperLU" in caplog.text
