import itertools

import meshio
import numpy as np
import pytest
from tests.mesh.decks import deck, lattice

from pneumorph.errors import MeshError
from pneumorph.mesh import Imported, inspect
from pneumorph.mesh.files import read_mesh_file
from pneumorph.mesh.inp import read_deck
from pneumorph.mesh.mesh import CELL_NODES, CellBlock
from pneumorph.mesh.quadratic import QUADRATIC, quadratic
from pneumorph.mesh.reference import MIDS, NODES, jacobians
from pneumorph.mesh.structured import box
from pneumorph.mesh.topology import CORNERS

LINEAR = {"tetra10": "tetra", "wedge18": "wedge", "hexahedron27": "hexahedron"}


def gmsh_body(tagged=True):
    """Two hexahedra of two domains under each other and the face below them, as meshio has it."""
    places, cells = lattice((1, 1, 2))
    cells = np.array(cells) - 1
    low = cells[0][[0, 1, 2, 3]]
    tags = [np.array([1, 2]), np.array([7])] if tagged else None
    return meshio.Mesh(
        np.array(places, dtype=float),
        [("hexahedron", cells), ("quad", low[None])],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags} if tagged else {},
        field_data={"low": np.array([1, 3]), "high": np.array([2, 3]), "base": np.array([7, 2])} if tagged else {},
    )


def gmsh_41(path):
    """Write the same as text of version 4.1, which says the groups of entities, not of cells."""
    places, (low, high) = lattice((1, 1, 2))
    nodes = "\n".join([*(str(i + 1) for i in range(12)), *(" ".join(map(str, place)) for place in places)])
    entities = "0 0 1 2\n1 0 0 0 1 1 0 1 7 0\n1 0 0 0 1 1 1 1 1 0\n2 0 0 1 1 1 2 1 2 0"
    cells = [("2 1 3 1", 1, low[:4]), ("3 1 5 1", 2, low), ("3 2 5 1", 3, high)]
    rows = "\n".join(f"{head}\n{number} {' '.join(map(str, cell))}" for head, number, cell in cells)
    sections = {
        "MeshFormat": "4.1 0 8", "PhysicalNames": '3\n2 7 "base"\n3 1 "low"\n3 2 "high"', "Entities": entities,
        "Nodes": f"1 12 1 12\n3 1 0 12\n{nodes}", "Elements": f"3 3 1 3\n{rows}",
    }  # fmt: skip
    path.write_text("".join(f"${name}\n{text}\n$End{name}\n" for name, text in sections.items()))


@pytest.mark.parametrize("form", ["2.2 text", "2.2 binary", "4.1 text"])
def test_physical_groups_are_domains_and_faces(tmp_path, form):
    path = tmp_path / "body.msh"
    if form == "4.1 text":
        gmsh_41(path)
    else:
        meshio.write(path, gmsh_body(), file_format="gmsh22", binary="binary" in form)
    body = Imported(str(path), "mm")
    assert set(body.domains) == {"low", "high"}
    assert {name: len(body.facets[name].nonzero()[0]) for name in body.face_names} == {"base": 1, "outer": 9}
    assert inspect(body.mesh).volume == pytest.approx(2.0)


def test_a_vtu_file_gives_cells_and_numbered_domains(tmp_path):
    path = tmp_path / "body.vtu"
    places, cells = lattice((1, 1, 2))
    meshio.write(
        path,
        meshio.Mesh(np.array(places, float), [("hexahedron", np.array(cells) - 1)], cell_data={"domain": [[4, 9]]}),
    )
    body = Imported(str(path), "m")
    assert body.domains == ("body_4", "body_9")
    assert inspect(body.mesh).volume == pytest.approx(2e9)
    meshio.write(path, gmsh_body(tagged=False))
    assert Imported(str(path), "mm").domains == ("body",)


def test_cells_that_are_not_supported_are_named(tmp_path):
    path = tmp_path / "body.vtu"
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]], dtype=float)
    meshio.write(path, meshio.Mesh(points, [("pyramid", np.arange(5)[None])]))
    with pytest.raises(MeshError, match="not supported: pyramid; solid cells: 0"):
        read_mesh_file(path)


# --- quadratic ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", LINEAR)
def test_linear_cells_get_the_nodes_that_quadratic_ones_have(kind):
    mesh = box(2, 2, 2, kind=kind, distortion=0.2)
    (block,) = mesh.blocks
    corners = block.nodes[:, : CORNERS[kind]]
    used, inverse = np.unique(corners, return_inverse=True)
    linear = CellBlock(LINEAR[kind], "body", inverse.reshape(corners.shape))
    points, (made,) = quadratic(mesh.points[used], [linear])
    assert made.kind == kind
    assert len(points) == len(mesh.points)
    assert points[made.nodes] == pytest.approx(mesh.points[block.nodes], abs=1e-12)


@pytest.mark.parametrize(("kind", "given"), [("hexahedron20", 20), ("wedge15", 15)])
def test_serendipity_cells_keep_their_curved_edges(kind, given):
    """x -> x + a y^2 ... has no term of the serendipity space's gap, so the added nodes lie on it exactly."""
    full = QUADRATIC[kind]
    flat = NODES[full].copy()
    curved = flat + 0.2 * np.column_stack([flat[:, 1] ** 2, flat[:, 2] * flat[:, 0], flat[:, 0] ** 2])
    points, (made,) = quadratic(curved[:given], [CellBlock(kind, "body", np.arange(given)[None])])
    assert made.nodes.shape == (1, CELL_NODES[full])
    assert points[made.nodes[0]] == pytest.approx(curved, abs=1e-12)
    assert (jacobians(points, full, made.nodes) > 0).all()


