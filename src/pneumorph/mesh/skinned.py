"""Tube with a bonded lattice skin -> layered mesh: hexahedra and wedges that share all nodes, no boolean operation."""

from __future__ import annotations

import math
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.geometry.lattice import SkinnedTube
from pneumorph.mesh.lattice_sheet import SheetMesh, mesh_sheet
from pneumorph.mesh.layered import lifted
from pneumorph.mesh.memory import check_cells
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.plug import plug
from pneumorph.mesh.topology import boundary, compressed

Array = NDArray[np.float64]

_SOLID = {"triangle6": "wedge18", "quad9": "hexahedron27"}
_RINGS = 3  # of cells in a cap, around the middle, at most: it hardly deforms
_MIDDLE = 0.25  # radius of the middle of a cap, of the inner radius of the tube


def mesh_skinned_tube(
    tube: SkinnedTube, size: float | None = None, *, wall_layers: int = 1, skin_layers: int = 1, half: bool = False
) -> Mesh:
    """Return the mesh of a tube with a lattice skin; one sheet mesh goes through all layers, so nothing is tied.

    size: largest edge along and around, mm, at the middle of the skin; automatic half the cell's height.
    wall_layers, skin_layers: quadratic cells through the wall of the tube and through the skin.
    half: the part y >= 0, for a map that is its own mirror image; `Lattice.mirror` of the sheet lies at y = 0, x > 0.

    Domains: tube, skin, cap. Faces: clamp and tip (end faces of tube and skin), clamp_cap and tip_cap (outsides of the
    caps), cavity, outer (the tube between the beams), skin, and with half symmetry_y. Raises MeshError for settings out
    of range, or half without a mirror.
    """
    lattice = tube.lattice
    size = lattice.height / 2.0 if size is None else size
    if isinstance(size, bool) or not isinstance(size, int | float) or not 0.0 < size < math.inf:
        raise MeshError(f"mesh: size = {size!r}: expected a finite number of mm greater than 0")
    for name, count in (("wall_layers", wall_layers), ("skin_layers", skin_layers)):
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise MeshError(f"mesh: {name} = {count!r}: expected a whole number of at least 1")
    if half and lattice.mirror is None:
        raise MeshError("mesh: half = True: the map of cells is not its own mirror image, expected one that is")
    check_cells(lattice.around * lattice.length / size**2 * (wall_layers + skin_layers), f"skinned tube at {size:g} mm")
    rings = min(_RINGS, max(1, int((tube.radius - tube.wall) * (1.0 - _MIDDLE) / size)))
    return roll(mesh_sheet(lattice, size, tube.cap, half=half), tube, wall_layers, skin_layers, half, rings=rings)


def roll(
    sheet: SheetMesh, tube: SkinnedTube, wall_layers: int, skin_layers: int, half: bool, *, rings: int = _RINGS
) -> Mesh:
    """Return the mesh of a tube whose wall, skin and caps are built on the cells of a flat sheet."""
    inner = tube.radius - tube.wall
    below = [-inner * (1.0 - _MIDDLE) * (1.0 - i / rings) for i in range(rings)]
    steps = [tube.wall * i / wall_layers for i in range(wall_layers)]
    steps += [tube.wall + tube.depth * i / skin_layers for i in range(skin_layers + 1)]
    corners = np.array(below + steps)
    heights = np.sort(np.concatenate([corners, (corners[1:] + corners[:-1]) / 2.0]))
    points = np.concatenate([_rolled(sheet, tube, height) for height in heights])
    stack = _stacked(sheet, wall_layers, skin_layers, rings)
    points, stack = _with_plugs(points, stack, sheet, tube.lattice.length, tube.cap)
    points, blocks, _ = compressed(points, stack)
    faces = _faces(points, blocks, tube, half)
    return Mesh(points, blocks, MappingProxyType(faces), bending_walls={"wall": tube.wall})


def _rolled(sheet: SheetMesh, tube: SkinnedTube, height: float) -> Array:
    """Return the points of the sheet rolled at a height above the inner wall; below it, at a share of its radius."""
    angle = sheet.points[:, 0] / tube.lattice.around * 2.0 * math.pi
    z = _shifted(sheet, tube, min(max(1.0 - height / tube.wall, 0.0), 1.0))
    inner = tube.radius - tube.wall + (tube.end_radius - tube.radius) * z / tube.lattice.length
    radius = inner + height if height >= 0.0 else inner * (1.0 + height / (tube.radius - tube.wall))
    result = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])
    result[np.abs(result) < 1e-12 * tube.lattice.length] = 0.0
    return result


