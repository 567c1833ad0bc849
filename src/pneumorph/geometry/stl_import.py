"""STL files in: points and triangles of closed surfaces, with holes, overlaps and directions checked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from pneumorph.errors import GeometryError

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SAME = 1e-6  # corners nearer than this fraction of the diagonal are one point: STL keeps 7 digits
_SAMPLE = 200  # corners of a shell that are tested against another one


def read_stl(paths: Sequence[Path]) -> tuple[Array, Index]:
    """Return points (n, 3) and triangles (k, 3) of closed surfaces, in the file's unit; normals leave the solid.

    Several files are one body: the solid's outer surface and the walls of its cavities. Which shells are walls of
    cavities follows from which lies in which, so the direction of a whole shell in the file does not matter.

    Raises GeometryError for a file that is no STL, a surface with holes (says where), triangles that face different
    ways, or shells that cross.
    """
    soup = np.concatenate([_triangles(path) for path in paths])
    owner = ", ".join(f"'{path}'" for path in paths)
    points, triangles = _merged(soup)
    if not len(triangles):
        raise GeometryError(f"{owner}: no triangle with an area")
    shells = _checked_shells(owner, points, triangles)
    return points, _outward(owner, points, triangles, shells)


def _triangles(path: Path) -> Array:
    """Return the corners (k, 3, 3) in a binary or text STL file."""
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and len(data) == 84 + 50 * count:
        table = np.frombuffer(data, dtype=[("vectors", "<f4", (4, 3)), ("attribute", "<u2")], offset=84)
        corners = table["vectors"][:, 1:].astype(np.float64)
    else:
        words = data.decode("ascii", errors="replace").lower().split()
        if words[:1] != ["solid"] or "facet" not in words:
            raise GeometryError(f"'{path}': neither a text STL file nor a binary one of {count} triangles")
        try:
            numbers = [words[i + 1 : i + 4] for i, word in enumerate(words) if word == "vertex"]
            corners = np.array(numbers, dtype=np.float64).reshape(-1, 3, 3)
        except ValueError as error:
            raise GeometryError(f"'{path}': a text STL file with a damaged vertex ({error})") from error
    if not len(corners) or not np.isfinite(corners).all():
        raise GeometryError(f"'{path}': expected at least one triangle, and finite coordinates")
    return corners


def _merged(soup: Array) -> tuple[Array, Index]:
    """Return the points, each once, and the triangles that have three different ones."""
    flat = soup.reshape(-1, 3)
    distinct, number = np.unique(flat, axis=0, return_inverse=True)
    reach = _SAME * float(np.linalg.norm(np.ptp(flat, axis=0)))
    close = cKDTree(distinct).query_pairs(reach, output_type="ndarray") if reach > 0.0 else np.empty((0, 2), int)
    graph = coo_array((np.ones(len(close)), (close[:, 0], close[:, 1])), shape=(len(distinct),) * 2)
    label = connected_components(graph, directed=False)[1]
    _, first = np.unique(label, return_index=True)
    triangles = label[number.ravel()].reshape(-1, 3).astype(np.int64)
    good = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return distinct[first], triangles[good]


def _checked_shells(owner: str, points: Array, triangles: Index) -> Index:
    """Return the number (k,) of the shell of each triangle."""
    directed = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    facet = np.tile(np.arange(len(triangles)), 3)
    keys, inverse, counts = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.ravel()
    if (counts == 1).any():
        raise GeometryError(f"{owner}: {_holes(points, keys[counts == 1])}")
    ahead = np.bincount(inverse, directed[:, 0] < directed[:, 1])
    crossed = 2.0 * ahead != counts
    if crossed.any():
        place = _text(points[keys[crossed][0]].mean(axis=0))
        raise GeometryError(
            f"{owner}: neighbouring triangles face different ways, or sheets meet, at {int(crossed.sum())} edges, "
            f"one at {place}: repair the surface where it was made"
        )
    # shells hang together by edges of two triangles; where four meet, two shells touch
    order = np.argsort(inverse, kind="stable")
    start = np.cumsum(counts) - counts
    first, second = order[start[counts == 2]], order[start[counts == 2] + 1]
    graph = coo_array((np.ones(len(first)), (facet[first], facet[second])), shape=(len(triangles),) * 2)
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _holes(points: Array, edges: Index) -> str:
    """Return a sentence on the holes that open edges (k, 2) make."""
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(len(points),) * 2)
    label = connected_components(graph, directed=False)[1][edges[:, 0]]
    names, counts = np.unique(label, return_counts=True)
    middles = points[edges].mean(axis=1)
    places = [
        f"{_text(middles[label == name].mean(axis=0))} ({count} open edges)"
        for name, count in zip(names, counts, strict=True)
    ]
    more = f" and {len(places) - 5} more" if len(places) > 5 else ""
    holes = "a hole" if len(places) == 1 else f"{len(places)} holes"
    return f"the surface has {holes}, about {', '.join(places[:5])}{more}, in the file's unit: expected closed surfaces"


def _outward(owner: str, points: Array, triangles: Index, shells: Index) -> Index:
    """Return the triangles with shells turned so that all normals leave the solid."""
    count = int(shells.max()) + 1
    depth = np.zeros(count, dtype=int)
    for inner in range(count):
        nodes = np.unique(triangles[shells == inner])
        sample = points[nodes[:: max(1, len(nodes) // _SAMPLE)]]
        for outer in range(count):
            if outer == inner or not _overlapping(points, triangles, shells, inner, outer):
                continue
            inside = _winding(sample, points[triangles[shells == outer]]) > 0.5
            if inside.any() and not inside.all():
                place = _text(sample[inside].mean(axis=0))
                raise GeometryError(f"{owner}: two closed surfaces overlap, about {place} in the file's unit")
            depth[inner] += int(inside.all())
    turned = triangles.copy()
    for shell in range(count):
        mine = shells == shell
        volume = float(np.linalg.det(points[triangles[mine]] - points.mean(axis=0)).sum())
        if (volume > 0.0) != (depth[shell] % 2 == 0):
            turned[mine] = triangles[mine][:, ::-1]
    return turned


def _overlapping(points: Array, triangles: Index, shells: Index, first: int, second: int) -> bool:
    boxes = [points[np.unique(triangles[shells == shell])] for shell in (first, second)]
    return bool(
        (boxes[0].min(axis=0) < boxes[1].max(axis=0)).all() and (boxes[1].min(axis=0) < boxes[0].max(axis=0)).all()
    )


def _winding(places: Array, corners: Array) -> Array:
    """Return how often closed triangles (k, 3, 3) wind about places (m, 3), without sign.

    Sum of the triangles' solid angles over 4 pi (van Oosterom and Strackee 1983).
    """
    total = np.zeros(len(places))
    for i, place in enumerate(places):
        a, b, c = np.moveaxis(corners - place, 1, 0)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        top = np.einsum("ij,ij->i", a, np.cross(b, c))
        below = la * lb * lc + np.einsum("ij,ij->i", a, b) * lc
        below += np.einsum("ij,ij->i", b, c) * la + np.einsum("ij,ij->i", c, a) * lb
        total[i] = 2.0 * np.arctan2(top, below).sum()
    return np.abs(total) / (4.0 * np.pi)


def _text(place: Array) -> str:
    return "(" + ", ".join(f"{round(float(x), 6) + 0.0:.4g}" for x in place) + ")"
