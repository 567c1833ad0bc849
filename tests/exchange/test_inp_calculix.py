"""CalculiX solves our input files as they are, and finds what we find."""

import numpy as np
import pytest

from pneumorph.exchange import pressures_of, write_inp
from pneumorph.materials import ArrudaBoyce, LinearElastic, MooneyRivlin, NeoHookean, Ogden, Yeoh
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Force,
    Gravity,
    Model,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Symmetry,
    Traction,
    VolumeSupply,
    march,
)
from pneumorph.mesh import CellBlock, FaceBlock, Mesh, box, rectangle
from pneumorph.mesh.reference import NODES
from pneumorph.mesh.topology import CELL_FACES
from pneumorph.solution import solve

# every law that the programs have; the bulk modulus is the default, 1000 shear moduli
LAWS = {
    "neo-Hookean": NeoHookean(0.2),
    "Yeoh": Yeoh(0.11, 0.03, 0.002),
    "Mooney-Rivlin": MooneyRivlin(0.08, 0.03),
    "polynomial": MooneyRivlin(0.08, 0.03, 0.01, 0.004, 0.002),
    "Ogden 1": Ogden((0.1,), (3.0,)),
    "Ogden 3": Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)),
    "Arruda-Boyce": ArrudaBoyce(0.2, 2.5),
}


def compared(calculix, path, model, programme, faces, **options):
    """Return, for each time printed, CalculiX's and our displacements (nodes, d) of the nodes printed."""
    write_inp(path, model, programme, printed=faces, **options)
    found = calculix(path)
    states = {round(state.time, 6): state for state in march(model, programme)}
    result = {}
    for time, moved in found.items():
        if round(time, 6) in states:
            nodes = np.array(sorted(moved))
            theirs = np.array([moved[node] for node in nodes])[:, : model.mesh.dimension]
            result[time] = theirs, states[round(time, 6)].displacement[nodes]
    return result