def _shifted(sheet: SheetMesh, tube: SkinnedTube, share: float) -> Array:
    """Return z of the points, a share (1 at the inner wall, 0 in the skin) of the way to where strips end with caps.

    A cut through the sheet at the end of a cap would leave slivers beside the outlines of holes, in the very corner
    where the strain is largest.
    """
    y, length = sheet.points[:, 1], tube.lattice.length
    middle = length / 2.0
    for edge, cap, mirrored in ((sheet.low, tube.cap, False), (length - sheet.high, tube.cap, True)):
        far = length - y if mirrored else y
        inside = cap * far / edge
        beyond = middle - (middle - cap) * (middle - far) / (middle - edge)
        moved = np.where(far <= edge * (1.0 + 1e-12), inside, np.where(far < middle, beyond, far))
        moved = far + share * (moved - far)
        y = length - moved if mirrored else moved
    return y


def _stacked(sheet: SheetMesh, wall_layers: int, skin_layers: int, rings: int) -> list[CellBlock]:
    count = len(sheet.points)
    result: list[CellBlock] = []
    first = 2 * rings
    for kind, nodes in sheet.cells.items():
        in_cap = sheet.below[kind] | sheet.above[kind]
        parts = {
            "tube": (nodes, range(first, first + 2 * wall_layers, 2)),
            "skin": (
                nodes[sheet.beam[kind]],
                range(first + 2 * wall_layers, first + 2 * (wall_layers + skin_layers), 2),
            ),
            "cap": (nodes[in_cap], range(0, first, 2)),
        }
        for domain, (flat, planes) in parts.items():
            if len(flat):
                cells = np.concatenate([lifted(kind, flat, plane, count) for plane in planes])
                result.append(CellBlock(_SOLID[kind], domain, cells))
    return sorted(result, key=lambda block: ("tube", "skin", "cap").index(block.domain))


def _with_plugs(
    points: Array, blocks: list[CellBlock], sheet: SheetMesh, length: float, cap: float
) -> tuple[Array, list[CellBlock]]:
    """Return the mesh with the tetrahedra in the middle of both caps."""
    for inside, z in ((sheet.below["triangle6"], (0.0, cap)), (sheet.above["triangle6"], (length - cap, length))):
        points, cells = plug(points, sheet.cells["triangle6"][inside], z)
        blocks = [*blocks, CellBlock("tetra10", "cap", cells)]
    merged = np.concatenate([block.nodes for block in blocks[-2:]])
    return points, [*blocks[:-2], CellBlock("tetra10", "cap", merged)]


def _faces(
    points: Array, blocks: tuple[CellBlock, ...], tube: SkinnedTube, half: bool
) -> dict[str, tuple[FaceBlock, ...]]:
    """Return the boundary by name, told from where the nodes of each face lie."""
    length, small = tube.lattice.length, 1e-7 * tube.lattice.length
    height = np.hypot(points[:, 0], points[:, 1]) - tube.radius + tube.wall
    height -= (tube.end_radius - tube.radius) * points[:, 2] / length
    named: dict[str, list[FaceBlock]] = {}
    for skin in boundary(blocks):
        nodes = skin.nodes
        h, y, z = height[nodes], points[nodes, 1], points[nodes, 2]
        in_wall, outside = (h > -small).all(axis=1), (h > tube.wall - small).all(axis=1)
        on_tube = outside & (h < tube.wall + small).all(axis=1)
        tests = {
            "symmetry_y": np.abs(y).max(axis=1) < small if half else np.zeros(len(nodes), dtype=bool),
            "clamp": (np.abs(z).max(axis=1) < small) & in_wall,
            "clamp_cap": np.abs(z).max(axis=1) < small,
            "tip": (np.abs(z - length).max(axis=1) < small) & in_wall,
            "tip_cap": np.abs(z - length).max(axis=1) < small,
            "cavity": (h < small).all(axis=1),
            "outer": on_tube,
            "skin": outside,
        }
        left = np.ones(len(nodes), dtype=bool)
        for name, test in tests.items():
            chosen = test & left
            left &= ~test
            if chosen.any():
                named.setdefault(name, []).append(FaceBlock(skin.kind, np.ascontiguousarray(nodes[chosen])))
        assert not left.any(), "a face inside the wall"
    return {name: tuple(parts) for name, parts in named.items()}
