"""Adapter to Netgen: solids with named faces (Open CASCADE), and their meshing into plain arrays.

No other module imports netgen. A `Shape` is opaque outside this file.
"""

from __future__ import annotations

import logging
import math
import re
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyngcore
from netgen import meshing, occ, stl
from numpy.typing import NDArray

from pneumorph.errors import EngineError, GeometryError, MeshError
from pneumorph.geometry.probe import check_survives
from pneumorph.geometry.quiet import caught_output
from pneumorph.geometry.stl import stl_bytes

Shape = Any
Point = tuple[float, float, float]

# Netgen lists the mid-edge nodes as 01 02 03 12 13 23 (tetrahedron) and 12 02 01 (triangle); VTK as below.
_TETRA10 = [0, 1, 2, 3, 4, 7, 5, 6, 8, 9]
_TRIANGLE6 = [0, 1, 2, 5, 3, 4]

# Netgen's default passes and a second round of them with splitting: fewer slivers at little cost
_OPTIMIZE = "cmdDmustmcmdDmustm"
# At a large size surfaces of thin walls may cross, or slivers remain; a smaller one keeps the promise of a largest edge
_TRIES = (1.0, 0.9, 0.8, 0.65)
_GOOD = 0.05

_log = logging.getLogger(__name__)
meshing.SetMessageImportance(0)


