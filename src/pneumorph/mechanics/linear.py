"""Direct solution of symmetric, possibly indefinite systems: PARDISO, or SciPy's SuperLU where MKL has no wheel."""

from __future__ import annotations

import logging
from typing import Protocol

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from pneumorph.errors import EngineError
from pneumorph.threads import thread_count

Array = NDArray[np.float64]
_log = logging.getLogger(__name__)


class LinearSolver(Protocol):
    """Factors a symmetric matrix given by its upper triangle, and solves with it."""

    name: str

    def factorise(self, upper: sparse.csr_matrix) -> None:
        """Factor the matrix; the analysis of its pattern is kept while the pattern object stays the same."""

    def solve(self, right: Array) -> Array:
        """Return the solution for right-hand sides (n,) or (n, m)."""

    def negative_pivots(self) -> int | None:
        """Return the number of negative eigenvalues of the factored matrix; None where the solver cannot tell."""

    def free(self) -> None:
        """Give back the memory of the factors."""


class Pardiso:
    """MKL PARDISO, symmetric indefinite (matrix type -2)."""

    name = "PARDISO"

    def __init__(self) -> None:
        try:
            from pypardiso import PyPardisoSolver
        except ImportError as error:
            raise EngineError(f"PARDISO is not available: {error}") from error
        self._solver = PyPardisoSolver(mtype=-2)
        self._solver.libmkl.MKL_Set_Num_Threads(thread_count())
        self._pattern: object = None
        self._matrix = sparse.csr_matrix((0, 0))
        settings = {
            1: 1,  # the values below, not the defaults
            2: 3 if thread_count() > 1 else 2,  # nested dissection, threaded
            8: 0,  # refine only where pivots were perturbed: Newton corrects the rest
            10: 8,  # perturb pivots below 1e-8
            11: 0,
            13: 0,
            21: 1,  # 1x1 and 2x2 pivots
            24: 1 if thread_count() > 1 else 0,  # two-level factorisation
            34: thread_count(),  # the same rounding in every run with this number of threads
        }
        for index, value in settings.items():
            self._solver.iparm[index - 1] = value

    def factorise(self, upper: sparse.csr_matrix) -> None:
        """Factor; the analysis is repeated only for a new pattern of indices."""
        new = self._pattern is not upper.indices
        self._call(12 if new else 22, upper, np.zeros(upper.shape[0]))
        self._pattern, self._matrix = upper.indices, upper

    def solve(self, right: Array) -> Array:
        """Solve with the last factors."""
        return self._call(33, self._matrix, np.asfortranarray(right))

    def negative_pivots(self) -> int | None:
        """Return the inertia that the factorisation counted."""
        return int(self._solver.iparm[22])

    def free(self) -> None:
        """Release PARDISO's memory; the next factorisation analyses again."""
        self._call(-1, self._matrix, np.zeros(self._matrix.shape[0]))
        self._pattern = None

    def _call(self, phase: int, matrix: sparse.csr_matrix, right: Array) -> Array:
        self._solver.set_phase(phase)
        try:
            result: Array = self._solver._call_pardiso(matrix, right)
        except Exception as error:
            raise EngineError(f"PARDISO failed in phase {phase}: {error}") from error
        return result


class SuperLU:
    """SciPy's SuperLU: slower and without inertia, but everywhere."""

    name = "SuperLU"

    def factorise(self, upper: sparse.csr_matrix) -> None:
        """Factor the full matrix."""
        full = (upper + sparse.triu(upper, 1).T).tocsc()
        try:
            self._factors = splu(full, permc_spec="COLAMD")
        except RuntimeError as error:
            raise EngineError(f"SuperLU failed: {error}") from error

    def solve(self, right: Array) -> Array:
        """Solve with the last factors."""
        result: Array = self._factors.solve(np.ascontiguousarray(right))
        return result

    def negative_pivots(self) -> int | None:
        """Return None: row exchanges lose the inertia."""
        return None

    def free(self) -> None:
        """Drop the factors."""
        del self._factors


def linear_solver() -> LinearSolver:
    """Return PARDISO where it works, else SuperLU with a line in the log."""
    try:
        return Pardiso()
    except EngineError as error:
        _log.warning("%s: falling back on SuperLU, which is slower and reports no stability", error)
        return SuperLU()
