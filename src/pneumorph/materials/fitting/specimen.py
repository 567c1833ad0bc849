"""One test of one specimen: its mode, its stretches and its nominal stresses, and where each point was read."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.materials.material import Material
from pneumorph.materials.tension import MODES

Array = NDArray[np.float64]

# beyond these a value is a wrong unit or a wrong column, not rubber
SMALLEST_STRETCH, LARGEST_STRETCH = 0.05, 20.0

_OTHER_NAMES = {
    "uniaxial tension": "uniaxial", "uniaxial compression": "uniaxial", "simple tension": "uniaxial",
    "tension": "uniaxial", "tensile": "uniaxial", "compression": "uniaxial", "ut": "uniaxial", "uc": "uniaxial",
    "equibiaxial tension": "equibiaxial", "biaxial": "equibiaxial", "equi biaxial": "equibiaxial",
    "et": "equibiaxial", "eb": "equibiaxial", "bulge": "equibiaxial",
    "planar tension": "planar", "pure shear": "planar", "plane strain tension": "planar", "ps": "planar",
}  # fmt: skip


def mode_named(text: str) -> str:
    """Return the mode that a test is called by: 'Pure shear' -> 'planar'.

    Raises NameNotFoundError, with the three modes, for a name that is not one.

    >>> mode_named("equi-biaxial")
    'equibiaxial'
    """
    plain = " ".join(text.lower().replace("-", " ").replace("_", " ").split())
    name = _OTHER_NAMES.get(plain, plain)
    if name not in MODES:
        raise NameNotFoundError(unknown_name("test", text.strip(), MODES))
    return name


def nominal_stress(material: Material, mode: str, stretch: ArrayLike) -> Array:
    """Return the nominal stress, MPa, of a material in a mode at stretches of any shape."""
    curves = {
        "uniaxial": material.uniaxial_tension,
        "equibiaxial": material.equibiaxial_tension,
        "planar": material.planar_tension,
    }
    return curves[mode](stretch)


@dataclass(frozen=True, eq=False)
class SpecimenTest:
    """A test: what a machine recorded, or what `prepare` made of it.

    mode:    "uniaxial", "equibiaxial" or "planar".
    stretch: stretch along the pull (n,).
    stress:  nominal stress along the pull (n,), MPa: force over undeformed area; negative in compression.
    source:  name of the file or specimen.
    lines:   line of the file of each point (n,); 0 where there is none.
    notes:   what was done to the record, in words.

    Raises NameNotFoundError for another mode, InputError for arrays that do not match, are empty, or hold values that
    are not finite, and for stretches outside 0.05 to 20.
    """

    mode: str
    stretch: Array
    stress: Array
    source: str = "data"
    lines: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "mode", mode_named(self.mode))
        for name in ("stretch", "stress"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))
        if not len(self.lines):
            object.__setattr__(self, "lines", np.zeros(len(self.stretch), dtype=np.int64))
        shapes = self.stretch.shape, self.stress.shape, self.lines.shape
        if len(set(shapes)) > 1 or self.stretch.ndim != 1 or not len(self.stretch):
            raise InputError(f"{self.source}: stretch, stress and lines have shapes {shapes}, allowed: the same (n,)")
        for name, values in (("stretch", self.stretch), ("stress", self.stress)):
            wrong = np.flatnonzero(~np.isfinite(values))
            if len(wrong):
                raise InputError(f"{self.where(wrong[0])}: {name} = {values[wrong[0]]}, allowed: finite numbers")
        wrong = np.flatnonzero((self.stretch < SMALLEST_STRETCH) | (self.stretch > LARGEST_STRETCH))
        if len(wrong):
            raise InputError(
                f"{self.where(wrong[0])}: stretch = {self.stretch[wrong[0]]:.4g}, allowed: {SMALLEST_STRETCH} to "
                f"{LARGEST_STRETCH:g}; it is 1 in the undeformed state (check the unit: a strain of 50 % is 1.5)"
            )

    def where(self, index: int) -> str:
        """Return the source of a point: 'data.csv line 12'."""
        line = self.lines[index]
        return f"{self.source} line {line}" if line else f"{self.source} point {index + 1}"

    @property
    def reach(self) -> float:
        """The largest strain of either sign."""
        return float(np.abs(self.stretch - 1.0).max())

    def take(self, index: ArrayLike, note: str = "") -> SpecimenTest:
        """Return the test with some of its points, and one more note if there is one."""
        index = np.asarray(index)
        return replace(
            self,
            stretch=self.stretch[index],
            stress=self.stress[index],
            lines=self.lines[index],
            notes=(*self.notes, note) if note else self.notes,
        )