@dataclass(frozen=True, eq=False)
class RawMesh:
    """What Netgen returns: points (n, 3) in mm; cells (m, 10) and triangles (k, 6) in VTK's node order.

    domain (m,) indexes `domains`; face (k,) indexes `face_names`. Triangles are those of the outer boundary only.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    domain: NDArray[np.int64]
    domains: tuple[str, ...]
    triangles: NDArray[np.int64]
    face: NDArray[np.int64]
    face_names: tuple[str, ...]


# --- solids ---------------------------------------------------------------------------------------------------------


def box(low: Point, high: Point, name: str | None = None) -> Shape:
    """Return the box between two corners, all its faces named `name`."""
    return named(occ.Box(occ.Pnt(*low), occ.Pnt(*high)), name)


def prism(outline: Sequence[tuple[float, float]], z0: float, z1: float, bottom: str, top: str) -> Shape:
    """Return a polygon in the xy plane (anticlockwise corners) extruded from z0 to z1, its end faces named."""
    plane = occ.WorkPlane(occ.Axes(occ.Pnt(0, 0, z0), occ.Z, occ.X)).MoveTo(*outline[0])
    for corner in outline[1:]:
        plane.LineTo(*corner)
    solid = plane.Close().Face().Extrude((z1 - z0) * occ.Z)
    solid.faces.Min(occ.Z).name = bottom
    solid.faces.Max(occ.Z).name = top
    return solid


def side_prism(profile: Sequence[tuple[float, float]], y0: float, y1: float) -> Shape:
    """Return a profile of (x, z) corners, anticlockwise seen from -y, extruded from y0 to y1."""
    # local x is the global x and local y the global z for a plane that looks along -y
    plane = occ.WorkPlane(occ.Axes(occ.Pnt(0, y1, 0), -occ.Y, occ.X)).MoveTo(*profile[0])
    for corner in profile[1:]:
        plane.LineTo(*corner)
    return plane.Close().Face().Extrude((y0 - y1) * occ.Y)


def side_sector(
    centre: tuple[float, float], radii: tuple[float, float], angles: tuple[float, float], y0: float, y1: float
) -> Shape:
    """Return a sector of a ring in the xz plane, extruded from y0 to y1.

    radii: inner and outer, mm; angles: start and end, rad, from +z towards +x.
    """
    (inner, outer), (start, stop) = radii, angles
    corners = [
        (centre[0] + radius * math.sin(angle), centre[1] + radius * math.cos(angle))
        for radius, angle in ((outer, stop), (outer, start), (inner, start))
    ]
    turn = math.degrees(stop - start)
    plane = occ.WorkPlane(occ.Axes(occ.Pnt(0, y1, 0), -occ.Y, occ.X)).MoveTo(*corners[0])
    plane.Direction(-math.cos(stop), math.sin(stop)).Arc(outer, turn).LineTo(*corners[2])
    plane.Direction(math.cos(start), -math.sin(start)).Arc(inner, -turn).Close()
    return plane.Face().Extrude((y0 - y1) * occ.Y)


def name_plane_faces(shape: Shape, point: Point, normal: Point, name: str) -> None:
    """Name the faces whose corners all lie in a plane, given by a point and its unit normal."""
    for face in shape.faces:
        if all(abs(sum((a - b) * n for a, b, n in zip(p, point, normal, strict=True))) < 1e-5 for p in _ends(face)):
            face.name = name


def name_round_faces(shape: Shape, centre: tuple[float, float], radius: float, name: str) -> None:
    """Name the faces whose corners all lie on a cylinder about an axis along y, through (x, z)."""
    for face in shape.faces:
        if all(abs(math.hypot(x - centre[0], z - centre[1]) - radius) < 1e-5 for x, _, z in _ends(face)):
            face.name = name


def _ends(face: Any) -> list[Point]:
    return [(vertex.p.x, vertex.p.y, vertex.p.z) for vertex in face.vertices]


def cylinder(radius: float, z0: float, z1: float, name: str | None = None) -> Shape:
    """Return a cylinder about the z axis, all its faces named `name`."""
    return named(occ.Cylinder(occ.Pnt(0, 0, z0), occ.Z, r=radius, h=z1 - z0), name)


def elliptic_loft(low: tuple[float, float], high: tuple[float, float], length: float, name: str | None = None) -> Shape:
    """Return a straight loft between ellipses across x, at 0 and at `length`, all its faces named `name`.

    low, high: half-axes along y and z, mm; the first of a pair is not the smaller one.
    """
    wires = [
        occ.WorkPlane(occ.Axes(occ.Pnt(x, 0, 0), occ.X, occ.Y)).Ellipse(*axes).Wire()
        for x, axes in ((0.0, low), (length, high))
    ]
    return named(occ.ThruSections(wires), name)


def sphere(radius: float, name: str | None = None) -> Shape:
    """Return a sphere about the origin, its face named `name`."""
    return named(occ.Sphere(occ.Pnt(0, 0, 0), radius), name)


def named(shape: Shape, name: str | None) -> Shape:
    """Give all faces of a shape one name; cuts and unions keep it."""
    if name is not None:
        shape.faces.name = name
    return shape


def name_end_faces(shape: Shape, direction: Point, low: str, high: str) -> Shape:
    """Name the outermost face on either side of a direction."""
    shape.faces.Min(occ.Vec(*direction)).name = low
    shape.faces.Max(occ.Vec(*direction)).name = high
    return shape


def name_low_faces(shape: Shape, names: dict[str, str]) -> Shape:
    """Name the lowest face of a shape in each of the directions "x", "y", "z" that is given."""
    for direction, name in names.items():
        shape.faces.Min({"x": occ.X, "y": occ.Y, "z": occ.Z}[direction]).name = name
    return shape


def turned(shape: Shape, degrees: float) -> Shape:
    """Return the shape turned about the z axis."""
    return shape.Rotate(occ.Axis(occ.Pnt(0, 0, 0), occ.Z), degrees)


def fused(shapes: Iterable[Shape]) -> Shape:
    """Return the union of shapes."""
    everything = list(shapes)
    return everything[0] if len(everything) == 1 else occ.Fuse(everything)


def cut(shape: Shape, tools: Iterable[Shape]) -> Shape:
    """Return the shape without the tools; the new faces keep the tools' names."""
    for tool in tools:
        shape = shape - tool
    return shape


def common(shape: Shape, other: Shape) -> Shape:
    """Return what two shapes share; faces keep their names."""
    return shape * other


def bonded(parts: Sequence[tuple[Shape, str]]) -> Shape:
    """Return solids of several material domains that share the faces (and later the nodes) where they touch."""
    for solid, domain in parts:
        solid.mat(domain)
    return occ.Glue([solid for solid, _ in parts])


def volume(shape: Shape) -> float:
    """Return the volume in mm³."""
    return float(shape.mass)


def check_solid(shape: Shape, solids: int, what: str) -> Shape:
    """Return the shape if it consists of that many solids with volume; raises GeometryError if not."""
    found = list(shape.solids)
    if len(found) != solids or any(solid.mass <= 0.0 for solid in found):
        raise GeometryError(f"{what}: the dimensions make {len(found)} separate solids, expected {solids}")
    return shape


