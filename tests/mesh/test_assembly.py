"""Several bodies in one mesh: where they stand, and what their names become."""

import numpy as np
import pytest

from pneumorph.errors import MeshError
from pneumorph.mesh import box, rectangle
from pneumorph.mesh.assembly import Placement, Turn, assembled, name_of
from pneumorph.mesh.quality import inspect

QUARTER = np.pi / 2.0


def brick():
    return box(2, 1, 1, "hexahedron27", lengths=(4.0, 2.0, 1.0), bending_walls={"wall": 1.0})


def test_a_turn_follows_the_right_hand_rule_about_its_point():
    turn = Turn((0.0, 0.0, 2.0), QUARTER, (1.0, 1.0, 5.0))
    np.testing.assert_allclose(turn(np.array([[2.0, 1.0, 7.0]])), [[1.0, 2.0, 7.0]], atol=1e-12)


def test_turns_come_one_after_the_other_and_the_shift_last():
    first, second = Turn((1.0, 0.0, 0.0), QUARTER), Turn((0.0, 0.0, 1.0), QUARTER)
    mesh = brick()
    both = Placement((first, second), (10.0, 0.0, 0.0))(mesh)
    np.testing.assert_allclose(both.points, second(first(mesh.points)) + np.array([10.0, 0.0, 0.0]), atol=1e-12)
    other = Placement((second, first))(mesh)
    assert np.abs(both.points - [10.0, 0.0, 0.0] - other.points).max() > 0.5


def test_a_placed_body_keeps_volume_names_and_edges():
    mesh = brick()
    moved = Placement((Turn((1.0, 2.0, 3.0), 0.7),), (5.0, -1.0, 2.0))(mesh)
    before, after = inspect(mesh), inspect(moved)
    assert after.volume == pytest.approx(before.volume, rel=1e-12)
    assert after.smallest_edge == pytest.approx(before.smallest_edge, rel=1e-12)
    assert moved.faces.keys() == mesh.faces.keys()


def test_parts_lead_the_names_of_what_is_theirs_and_share_no_node():
    one = brick()
    whole = assembled(one, {"arm": Placement(shift=(9.0, 0.0, 0.0))(one)})
    assert whole.domains == (one.domains[0], f"arm.{one.domains[0]}")
    assert set(whole.faces) == {*one.faces, *(f"arm.{name}" for name in one.faces)}
    assert dict(whole.bending_walls) == {"wall": 1.0, "arm.wall": 1.0}
    assert whole.cell_count == 2 * one.cell_count
    assert inspect(whole).volume == pytest.approx(16.0)
    for name in one.faces:
        np.testing.assert_array_equal(whole.face_nodes(name), one.face_nodes(name))
        np.testing.assert_allclose(
            whole.points[whole.face_nodes(f"arm.{name}")], one.points[one.face_nodes(name)] + [9.0, 0.0, 0.0]
        )


def test_the_main_body_bears_its_own_names():
    assert name_of("", "tip") == "tip"
    assert name_of("arm", "skin") == "arm.skin"


def test_a_plane_body_turns_in_its_plane():
    mesh = rectangle(1, 1, width=2.0)
    moved = Placement((Turn((0.0, 0.0, 1.0), QUARTER),), (3.0, 0.0, 0.0))(mesh)
    np.testing.assert_allclose(moved.points, np.column_stack([3.0 - mesh.points[:, 1], mesh.points[:, 0]]), atol=1e-12)
    for placement in (Placement((Turn((1.0, 0.0, 0.0), 0.1),)), Placement(shift=(0.0, 0.0, 1.0))):
        with pytest.raises(MeshError, match="out of its plane"):
            placement(mesh)


def test_a_body_with_axial_symmetry_stays_on_its_axis():
    mesh = rectangle(1, 1, width=2.0, space="axisymmetric")
    np.testing.assert_allclose(Placement(shift=(0.0, 4.0, 0.0))(mesh).points, mesh.points + np.array([0.0, 4.0]))
    for placement in (Placement(shift=(1.0, 0.0, 0.0)), Placement((Turn((0.0, 0.0, 1.0), 0.1),))):
        with pytest.raises(MeshError, match="off its axis"):
            placement(mesh)


def test_bodies_of_different_spaces_do_not_join():
    with pytest.raises(MeshError, match="part 'flat' is plane_strain, the main body 3d"):
        assembled(brick(), {"flat": rectangle(1, 1, width=2.0)})


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Turn((0.0, 0.0, 0.0), 1.0), "not all zero"),
        (lambda: Turn((0.0, 1.0), 1.0), "axis = .*expected 3 finite numbers"),
        (lambda: Turn((0.0, 0.0, 1.0), float("nan")), "angle = nan rad"),
        (lambda: Turn((0.0, 0.0, 1.0), 1.0, (0.0, float("inf"), 0.0)), "about = .*expected 3 finite numbers"),
        (lambda: Placement(shift=(0.0, 1.0)), "shift = .*expected 3 finite lengths"),
    ],
)
def test_a_place_that_is_none_is_refused(make, message):
    with pytest.raises(MeshError, match=message):
        make()
