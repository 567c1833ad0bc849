"""Block grid -> quadratic hexahedra: a sheet of quadrilaterals in layers, each cell of a material, of air, or nothing.

Actuators of flat walls at right angles are drawn by filling boxes with material and hollowing out others: no boolean
operation, no slivers, and one cell through each wall. A mapping then bends the grid as a whole; several of them are
put together by `mesh.joining`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import MeshError
from pneumorph.mesh.layered import lifted
from pneumorph.mesh.memory import check_cells
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.quads import Quads, checked_lines
from pneumorph.mesh.reference import jacobians
from pneumorph.mesh.topology import boundary, compressed, corner_keys, rows_in

Array = NDArray[np.float64]
Labels = NDArray[np.object_]
Range = tuple[float, float] | None

_KIND = "hexahedron27"


@dataclass(frozen=True, eq=False)
class BlockGrid:
    """A sheet of quadrilaterals (u, v) in layers along w: cells (quadrilaterals, layers), at first all empty.

    heights: w of the planes between the layers (layers + 1,), mm, growing.
    domain: material domain of each cell, "" where there is none. air: what its walls are called if it is empty.
    """

    sheet: Quads
    heights: ArrayLike
    domain: Labels | None = None
    air: Labels | None = None

    def __post_init__(self) -> None:
        heights = checked_lines("w", self.heights)
        object.__setattr__(self, "heights", heights)
        shape = (len(self.sheet.corners), len(heights) - 1)
        for name in ("domain", "air"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, np.full(shape, "", dtype=object))

    def fill(self, domain: str, *, u: Range = None, v: Range = None, w: Range = None) -> BlockGrid:
        """Return the grid with the material in all cells of the box; limits in mm, None for all there is.

        Raises MeshError for a limit that cuts through cells, or a box without any.
        """
        return self._painted(domain, "", {"u": u, "v": v, "w": w})

    def hollow(self, name: str = "", *, u: Range = None, v: Range = None, w: Range = None) -> BlockGrid:
        """Return the grid with nothing in the cells of the box: what bounds them is called `name`; errors as `fill`."""
        return self._painted("", name, {"u": u, "v": v, "w": w})

    def mesh(
        self,
        mapping: Callable[[Array], Array] | None = None,
        *,
        patches: Sequence[tuple[str, Mapping[str, Range]]] = (),
        bending_walls: Mapping[str, float] | None = None,
    ) -> Mesh:
        """Return the hexahedra, one block a domain.

        mapping: takes points (u, v, w) (n, 3), mid nodes as well, to where they shall be, so cells follow a curve.
        patches: (name, box) in coordinates of the grid, such as ("clamp", {"w": (0.0, 0.0)}): faces of the boundary in
            the box, borders included, have that name, the first box that holds them counts. Others are called after the
            air that they bound, or "outer".

        Raises MeshError for a grid without material, a patch without faces, or a mapping that turns cells over.
        """
        assert self.domain is not None
        assert self.air is not None
        check_cells(float((self.domain != "").sum()), "the block grid")
        flat, quads = self.sheet.quadratic
        heights = np.asarray(self.heights)
        planes = np.empty(2 * len(heights) - 1)
        planes[::2], planes[1::2] = heights, (heights[1:] + heights[:-1]) / 2.0
        points = np.column_stack([np.tile(flat, (len(planes), 1)), np.repeat(planes, len(flat))])
        blocks = [CellBlock(_KIND, name, _lift(quads, self.domain == name, len(flat))) for name in _names(self.domain)]
        if not blocks:
            raise MeshError("block grid: no cell has a material, fill some first")
        (skin,) = boundary(blocks)
        labels = self._labels(points, skin, quads, len(flat), patches)
        placed = points if mapping is None else np.asarray(mapping(points), dtype=float)
        if placed.shape != points.shape:
            raise MeshError(f"block grid: the mapping made points of shape {placed.shape}, expected {points.shape}")
        named = {name: (FaceBlock(skin.kind, skin.nodes[labels == name]),) for name in _names(labels)}
        placed, cells, faces = compressed(placed, blocks, named)
        if not all((jacobians(placed, _KIND, block.nodes) > 0.0).all() for block in cells):
            raise MeshError("block grid: the mapping turns cells over: det J is not positive everywhere")
        return Mesh(placed, cells, MappingProxyType(faces), "3d", MappingProxyType(dict(bending_walls or {})))

    def _painted(self, domain: str, air: str, box: Mapping[str, Range]) -> BlockGrid:
        chosen = self._inside(box)
        assert self.domain is not None
        assert self.air is not None
        return replace(
            self,
            domain=np.where(chosen, np.array(domain, dtype=object), self.domain),
            air=np.where(chosen, np.array(air, dtype=object), self.air),
        )

    def _inside(self, box: Mapping[str, Range]) -> NDArray[np.bool_]:
        """Return which cells (quadrilaterals, layers) lie in a box."""
        heights = np.asarray(self.heights)
        (u0, u1), (v0, v1), (w0, w1) = (_limits(axis, box[axis]) for axis in "uvw")
        scale = 1e-6 * max(float(np.ptp(self.sheet.points)), float(np.ptp(heights)))
        flat, flat_cut = self.sheet.inside((u0, v0), (u1, v1), scale)
        layer = (heights[:-1] > w0 - scale) & (heights[1:] < w1 + scale)
        layer_cut = (heights[1:] > w0 + scale) & (heights[:-1] < w1 - scale)
        shown = ", ".join(f"{axis} = {limits}" for axis, limits in box.items() if limits is not None) or "everywhere"
        if (np.outer(flat_cut, layer_cut) & ~np.outer(flat, layer)).any():
            raise MeshError(f"block grid: the box {shown} mm cuts through cells: its limits must be lines of the grid")
        if not (flat.any() and layer.any()):
            raise MeshError(f"block grid: no cell lies in the box {shown} mm")
        return np.outer(flat, layer)

    def _labels(
        self, points: Array, skin: FaceBlock, quads: NDArray[np.int64], count: int,
        patches: Sequence[tuple[str, Mapping[str, Range]]],
    ) -> Labels:  # fmt: skip
        """Return the name (faces,) of each face of the boundary."""
        assert self.air is not None
        labels = np.full(len(skin.nodes), "outer", dtype=object)
        keys = corner_keys(skin.kind, skin.nodes)
        for name in _names(self.air):
            (around,) = boundary([CellBlock(_KIND, name, _lift(quads, self.air == name, count))])
            labels[rows_in(keys, corner_keys(around.kind, around.nodes))] = name
        place = points[skin.nodes[:, :4]]
        scale = 1e-6 * float(np.ptp(points, axis=0).max())
        for name, box in reversed(patches):  # so that the first has the last word
            if unknown := set(box) - {"u", "v", "w"}:
                raise MeshError(f"patch '{name}': {', '.join(sorted(unknown))}: expected limits of u, v or w")
            held = np.ones(len(labels), dtype=bool)
            for axis, letter in enumerate("uvw"):
                low, high = _limits(letter, box.get(letter), flat=True)
                held &= ((place[..., axis] >= low - scale) & (place[..., axis] <= high + scale)).all(axis=1)
            if not held.any():
                raise MeshError(f"patch '{name}': no face of the boundary lies in its box")
            labels[held] = name
        return labels


def _limits(axis: str, limits: Range, flat: bool = False) -> tuple[float, float]:
    if limits is None:
        return -np.inf, np.inf
    low, high = limits
    if not (low <= high if flat else low < high):
        raise MeshError(f"block grid: {axis} = {limits}: expected two limits in mm, the smaller first")
    return low, high


def _lift(quads: NDArray[np.int64], chosen: NDArray[np.bool_], count: int) -> NDArray[np.int64]:
    """Return the nodes (cells, 27) of the chosen cells (quadrilaterals, layers)."""
    return np.concatenate(
        [lifted("quad9", quads[chosen[:, layer]], 2 * layer, count) for layer in range(chosen.shape[1])]
    )


def _names(labels: Labels) -> list[str]:
    """Return the labels that there are, but for the empty one, sorted."""
    return sorted(set(labels.ravel().tolist()) - {""})
