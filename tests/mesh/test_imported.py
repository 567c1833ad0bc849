import itertools
import math

import numpy as np
import pytest
from tests.mesh.decks import deck

from pneumorph.errors import GeometryError, InputError, MeshError, NameNotFoundError
from pneumorph.geometry import Finger, ThickTube, export, occ
from pneumorph.mesh import Imported, MeshSize, Selector, generate
from pneumorph.mesh.findings import cavities_found, domains_found, faces_found

HOLLOW = ((3, 3, 3), ((1, 1, 1),))


@pytest.fixture
def write(tmp_path):
    def put(text, name="body.inp"):
        path = tmp_path / name
        path.write_text(text)
        return str(path)

    return put


def area(body, name):
    return float(body.body.skin.areas[body.facets[name]].sum())


# --- meshes -----------------------------------------------------------------------------------------------------------


def test_a_cell_that_is_left_out_is_a_cavity_of_its_volume(write):
    body = Imported(write(deck(*HOLLOW)), "cm")
    assert body.cavities == ("cavity",)
    assert body.cavity_volume == pytest.approx(1000.0, rel=1e-12)
    assert area(body, "cavity") == pytest.approx(600.0)
    assert area(body, "outer") == pytest.approx(5400.0)
    (domain,) = domains_found(body.mesh)
    assert (domain.name, domain.cells, domain.kinds) == ("BODY", 26, ("hexahedron27",))
    assert domain.volume == pytest.approx(26000.0)
    assert "lock" in body.notes[0]


def test_cavities_are_numbered_along_the_longest_side(write):
    left_out = ((1, 1, 5), (1, 1, 1), (1, 1, 3))
    body = Imported(write(deck((3, 3, 7), left_out)), "mm")
    assert body.cavities == ("cavity_1", "cavity_2", "cavity_3")
    assert [c.middle[2] for c in cavities_found(body.mesh, body)] == pytest.approx([1.5, 3.5, 5.5])
    assert all(volume == pytest.approx(1.0) for volume in body.volumes.values())


def test_two_cavities_that_touch_in_an_edge_are_two(write):
    body = Imported(write(deck((4, 4, 3), ((1, 1, 1), (2, 2, 1)))), "mm")
    assert len(body.cavities) == 2


def test_a_surface_of_the_file_is_a_face_and_names_the_cavity_that_it_covers(write):
    # cells are numbered with z fastest, 1 at the origin; the hole lies between 13 and 14
    base = "*SURFACE, NAME=BASE\n" + "\n".join(f"{1 + 3 * i - (i > 4)}, S1" for i in range(9))
    air = "\n*SURFACE, NAME=AIR, TYPE=ELEMENT\n5, S4\n22, S6\n11, S5\n16, S3\n13, S2\n14, S1"
    body = Imported(write(deck(*HOLLOW, extra=base + air)), "mm")
    assert area(body, "BASE") == pytest.approx(9.0)
    (face,) = [face for face in faces_found(body.mesh) if face.name == "BASE"]
    assert face.normal == pytest.approx([0, 0, -1])
    assert face.centre == pytest.approx([1.5, 1.5, 0.0])
    assert body.cavities == ("AIR",)
    assert body.cavity_faces("AIR") == ("AIR",)
    assert set(body.face_names) == {"AIR", "BASE", "outer"}


def test_node_sets_and_face_elements_are_sets_that_selectors_can_ask_for(write):
    nodes = [i + 1 for i, place in enumerate(itertools.product(range(4), repeat=3)) if place[0] == 0]
    extra = f"*NSET, NSET=WALL\n{', '.join(map(str, nodes))}\n*ELEMENT, TYPE=M3D4, ELSET=LID\n900, 4, 8, 24, 20"
    path = write(deck(*HOLLOW, extra=extra))
    plain = Imported(path, "mm")
    assert set(plain.face_names) == {"cavity", "outer"}
    assert {"WALL", "LID", "ALL"} <= set(plain.body.sets)
    body = Imported(path, "mm", {"clamp": Selector(set="WALL")})
    assert area(body, "clamp") == pytest.approx(9.0)
    assert area(body, "outer") == pytest.approx(45.0)