def write_step(shape: Shape, path: Path) -> None:
    """Write a STEP file in mm."""
    try:
        shape.WriteStep(str(path))
    except Exception as error:
        raise EngineError(f"'{path}': Open CASCADE cannot write this STEP file ({error})") from error


# --- import ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class CadFile:
    """What a STEP or IGES file holds, in mm. Face i of `shape` is named str(i), for `mesh_solid`.

    names, colours: of each face as in the file, "" where it has none; domains: names of the solids, as many as solids;
    volume (mm³) of all solids, area (mm²) of all faces.
    """

    shape: Shape
    names: tuple[str, ...]
    colours: tuple[str, ...]
    domains: tuple[str, ...]
    volume: float
    area: float


def read_cad(path: Path, *, probed: bool = False) -> CadFile:
    """Return the solids of a STEP or IGES file, in mm whatever the file's unit; solids that touch share the faces.

    Loose faces that close are sewn to a solid. Raises GeometryError for a file that cannot be read, holds no solid, or
    holds solids that overlap. `probed`: the file is known not to end the process, see `probe`.
    """
    if not probed:
        check_survives(path)
    solids = _solids_of(path)
    for i, first in enumerate(solids):
        for j, second in enumerate(solids[:i]):
            shared = common(first, second).mass if _boxes_meet(first, second) else 0.0
            if shared > 1e-6 * min(first.mass, second.mass):
                corners = _show_box(common(first, second))
                raise GeometryError(
                    f"'{path}': the solids {j + 1} and {i + 1} overlap by {shared:.4g} mm3 in {corners}"
                )
    names = [solid.name or f"body_{i + 1}" for i, solid in enumerate(solids)] if len(solids) > 1 else ["body"]
    shape = bonded(list(zip(solids, names, strict=True)))
    faces = list(shape.faces)
    given = tuple("" if face.name in (None, "NONE", "default") else str(face.name) for face in faces)
    colours = tuple(_hexadecimal(face.col) for face in faces)
    for number, face in enumerate(faces):
        face.name = str(number)
    return CadFile(shape, given, colours, tuple(names), volume(shape), math.fsum(float(face.mass) for face in faces))


def _solids_of(path: Path) -> list[Shape]:
    try:
        with caught_output() as printed:
            shape = occ.OCCGeometry(str(path)).shape
            solids = list(shape.solids)
            if not solids and list(shape.faces):
                solids = list(occ.Solid(occ.Sew(list(shape.faces), 1e-3)).solids)
    except Exception as error:  # Netgen and Open CASCADE raise several unrelated types
        reason = re.sub(r"\x1b\[[0-9;]*m|\*{2,}", "", " ".join(printed.text.split())) or error
        raise GeometryError(f"'{path}': Open CASCADE cannot make a solid of this file: {reason}".strip()) from error
    if not solids or any(not solid.mass > 0.0 for solid in solids):
        raise GeometryError(
            f"'{path}': {len(solids)} solids, {len(list(shape.faces))} faces; expected at least one solid of positive "
            "volume (export the body as a solid, not as surfaces)"
        )
    return solids


def _boxes_meet(first: Shape, second: Shape) -> bool:
    (a, b), (c, d) = _corners(first), _corners(second)
    return all(low < high for low, high in zip((*a, *c), (*d, *b), strict=True))


def _hexadecimal(colour: Sequence[float] | None) -> str:
    return "" if colour is None else "#" + "".join(f"{round(255 * c):02x}" for c in list(colour)[:3])


# --- meshing --------------------------------------------------------------------------------------------------------


def mesh_solid(
    shape: Shape, *, size: float, grading: float, detail: float, face_sizes: dict[str, float] | None = None
) -> RawMesh:
    """Return the mesh of 10-node tetrahedra of a solid; mid-edge nodes lie on curved faces.

    size: largest edge (mm). grading: how fast the size may change, 0 (slowly) to 1. detail: segments for each edge of
    the solid; below 1 short edges do not refine their surroundings. face_sizes: largest edge on named faces (mm).
    Where Netgen fails or leaves slivers it tries again with a smaller size, down to 0.65 of it. One thread, so that
    equal input gives an equal mesh. Unnamed faces become "outer", unnamed domains "body". Raises MeshError if Netgen
    fails.
    """
    _set_face_sizes(shape, face_sizes or {})
    return _raw_mesh(_run_netgen(shape, size, grading, detail, surface_only=False))


