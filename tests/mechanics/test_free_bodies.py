"""Free rigid bodies in a solve: fall, spin, rest and slide, held by soft pads or dropped, resumed, balanced."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Block,
    Clamp,
    Contact,
    Cylinder,
    Force,
    FreeBody,
    Gravity,
    HalfSpace,
    Model,
    Motion,
    Phase,
    Prescribed,
    Programme,
    Roller,
    march,
)
from pneumorph.mechanics.state import rest
from pneumorph.mesh import Mesh, box, rectangle
from pneumorph.solution import solve

RUBBER = NeoHookean(0.3, bulk=30.0, density=1.1e-9)
G = 9810.0
MASS = 3e-5  # tonne: 30 g
ASIDE = box(1, 1, 1, mapping=lambda p: 10.0 * p + np.array([200.0, 0.0, 0.0]))  # a model needs a soft body


def alone(*contacts, direction=(0, 0, -1), upper=(10, 20, 30)):
    brick = FreeBody("brick", Block((0, 0, 0), upper), mass=MASS)
    loads = (Gravity(direction),)
    return Model(ASIDE, {"body": RUBBER}, (Clamp("x0"),), loads, free_bodies=(brick,), contacts=contacts)


FAR = Contact("floor", ("brick",), HalfSpace((0, 0, -1e4), (0, 0, 1)))


def test_a_body_falls_as_gravity_says():
    """Under g t / T the way is g t3 / (6 T); then at constant g it is parabolic."""
    ramp = Phase("ramp", {"gravity": G}, first=0.05, largest=0.05, duration=0.1, inertia="transient")
    *_, last = march(alone(FAR), Programme((ramp, replace(ramp, name="fall"))))
    motion = last.body_motion("brick")
    way, speed = G * 0.1**2 / 6, G * 0.1 / 2
    assert motion.centre == pytest.approx([5, 10, 15 - way - speed * 0.1 - G * 0.1**2 / 2], rel=1e-3)
    assert motion.velocity == pytest.approx([0, 0, -speed - G * 0.1], abs=0.2)
    assert motion.rotation == pytest.approx(np.zeros(3), abs=1e-9)
    assert last.energies.kinetic == pytest.approx(0.5 * MASS * motion.velocity[2] ** 2, rel=1e-9)
    assert abs(last.energies.difference) < 1e-3 * last.energies.kinetic


def spun(steps):
    """Return the motion and the relative change of angular momentum after two turns about a middle axis and more."""
    model = alone(FAR)
    (frame,), spin = model.frames, np.array([30.0, 1.0, 2.0])
    velocity, acceleration = np.zeros_like(model.mesh.points), np.zeros_like(model.mesh.points)
    velocity[frame.nodes] = np.cross(spin, frame.rest - frame.rest.mean(axis=0))
    acceleration[frame.nodes] = np.cross(spin, velocity[frame.nodes])
    start = replace(rest(model), velocity=velocity, acceleration=acceleration, next_increment=1 / steps)

    def momentum(state):
        return np.cross(state.positions[frame.nodes], frame.matrix @ state.velocity[frame.nodes]).sum(axis=0)

    phase = Phase("spin", {"gravity": 0.0}, first=1 / steps, largest=1 / steps, duration=0.4, inertia="transient")
    states = list(march(model, Programme((phase,)), start=[start]))
    before = momentum(start)
    lost = np.linalg.norm(momentum(states[-1]) - before) / np.linalg.norm(before)
    return states, lost


def test_a_spinning_body_keeps_its_angular_momentum_its_energy_and_its_shape():
    states, lost = spun(100)
    finer, less = spun(200)
    assert less < 0.002
    assert less < 0.4 * lost  # second order: a quarter
    energies = [state.energies.kinetic for state in finer]
    assert energies[-1] == pytest.approx(energies[0], rel=3e-3)
    assert max(state.body_motion("brick").strain for state in states) < 1e-6
    # with three different moments it is no steady turn
    assert finer[-1].body_motion("brick").spin == pytest.approx(_euler(finer[-1]), abs=0.3)
    assert max(state.iterations for state in finer) <= 5


def _euler(state):
    """Return the angular velocity in space after 0.4 s, by Euler's equations with 20,000 small steps."""
    a, b, c = 10.0, 20.0, 30.0
    moments = np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    own, h = np.array([30.0, 1.0, 2.0]), 0.4 / 20_000

    def rate(w):
        return np.cross(moments * w, w) / moments

    for _ in range(20_000):
        own = own + h * rate(own + 0.5 * h * rate(own))
    return Rotation.from_rotvec(state.body_motion("brick").rotation).apply(own)


