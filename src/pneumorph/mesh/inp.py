"""Abaqus and CalculiX input decks: nodes, solid elements, sets and surfaces. Everything else in a deck is left aside.

Our own reader, because meshio 5.3 leaves out *SURFACE and the NSET of *NODE. Node orders and face numbers are those
of the CalculiX manual; mid-edge nodes follow there in the order of VTK.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# C3D10, C3D10H, C3D8R, ... -> kind; hybrid, reduced and incompatible variants have the same nodes
_SOLIDS = {4: "tetra", 6: "wedge", 8: "hexahedron", 10: "tetra10", 15: "wedge15", 20: "hexahedron20"}
_SOLID = re.compile(r"^C3D(4|6|8|10|15|20)[HRIMST]*$")
# elements without stiffness of their own that mark faces: how many corners -> names
_FLAT = re.compile(r"^(?:CPS|CPE|CAX|M3D|SFM3D|S|STRI|DS)(3|4|6|8|65)[RS5]*$")
_FLAT_CORNERS = {"3": 3, "6": 3, "65": 3, "4": 4, "8": 4}

# S1, S2, ... of an element: its corners
_SIDES = {
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
}


@dataclass
class Deck:
    """What a deck holds. nodes: number -> place; elements: number -> (kind, node numbers) of solids; flat: of elements
    that only mark faces; node_sets, element_sets: name -> numbers; surfaces: name -> (element or set, side) or node
    set, side ""; sections: element sets of *SOLID SECTION in order."""

    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, tuple[str, list[int]]] = field(default_factory=dict)
    flat: dict[int, list[int]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    element_sets: dict[str, list[int]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    sections: list[str] = field(default_factory=list)
    unsupported: dict[str, int] = field(default_factory=dict)


def read_deck(path: Path) -> Deck:
    """Return the mesh in a deck. Raises MeshError with the line for what cannot be read, and for elements that are not
    supported, with their types."""
    deck, keyword = Deck(), ""
    options: dict[str, str] = {}
    reader = _Reader(path, deck)
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), start=1):
        text = line.strip()
        if not text or text.startswith("**"):
            continue
        if text.startswith("*"):
            reader.flush()
            keyword, options = _keyword(text)
            reader.line = number
            reader.begin(keyword, options)
            continue
        reader.line = number
        try:
            reader.data(keyword, options, [part.strip() for part in text.split(",")])
        except (ValueError, IndexError, OverflowError) as error:
            raise MeshError(f"'{path}', line {number}: cannot read '{text[:60]}' under {keyword} ({error})") from error
    reader.flush()
    if deck.unsupported:
        kinds = ", ".join(f"{kind} ({count})" for kind, count in sorted(deck.unsupported.items()))
        raise MeshError(
            f"'{path}': elements that are not supported: {kinds}. Supported: C3D4, C3D6, C3D8, C3D10, C3D15, C3D20 and "
            "their variants; triangles and quadrilaterals mark faces"
        )
    if not deck.nodes or not deck.elements:
        raise MeshError(
            f"'{path}': {len(deck.nodes)} nodes and {len(deck.elements)} solid elements, expected some of both"
        )
    return deck


class _Reader:
    """Fills a deck, data line by data line; elements may run over several lines."""

    def __init__(self, path: Path, deck: Deck):
        self.path, self.deck, self.line = path, deck, 0
        self._pending: list[int] = []
        self._kind, self._type, self._set = "", "", ""
        self._instances = 0

    def begin(self, keyword: str, options: dict[str, str]) -> None:
        """Take note of a keyword line."""
        if keyword == "*ELEMENT":
            self._type, self._set = options.get("TYPE", "").upper(), options.get("ELSET", "")
            solid = _SOLID.match(self._type)
            self._kind = _SOLIDS[int(solid[1])] if solid else "flat" if _FLAT.match(self._type) else ""
        elif keyword == "*SOLID SECTION":
            self.deck.sections.append(options.get("ELSET", ""))
        elif keyword == "*SURFACE":
            self.deck.surfaces.setdefault(options.get("NAME", ""), [])
        elif keyword == "*INCLUDE":
            raise MeshError(f"'{self.path}', line {self.line}: *INCLUDE is not followed; put everything into one file")
        elif keyword == "*INSTANCE":
            self._instances += 1
            if self._instances > 1:
                raise MeshError(f"'{self.path}', line {self.line}: a second *INSTANCE; expected one part")

    def data(self, keyword: str, options: dict[str, str], parts: list[str]) -> None:
        """Take one data line; raises ValueError or IndexError where it does not fit."""
        deck = self.deck
        if keyword == "*NODE":
            number = int(parts[0])
            x, y, z = ([float(part or 0.0) for part in parts[1:4]] + [0.0] * 3)[:3]
            deck.nodes[number] = (x, y, z)
            if "NSET" in options:
                deck.node_sets.setdefault(options["NSET"], []).append(number)
        elif keyword == "*ELEMENT":
            self._pending += [int(part) for part in parts if part]
            if len(self._pending) > self._width():
                self.flush()
        elif keyword in ("*NSET", "*ELSET"):
            sets, name = (deck.node_sets, "NSET") if keyword == "*NSET" else (deck.element_sets, "ELSET")
            mine = sets.setdefault(options.get(name, ""), [])
            words = [part for part in parts if part]
            if "GENERATE" in options:
                first, last, step = ([int(word) for word in words] + [1])[:3]
                numbers = range(first, last + 1, step)
                if len(numbers) > len(deck.nodes) + len(deck.elements) + len(deck.flat):
                    raise ValueError("more numbers than there are nodes and elements")
                mine += numbers
            else:
                for word in words:
                    known = _find(sets, word)
                    mine += sets[known] if known is not None else [int(word.rsplit(".", 1)[-1])]
        elif keyword == "*SURFACE":
            side = parts[1].upper() if len(parts) > 1 else ""
            deck.surfaces[options.get("NAME", "")].append((parts[0], side))
        elif keyword == "*INSTANCE":
            raise MeshError(f"'{self.path}', line {self.line}: an *INSTANCE that is moved; expected a part in place")

    def flush(self) -> None:
        """Put the element that was read into the deck."""
        if not self._pending:
            return
        (number, *nodes), self._pending = self._pending, []
        if not self._kind:
            self.deck.unsupported[self._type or "no TYPE"] = self.deck.unsupported.get(self._type or "no TYPE", 0) + 1
            return
        if len(nodes) != self._width():
            raise MeshError(
                f"'{self.path}', line {self.line}: element {number} of type {self._type} has {len(nodes)} nodes, "
                f"expected {self._width()}"
            )
        if self._kind == "flat":
            self.deck.flat[number] = nodes[: _FLAT_CORNERS[_FLAT.match(self._type)[1]]]  # type: ignore[index]
        else:
            self.deck.elements[number] = (self._kind, nodes)
        if self._set:
            self.deck.element_sets.setdefault(self._set, []).append(number)

    def _width(self) -> int:
        if self._kind == "flat":
            found = _FLAT.match(self._type)
            return {"65": 6}.get(found[1], int(found[1])) if found else 0
        return next((count for count, kind in _SOLIDS.items() if kind == self._kind), 0)


def _keyword(text: str) -> tuple[str, dict[str, str]]:
    """Return the keyword and its options; a value keeps its case, without quotes."""
    first, *rest = text.split(",")
    options = {}
    for item in rest:
        key, _, value = item.partition("=")
        options[key.strip().upper()] = value.strip().strip("\"'")
    return " ".join(first.upper().split()), options


def _find(names: dict[str, list[int]], word: str) -> str | None:
    """Return the name that a word means, whatever its case."""
    return next((name for name in names if name.upper() == word.strip("\"'").upper()), None)


def sides(deck: Deck, name: str) -> list[tuple[int, ...]]:
    """Return the corner nodes of the faces of an element surface. Raises ValueError for what it refers to in vain."""
    result = []
    for first, side in deck.surfaces[name]:
        known = _find(deck.element_sets, first)
        for number in deck.element_sets[known] if known is not None else [int(first)]:
            kind, nodes = deck.elements[number]
            local = _SIDES[kind.rstrip("0123456789")]
            if side not in [f"S{i + 1}" for i in range(len(local))]:
                raise ValueError(f"side '{side}' of element {number}")
            result.append(tuple(nodes[i] for i in local[int(side[1:]) - 1]))
    return result
