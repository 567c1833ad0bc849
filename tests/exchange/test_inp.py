"""Input files as text: what is refused, names, and the dialect of Abaqus (which is not here to run)."""

import re
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import InputError, MeshError, NameNotFoundError
from pneumorph.exchange import PressureTable, write_inp
from pneumorph.exchange import inp_mesh as inp_meshes
from pneumorph.exchange.inp_mesh import ELEMENTS, InpMesh
from pneumorph.materials import ExtendedTube, Gent, LinearElastic, NeoHookean, Ogden, Prony, Yeoh
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Contact,
    Gravity,
    HalfSpace,
    Model,
    Phase,
    Programme,
    Roller,
    Traction,
    VolumeSupply,
)
from pneumorph.mesh import CellBlock, FaceBlock, Mesh, box, rectangle
from pneumorph.mesh.inp import read_deck, sides
from pneumorph.mesh.mesh import CELL_NODES
from pneumorph.mesh.reference import NODES
from pneumorph.mesh.topology import CELL_FACES, CORNERS

SKEW = np.array([[2.0, 0.0, 0.0], [0.0, 1.0, 0.3], [0.0, 0.0, 1.0]])
PULL = Programme((Phase("pull", {"pull": 0.01}),))


RUBBER = NeoHookean(0.2)


def pulled(law=RUBBER):
    return Model(box(1, 1, 1), {"body": law}, (Clamp("x0"),), (Traction("x1", (1.0, 0.0, 0.0), "pull"),))


def ring(supply=None):
    mesh = rectangle(2, 1, lambda p: np.add(p, [3.0, 0.0]), space="axisymmetric")
    cavity = Cavity("ring", ("left",), *([supply] if supply else []), mirrors=("bottom", "top"))
    return Model(mesh, {"body": NeoHookean(0.1)}, (Roller("bottom", "y"), Roller("top", "y")), (), (cavity,))


def written(tmp_path, model, programme=PULL, **options):
    return write_inp(tmp_path / "model.inp", model, programme, **options).path.read_text().splitlines()


def after(lines, keyword, count=1):
    """Return the lines under the first line that starts with a keyword."""
    start = next(i for i, line in enumerate(lines) if line.startswith(keyword))
    return lines[start + 1 : start + 1 + count]


def test_the_header_says_title_units_and_version(tmp_path):
    lines = written(tmp_path, pulled(), title=" *Finger,\n second line")
    assert lines[0] == "** Finger, second line"
    assert re.match(r"\*\* written by pneumorph \d+\.\d+.* for CalculiX", lines[1])
    assert "mm, N, MPa, s, tonne" in lines[2]
    assert after(lines, "*HEADING") == ["Finger, second line"]


def test_the_name_of_a_phase_stays_on_its_line(tmp_path):
    lines = written(tmp_path, pulled(), Programme((Phase("pull\n*END STEP", {"pull": 0.01}),)))
    assert "** phase 1: pull *END STEP" in lines
    assert lines.count("*END STEP") == 1


@pytest.mark.parametrize("kind", CELL_NODES)
def test_every_kind_of_cell_has_an_element_whose_faces_are_those_of_the_cell(kind):
    ours = {tuple(sorted(nodes[: CORNERS[face]])) for face, nodes in CELL_FACES[kind]}
    assert {tuple(sorted(face)) for face in ELEMENTS[kind].faces} == ours


@pytest.mark.parametrize("kind", ["wedge18", "hexahedron27"])
def test_forces_of_nodes_that_are_left_out_do_the_same_work_elsewhere(kind):
    # on a displacement that the written element can follow: a full polynomial of degree two
    mesh = brick() if kind == "hexahedron27" else box(1, 1, 1, kind=kind, mapping=lambda p: p @ SKEW)
    x, y, z = mesh.points.T
    moved = np.column_stack([x * y + z**2, 1.0 + y * z, x - x**2])
    forces = np.random.default_rng(0).random(mesh.points.shape)
    inp = InpMesh(mesh)
    handed = inp.moved_forces(forces)
    assert not handed[~inp.used].any()
    assert (~inp.used).sum() in (5, 7)
    assert (handed * moved).sum() == pytest.approx((forces * moved).sum(), rel=1e-12)