def mesh_triangles(
    points: NDArray[np.float64], triangles: NDArray[np.int64], *, size: float, grading: float
) -> RawMesh:
    """Return the mesh of 10-node tetrahedra inside closed triangulated surfaces, such as an STL file holds.

    points (n, 3), mm; triangles (k, 3), outward normals, walls of inner cavities included. The surfaces are meshed anew
    between their sharp edges, size and tries as in `mesh_solid`; where that fails, or loses more than 2 % of the
    volume, their own triangles are kept. Raises MeshError if that fails too.
    """
    corners = points[triangles]
    wanted = float(np.linalg.det(corners).sum()) / 6.0
    geometry = _stl_geometry(points, triangles)
    makers = [
        lambda limit: geometry.GenerateMesh(maxh=limit, grading=grading, optimize3d=_OPTIMIZE),
        lambda limit: _filled(points, triangles, limit, grading),
    ]
    reason = "flat or inverted tetrahedra"
    for make in makers:
        mesh, why = _first_good(make, size)
        reason = why or reason
        if mesh is not None and abs(_volume_of(mesh) / wanted - 1.0) < 0.02:
            if make is not makers[0]:
                _log.warning("the surface could not be meshed anew (%s): its own triangles are kept", reason)
            return _raw_mesh(mesh)
    raise MeshError(f"Netgen cannot mesh the inside of the {len(triangles)} triangles at size {size:.3g} mm: {reason}")