def sliding(ratio, friction=0.5, inertia="moderate"):
    """Return the states of a brick on a floor whose normal leans to gravity by a slope `ratio`."""
    angle = np.arctan(ratio)
    floor = Contact("floor", ("brick",), HalfSpace((0, 0, -0.01), (0, 0, 1)), friction, creep=0.05)
    model = alone(floor, direction=(np.sin(angle), 0, -np.cos(angle)), upper=(10, 20, 10))
    settle = Phase("settle", {"gravity": G}, first=0.1, largest=0.2, duration=0.01, inertia="quasi-static")
    slide = Phase("slide", {"gravity": G}, first=0.05, largest=0.1, duration=0.1, inertia=inertia)
    return list(march(model, Programme((settle, slide)))), angle


def test_a_block_on_the_ground_is_borne_with_its_weight():
    states, _ = sliding(0.0, inertia="quasi-static")
    touch = states[-1].touches["floor"]
    assert touch.force == pytest.approx((0, 0, MASS * G), rel=1e-4, abs=1e-8)
    assert touch.by_face["brick"] == touch.force
    assert touch.area == pytest.approx(200.0)
    assert 0.0 < touch.distance < 1e-3 * ASIDE.size
    assert states[-1].body_motion("brick").strain < 1e-6


def test_below_the_angle_of_friction_a_block_sticks_and_above_it_slides_as_coulomb_says():
    states, _ = sliding(0.48)
    settled = [state for state in states if state.time > 1.5]  # it starts a little above the floor
    way = settled[-1].body_motion("brick").centre[0] - settled[0].body_motion("brick").centre[0]
    assert 0.0 < way < 0.05 * (settled[-1].clock - settled[0].clock)  # creeps slower than the transition speed
    states, angle = sliding(0.6)
    expected = G * (np.sin(angle) - 0.5 * np.cos(angle))
    first, last = next(s for s in states if s.time > 1.5), states[-1]
    gained = last.body_motion("brick").velocity[0] - first.body_motion("brick").velocity[0]
    assert gained / (last.clock - first.clock) == pytest.approx(expected, rel=0.01)
    touch = last.touches["floor"]
    assert -touch.force[0] == pytest.approx(0.5 * touch.force[2], rel=1e-3)
    lost = last.energies.friction - first.energies.friction
    moved = last.body_motion("brick").centre[0] - first.body_motion("brick").centre[0]
    assert lost == pytest.approx(0.5 * MASS * G * np.cos(angle) * moved, rel=0.01)
    assert abs(last.energies.difference) < 0.01 * last.energies.load


def test_a_tall_block_on_a_steep_rough_slope_tips_over_its_edge():
    """It turns about the lower edge by its weight, moment of inertia m (w2 + h2) / 3, as the gravity ramps up."""
    width, height, slope, ramp, end = 10.0, 30.0, np.arctan(0.6), 0.02, 0.1
    floor = Contact("floor", ("brick",), HalfSpace((0, 0, -0.02), (0, 0, 1)), 3.0, reach=0.02, creep=0.05)
    model = alone(floor, direction=(np.sin(slope), 0, -np.cos(slope)), upper=(width, 20, height))
    first = Phase("ramp", {"gravity": G}, first=0.05, largest=0.1, duration=ramp, inertia="moderate")
    states = list(march(model, Programme((first, replace(first, name="tip", duration=end - ramp)))))

    def turning(time, state):
        angle, speed = state
        across = -width / 2 * np.cos(angle) + height / 2 * np.sin(angle)
        high = width / 2 * np.sin(angle) + height / 2 * np.cos(angle)
        moment = G * min(time / ramp, 1.0) * (np.sin(slope) * high + np.cos(slope) * across)
        return speed, moment / ((width**2 + height**2) / 3)

    angle, speed = solve_ivp(turning, (0, end), (0, 0), rtol=1e-8, max_step=1e-3).y[:, -1]
    motion = states[-1].body_motion("brick")
    assert angle > 0.5
    assert motion.rotation == pytest.approx([0, angle, 0], rel=0.03, abs=1e-3)
    assert motion.spin == pytest.approx([0, speed, 0], rel=0.03, abs=0.02)
    assert states[-1].touches["floor"].force[2] > 0.0
    assert abs(states[-1].energies.difference) < 0.01 * states[-1].energies.load


