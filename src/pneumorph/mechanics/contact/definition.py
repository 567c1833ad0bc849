"""What may touch what: a surface itself, a rigid obstacle, or another surface."""

from __future__ import annotations

from dataclasses import dataclass, field

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.obstacles import Motion, Obstacle


@dataclass(frozen=True)
class Contact:
    """Contact without penetration, with Coulomb friction.

    name:     how histories and reports call it.
    faces:    names of the faces of the mesh, or of free bodies, that may touch.
    against:  a rigid obstacle; or a tuple of other faces and free bodies; or nothing: the faces touch themselves and
              each other. The two sides of a wall are never in contact: name outer faces and those of each cavity in
              contacts of their own.
    friction: coefficient of Coulomb friction, 0 to 5.
    reach:    distance (mm) below which surfaces begin to push each other off, and an upper bound of the error of their
              places; default: a thousandth of the body's size, but at most a fifth of the smallest gap that a
              surface has with itself or another.
    stiffness: pressure (MPa) at which they are at about three quarters of the reach; default: the smallest shear
              modulus of the model; between rigid bodies, at most what suits the weight of a free one.
    body:     name of the obstacle in messages, histories and pictures; default: its kind.
    creep:    speed (mm/s) below which friction holds, not to the full; default: a thousandth of the body's size per
              second. A phase without duration counts as one second.
    """

    name: str
    faces: tuple[str, ...]
    against: Obstacle | tuple[str, ...] | None = None
    friction: float = 0.0
    reach: float | None = field(default=None, kw_only=True)
    stiffness: float | None = field(default=None, kw_only=True)
    creep: float | None = field(default=None, kw_only=True)
    body: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        owner = f"contact '{self.name}'"
        for what, names in (("faces", self.faces), ("against", self.against)):
            if isinstance(names, str) or (isinstance(names, tuple) and not names):
                raise InputError(f"{owner}: {what} = {names!r}, expected a tuple of face names")
        if not 0.0 <= self.friction <= 5.0:
            raise InputError(f"{owner}: friction = {self.friction}, allowed: 0 to 5")
        units = {"reach": "mm", "stiffness": "MPa", "creep": "mm/s"}
        for what, unit in units.items():
            value = getattr(self, what)
            if value is not None and not 0.0 < value < float("inf"):
                raise InputError(f"{owner}: {what} = {value} {unit}, allowed: more than 0")
        if isinstance(self.against, tuple) and set(self.against) & set(self.faces):
            twice = ", ".join(sorted(set(self.against) & set(self.faces)))
            raise InputError(f"{owner}: {twice} is on both sides; leave `against` out for contact with itself")

    @property
    def other_faces(self) -> tuple[str, ...]:
        """The names of faces and free bodies in `against`."""
        return self.against if isinstance(self.against, tuple) else ()

    @property
    def other(self) -> str:
        """What the faces may touch, in words: the obstacle by its name or kind, other faces, or 'itself'."""
        if self.against is None:
            return "itself"
        if isinstance(self.against, tuple):
            return ", ".join(self.against)
        kind = type(self.against).__name__
        return f"{kind} '{self.body}'" if self.body else kind

    @property
    def motion(self) -> Motion | None:
        """How the obstacle moves; None where it is fixed, or there is none."""
        return None if self.against is None or isinstance(self.against, tuple) else self.against.motion
