"""Cavities of an imported body: closed inner shells of its boundary, or spaces behind a named cap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.mesh.mesh import FaceBlock
from pneumorph.mesh.rims import Rim, cap, cap_corners, rims
from pneumorph.mesh.skin import Index, Mask, Skin
from pneumorph.units import show

Array = NDArray[np.float64]
Point = tuple[float, float, float]

_SAME = 0.01  # of the body's diagonal: rims whose centres are nearer than this lie about one point
_POCKET = 1e-3  # of the body's volume: smaller hollows are no spaces to inflate
_NOTHING = 1e-9  # of the body's volume: a piece that encloses less encloses nothing


@dataclass(frozen=True, eq=False)
class Space:
    """A cavity: facets (count,) of its wall, its volume (mm3), and name -> faces of the caps that close it."""

    facets: Mask
    volume: float
    caps: dict[str, tuple[FaceBlock, ...]] = field(default_factory=dict)


def spaces(skin: Skin, patches: Index, caps: Mapping[str, Point]) -> list[Space]:
    """Return the cavities, ordered along the longest side of the body.

    caps: name -> a point near the middle of the rim that a virtual membrane closes. A rim is a loop of sharp edges
    around a patch (count,); the nearest one is taken, of several about one centre the shortest.

    Raises MeshError for a body in separate parts, or a cap that closes no space.
    """
    chosen = {name: _nearest(name, point, skin, patches) for name, point in caps.items()}
    cut = np.concatenate([rim.edges for rim in chosen.values()]) if chosen else np.empty((0, 2), dtype=np.int64)
    pieces = skin.components(cut)
    count = int(pieces.max()) + 1
    volumes = np.bincount(pieces, skin.shares, minlength=count)
    closing: list[dict[str, tuple[FaceBlock, ...]]] = [{} for _ in range(count)]
    for name, rim in chosen.items():
        sides = _sides(skin, rim, pieces)
        if len(sides) != 2:
            raise MeshError(
                f"cap '{name}': the rim about {_text(rim.centre)} does not part the inside from the outside: has the "
                "space behind it another opening, without a cap?"
            )
        for piece, edges in sides.items():
            closing[piece][name] = cap(edges)
            volumes[piece] += skin.closing_volume(cap_corners(skin.points, closing[piece][name]))
    whole = float(skin.shares.sum())
    bodies = np.flatnonzero(volumes > _NOTHING * whole)
    if len(bodies) > 1:
        where = ", ".join(_text(skin.centres[pieces == body].mean(axis=0)) for body in bodies)
        raise MeshError(f"the body is in {len(bodies)} separate parts, about {where}: expected one that hangs together")
    hollow = np.flatnonzero(volumes < -_NOTHING * whole)
    for name, rim in chosen.items():
        if not any(name in closing[piece] for piece in hollow):
            raise MeshError(f"cap '{name}': no space lies behind the rim about {_text(rim.centre)}")
    along = int(np.argmax(np.ptp(skin.points, axis=0)))
    found = [Space(pieces == piece, -float(volumes[piece]), closing[piece]) for piece in hollow]
    return sorted(found, key=lambda space: float(np.mean(skin.centres[space.facets, along])))


def openings(skin: Skin, patches: Index) -> list[tuple[Rim, float]]:
    """Return the openings behind which a space lies: rim and volume up to it (mm3), the largest space first.

    Of several rims along one inlet the outermost counts, and of several in one plane the shortest.
    """
    found = []
    for rim in rims(skin, patches):
        pieces = skin.components(rim.edges)
        sides = _sides(skin, rim, pieces)
        for piece, edges in sides.items():
            volume = float(skin.shares[pieces == piece].sum())
            volume += skin.closing_volume(cap_corners(skin.points, cap(edges)))
            if volume < -_POCKET * float(skin.shares.sum()):
                found.append((rim, -volume, pieces == piece))
    largest = max((volume for _, volume, _ in found), default=1.0)
    found.sort(key=lambda item: (-round(item[1] / largest, 6), item[0].length))
    result: list[tuple[Rim, float]] = []
    seen = np.zeros(skin.count, dtype=bool)
    for rim, volume, facets in found:
        if not (facets & seen).any():
            result.append((rim, volume))
            seen |= facets
    return result


def _nearest(name: str, point: Point, skin: Skin, patches: Index) -> Rim:
    known = rims(skin, patches)
    if not known:
        raise MeshError(f"cap '{name}': the body has no sharp edges that make a rim")
    distance = [float(np.linalg.norm(rim.centre - np.array(point))) for rim in known]
    # a rim and the outline of the face around it often have one centre: the opening is the shorter of them
    limit = min(distance) + _SAME * float(np.linalg.norm(np.ptp(skin.points, axis=0)))
    return min((rim for rim, d in zip(known, distance, strict=True) if d <= limit), key=lambda rim: rim.length)


def _sides(skin: Skin, rim: Rim, pieces: Index) -> dict[int, Index]:
    """Return piece -> the rim's edges, in order, directed as those of the piece's facets."""
    turned = rim.edges[::-1][:, [1, 0, 2]]
    ahead, back = (np.unique(pieces[skin.facets_beside(edges)]) for edges in (rim.edges, turned))
    if len(ahead) != 1 or len(back) != 1 or ahead[0] == back[0]:
        return {}
    return {int(ahead[0]): rim.edges, int(back[0]): turned}


def describe(opening: tuple[Rim, float]) -> str:
    """Return an opening as text: where its rim is, how long, and how much space lies behind."""
    rim, volume = opening
    return f"{_text(rim.centre)}, rim {show(rim.length, 'length', 3)}, {show(volume, 'volume', 3)} behind it"


def _text(place: Array) -> str:
    return "(" + ", ".join(f"{round(float(x), 3) + 0.0:.4g}" for x in place) + ") mm"