def test_mid_nodes_of_the_reference_cells_lie_between_their_corners():
    for kind, nodes in NODES.items():
        for mid, corners in MIDS[kind].items():
            assert nodes[mid] == pytest.approx(nodes[list(corners)].mean(axis=0))


# --- input decks ----------------------------------------------------------------------------------------------------


def put(tmp_path, text):
    path = tmp_path / "body.inp"
    path.write_text(text)
    return path


def test_a_deck_is_read_with_continued_lines_generated_sets_and_any_case(tmp_path):
    places, cells = lattice((1, 1, 2))
    # a 20-node cell over several lines; nodes 101.. in the middle of the edges
    corners = np.array([places[n - 1] for n in cells[0]], dtype=float)
    mids = [(corners[a] + corners[b]) / 2 for a, b in itertools.islice(MIDS["hexahedron27"].values(), 12)]
    nodes = [*(f"{n},{','.join(map(str, places[n - 1]))}" for n in cells[0])]
    nodes += [f"{101 + i}, {x}, {y}, {z}" for i, (x, y, z) in enumerate(mids)]
    numbers = [*cells[0], *range(101, 113)]
    text = "\n".join(
        [
            "** a comment", "*Heading", "what, ever", "*node", *nodes, "*ELEMENT, type=c3d20r, elset=Gum",
            "5, " + ", ".join(map(str, numbers[:11])) + ",", ", ".join(map(str, numbers[11:])),
            "*nset, nset=low, generate", "101, 104, 1", "*Elset, elset=all", "gum", "*SURFACE, name=top", "GUM, S2",
            "*Solid Section, elset=gum, material=m", "*STEP", "*STATIC", "1., 1.", "*END STEP",
        ]
    )  # fmt: skip
    found = read_deck(put(tmp_path, text))
    assert found.elements == {5: ("hexahedron20", numbers)}
    assert found.node_sets["low"] == [101, 102, 103, 104]
    assert found.element_sets["all"] == [5]
    body = Imported(str(tmp_path / "body.inp"), "mm")
    assert body.domains == ("Gum",)
    assert body.body.skin.normals[body.facets["top"]] == pytest.approx(np.array([[0.0, 0.0, 1.0]]))
    assert inspect(body.mesh).volume == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_sides_of_abaqus_cells_are_faces_of_ours(tmp_path, kind):
    """Every side that a deck can name is one face of the cell, each once."""
    short, count = {"tetra10": ("C3D4", 4), "wedge18": ("C3D6", 6)}[kind]
    lines = ["*NODE", *(f"{i + 1}, {x}, {y}, {z}" for i, (x, y, z) in enumerate(NODES[kind][:count]))]
    lines += [f"*ELEMENT, TYPE={short}, ELSET=E", "1, " + ", ".join(str(i + 1) for i in range(count))]
    sides = 4 if kind == "tetra10" else 5
    for i in range(sides):
        lines += [f"*SURFACE, NAME=F{i + 1}", f"E, S{i + 1}"]
    body = Imported(str(put(tmp_path, "\n".join(lines))), "mm")
    assert sorted(body.face_names) == [f"F{i + 1}" for i in range(sides)]
    assert all(mask.sum() == 1 for mask in body.facets.values())


GOOD = deck((1, 1, 1))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("C3D8", "C3D8R") + "*ELEMENT, TYPE=B31\n9, 1, 2\n", r"supported: B31 \(1\)"),
        (GOOD + "*ELEMENT, TYPE=C3D5\n9, 1, 2\n10, 1, 2\n*ELEMENT, TYPE=T3D2\n11, 1, 2\n", r"C3D5 \(2\), T3D2 \(1\)"),
        (GOOD.replace("1, 0, 0, 0", "1, 0, nought, 0"), "line 2: cannot read '1, 0, nought, 0' under"),
        (GOOD.replace("1, 1, 5, 7, 3, 2, 6, 8, 4", "1, 1, 5, 7"), "element 1 of type C3D8 has 3 nodes, expected 8"),
        (GOOD.replace("1, 1, 5, 7, 3, 2, 6, 8, 4", "1, 1, 5, 7, 3, 2, 6, 8, 44"), "node or element 44 is named"),
        (GOOD + "*SURFACE, NAME=S\nBODY, S9\n", "refers to what is not there: side 'S9' of element 1"),
        (GOOD + "*SURFACE, NAME=S\n77, S1\n", "node or element 77 is named"),
        (GOOD + "*NSET, NSET=N, GENERATE\n1, 1000000000, 1\n", "more numbers than there are"),
        (GOOD + "*NSET, NSET=N, GENERATE\n1\n", "cannot read '1' under"),
        (GOOD + "*NSET, NSET=N, GENERATE\n1, 2, 0\n", "must not be zero"),
        (GOOD + "*INCLUDE, INPUT=more.inp\n", "is not followed"),
        (GOOD + "*INSTANCE, NAME=A\n*INSTANCE, NAME=B\n", "a second"),
        (GOOD + "*INSTANCE, NAME=A\n1., 0., 0.\n", "that is moved"),
        (GOOD.replace("1, 0, 0, 0", "1, 0, nan, 0"), "without finite coordinates"),
        ("*NODE\n1, 0, 0, 0\n", "1 nodes and 0 solid elements"),
    ],
)  # fmt: skip
def test_a_deck_that_cannot_be_meant_is_refused(tmp_path, text, message):
    with pytest.raises(MeshError, match=message):
        read_mesh_file(put(tmp_path, text))