def ramp(name="load", first=0.5, marks=(), **targets):
    return Phase(name, targets, marks, first=first, largest=first)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_every_law_stretches_alike_under_two_unequal_pulls(calculix, tmp_path, law):
    # homogeneous, so that no element is too stiff: what is left is the law and its constants
    model = Model(
        box(1, 1, 1),
        {"body": law},
        (Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z")),
        (Force("x1", (1.0, 0.0, 0.0), "along"), Force("y1", (0.0, 1.0, 0.0), "across")),
    )
    programme = Programme((ramp(first=0.25, along=0.25, across=0.1),))
    pairs = compared(calculix, tmp_path / "law.inp", model, programme, ("x1", "y1"))
    theirs, ours = pairs[1.0]
    assert np.abs(ours).max() > 0.2
    assert theirs == pytest.approx(ours, abs=2e-4 * np.abs(ours).max())


def test_a_hexahedron_without_its_middle_nodes_stretches_alike(calculix, tmp_path):
    points, nodes = 2.0 * NODES["hexahedron27"], np.arange(27)[None, :]
    faces = {}
    for kind, local in CELL_FACES["hexahedron27"]:
        axis = int(np.argmin(np.ptp(points[list(local)], axis=0)))
        faces[f"{'xyz'[axis]}{int(points[local[0], axis] > 0)}"] = (FaceBlock(kind, nodes[:, local]),)
    model = Model(
        Mesh(points, (CellBlock("hexahedron27", "body", nodes),), faces),
        {"body": NeoHookean(0.2)},
        (Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z")),
        (Force("x1", (1.0, 0.0, 0.0), "along"), Traction("y1", (0.0, 1.0, 0.0), "across")),
    )
    programme = Programme((ramp(first=0.25, along=1.0, across=0.02),))
    theirs, ours = compared(calculix, tmp_path / "brick.inp", model, programme, ("x1", "y1"))[1.0]
    assert np.abs(ours).max() > 0.5
    assert theirs == pytest.approx(ours, abs=2e-4 * np.abs(ours).max())


def dome(points):
    """Map the unit cube to a part of a shell with radii 3 and 4 between four planes through its centre."""
    angle = points[:, 1:] * np.pi / 4
    way = np.column_stack([np.ones(len(points)), np.tan(angle)])
    return (3.0 + points[:, :1]) * way / np.linalg.norm(way, axis=1, keepdims=True)


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_a_pressure_follows_the_sides_of_solid_elements(calculix, tmp_path, kind):
    mesh = box(2, 4, 4, mapping=dome, kind=kind)
    cavity = Cavity("dome", ("x0",), mirrors=("y0", "y1", "z0", "z1"))
    supports = (Symmetry("y0"), Symmetry("z0"), Clamp("y1"), Clamp("z1"))
    model = Model(mesh, {"body": NeoHookean(0.2, bulk=1.0)}, supports, (), (cavity,))
    pairs = compared(calculix, tmp_path / "dome.inp", model, Programme((ramp(dome=0.1),)), ("x0", "x1"))
    theirs, ours = pairs[1.0]
    assert np.abs(ours).max() > 0.5
    # the sides of wedges are curved a little less without their middle nodes
    assert theirs == pytest.approx(ours, abs=0.03 * np.abs(ours).max())


def test_hookes_law_agrees_where_strains_are_small(calculix, tmp_path):
    model = Model(box(1, 1, 1), {"body": LinearElastic(3500.0, 0.36)}, (Clamp("x0"),), (Force("x1", (0, 0, 1.0), "f"),))
    pairs = compared(calculix, tmp_path / "hooke.inp", model, Programme((ramp(f=0.1),)), ("x1",))
    theirs, ours = pairs[1.0]
    # ours averages the volume change over a cell: one coarse cell differs, the law does not
    assert theirs == pytest.approx(ours, abs=0.05 * np.abs(ours).max())


def test_gravity_a_traction_and_their_end_on_tetrahedra(calculix, tmp_path):
    model = Model(
        box(6, 2, 2, lengths=(4.0, 1.0, 1.0)),
        {"body": Yeoh(0.11, 0.03, bulk=1.0, density=1.1e-9)},
        (Clamp("x0"),),
        (Gravity((0.0, 0.0, -2.0)), Traction("x1", (0.0, 1.0, 0.0), "pull")),
    )
    phases = (
        ramp("weight", gravity=9.81e6),
        ramp("pull", 0.25, (0.5,), pull=0.004),
        ramp("relax", pull=0.0, gravity=0.0),
    )
    pairs = compared(calculix, tmp_path / "beam.inp", model, Programme(phases), ("x1",))
    # the middle of the second phase is there because its mark became a time point
    assert {1.0, 1.5, 2.0, 3.0} <= pairs.keys()
    for time in (1.0, 1.5, 2.0):
        theirs, ours = pairs[time]
        assert np.abs(ours).max() > 0.3
        assert theirs == pytest.approx(ours, abs=0.01 * np.abs(ours).max())
    assert np.abs(pairs[3.0][0]).max() < 1e-3


def test_wedges_without_their_middle_nodes_bear_the_same_loads(calculix, tmp_path):
    model = Model(
        box(8, 4, 4, kind="wedge18", lengths=(4.0, 1.0, 1.0)),
        {"body": NeoHookean(0.2, bulk=1.0, density=1.1e-9)},
        (Clamp("x0"),),
        (Traction("y1", (0.0, 1.0, 0.0), "pull"), Gravity((0.0, 0.0, 1.0))),
    )
    pairs = compared(
        calculix, tmp_path / "wedges.inp", model, Programme((ramp(pull=0.001, gravity=9810.0),)), ("x1", "z1")
    )
    theirs, ours = pairs[1.0]
    assert theirs == pytest.approx(ours, abs=3e-3 * np.abs(ours).max())


def arc(points):
    """Map the unit square to a quarter of a ring with radii 3 and 4."""
    radius, angle = 3.0 + points[:, 0], points[:, 1] * np.pi / 2
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


@pytest.mark.parametrize("space", ["plane_strain", "axisymmetric"])
def test_a_ring_inflates_alike_in_the_plane_and_about_its_axis(calculix, tmp_path, space):
    if space == "plane_strain":
        mesh, supports = rectangle(4, 16, arc), (Symmetry("bottom"), Symmetry("top"))
    else:
        mesh = rectangle(4, 4, lambda p: np.add(p, [3.0, 0.0]), space=space)
        supports = (Roller("bottom", "y"), Roller("top", "y"))
    cavity = Cavity("cavity", ("left",), mirrors=("bottom", "top"))
    model = Model(mesh, {"body": NeoHookean(0.2, bulk=5.0)}, supports, (), (cavity,))
    pairs = compared(
        calculix, tmp_path / "ring.inp", model, Programme((ramp(cavity=0.03),)), ("left", "right"), title="* ring"
    )
    theirs, ours = pairs[1.0]
    assert np.abs(ours).max() > 0.5
    assert theirs == pytest.approx(ours, abs=5e-3 * np.abs(ours).max())


def test_a_fixed_support_wins_over_a_moved_one_and_a_later_one_over_an_earlier(calculix, tmp_path):
    model = Model(
        box(2, 2, 2, lengths=(2.0, 1.0, 1.0)),
        {"body": NeoHookean(0.2, bulk=1.0)},
        (Prescribed("x1", "x", "pull"), Clamp("x0"), Prescribed("z1", "x", "shear")),
    )
    phases = (ramp("wait", shear=0.0), ramp("pull", pull=0.4), ramp("shear", shear=0.2))
    pairs = compared(calculix, tmp_path / "moved.inp", model, Programme(phases), ("x0", "x1", "z1"))
    for theirs, ours in pairs.values():
        assert theirs == pytest.approx(ours, abs=0.01)
    assert np.abs(pairs[3.0][1][:, 0]).max() == pytest.approx(0.4)


def test_a_cavity_filled_by_volume_is_solved_with_the_pressures_of_its_run(calculix, tmp_path):
    mesh = rectangle(4, 4, lambda p: np.add(p, [3.0, 0.0]), space="axisymmetric")
    cavity = Cavity("cavity", ("left",), VolumeSupply(), mirrors=("bottom", "top"))
    supports = (Roller("bottom", "y"), Roller("top", "y"))
    model = Model(mesh, {"body": NeoHookean(0.2, bulk=5.0)}, supports, (), (cavity,))
    programme = Programme((ramp("fill", 0.1, cavity=10.0),))
    tables = pressures_of(solve(model, programme).history, ("cavity",))
    pairs = compared(calculix, tmp_path / "filled.inp", model, programme, ("left",), pressures=tables)
    theirs, ours = pairs[1.0]
    assert np.abs(ours).max() > 0.3
    assert theirs == pytest.approx(ours, abs=5e-3 * np.abs(ours).max())
