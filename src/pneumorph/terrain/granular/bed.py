"""A bed of grains in a box: what it is, how grains are strewn, and the LAMMPS input that lets them settle."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.terrain.granular.sands import Sand
from pneumorph.terrain.rover import GRAVITY
from pneumorph.terrain.si import METRE
from pneumorph.units import show

Array = NDArray[np.float64]

KILOGRAM_PER_CUBIC_METRE = 1e12  # of a tonne/mm3
GRAINS_FILE, RESTART_FILE = "grains.data", "settled.restart"
_STREW_SPEED = 0.3  # m/s, in random directions, so that no lattice is left
_LOOSE = 1.12  # distance of strewn grains over the largest diameter
_SLACK = 0.3  # reach of neighbour lists beyond contact, in mean radii: few rebuilds against short lists

# the box is open above as far as grains fly; grains stay in their order, which costs less than sorting them here
SPACE = (
    "units si\natom_style sphere\natom_modify map array sort 0 0\nboundary f f fm\nnewton off\ncomm_modify vel yes\n"
)


@dataclass(frozen=True)
class Bed:
    """Grains in a box of length (x), width (y) and height (z), mm, from the origin on.

    radius: mean, mm; radii are spread evenly over +- spread of it. seed: of places and radii. step: time step, s.

    Given by the study: the box, and 30,000 to 35,000 grains. Assumed: their size, 20 mm +- 10 %, so that they fill the
    box to a depth of about 190 mm.

    Raises InputError for dimensions that are not positive, fewer than one grain, a spread that is not between 0 and
    one half, a time step that is not stable, and grains that do not fit into the box when they are strewn.
    """

    sand: Sand
    grains: int = 32_500
    length: float = 4_000.0
    width: float = 3_000.0
    height: float = 800.0
    radius: float = 20.0
    spread: float = 0.1
    seed: int = 1
    step: float = 2e-4

    def __post_init__(self) -> None:
        for name in ("length", "width", "height", "radius"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(f"bed: {name} = {show(getattr(self, name), 'length')}, expected more than 0")
        if self.grains < 1:
            raise InputError(f"bed: grains = {self.grains}, expected at least 1")
        if not 0.0 <= self.spread < 0.5:
            raise InputError(f"bed: spread = {self.spread:g}, expected at least 0 and below 0.5")
        self.sand.check_step(self.step, (1.0 - self.spread) * self.radius)
        columns, rows, layers = self._lattice()
        if columns < 1 or rows < 1 or layers * self.pitch > self.height:
            raise InputError(
                f"bed: {self.grains} grains of radius {show(self.radius, 'length')} do not fit loosely into the box of "
                f"{show(self.length, 'length')} x {show(self.width, 'length')} x {show(self.height, 'length')}: "
                f"expected at most {max(0, columns * rows) * int(self.height // self.pitch)}"
            )

    @property
    def largest_radius(self) -> float:
        """Radius of the largest grain, mm."""
        return (1.0 + self.spread) * self.radius

    @property
    def pitch(self) -> float:
        """Distance of strewn grains, mm: no two overlap."""
        return 2.0 * self.largest_radius * _LOOSE

    @property
    def digest(self) -> str:
        """A name of 16 letters for all that the settled bed depends on but the release of LAMMPS."""
        return hashlib.sha256(json.dumps(asdict(self), sort_keys=True).encode()).hexdigest()[:16]

    def _lattice(self) -> tuple[int, int, int]:
        columns, rows = int(self.length // self.pitch), int(self.width // self.pitch)
        return columns, rows, ceil(self.grains / max(1, columns * rows))

    def strewn(self) -> tuple[Array, Array]:
        """Return places (n, 3) and radii (n,), mm: a loose lattice, each grain moved at random within its cell."""
        random = np.random.default_rng(self.seed)
        radii = self.radius * random.uniform(1.0 - self.spread, 1.0 + self.spread, self.grains)
        columns, rows, layers = self._lattice()
        numbers = np.arange(self.grains)
        layer, place = np.divmod(numbers, columns * rows)
        # of a layer that is not full the places are spread evenly
        last = self.grains - (layers - 1) * columns * rows
        place = np.where(layer == layers - 1, place * columns * rows // max(1, last), place)
        cell = np.column_stack([place % columns, place // columns, layer])
        pitch = np.array([self.length / columns, self.width / rows, self.pitch])
        room = 0.5 * np.array(pitch)[None, :] - radii[:, None]
        return (cell + 0.5) * pitch + 0.98 * room * random.uniform(-1.0, 1.0, (self.grains, 3)), radii

    def data_text(self) -> str:
        """Return the strewn grains as the data file that the input reads."""
        places, radii = self.strewn()
        size = (self.length, self.width, self.height)
        head = ["strewn grains", "", f"{self.grains} atoms", "1 atom types", ""]
        head += [f"0 {value * METRE:.9g} {axis}lo {axis}hi" for axis, value in zip("xyz", size, strict=True)]
        density = self.sand.density * KILOGRAM_PER_CUBIC_METRE
        rows = [
            f"{i} 1 {2.0 * r * METRE:.9g} {density:.9g} {x * METRE:.9g} {y * METRE:.9g} {z * METRE:.9g}"
            for i, ((x, y, z), r) in enumerate(zip(places, radii, strict=True), start=1)
        ]
        random = np.random.default_rng([self.seed, 1])
        speeds = [
            f"{i} {' '.join(f'{v:.6g}' for v in random.uniform(-_STREW_SPEED, _STREW_SPEED, 3))} 0 0 0"
            for i in range(1, self.grains + 1)
        ]
        return "\n".join([*head, "", "Atoms # sphere", "", *rows, "", "Velocities", "", *speeds, ""])

    def settling_input(self, time: float) -> str:
        """Return the whole LAMMPS input that strews the grains and lets them fall and settle for a time, s."""
        steps = ceil(time / self.step)
        return self.strewing() + self.physics() + f"run {steps} post no\nwrite_restart {RESTART_FILE}\n"

    def strewing(self) -> str:
        """Return the commands that read the strewn grains."""
        return SPACE + f"read_data {GRAINS_FILE}\n"

    def physics(self) -> str:
        """Return the commands for contacts, walls, gravity and motion; also after a restart file has been read."""
        law = self.sand.law()
        return (
            f"neighbor {_SLACK * self.radius * METRE:.6g} bin\n"
            "neigh_modify delay 0 every 1 check yes\n"
            f"pair_style granular\npair_coeff * * {law}\n"
            f"timestep {self.step:.9g}\n"
            f"fix floor all wall/gran granular {law} zplane 0 NULL\n"
            f"fix ends all wall/gran granular {law} xplane 0 {self.length * METRE:.9g}\n"
            f"fix sides all wall/gran granular {law} yplane 0 {self.width * METRE:.9g}\n"
            f"fix weight all gravity {GRAVITY * METRE:.9g} vector 0 0 -1\n"
            "fix motion all nve/sphere\n"
            "thermo_modify lost error\n"
        )


def solid_fraction(places: Array, radii: Array, footprint: float, low: float, high: float) -> float:
    """Return the part of the space between two heights that the grains fill; footprint: area of the bed, mm2.

    Each sphere's part between the heights counts, pi (r^2 h - h^3 / 3) between two planes.
    """
    z = places[:, 2]
    a, b = (np.clip(level - z, -radii, radii) for level in (low, high))
    volume = pi * (radii**2 * (b - a) - (b**3 - a**3) / 3.0)
    return float(volume.sum()) / (footprint * (high - low))


def surface_level(places: Array, radii: Array, cell: float) -> float:
    """Return the height of a bed's surface, mm: the highest grain's top, mean over square cells of a side, mm."""
    column = np.floor(places[:, :2] / cell).astype(int)
    _, number = np.unique(column, axis=0, return_inverse=True)
    tops = np.full(int(number.max()) + 1, -np.inf)
    np.maximum.at(tops, number.ravel(), places[:, 2] + radii)
    return float(tops.mean())