def brick():
    """One hexahedron of 2 mm with its sides named as those of `box`."""
    points, nodes = 2.0 * NODES["hexahedron27"], np.arange(27)[None, :]
    faces = {}
    for kind, local in CELL_FACES["hexahedron27"]:
        axis = int(np.argmin(np.ptp(points[list(local)], axis=0)))
        faces[f"{'xyz'[axis]}{int(points[local[0], axis] > 0)}"] = (FaceBlock(kind, nodes[:, local]),)
    return Mesh(points, (CellBlock("hexahedron27", "body", nodes),), faces)


def test_abaqus_gets_hybrid_elements_where_nearly_incompressible_and_its_own_words(tmp_path):
    mesh = box(2, 1, 1)
    half = len(mesh.blocks[0].nodes) // 2
    nodes = mesh.blocks[0].nodes
    blocks = (CellBlock("tetra10", "body", nodes[:half]), CellBlock("tetra10", "frame", nodes[half:]))
    model = Model(
        Mesh(mesh.points, blocks, mesh.faces),
        {"body": Yeoh(0.11, 0.03), "frame": LinearElastic(3500.0, 0.36)},
        (Clamp("x0"),),
        (Traction("x1", (1.0, 0.0, 0.0), "pull"),),
    )
    programme = Programme((Phase("pull", {"pull": 0.01}, (0.5,)),))
    lines = written(tmp_path, model, programme, dialect="abaqus", printed=("x1",))
    assert "*ELEMENT, TYPE=C3D10H, ELSET=BODY" in lines
    assert "*ELEMENT, TYPE=C3D10, ELSET=FRAME" in lines
    # Abaqus drops volumetric terms whose D is 0; bulk modulus 1000 mu = 220 MPa
    assert after(lines, "*HYPERELASTIC, YEOH") == [f"0.11, 0.03, 0, {2 / 220:.12g}, 0, 0"]
    assert after(lines, "*ELASTIC") == ["3500, 0.36"]
    assert "*STEP, NAME=PHASE_1, NLGEOM=YES, INC=10000" in lines
    assert after(lines, "*TIME POINTS") == ["0.5, 1"]
    assert "*OUTPUT, FIELD, TIME POINTS=MARKS_1" in lines
    assert not any(line.startswith("*NODE FILE") for line in lines)


def test_calculix_switches_volumetric_terms_off_that_it_would_replace(tmp_path):
    lines = written(tmp_path, pulled(Yeoh(0.11, 0.03)), fields=False)
    assert after(lines, "*HYPERELASTIC, YEOH") == [f"0.11, 0.03, 0, {2 / 220:.12g}, 1e+20, 1e+20"]
    assert not any("FILE" in line for line in lines)


def test_four_ogden_terms_go_to_abaqus_in_its_convention_but_not_to_calculix(tmp_path):
    law = Ogden.from_shear_moduli((0.1, 0.2, 0.3, 0.4), (1.0, 2.0, 3.0, 4.0), bulk=500.0)
    lines = written(tmp_path, pulled(law), dialect="abaqus")
    assert after(lines, "*HYPERELASTIC, OGDEN, N=4", 2) == ["0.1, 1, 0.2, 2, 0.3, 3, 0.4, 4", "0.004, 0, 0, 0"]
    with pytest.raises(InputError, match="with 4 terms: CalculiX has at most 3"):
        written(tmp_path, pulled(law))