@pytest.mark.parametrize(
    ("selector", "expected"),
    [
        (Selector(normal=(-2, 0, 0)), 9.0),
        (Selector(axis="z", at=3.0), 9.0),
        (Selector(box=((0, 0, 0), (1, 3, 3))), 9.0 + 4 * 3.0),
        (Selector(box=((0, 0, 0), (1, 3, 3)), normal=(0, 0, 1)), 3.0),
        (Selector(nearest=(1.5, 1.5, 9.0)), 9.0),
        (Selector(largest_planar=True, normal=(0, 1, 0)), 9.0),
        (Selector(set="ALL"), 60.0),
    ],
    ids=str,
)
def test_selectors_catch_the_facets_they_describe(write, selector, expected):
    body = Imported(write(deck(*HOLLOW)), "mm")
    skin = body.body.skin
    outside = ~body.facets["cavity"]
    mask = selector.facets(skin, outside, body.patches, body.body.sets)
    assert skin.areas[mask].sum() == pytest.approx(expected)


@pytest.mark.parametrize(
    ("faces", "message"),
    [
        ({"clamp": Selector(axis="x", at=7.0)}, r"face 'clamp': its selector \(plane x = 7 mm\) catches no facet"),
        (
            {"a": Selector(normal=(1, 0, 0)), "b": Selector(axis="x", at=3.0)},
            r"'a' and 'b' claim the same 9 facets, about \(3, 1.5, 1.5\) mm",
        ),
        ({"a": Selector(set="WALLS")}, "face 'a': unknown set 'WALLS'"),
        ({"all": Selector(set="ALL")}, "'all' lies partly outside and partly in a cavity"),
        ({"cavity": Selector(normal=(1, 0, 0))}, "'cavity' bears the name of a cavity"),
        ({"outer": Selector(normal=(1, 0, 0))}, "'outer' does not cover all of the outside"),
    ],
)
def test_faces_that_catch_nothing_or_the_same_are_refused(write, faces, message):
    with pytest.raises((MeshError, NameNotFoundError), match=message):
        Imported(write(deck(*HOLLOW)), "mm", faces)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "an empty selector"),
        ({"axis": "x"}, "needs both"),
        ({"axis": "w", "at": 1.0}, "unknown axis 'w'"),
        ({"normal": (0, 0, 0)}, "not all zero"),
        ({"box": ((1, 0, 0), (0, 1, 1))}, "low corner first"),
    ],
)
def test_half_a_selector_is_refused(values, message):
    with pytest.raises(InputError, match=message):
        Selector(**values)


# --- caps -------------------------------------------------------------------------------------------------------------

OPEN = deck((3, 3, 3), ((1, 1, 1), (1, 1, 2)))


def test_a_cap_closes_an_opening_and_a_missing_one_is_hinted_at(write):
    path = write(OPEN)
    plain = Imported(path, "mm")
    assert plain.cavities == ()
    with pytest.raises(GeometryError, match=r"no closed cavity; caps could close it at \(1.5, 1.5, 3\) mm, rim 4 mm"):
        plain.require_cavity()
    body = Imported(path, "mm", caps={"inlet": (1.4, 1.5, 3.2)})
    assert body.cavity_faces("cavity") == ("cavity", "inlet")
    assert body.cavity_volume == pytest.approx(2.0, rel=1e-12)
    (found,) = cavities_found(body.mesh, body)
    assert found.volume == pytest.approx(2.0, rel=1e-12)
    assert area(body, "cavity") == pytest.approx(9.0)
    assert body.require_cavity() is None


def test_a_passage_needs_a_cap_at_both_ends(write):
    path = write(deck((3, 3, 3), ((1, 1, 0), (1, 1, 1), (1, 1, 2))))
    with pytest.raises(MeshError, match="has the space behind it another opening"):
        Imported(path, "mm", caps={"top": (1.5, 1.5, 3.0)})
    body = Imported(path, "mm", caps={"top": (1.5, 1.5, 3.0), "bottom": (1.5, 1.5, 0.0)})
    assert body.cavity_volume == pytest.approx(3.0)
    assert body.cavity_faces("cavity") == ("cavity", "top", "bottom")


