"""One grain on the wheels' contact law, integrated here step by step."""

from dataclasses import replace
from math import atan, cos, sin

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.terrain.granular import SANDS, Friction
from pneumorph.terrain.granular.broad_phase import cell_lists
from pneumorph.terrain.granular.contact_kernels import wheel_forces
from pneumorph.terrain.granular.cosimulation import law

R, DENSITY, DT = 0.02, 1500.0, 1e-5
MASS = DENSITY * 4.0 / 3.0 * np.pi * R**3
INERTIA = 0.4 * MASS * R**2


class Grain:
    """A grain over the upper side, z = 0, of a large fixed slab, in SI units; leapfrog as in LAMMPS."""

    def __init__(self, sand=SANDS["dry"], friction=None, height=R, dt=DT):
        self.law, self.dt = law(sand, friction or Friction()), dt
        points = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.1, 0.0)])
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        self.corners = points[np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])]
        middle = self.corners.mean(axis=1)
        around = np.linalg.norm(self.corners - middle[:, None], axis=2).max(axis=1)
        self.spheres = np.column_stack([middle, around])
        self.cells = cell_lists(self.corners, R)
        self.x, self.v, self.omega = np.array([[0.05, 0.02, height]]), np.zeros((1, 3)), np.zeros((1, 3))
        self.f, self.torque = np.zeros((1, 3)), np.zeros((1, 3))
        self.radii, self.mass, self.tag = np.array([R]), np.array([MASS]), np.array([1], np.int32)
        self.pose = [np.zeros((1, 3)), np.eye(3)[None].copy(), np.zeros((1, 3)), np.zeros((1, 3))]
        self.first, self.number = np.zeros((1, 2), np.int32), np.zeros((1, 2), np.int32)
        self.old, self.new = np.zeros((8, 9)), np.zeros((8, 9))
        self.old_owner, self.new_owner = np.zeros((8, 3), np.int64), np.zeros((8, 3), np.int64)
        self.acting, self.wrench, self.total, self.work = np.zeros((8, 6)), np.zeros((1, 6)), 0, 0.0

    def step(self, weight=(0.0, 0.0, 0.0)):
        self.x += self.v * self.dt
        self.f[0], self.torque[0] = MASS * np.array(weight), 0.0
        self.total, self.deepest, power, dropped = wheel_forces(
            self.x, self.v, self.omega, self.radii, self.mass, self.tag, self.f, self.torque, *self.pose,
            2.0, self.corners, self.spheres, self.cells.origin, self.cells.size, self.cells.counts, self.cells.starts,
            self.cells.triangles, self.cells.nearest, self.law, self.dt, self.first, self.number, self.old,
            self.old_owner, self.total,
            self.new, self.new_owner, self.acting, self.wrench,
        )  # fmt: skip
        assert dropped == 0
        self.old, self.new = self.new, self.old
        self.old_owner, self.new_owner = self.new_owner, self.old_owner
        self.work += power * self.dt
        self.v += self.f / MASS * self.dt
        self.omega += self.torque / INERTIA * self.dt

    @property
    def energy(self):
        return 0.5 * MASS * (self.v**2).sum() + 0.5 * INERTIA * (self.omega**2).sum()


@pytest.mark.parametrize("name", list(SANDS))
@pytest.mark.parametrize("speed", [0.2, 1.0])
def test_a_grain_leaves_a_wheel_with_its_restitution(name, speed):
    grain = Grain(SANDS[name], height=1.001 * R)
    grain.v[0, 2] = -speed
    touched = False
    while not touched or grain.total:
        grain.step()
        touched = touched or grain.total > 0
    assert grain.v[0, 2] / speed == pytest.approx(SANDS[name].restitution, abs=0.003)


def test_the_work_on_a_grain_is_what_its_energy_grows_by():
    grain = Grain(height=1.001 * R)
    grain.v[0] = 0.8, 0.3, -0.5
    before = grain.energy
    for _ in range(3000):
        grain.step()
    assert grain.energy < 0.9 * before
    assert grain.work == pytest.approx(grain.energy - before, rel=1e-3)