@pytest.mark.parametrize("law", [Gent(0.2, 30.0), ExtendedTube(0.1, 0.1, 0.2, 0.5)], ids=lambda law: type(law).__name__)
def test_laws_that_neither_program_has_are_refused_by_name(tmp_path, law):
    with pytest.raises(InputError, match=rf"material of 'body' is a {type(law).__name__}: no such law .* Yeoh"):
        written(tmp_path, pulled(law))
    assert list(tmp_path.iterdir()) == []


def test_a_prony_series_is_said_to_be_left_out_and_refused_where_it_would_matter(tmp_path):
    model = pulled(NeoHookean(0.2, prony=Prony((0.2,), (1.0,))))
    assert any("Prony series is left out" in line for line in written(tmp_path, model))
    with pytest.raises(InputError, match="phase 'pull' has a duration and the material of 'body' a Prony series"):
        written(tmp_path, model, Programme((Phase("pull", {"pull": 0.01}, duration=1.0),)))


def test_contact_is_refused(tmp_path):
    contact = Contact("floor", ("z0",), HalfSpace((0.0, 0.0, -1.0), (0.0, 0.0, 1.0)))
    model = replace(pulled(), contacts=(contact,))
    with pytest.raises(InputError, match=r"contact \(floor\) cannot be written to an .inp file"):
        written(tmp_path, model)


def test_phases_with_inertia_are_refused(tmp_path):
    moving = Programme((Phase("pull", {"pull": 0.01}, duration=1.0, inertia="transient"),))
    with pytest.raises(InputError, match="phase 'pull' has inertia"):
        written(tmp_path, pulled(NeoHookean(0.2, density=1e-9)), moving)


def test_a_volume_supply_is_refused_without_the_pressures_of_a_run(tmp_path):
    fill = Programme((Phase("fill", {"ring": 5.0}),))
    with pytest.raises(InputError, match=r"cavity 'ring' has a VolumeSupply.*export the run .*--pressures"):
        written(tmp_path, ring(VolumeSupply()), fill)
    table = PressureTable(np.array([0.0, 0.5, 1.0]), np.array([0.0, 0.02, 0.03]))
    lines = written(tmp_path, ring(VolumeSupply()), fill, pressures={"ring": table})
    assert after(lines, "*AMPLITUDE, NAME=P_RING, TIME=TOTAL TIME") == ["0, 0, 0.5, 0.02, 1, 0.03"]
    assert after(lines, "*DSLOAD, AMPLITUDE=P_RING") == ["LEFT, P, 1."]
    with pytest.raises(NameNotFoundError, match="unknown cavity 'rng'"):
        written(tmp_path, ring(), fill, pressures={"rng": table})


def test_one_face_in_two_cavities_is_refused(tmp_path):
    model = ring()
    again = Cavity("again", ("left",), mirrors=("bottom", "top"))
    twice = Model(model.mesh, model.materials, model.supports, (), (*model.cavities, again))
    with pytest.raises(InputError, match="face 'left' belongs to the cavities 'ring' and 'again'"):
        written(tmp_path, twice, Programme((Phase("fill", {"ring": 0.01, "again": 0.01}),)))


def test_several_gravities_become_nodal_forces_with_the_weight_of_the_body(tmp_path):
    model = Model(
        box(1, 1, 1),
        {"body": NeoHookean(0.2, density=1e-9)},
        (Clamp("x0"),),
        (Gravity((0.0, 0.0, -1.0), "down"), Gravity((0.0, 1.0, 0.0), "sideways")),
    )
    lines = written(tmp_path, model, Programme((Phase("weight", {"down": 9810.0, "sideways": 100.0}),)))
    assert not any("GRAV" in line for line in lines)
    start = lines.index("*CLOAD") + 1
    forces = [line.split(", ") for line in lines[start:] if line[0].isdigit()]
    assert sum(float(force) for _, axis, force in forces if axis == "3") == pytest.approx(-9810.0e-9)
    assert sum(float(force) for _, axis, force in forces if axis == "2") == pytest.approx(100.0e-9)