def test_a_cap_over_no_space_is_refused(write):
    path = write(deck((1, 1, 3)))
    with pytest.raises(MeshError, match=r"cap 'inlet': no space lies behind the rim about \(0.5, 0.5, 3\) mm"):
        Imported(path, "mm", caps={"inlet": (0.5, 0.5, 3.0)})
    with pytest.raises(GeometryError, match="nor an opening"):
        Imported(path, "mm").require_cavity()
    with pytest.raises(MeshError, match="bears the name of a face"):
        Imported(write(OPEN), "mm", {"inlet": Selector(axis="z", at=0.0)}, {"inlet": (1.5, 1.5, 3.0)})


# --- CAD --------------------------------------------------------------------------------------------------------------


def test_an_exported_template_comes_back_with_its_names(tmp_path):
    finger = Finger(chambers=2, length=30.0)
    path = export(finger, tmp_path / "finger.step")
    body = Imported(str(path), meshing=MeshSize(coarse=True))
    assert set(body.face_names) == set(finger.face_names)
    assert body.cavities == finger.cavities
    assert body.cavity_volume == pytest.approx(finger.cavity_volume, rel=1e-9)
    assert body.axis == finger.axis
    assert occ.volume(body.shape()) == pytest.approx(occ.volume(finger.shape()), rel=1e-9)
    assert generate(body) is body.mesh
    assert generate(body, coarse=True) is body.mesh
    assert generate(body, 2.0).cell_count > body.mesh.cell_count
    with pytest.raises(MeshError, match=r"wall_size = 1\.0: only templates"):
        generate(body, wall_size=1.0)
    assert [d.value for d in body.dimensions()] == pytest.approx([30.0, 16.0, 18.0])


def test_a_step_file_in_metres_gives_the_same_body(tmp_path):
    path = tmp_path / "box.step"
    occ.write_step(occ.cut(occ.box((0, 0, 0), (4, 4, 4)), [occ.box((1, 1, 1), (3, 3, 3))]), path)
    millimetres = Imported(str(path))
    path.write_text(path.read_text().replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"))
    metres = Imported(str(path), meshing=MeshSize(2000.0))
    assert millimetres.cavity_volume == pytest.approx(8.0, rel=1e-9)
    assert metres.cavity_volume == pytest.approx(8e9, rel=1e-9)


def test_solids_that_touch_are_bonded_and_those_that_overlap_refused(tmp_path):
    low, high = occ.box((0, 0, 0), (4, 4, 2)), occ.box((0, 0, 2), (4, 4, 4))
    occ.write_step(occ.bonded([(low, "a"), (high, "b")]), tmp_path / "two.step")
    body = Imported(str(tmp_path / "two.step"))
    assert len(body.domains) == 2
    assert area(body, "outer") == pytest.approx(96.0)
    both = occ.occ.Compound([occ.box((0, 0, 0), (4, 4, 2)), occ.box((0, 0, 1), (4, 4, 4))])
    occ.write_step(both, tmp_path / "overlap.step")
    with pytest.raises(GeometryError, match=r"the solids 1 and 2 overlap by 16 mm3 in \(.*0.0.*1.0\) to"):
        Imported(str(tmp_path / "overlap.step"))


def test_a_tube_through_and_through_is_closed_by_two_caps_to_its_volume(tmp_path):
    tube = ThickTube(cap=0.0, length=20.0)
    path = export(tube, tmp_path / "tube.step")
    caps = {"low": (0.0, 0.0, 0.0), "high": (0.0, 0.0, 20.0)}
    body = Imported(str(path), caps=caps, meshing=MeshSize(6.0))
    assert body.cavity_volume == pytest.approx(math.pi * 100.0 * 20.0, rel=1e-3)


# --- what is refused --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "unit", "message"),
    [
        ("body.inp", None, "unit: missing; a .inp file does not say it. Allowed: um, mm, cm"),
        ("body.inp", "furlong", "unknown unit 'furlong'"),
        ("body.obj", "mm", "unknown suffix of a geometry or mesh file '.obj'"),
        ("gone.inp", "mm", "there is no such file"),
        ("body.step", "mm", "the file says its unit itself"),
        ("body.step", None, "Open CASCADE cannot make a solid"),
        ("body.iges", None, "Open CASCADE cannot make a solid|expected at least one solid"),
        ("body.vtu", "mm", "meshio cannot read this file"),
        ("body.msh", "mm", "meshio cannot read this file"),
        ("body.stl", "mm", "neither a text STL file nor a binary one"),
    ],
)
def test_a_bad_file_is_refused_with_one_message(tmp_path, name, unit, message):
    if not name.startswith("gone"):
        (tmp_path / name).write_text("no geometry\n")
    with pytest.raises(InputError, match=message) as caught:
        Imported(str(tmp_path / name), unit)
    assert name in str(caught.value) or unit == "furlong"


