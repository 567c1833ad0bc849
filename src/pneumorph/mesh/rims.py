"""Rims: the closed loops of sharp edges around smooth patches, and the virtual caps that close an opening there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mesh.mesh import FaceBlock
from pneumorph.mesh.skin import Index, Skin

Array = NDArray[np.float64]

_CHORDS = np.array([[1, 1, 0], [0, 1, 1], [1, 0, 1]]) / 2.0


@dataclass(frozen=True, eq=False)
class Rim:
    """A closed loop. edges (k, 3): its edges (end, end, middle) in order, in the sense of the patch that it borders;
    centre (3,): centre of the line, mm; length: mm."""

    edges: Index
    centre: Array
    length: float


def rims(skin: Skin, patches: Index) -> list[Rim]:
    """Return the loops that border patches (count,), each once."""
    first, second = skin.pairs
    border = patches[skin.owner[first]] != patches[skin.owner[second]]
    found: dict[frozenset[int], Rim] = {}
    edges = np.concatenate([first[border], second[border]])
    for patch in np.unique(patches[skin.owner[edges]]):
        mine = skin.edge[edges[patches[skin.owner[edges]] == patch]]
        for loop in _loops(mine):
            x = skin.points[loop]
            lengths = np.linalg.norm(x[:, 2] - x[:, 0], axis=1) + np.linalg.norm(x[:, 1] - x[:, 2], axis=1)
            # an edge's own centre by Simpson's rule
            centre = np.average((x[:, 0] + x[:, 1] + 4.0 * x[:, 2]) / 6.0, axis=0, weights=lengths)
            found.setdefault(frozenset(loop[:, 0].tolist()), Rim(loop, centre, float(lengths.sum())))
    return list(found.values())


def cap(edges: Index) -> tuple[FaceBlock, ...]:
    """Return the faces over a loop of edges (k, 3), whose directed edges run against those of the loop.

    A fan of plane triangles about one corner of the loop, and between each edge and its chord a lens: together they
    have exactly the edges of the body's quadratic faces in every deformation, so that the cavity stays closed.
    """
    apex = edges[0, 0]
    fan = edges[1:-1]
    triangles = np.column_stack([np.full(len(fan), apex), fan[:, 1], fan[:, 0]])
    return FaceBlock("triangle3", triangles), FaceBlock("lens3", edges[:, [1, 0, 2]])


def cap_corners(points: Array, blocks: tuple[FaceBlock, ...]) -> Array:
    """Return a cap as 6-node triangles (m, 6, 3), mm."""
    triangles, lenses = (points[block.nodes] for block in blocks)
    chord = lenses[:, :2].mean(axis=1, keepdims=True)
    ends = np.concatenate([lenses[:, :2], chord], axis=1)
    mids = np.einsum("cn,eni->eci", _CHORDS, ends)
    mids[:, 0] = lenses[:, 2]
    flat = np.concatenate([triangles, np.einsum("cn,eni->eci", _CHORDS, triangles)], axis=1)
    return np.concatenate([flat, np.concatenate([ends, mids], axis=1)])


def _loops(edges: Index) -> list[Index]:
    """Return directed edges (e, 3) as closed loops; where loops touch in a node they may be joined otherwise."""
    following: dict[int, list[int]] = {}
    for number, start in enumerate(edges[:, 0].tolist()):
        following.setdefault(start, []).append(number)
    loops = []
    while following:
        start = next(iter(following))
        place, loop = start, []
        while place in following:
            number = following[place].pop()
            if not following[place]:
                del following[place]
            loop.append(number)
            place = int(edges[number, 1])
            if place == start:
                break
        if place == start and len(loop) > 2:
            loops.append(edges[loop])
    return loops