def test_names_become_plain_and_two_that_become_one_are_refused(tmp_path):
    mesh = box(1, 1, 1)
    faces = {"2nd face": mesh.faces["x0"], "tip.é": mesh.faces["x1"]}
    assert InpMesh(Mesh(mesh.points, mesh.blocks, faces)).faces == {"2nd face": "X2ND_FACE", "tip.é": "TIP__"}
    with pytest.raises(InputError, match=r"face 'a b': in an .inp file it would be called A_B, as face 'a.b' is"):
        InpMesh(Mesh(mesh.points, mesh.blocks, {"a.b": mesh.faces["x0"], "a b": mesh.faces["x1"]}))
    with pytest.raises(InputError, match=r"domain 'eall'.* called EALL, as the exporter itself is"):
        InpMesh(Mesh(mesh.points, (CellBlock("tetra10", "eall", mesh.blocks[0].nodes),), {}))


def test_unknown_dialects_faces_and_cells_are_refused(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="unknown dialect 'abacus': did you mean 'abaqus'"):
        written(tmp_path, pulled(), dialect="abacus")
    with pytest.raises(NameNotFoundError, match="unknown face 'x2'"):
        written(tmp_path, pulled(), printed=("x2",))
    monkeypatch.delitem(inp_meshes.ELEMENTS, "tetra10")
    with pytest.raises(MeshError, match="tetra10 cells of 'body' cannot be written: known are wedge18"):
        written(tmp_path, pulled())


def test_node_sets_surfaces_and_plane_thickness(tmp_path):
    mesh = rectangle(1, 1)
    model = Model(mesh, {"body": NeoHookean(0.2)}, (Clamp("left"),), (Traction("right", (1.0, 0.0), "pull"),))
    lines = written(tmp_path, model)
    assert "*ELEMENT, TYPE=CPE6, ELSET=BODY" in lines
    assert after(lines, "*NSET, NSET=LEFT") == [", ".join(str(n + 1) for n in mesh.face_nodes("left"))]
    ((element, side),) = [line.split(", ") for line in after(lines, "*SURFACE, NAME=RIGHT, TYPE=ELEMENT")]
    cell = mesh.blocks[0].nodes[int(element) - 1]
    corners = {cell[i] for i in ELEMENTS["triangle6"].faces[int(side[1]) - 1]}
    assert corners == set(mesh.faces["right"][0].nodes[0, :2])
    assert after(lines, "*SOLID SECTION") == ["1."]


def test_a_cavity_that_is_closed_by_a_cap_is_refused(tmp_path):
    model = ring()
    object.__setattr__(model.mesh, "caps", {"left": model.mesh.faces["left"]})
    with pytest.raises(InputError, match="cavity 'ring' is closed by the cap 'left', which is no part of the body"):
        written(tmp_path, model, Programme((Phase("fill", {"ring": 0.01}),)))


@pytest.mark.parametrize("kind", ["tetra10", "wedge18", "hexahedron27"])
def test_the_mesh_reads_back_node_by_node_and_face_by_face(tmp_path, kind):
    mesh = brick() if kind == "hexahedron27" else box(2, 1, 1, kind=kind)
    model = Model(mesh, {"body": RUBBER}, (Clamp("x0"),), (Traction("x1", (1.0, 0.0, 0.0), "pull"),))
    write_inp(tmp_path / "model.inp", model, PULL)
    deck = read_deck(tmp_path / "model.inp")
    for number, place in deck.nodes.items():
        assert place == pytest.approx(mesh.points[number - 1], abs=1e-9)
    cells = [[number - 1 for number in nodes] for _, nodes in deck.elements.values()]
    assert cells == mesh.blocks[0].nodes[:, : ELEMENTS[kind].nodes].tolist()
    for face, blocks in mesh.faces.items():
        expected = {frozenset(nodes[: CORNERS[block.kind]]) for block in blocks for nodes in block.nodes.tolist()}
        found = {frozenset(number - 1 for number in corners) for corners in sides(deck, face.upper())}
        assert found == expected
