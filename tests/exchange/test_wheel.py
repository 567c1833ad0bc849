"""Whole bodies from halves, and wheels of soft limbs at any pressure."""

from dataclasses import asdict

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.exchange.surface import completed_surface, surface_of
from pneumorph.exchange.wheel import limb_surface, positions_at, wheel_height, wheel_surface, write_wheel
from pneumorph.geometry import SoftLimb
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, Symmetry
from pneumorph.mesh import box, generate
from pneumorph.solution import solve

RUBBER = NeoHookean(0.2)
LIMB = SoftLimb(chambers=2, length=55.0, half=True)


@pytest.fixture(scope="module")
def run():
    """Two states of a short limb: at rest and at 2 kPa."""
    model = Model(
        generate(LIMB, 10.0, detail=0.2), {"body": RUBBER, "base": RUBBER},
        (Clamp("clamp"), Symmetry("symmetry_y")), (),
        (Cavity("cavity", ("cavity",), mirrors=("symmetry_y",)),),
    )  # fmt: skip
    programme = Programme((Phase("inflate", {"cavity": 0.002}, first=1.0, largest=1.0),))
    return solve(model, programme, about={"limb": asdict(LIMB)})


def volume(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def closes(triangles):
    """Every edge is passed once in each direction."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forward = {tuple(edge) for edge in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def test_a_half_and_its_image_close_and_have_twice_the_volume():
    half = Model(box(2, 2, 1, lengths=(4.0, 1.0, 2.0), distortion=0.1), {"body": RUBBER}, (Clamp("z0"),))
    whole = completed_surface(half, "x0")
    assert closes(whole.triangles)
    assert whole.volume == pytest.approx(2.0 * surface_of(half).volume)
    assert whole.points[:, 0].min() == pytest.approx(-whole.points[:, 0].max())


def test_the_filled_limb_holds_the_air_besides(run):
    whole, outer = (limb_surface(run, 0.0, part) for part in ("whole", "outer"))
    assert closes(whole.triangles)
    assert closes(outer.triangles)
    air = 2.0 * run.states[0].volume["cavity"]
    assert outer.volume - whole.volume == pytest.approx(air, rel=6e-3)  # flat triangles on round faces


def test_between_two_states_nodes_lie_on_the_line_between_them(run):
    first, last = run.states[0].positions, run.states[-1].positions
    assert positions_at(run, "cavity", 0.0) == pytest.approx(first)
    assert positions_at(run, "cavity", 0.002) == pytest.approx(last)
    assert positions_at(run, "cavity", 0.0005) == pytest.approx(0.75 * first + 0.25 * last)
    assert np.abs(last - first).max() > 0.5


@pytest.mark.parametrize("pressure", [0.0, 0.0013, 0.002])
def test_a_wheel_is_limbs_that_close_turned_about_the_axle(run, pressure):
    points, triangles = wheel_surface(run, pressure)
    count = len(points) // 4
    assert closes(triangles)
    assert triangles.reshape(4, -1).min(axis=1).tolist() == [0, count, 2 * count, 3 * count]
    one = limb_surface(run, pressure)
    assert volume(points, triangles) == pytest.approx(4.0 * one.volume)
    assert one.volume > 0.0
    assert points[:count] == pytest.approx(one.points - np.array(LIMB.axle))
    # a quarter turn about y takes x to -z
    assert points[count : 2 * count][:, [0, 2]] == pytest.approx(points[:count][:, [2, 0]] * [1.0, -1.0])
    assert wheel_height(points) == pytest.approx(2.0 * np.hypot(points[:, 0], points[:, 2]).max())


def test_an_inflated_wheel_is_higher(run):
    assert wheel_height(wheel_surface(run, 0.002)[0]) > wheel_height(wheel_surface(run, 0.0)[0]) + 0.1


def test_a_wheel_is_written_as_stl_with_all_its_triangles(run, tmp_path):
    written = write_wheel(tmp_path / "wheel.stl", run, 0.001, limbs=3)
    content = (tmp_path / "wheel.stl").read_bytes()
    assert int.from_bytes(content[80:84], "little") == written.counts["triangles"]
    assert len(content) == 84 + 50 * written.counts["triangles"]


def test_pressures_beyond_the_run_and_runs_of_no_limb_are_refused(run):
    with pytest.raises(InputError, match="pressure = 3 kPa, allowed: 0 kPa to 2 kPa"):
        wheel_surface(run, 0.003)
    with pytest.raises(InputError, match="limbs = 0, allowed: 1 or more"):
        wheel_surface(run, 0.0, limbs=0)
    other = type(run)(run.model, run.programme, run.states, run.history, run.status, "", {}, {})
    with pytest.raises(InputError, match="does not say which limb"):
        wheel_surface(other, 0.0)
    empty = type(run)(run.model, run.programme, [], type(run.history)(run.history.columns, []), run.status, "", {}, {})
    with pytest.raises(InputError, match="no states"):
        positions_at(empty, "cavity", 0.0)


def test_halves_that_do_not_close_and_unknown_parts_are_refused(run):
    model = run.model
    with pytest.raises(InputError, match="does not end in the plane of 'tip'"):
        completed_surface(model, "tip", part="outer")
    with pytest.raises(InputError, match="part of a surface"):
        completed_surface(model, "symmetry_y", part="inner")