def test_a_cylinder_rolls_down_a_slope_without_slip_at_two_thirds_of_the_speed_of_a_sliding_one():
    radius, slope, ramp, end = 15.0, np.arctan(0.2), 0.02, 0.08
    roller = FreeBody("roller", Cylinder((0, 0, radius), (0, 20, radius), radius, 96), mass=MASS)
    floor = Contact("floor", ("roller",), HalfSpace((0, 0, -0.02), (0, 0, 1)), 0.8, reach=0.02, creep=0.5)
    loads = (Gravity((np.sin(slope), 0, -np.cos(slope))),)
    model = Model(ASIDE, {"body": RUBBER}, (Clamp("x0"),), loads, free_bodies=(roller,), contacts=(floor,))
    first = Phase("ramp", {"gravity": G}, first=0.05, largest=0.1, duration=ramp, inertia="moderate")
    *_, last = march(model, Programme((first, replace(first, name="roll", duration=end - ramp))))
    speed = 2 / 3 * G * np.sin(slope) * (end - ramp / 2)
    motion = last.body_motion("roller")
    bumps = speed * np.sin(np.pi / 96)  # from flat to flat
    assert motion.velocity == pytest.approx([speed, 0, 0], rel=0.02, abs=1.1 * bumps)
    assert motion.velocity[0] == pytest.approx(speed, rel=0.02)
    assert motion.spin == pytest.approx([0, speed / radius, 0], rel=0.02, abs=1e-3)
    assert abs(last.energies.difference) < 0.01 * last.energies.load


GAP, REACH = 0.02, 0.01
LIMIT = 0.2  # coefficient of friction of the pads


def gripped():
    """Return two soft pads beside a block on a table that can be lowered; 'pull' draws the block down."""
    left = box(1, 2, 2, kind="hexahedron27", mapping=lambda p: p * [3, 10, 10] - [3 + GAP, 5, 5])
    right = box(1, 2, 2, kind="hexahedron27", mapping=lambda p: p * [3, 10, 10] + [8 + GAP, -5, -5])
    count = len(left.points)
    blocks = [*left.blocks, *(replace(b, nodes=b.nodes + count) for b in right.blocks)]
    faces = {name + "'": tuple(replace(b, nodes=b.nodes + count) for b in f) for name, f in right.faces.items()}
    mesh = Mesh(np.concatenate([left.points, right.points]), tuple(blocks), {**left.faces, **faces})
    brick = FreeBody("brick", Block((0, -4, -4), (8, 4, 4)), mass=2e-6)
    table = HalfSpace((0, 0, -4.005), (0, 0, 1), motion=Motion("table", (0, 0, -1)))
    contacts = (
        Contact("grip", ("x1", "x0'"), ("brick",), LIMIT, reach=REACH, creep=0.02),
        Contact("stand", ("brick",), table, 0.3, reach=REACH, creep=0.02, body="table"),
    )
    supports = [Roller(face, axis) for face in ("x0", "x1'") for axis in "yz"]
    supports += [Prescribed("x0", "x", "left"), Prescribed("x1'", "x", "right")]
    loads = Gravity((0, 0, -1)), Force("brick", (0, 0, -1), "pull")
    return Model(mesh, {"body": RUBBER}, tuple(supports), loads, free_bodies=(brick,), contacts=contacts)


def grip_and(*phases):
    still = {"inertia": "quasi-static", "duration": 1.0}
    return Programme((
        Phase("settle", {"gravity": G, "pull": 0.0}, first=0.1, largest=0.3, **still),
        Phase("close", {"left": 0.15, "right": -0.15}, first=0.1, largest=0.25, **still),
        Phase("lower", {"table": 2.0}, first=0.1, largest=0.5, **still),
        *phases,
    ))  # fmt: skip


