"""Selectors: which facets of an imported body bear a name, by direction, place, shape or the file's own sets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError, NameNotFoundError, unknown_name
from pneumorph.mesh.skin import Index, Mask, Skin
from pneumorph.units import show

Point = tuple[float, float, float]

_WITHIN = np.cos(np.radians(5.0))  # of a direction
_NEAR = 1e-4  # of a plane or the sides of a box, as a fraction of the body's diagonal


@dataclass(frozen=True)
class Selector:
    """Conditions that all hold for the facets chosen; at least one is given.

    set: they are in a set of the file: a named or coloured ("#rrggbb") CAD face, surface, node or element set, group.
    normal: their outward normal lies within 5 degrees of this direction.
    axis, at: they lie in the plane where the coordinate "x", "y" or "z" has this value (mm).
    box: they lie between these two corners (mm), sides included.
    largest_planar: of the flat patches chosen so far, the one with the largest area; a patch ends at sharp edges.
    nearest: of the patches chosen so far, the one with the facet nearest to this point (mm).

    Without `set` only facets on the outside count, none of a cavity. Raises InputError for no or half a condition.
    """

    set: str | None = None
    normal: Point | None = None
    axis: str | None = None
    at: float | None = None
    box: tuple[Point, Point] | None = None
    largest_planar: bool = False
    nearest: Point | None = None

    def __post_init__(self) -> None:
        if (self.axis is None) != (self.at is None):
            raise InputError("a selector by plane needs both: axis = 'x', 'y' or 'z', and at, where it lies")
        if self.axis is not None and self.axis not in ("x", "y", "z"):
            raise InputError(unknown_name("axis", self.axis, "xyz"))
        if not self.largest_planar and not any(
            v is not None for v in (self.set, self.normal, self.at, self.box, self.nearest)
        ):
            raise InputError("an empty selector: expected set, normal, axis and at, box, largest_planar or nearest")
        if self.normal is not None and (len(self.normal) != 3 or not any(self.normal)):
            raise InputError(f"normal = {self.normal}: expected 3 numbers, not all zero")
        if self.box is not None and any(a > b for a, b in zip(*self.box, strict=True)):
            raise InputError(f"box = {self.box}: expected the low corner first, then the high one")

    def facets(self, skin: Skin, outside: Mask, patches: Index, sets: Mapping[str, Mask]) -> Mask:
        """Return the facets (count,) that are chosen, maybe none. outside: facets that belong to no cavity.

        Raises NameNotFoundError for a set that the file does not have.
        """
        if self.set is not None and self.set not in sets:
            raise NameNotFoundError(unknown_name("set", self.set, sets))
        chosen = (outside if self.set is None else sets[self.set]).copy()
        if self.normal is not None:
            chosen &= skin.normals @ (np.array(self.normal) / np.linalg.norm(self.normal)) > _WITHIN
        known = skin.corners >= 0
        corners = skin.points[skin.corners]
        near = _NEAR * float(np.linalg.norm(np.ptp(skin.points, axis=0)))
        if self.axis is not None and self.at is not None:
            off = np.abs(corners[..., "xyz".index(self.axis)] - self.at)
            chosen &= np.where(known, off, 0.0).max(axis=1) < near
        if self.box is not None:
            low, high = (np.array(corner) for corner in self.box)
            inside = ((corners > low - near) & (corners < high + near)).all(axis=2)
            chosen &= (inside | ~known).all(axis=1)
        if self.largest_planar:
            flat = [patch for patch in np.unique(patches[chosen]) if skin.flat(patches == patch)]
            area = [skin.areas[chosen & (patches == patch)].sum() for patch in flat]
            chosen &= patches == (flat[int(np.argmax(area))] if flat else -1)
        if self.nearest is not None and chosen.any():
            distance = np.linalg.norm(skin.centres - np.array(self.nearest), axis=1)
            chosen &= patches == patches[np.argmin(np.where(chosen, distance, np.inf))]
        return chosen

    def __str__(self) -> str:
        words = [f"set '{self.set}'"] if self.set is not None else []
        words += [f"normal {_text(self.normal, '')}"] if self.normal is not None else []
        words += [f"plane {self.axis} = {show(self.at, 'length')}"] if self.at is not None else []
        words += [f"box {_text(self.box[0])} to {_text(self.box[1])}"] if self.box is not None else []
        words += ["largest planar"] if self.largest_planar else []
        words += [f"nearest to {_text(self.nearest)}"] if self.nearest is not None else []
        return ", ".join(words)


def named_facets(
    skin: Skin, outside: Mask, patches: Index, sets: Mapping[str, Mask], faces: Mapping[str, Selector]
) -> dict[str, Mask]:
    """Return name -> facets (count,) of each selector.

    Raises MeshError for a selector that catches nothing, or two that claim the same facets.
    """
    claimed: dict[str, Mask] = {}
    for name, selector in faces.items():
        try:
            mask = selector.facets(skin, outside, patches, sets)
        except NameNotFoundError as error:
            raise NameNotFoundError(f"face '{name}': {error}") from None
        if not mask.any():
            raise MeshError(
                f"face '{name}': its selector ({selector}) catches no facet; the body lies in "
                f"{_text(skin.points.min(axis=0))} to {_text(skin.points.max(axis=0))}"
            )
        for other, taken in claimed.items():
            both = mask & taken
            if both.any():
                where = _text(skin.centres[both].mean(axis=0))
                raise MeshError(
                    f"the faces '{other}' and '{name}' claim the same {int(both.sum())} facets, about {where}: "
                    f"their selectors are ({faces[other]}) and ({selector})"
                )
        claimed[name] = mask
    return claimed


def _text(place: Iterable[float] | NDArray[np.float64], unit: str = " mm") -> str:
    return "(" + ", ".join(f"{round(float(x), 9) + 0.0:.4g}" for x in place) + f"){unit}"