def _stl_geometry(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> Any:
    """Return Netgen's geometry of triangles; it takes them from a file only, and trusts the normals in it."""
    with tempfile.TemporaryDirectory() as folder, caught_output():
        path = Path(folder) / "surface.stl"
        path.write_bytes(stl_bytes(points, triangles, "surface"))
        return stl.STLGeometry(str(path))


def _filled(points: NDArray[np.float64], triangles: NDArray[np.int64], size: float, grading: float) -> Any:
    """Return Netgen's mesh of tetrahedra on given triangles."""
    mesh = meshing.Mesh(3)
    mesh.Add(meshing.FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
    mesh.AddPoints(np.ascontiguousarray(points))
    mesh.AddElements(dim=2, index=1, data=np.ascontiguousarray(triangles, dtype=np.int32), base=0)
    mesh.GenerateVolumeMesh(maxh=size, grading=grading, optimize3d=_OPTIMIZE)
    return mesh


def _volume_of(mesh: Any) -> float:
    cells, _ = _arrays(mesh.Elements3D(), 4)
    corners = np.array(mesh.Coordinates(), dtype=np.float64)[cells]
    return float(np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum()) / 6.0


def _raw_mesh(mesh: Any) -> RawMesh:
    """Return the arrays of Netgen's mesh, which gets mid-edge nodes."""
    mesh.SecondOrder()
    points = np.array(mesh.Coordinates(), dtype=np.float64)
    cells, domain = _arrays(mesh.Elements3D(), 10)
    triangles, region = _arrays(mesh.Elements2D(), 6)
    descriptors = [mesh.FaceDescriptor(i + 1) for i in range(mesh.GetNFaceDescriptors())]
    names = [_face_name(descriptor.bcname) for descriptor in descriptors]
    # a face with a domain on both sides is a bond inside the body, not boundary
    inner = np.array([descriptor.domin > 0 and descriptor.domout > 0 for descriptor in descriptors])
    outside = ~inner[region]
    face_names = tuple(sorted(set(names)))
    face = np.array([face_names.index(name) for name in names])[region[outside]]
    count = int(domain.max()) + 1
    domains = [_domain_name(mesh.GetMaterial(i + 1)) for i in range(count)]
    unique = tuple(dict.fromkeys(domains))
    domain = np.array([unique.index(name) for name in domains])[domain]
    return RawMesh(points, cells[:, _TETRA10], domain, unique, triangles[outside][:, _TRIANGLE6], face, face_names)


def surface(shape: Shape, *, size: float, grading: float = 0.8) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a closed triangulated surface of a solid: points (n, 3) in mm, triangles (k, 3) with outward normals."""
    mesh = _run_netgen(shape, size, grading, 1.0, surface_only=True)
    triangles, region = _arrays(mesh.Elements2D(), 3)
    descriptors = [mesh.FaceDescriptor(i + 1) for i in range(mesh.GetNFaceDescriptors())]
    boundary = np.array([d.domin == 0 or d.domout == 0 for d in descriptors])[region]
    flipped = np.array([d.domin == 0 for d in descriptors])[region]
    triangles[flipped] = triangles[flipped][:, ::-1]
    return np.array(mesh.Coordinates(), dtype=np.float64), triangles[boundary]


def _set_face_sizes(shape: Shape, sizes: dict[str, float]) -> None:
    # a face hands its size on to its edges, so the small ones come last
    shape.faces.maxh = 1e99
    for face in shape.faces:
        if _face_name(face.name) in sizes:
            face.maxh = sizes[_face_name(face.name)]


def _run_netgen(shape: Shape, size: float, grading: float, detail: float, surface_only: bool) -> Any:
    """Return Netgen's mesh of straight cells: the first without slivers, else the best of all tries."""
    last = meshing.MeshingStep.MESHSURFACE if surface_only else meshing.MeshingStep.MESHVOLUME
    settings = {"grading": grading, "segmentsperedge": detail, "perfstepsend": last, "optimize3d": _OPTIMIZE}
    if detail < 1.0:
        settings["curvaturesafety"] = 1.0
    mesh, reason = _first_good(
        lambda limit: occ.OCCGeometry(shape).GenerateMesh(maxh=limit, **settings), size, check=not surface_only
    )
    if mesh is not None:
        return mesh
    sizes = ", ".join(f"{factor * size:.3g}" for factor in _TRIES)
    raise MeshError(f"Netgen cannot mesh the solid in {_show_box(shape)} at sizes {sizes} mm: {reason}")


def _first_good(make: Callable[[float], Any], size: float, check: bool = True) -> tuple[Any, str]:
    """Return the first mesh of all tries without slivers, else the best, else None; and the last reason of failure."""
    best, best_quality, reason = None, 0.0, "flat or inverted tetrahedra"
    threads = pyngcore.GetNumThreads()
    pyngcore.SetNumThreads(1)
    try:
        for factor in _TRIES:
            try:
                with caught_output() as printed:
                    mesh = make(factor * size)
            except Exception as error:  # Netgen and Open CASCADE raise several unrelated types
                reason = " / ".join([str(error), *printed.text.strip().splitlines()[-1:]])
                continue
            quality = _smallest_quality(mesh) if check else 1.0
            if quality >= _GOOD:
                return mesh, reason
            if quality > best_quality:
                best, best_quality = mesh, quality
    finally:
        pyngcore.SetNumThreads(threads)
    return best, reason


def _smallest_quality(mesh: Any) -> float:
    """Return the worst 6 sqrt(2) V / sqrt(product of the edges) of the tetrahedra: 1 if regular, 0 if flat."""
    cells, _ = _arrays(mesh.Elements3D(), 4)
    if len(cells) == 0:
        return 0.0
    corners = np.array(mesh.Coordinates(), dtype=np.float64)[cells]
    volume6 = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    edges = np.linalg.norm(corners[:, [0, 0, 0, 1, 1, 2]] - corners[:, [1, 2, 3, 2, 3, 3]], axis=2)
    return float((np.sqrt(2.0) * volume6 / np.sqrt(edges.prod(axis=1))).min())


def _corners(shape: Shape) -> list[Point]:
    return [(p.x, p.y, p.z) for p in shape.bounding_box]


def _show_box(shape: Shape) -> str:
    return " to ".join(str(tuple(round(v, 3) + 0.0 for v in corner)) for corner in _corners(shape)) + " mm"


def _arrays(elements: Any, nodes: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return node numbers (m, nodes) and region numbers (m,), both from 0."""
    table = elements.NumPy()
    return table["nodes"][:, :nodes].astype(np.int64) - 1, table["index"].astype(np.int64) - 1


def _face_name(name: str | None) -> str:
    return name if name and name != "default" else "outer"


def _domain_name(name: str | None) -> str:
    return name if name and name != "default" else "body"


def regular_polygon(sides: int, edge: float, first_angle: float) -> list[tuple[float, float]]:
    """Return the corners of a regular polygon of given edge length, the first at `first_angle` (rad) from x."""
    radius = edge / (2.0 * math.sin(math.pi / sides))
    angles = [first_angle + 2.0 * math.pi * i / sides for i in range(sides)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
