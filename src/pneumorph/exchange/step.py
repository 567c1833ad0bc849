"""STEP files (ISO 10303-21, AP214) of a surface of flat triangles, as a solid of plane faces.

A deformed body has no CAD surfaces: what can be written is its mesh, one plane face a triangle. Open CASCADE can sew
such faces, too, but needs a tolerance to find again which of them are neighbours; here the nodes say so.
"""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from pneumorph.errors import InputError
from pneumorph.exchange.surface import Surface

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

# what CAD programs still open; about 800 bytes a face
MOST_FACES = 50_000


def step_text(surface: Surface, title: str, version: str) -> str:
    """Return the text of a STEP file in mm with one solid, its cavities as voids.

    surface: closed, normals leaving the body; title: name of the product; version: of pneumorph.

    Raises InputError for more than 50,000 triangles, triangles without area, or several separate bodies.
    """
    count = len(surface.triangles)
    if count > MOST_FACES:
        raise InputError(f"a STEP file of {count:,} plane faces: allowed are {MOST_FACES:,}; write an STL file")
    shells = _shells(surface)
    writer = _Writer(surface)
    outer, *voids = [writer.shell(triangles) for triangles in shells]
    if voids:
        # the normals of a void's faces leave the body already: as ISO 10303-42 wants them
        inner = [writer.add(f"ORIENTED_CLOSED_SHELL('',*,#{shell},.T.)") for shell in voids]
        solid = writer.add(f"BREP_WITH_VOIDS('',#{outer},{_list(inner)})")
    else:
        solid = writer.add(f"MANIFOLD_SOLID_BREP('',#{outer})")
    return _HEAD.format(
        title=_text(title), version=_text(version), time=datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S"), solid=solid
    ) + "\n".join([*writer.lines, "ENDSEC;", "END-ISO-10303-21;", ""])


def _shells(surface: Surface) -> list[Nodes]:
    """Return the triangles of each closed shell, that of the outside first."""
    triangles, size = surface.triangles, len(surface.points)
    ends = triangles[:, [0, 1, 1, 2]].reshape(-1, 2)
    _, label = connected_components(coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(size, size)))
    parts = [triangles[label[triangles[:, 0]] == number] for number in np.unique(label[triangles[:, 0]])]
    outside = [i for i, part in enumerate(parts) if Surface(surface.points, part).volume > 0.0]
    if len(outside) != 1:
        raise InputError(f"the surface has {len(outside)} separate bodies: expected one for a STEP file")
    return [parts[outside[0]], *(part for i, part in enumerate(parts) if i != outside[0])]


class _Writer:
    """Entities of the data section, numbered from 100."""

    def __init__(self, surface: Surface):
        self.lines: list[str] = []
        self._points = surface.points
        self._vertex: dict[int, tuple[int, int]] = {}
        self._edge: dict[tuple[int, int], int] = {}

    def add(self, entity: str) -> int:
        """Append an entity; return its number."""
        number = 100 + len(self.lines)
        self.lines.append(f"#{number}={entity};")
        return number

    def shell(self, triangles: Nodes) -> int:
        """Append a closed shell of plane faces; return its number."""
        corners = self._points[triangles]
        along = corners[:, 1] - corners[:, 0]
        normal = np.cross(along, corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(normal, axis=1)
        if not (length > 0.0).all():
            raise InputError(f"{int((length <= 0.0).sum())} triangles of the surface have no area")
        normal /= length[:, None]
        along /= np.linalg.norm(along, axis=1)[:, None]
        faces = [self._face(*values) for values in zip(triangles.tolist(), normal, along, strict=True)]
        return self.add(f"CLOSED_SHELL('',{_list(faces)})")

    def _face(self, triangle: list[int], normal: Array, along: Array) -> int:
        pairs = zip(triangle, triangle[1:] + triangle[:1], strict=True)
        loop = self.add(f"EDGE_LOOP('',{_list([self._oriented(a, b) for a, b in pairs])})")
        bound = self.add(f"FACE_OUTER_BOUND('',#{loop},.T.)")
        axes = [self._direction(normal), self._direction(along)]
        place = self.add(f"AXIS2_PLACEMENT_3D('',#{self._node(triangle[0])[0]},#{axes[0]},#{axes[1]})")
        plane = self.add(f"PLANE('',#{place})")
        return self.add(f"ADVANCED_FACE('',(#{bound}),#{plane},.T.)")

    def _oriented(self, a: int, b: int) -> int:
        low, high = min(a, b), max(a, b)
        if (low, high) not in self._edge:
            (point, start), (_, end) = self._node(low), self._node(high)
            way = self._points[high] - self._points[low]
            length = float(np.linalg.norm(way))
            vector = self.add(f"VECTOR('',#{self._direction(way / length)},1.)")
            line = self.add(f"LINE('',#{point},#{vector})")
            self._edge[low, high] = self.add(f"EDGE_CURVE('',#{start},#{end},#{line},.T.)")
        return self.add(f"ORIENTED_EDGE('',*,*,#{self._edge[low, high]},.{'T' if a < b else 'F'}.)")

    def _node(self, node: int) -> tuple[int, int]:
        """Return the numbers of point and vertex of a node."""
        if node not in self._vertex:
            point = self.add(f"CARTESIAN_POINT('',{_numbers(self._points[node])})")
            self._vertex[node] = point, self.add(f"VERTEX_POINT('',#{point})")
        return self._vertex[node]

    def _direction(self, direction: Array) -> int:
        return self.add(f"DIRECTION('',{_numbers(direction)})")


def _numbers(values: Array) -> str:
    """Return reals as STEP writes them: with a point, an exponent in capitals."""
    texts = (f"{value + 0.0:.12G}" for value in values.tolist())
    return f"({','.join(t if '.' in t else t.replace('E', '.E') if 'E' in t else f'{t}.' for t in texts)})"


def _list(numbers: list[int]) -> str:
    return f"({','.join(f'#{number}' for number in numbers)})"


def _text(text: str) -> str:
    """Return printable ASCII for a string of the file, its quotes doubled."""
    plain = " ".join(text.split()).encode("ascii", "replace").decode()
    return plain.replace("\\", "/").replace("'", "''")


_HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('{title}: plane faces of a mesh'),'2;1');
FILE_NAME('{title}','{time}',(''),(''),'pneumorph {version}','pneumorph','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));
ENDSEC;
DATA;
#1=APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#2);
#2=APPLICATION_CONTEXT('core data for automotive mechanical design processes');
#3=SHAPE_DEFINITION_REPRESENTATION(#4,#10);
#4=PRODUCT_DEFINITION_SHAPE('','',#5);
#5=PRODUCT_DEFINITION('design','',#6,#9);
#6=PRODUCT_DEFINITION_FORMATION('','',#7);
#7=PRODUCT('{title}','{title}','',(#8));
#8=PRODUCT_CONTEXT('',#2,'mechanical');
#9=PRODUCT_DEFINITION_CONTEXT('part definition',#2,'design');
#10=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#11,#{solid}),#15);
#11=AXIS2_PLACEMENT_3D('',#12,#13,#14);
#12=CARTESIAN_POINT('',(0.,0.,0.));
#13=DIRECTION('',(0.,0.,1.));
#14=DIRECTION('',(1.,0.,0.));
#15=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#19))
GLOBAL_UNIT_ASSIGNED_CONTEXT((#16,#17,#18))REPRESENTATION_CONTEXT('','3D'));
#16=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#17=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#18=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#19=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-06),#16,'distance_accuracy_value','');
"""
