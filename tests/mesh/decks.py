"""Small meshes as text: blocks of hexahedra, with a hole where a cell is left out."""

from __future__ import annotations

import itertools

CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def lattice(counts, left_out=()):
    """Return nodes (places) and cells (8 node numbers from 1) of unit blocks."""
    places = list(itertools.product(*(range(n + 1) for n in counts)))
    number = {place: i + 1 for i, place in enumerate(places)}
    cells = [
        [number[tuple(a + b for a, b in zip(cell, corner, strict=True))] for corner in CORNERS]
        for cell in itertools.product(*(range(n) for n in counts))
        if cell not in left_out
    ]
    return places, cells


def deck(counts, left_out=(), extra="", kind="C3D8"):
    """Return an input deck of unit hexahedra, all in the set BODY; unused nodes stay in it."""
    places, cells = lattice(counts, left_out)
    lines = ["*NODE, NSET=ALL", *(f"{i + 1}, {x}, {y}, {z}" for i, (x, y, z) in enumerate(places))]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=BODY"]
    lines += [f"{i + 1}, {', '.join(map(str, nodes))}" for i, nodes in enumerate(cells)]
    return "\n".join([*lines, extra]) + "\n"
