"""The laws that can be fitted: which constants scale the stress, which shape it, and where a search starts.

For given shape constants (exponents, limits of extension) every law here is linear in the others (moduli), so that a
fit searches the shapes alone, up to four numbers, and solves for the moduli: variable projection (Golub, Pereyra, SIAM
J. Numer. Anal. 10 (1973) 413).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.materials.arruda_boyce import ArrudaBoyce
from pneumorph.materials.extended_tube import ExtendedTube
from pneumorph.materials.gent import Gent
from pneumorph.materials.material import Material
from pneumorph.materials.mooney_rivlin import MooneyRivlin
from pneumorph.materials.neo_hookean import NeoHookean
from pneumorph.materials.ogden import Ogden
from pneumorph.materials.yeoh import Yeoh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Model(ABC):
    """A law as a fit sees it; `name` is "yeoh", "ogden-3" and so on.

    In the methods `most` is the largest Ī1 - 3 of the data, beyond which a law that locks must lock.
    """

    name: str

    @abstractmethod
    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        """Return the law with moduli (m,) and shapes (s,); raises InputError for constants that it refuses."""

    @abstractmethod
    def base(self, shapes: Array) -> Array:
        """Return moduli (m,) with which the law exists."""

    @property
    def positive(self) -> int:
        """How many of the moduli, from the first on, must have the sign that they have in `base`."""
        return 1

    @property
    def starts(self) -> Array:
        """Starts (k, s) of the search."""
        return np.zeros((1, 0))

    def bounds(self, start: Array) -> tuple[Array, Array]:
        """Return the bounds of the search from a start."""
        return start, start

    @property
    def constants(self) -> int:
        """How many constants are fitted."""
        start = self.starts[0]
        return len(self.base(start)) + len(start)


@dataclass(frozen=True)
class _Linear(Model):
    """A law without shapes; the first modulus must be positive."""

    law: Callable[..., Material]
    count: int

    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        return self.law(*moduli.tolist())

    def base(self, shapes: Array) -> Array:
        return np.eye(1, self.count)[0]


def _mooney_rivlin(total: float, c01: float, *rest: float) -> MooneyRivlin:
    """Return the law from c10 + c01, which must be positive while the two alone need not."""
    return MooneyRivlin(total - c01, c01, *rest)


@dataclass(frozen=True)
class _Gent(Model):
    """The shape s gives jm = most (1 + exp s)."""

    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        return Gent(float(moduli[0]), most * (1.0 + float(np.exp(shapes[0]))))

    def base(self, shapes: Array) -> Array:
        return np.ones(1)

    @property
    def starts(self) -> Array:
        return np.linspace(-5.0, 4.0, 10)[:, np.newaxis]

    def bounds(self, start: Array) -> tuple[Array, Array]:
        return np.array([-7.0]), np.array([9.0])


@dataclass(frozen=True)
class _ArrudaBoyce(Model):
    """The shape s gives a locking stretch of 1 + exp s."""

    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        return ArrudaBoyce(float(moduli[0]), 1.0 + float(np.exp(shapes[0])))

    def base(self, shapes: Array) -> Array:
        return np.ones(1)

    @property
    def starts(self) -> Array:
        return np.linspace(-2.0, 3.5, 10)[:, np.newaxis]

    def bounds(self, start: Array) -> tuple[Array, Array]:
        return np.array([-2.3]), np.array([4.0])


@dataclass(frozen=True)
class _ExtendedTube(Model):
    """The shapes are beta and s, with delta² = 1/most (or the law's limit, if less) over 1 + exp -s."""

    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        delta = np.sqrt(min(1.0 / most, 0.4999) / (1.0 + np.exp(-shapes[1])))
        return ExtendedTube(float(moduli[0]), float(moduli[1]), float(shapes[0]), float(delta))

    def base(self, shapes: Array) -> Array:
        return np.ones(2)

    @property
    def positive(self) -> int:
        return 2

    @property
    def starts(self) -> Array:
        return np.array([(beta, s) for beta in (0.05, 0.2, 0.5, 0.9) for s in (-6.0, -3.0, -1.0, 0.0, 1.5, 3.0)])

    def bounds(self, start: Array) -> tuple[Array, Array]:
        return np.array([0.01, -12.0]), np.array([1.0, 8.0])


@dataclass(frozen=True)
class _Ogden(Model):
    """The shapes are the exponents. Every term has mu alpha > 0: stable at all stretches, and a well-posed search."""

    terms: int

    def make(self, moduli: Array, shapes: Array, most: float) -> Material:
        return Ogden(tuple(moduli.tolist()), tuple(shapes.tolist()))

    def base(self, shapes: Array) -> Array:
        return np.sign(shapes)

    @property
    def positive(self) -> int:
        return self.terms

    @property
    def starts(self) -> Array:
        alphas = (-6.0, -4.0, -2.0, -1.0, 0.5, 1.3, 2.0, 3.0, 4.5, 6.5, 9.0, 13.0)
        return np.array(list(combinations(alphas, self.terms)))

    def bounds(self, start: Array) -> tuple[Array, Array]:
        return np.where(start < 0.0, -12.0, 0.1), np.where(start < 0.0, -0.1, 25.0)


MODELS: tuple[Model, ...] = (
    _Linear("neo-hookean", NeoHookean, 1),
    _Linear("mooney-rivlin", _mooney_rivlin, 2),
    _Linear("mooney-rivlin-5", _mooney_rivlin, 5),
    _Linear("yeoh-2", Yeoh, 2),
    _Linear("yeoh", Yeoh, 3),
    _Gent("gent"),
    _ArrudaBoyce("arruda-boyce"),
    _ExtendedTube("extended-tube"),
    *(_Ogden(f"ogden-{terms}", terms) for terms in (1, 2, 3, 4)),
)


def model(name: str) -> Model:
    """Return a model by its name; raises NameNotFoundError with the nearest one.

    >>> model("yeoh").constants
    3
    """
    found = {item.name: item for item in MODELS}.get(name.strip().lower())
    if found is None:
        raise NameNotFoundError(unknown_name("model", name, [item.name for item in MODELS]))
    return found