def test_wheel_and_grain_get_opposite_forces_and_moments():
    grain = Grain(height=0.999 * R)
    grain.v[0], grain.omega[0] = (0.4, 0.1, -0.2), (1.0, -2.0, 3.0)
    grain.pose[2][0], grain.pose[3][0] = (0.1, 0.0, 0.3), (0.0, 1.5, 0.2)
    for _ in range(3):
        grain.step()
    assert np.linalg.norm(grain.f) > 0.1
    np.testing.assert_allclose(grain.wrench[0, :3], -grain.f[0], rtol=1e-12)
    about = np.cross(grain.x[0], grain.f[0]) + grain.torque[0]  # about the axle, the origin
    np.testing.assert_allclose(grain.wrench[0, 3:], -about, rtol=1e-9, atol=1e-12)


def settle_down(grain, weight):
    """Let a grain come to rest on the slab."""
    for _ in range(20_000):
        grain.step(weight)
        grain.v *= 0.999
        grain.omega *= 0.999


def test_a_grain_that_slides_is_slowed_by_friction_until_it_rolls_at_five_sevenths():
    """Without rolling friction: a = mu g while it slides, and the momentum about the contact is kept."""
    grain = Grain(friction=Friction(0.55, 0.0), dt=2e-5)
    settle_down(grain, (0.0, 0.0, -9.81))
    grain.v[0, 0], grain.omega[0] = 1.0, 0.0
    for _ in range(1000):
        grain.step((0.0, 0.0, -9.81))
    assert grain.v[0, 0] == pytest.approx(1.0 - 0.55 * 9.81 * 0.02, rel=0.01)
    for _ in range(4000):
        grain.step((0.0, 0.0, -9.81))
    assert grain.v[0, 0] == pytest.approx(5.0 / 7.0, rel=0.01)
    assert grain.omega[0, 1] * R == pytest.approx(grain.v[0, 0], rel=0.01)


@pytest.mark.parametrize(("slope", "rolls"), [(0.35, False), (0.45, True)])
def test_a_grain_rolls_down_a_slope_steeper_than_the_rolling_coefficient(slope, rolls):
    angle = atan(slope)
    weight = 9.81 * np.array([sin(angle), 0.0, -cos(angle)])
    grain = Grain(dt=2e-5)
    settle_down(grain, (0.0, 0.0, -9.81))
    for _ in range(20_000):
        grain.step(weight)
    if rolls:
        # beyond the limit: a = 5/7 g (sin - 0.37 cos)
        assert grain.v[0, 0] == pytest.approx(0.4 * 5.0 / 7.0 * 9.81 * (sin(angle) - 0.37 * cos(angle)), rel=0.05)
    else:
        assert abs(grain.v[0, 0]) < 1e-3


def test_springs_stay_with_their_grain_and_go_when_it_leaves():
    grain = Grain()
    settle_down(grain, (0.0, 0.0, -9.81))
    grain.v[0, 0] = 0.05
    for _ in range(100):
        grain.step((0.0, 0.0, -9.81))
    assert grain.number[0, 1] == 1
    assert np.abs(grain.old[0, 3:6]).max() > 1e-7
    grain.x[0, 2] += R
    grain.step()
    assert grain.number[0, 1] == 0
    grain.x[0, 2] -= R
    grain.v[:] = grain.omega[:] = 0.0
    grain.step()
    assert np.abs(grain.old[0, 3:6]).max() == 0.0


def test_a_negative_friction_is_refused():
    with pytest.raises(InputError, match="friction: rolling = -1, expected at least 0"):
        Friction(0.5, -1.0)


def test_the_law_of_the_wheel_has_the_stiffness_of_the_sand():
    soft, hard = (law(replace(SANDS["dry"], modulus=m), Friction()) for m in (0.5, 5.0))
    assert hard[0] == pytest.approx(5e6 / (2.0 * (1.0 - 0.25**2)))
    assert hard[0] / soft[0] == pytest.approx(10.0)
    assert hard[1] / soft[1] == pytest.approx(10.0)