def pull(force, first=0.1, largest=0.1):
    return Phase("pull", {"pull": force}, first=first, largest=largest, duration=1.0, inertia="quasi-static")


def test_soft_pads_hold_a_block_up_by_friction_and_drop_it_beyond_its_limit():
    """Held while weight and pull are below 2 mu N, N the force of each pad; the largest held is found within 2 %."""
    weight, held, dropped = 2e-6 * G, [], None
    for state in march(gripped(), grip_and(pull(4.0, first=0.02, largest=0.02))):
        motion = state.body_motion("brick")
        if state.phase == "lower" and state.time == 3.0:
            assert state.touches["stand"].area == 0.0
            assert state.touches["grip"].by_face["brick"][2] == pytest.approx(weight, rel=1e-3)
            assert abs(motion.velocity[2]) < 1e-2
        if state.phase == "pull":
            grip = state.touches["grip"]
            normal = 0.5 * (abs(grip.by_face["x1"][0]) + abs(grip.by_face["x0'"][0]))
            limit, load = 2.0 * LIMIT * normal, weight + state.values["pull"]
            if abs(motion.velocity[2]) < 5.0:  # it creeps, and sinks with the pads; falling it is ten times faster
                held.append((load, limit))
                assert grip.by_face["brick"][2] == pytest.approx(load, rel=0.02, abs=1e-3)
            else:
                dropped = (load, limit)
                break
    assert dropped is not None
    load, limit = held[-1]
    assert 0.98 * limit < load < 1.001 * limit
    assert dropped[0] > 0.98 * limit


def test_a_run_with_a_free_body_that_is_resumed_ends_bit_for_bit_alike(tmp_path):
    programme = grip_and()
    whole = solve(gripped(), programme, folder=tmp_path / "whole")

    class StopError(Exception):
        pass

    def stop(progress):
        if progress.state.index == 8:
            raise StopError

    with pytest.raises(StopError):
        solve(gripped(), programme, folder=tmp_path / "broken", progress=stop)
    resumed = solve(gripped(), programme, folder=tmp_path / "broken", resume=True)
    last, other = resumed.states[-1], whole.states[-1]
    assert (last.displacement == other.displacement).all()
    assert last.touches == other.touches
    assert vars(last.energies) == vars(other.energies)
    assert resumed.model.free_bodies == gripped().free_bodies
    rows, motion = whole.history, other.body_motion("brick")
    assert rows.values("body_z:brick")[-1] == motion.centre[2]
    assert rows.values("body_velocity_x:brick")[-1] == motion.velocity[0]
    assert rows.values("body_rotation_y:brick")[-1] == motion.rotation[1]
    assert rows.values("body_force_z:brick")[-1] == pytest.approx(2e-6 * G, rel=1e-3)
    assert rows.values("body_force_z:table")[-1] == 0.0
    assert rows.values("body_strain:brick").max() < 1e-5


def test_in_the_plane_a_block_rests_on_a_soft_one_and_on_another():
    mesh = rectangle(4, 2, lambda p: p * [8, 4])
    lower = FreeBody("lower", Block((2, 4.004), (6, 6)), mass=1e-6)
    upper = FreeBody("upper", Block((3, 6.004), (5, 8)), mass=5e-7)
    contacts = (
        Contact("seat", ("lower",), ("top",), 0.5, reach=0.01),
        Contact("stack", ("upper",), ("lower",), 0.5, reach=0.01),
    )
    model = Model(
        mesh, {"body": RUBBER}, (Clamp("bottom"),), (Gravity((0, -1)),), free_bodies=(lower, upper), contacts=contacts
    )
    phase = Phase("settle", {"gravity": G}, first=0.1, largest=0.25, duration=1.0, inertia="quasi-static")
    rest_phase = replace(phase, name="rest")
    *_, last = march(model, Programme((phase, rest_phase)))
    assert last.touches["stack"].force[1] == pytest.approx(5e-7 * G, rel=1e-3)
    assert last.touches["seat"].force[1] == pytest.approx(1.5e-6 * G, rel=1e-3)
    for name in ("lower", "upper"):
        motion = last.body_motion(name)
        assert motion.rotation == pytest.approx([0.0], abs=1e-4)
        assert motion.strain < 1e-6