def test_several_files_make_one_body_only_as_stl(write):
    with pytest.raises(InputError, match=r"only if all are \.stl"):
        Imported((write(deck((1, 1, 1))), write(deck((1, 1, 1)), "b.inp")), "mm")
    with pytest.raises(InputError, match="expected at least one"):
        Imported((), "mm")


def test_what_does_not_fit_into_memory_is_refused(write, monkeypatch):
    path = write(deck((1, 1, 1)))

    class Little:
        available = 1000

    monkeypatch.setattr("pneumorph.mesh.memory.psutil.virtual_memory", lambda: Little)
    with pytest.raises(MeshError, match="of memory, 1e-06 GB are free"):
        Imported(path, "mm")
    monkeypatch.setattr("pneumorph.mesh.memory._TEXT", 0)
    with pytest.raises(MeshError, match="about 1 cells take at least"):
        Imported(path, "mm")


def test_a_mesh_cannot_be_meshed_anew_and_cad_only_with_a_size(write, tmp_path):
    with pytest.raises(MeshError, match="is a mesh already"):
        Imported(write(deck((1, 1, 1))), "mm", meshing=MeshSize(1.0))
    with pytest.raises(GeometryError, match="holds no CAD solid"):
        Imported(write(deck((1, 1, 1))), "mm").shape()
    occ.write_step(occ.box((0, 0, 0), (1, 1, 1)), tmp_path / "box.step")
    with pytest.raises(MeshError, match=r"size = -1\.0"):
        Imported(str(tmp_path / "box.step"), meshing=MeshSize(-1.0))
    with pytest.raises(GeometryError, match="feature_angle"):
        Imported(str(tmp_path / "box.step"), feature_angle=0.0)


def test_a_body_in_two_parts_and_a_cell_inside_out_are_refused(write):
    with pytest.raises(MeshError, match=r"2 separate parts, about \(.*\) mm, \("):
        Imported(write(deck((1, 1, 3), ((0, 0, 1),))), "mm")
    turned = deck((1, 1, 1)).replace("1, 1, 5, 7, 3, 2, 6, 8, 4", "1, 2, 6, 8, 4, 1, 5, 7, 3")
    assert turned != deck((1, 1, 1))
    with pytest.raises(MeshError, match="1 hexahedron27 turned inside out, one at"):
        Imported(write(turned), "mm")


def test_a_node_set_of_the_file_that_shares_facets_with_a_face_is_noted(write):
    base = "*SURFACE, NAME=BASE\n1, S1\n2, S1"
    body = Imported(write(deck((2, 1, 1), extra=base)), "mm", {"clamp": Selector(box=((0, 0, 0), (1, 1, 0)))})
    assert "BASE" not in body.face_names
    assert any("set 'BASE' is no face" in note for note in body.notes)
    assert np.array_equal(body.body.sets["BASE"] & body.facets["clamp"], body.facets["clamp"])
