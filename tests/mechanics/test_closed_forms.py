"""Tubes, spheres and the balloon against their closed forms."""

import numpy as np
import pytest

from pneumorph.closed_form import thick_wall
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics import Cavity, Model, Phase, Programme, Roller, Symmetry, VolumeSupply, march
from pneumorph.mechanics.fields import fields
from pneumorph.mesh.structured import rectangle

INNER, OUTER = 5.0, 8.0
# so stiff in volume that the closed forms, which are incompressible, hold to 1e-5
MATERIALS = [NeoHookean(0.3, bulk=1e5), Yeoh(0.11, 0.03, bulk=1e5)]
SHAPES = ["tube", "revolved tube", "sphere"]
WALLS = pytest.mark.parametrize("material", MATERIALS, ids=["neo-Hookean", "Yeoh"])


def bent(inner, outer):
    """Radius along x, angle from the x axis along y: a quarter of a ring."""

    def mapping(points):
        radius, angle = inner + (outer - inner) * points[:, 0], 0.5 * np.pi * points[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    return mapping


def wall(shape, material, cells, pressure="constant"):
    """Return the model of a wall with `cells` cells across it and square cells."""
    if shape == "revolved tube":
        mesh = rectangle(
            cells, cells, lambda x: x + np.array([INNER, 0.0]), width=OUTER - INNER, height=3.0, space="axisymmetric"
        )
        supports = (Roller("bottom", "y"), Roller("top", "y"))
        mirrors = ("bottom", "top")
    else:
        space = "plane_strain" if shape == "tube" else "axisymmetric"
        mesh = rectangle(cells, 3 * cells, bent(INNER, OUTER), space=space)
        supports = (Symmetry("bottom"), Symmetry("top"))
        mirrors = ("bottom", "top") if shape == "tube" else ("bottom",)
    return Model(mesh, {"body": material}, supports, (), (Cavity("c", ("left",), mirrors=mirrors),), pressure=pressure)


def closed(shape):
    """Return the closed forms (pressure, inner radius, state) of a shape."""
    if shape == "sphere":
        return thick_wall.sphere_pressure, thick_wall.sphere_inner_radius, thick_wall.sphere_state
    return thick_wall.tube_pressure, thick_wall.tube_inner_radius, thick_wall.tube_state


def inflated(model, target):
    *_, last = march(model, Programme((Phase("inflate", {"c": target}, first=0.5, largest=0.5),)))
    return last


def mean_inner_radius(shape, volume):
    """Return the radius of the round cavity with the part of its volume that is modelled."""
    if shape == "tube":
        return np.sqrt(4.0 * volume / np.pi)
    return np.sqrt(volume / (3.0 * np.pi)) if shape == "revolved tube" else np.cbrt(1.5 * volume / np.pi)


def radial(shape, places):
    """Return distances from the axis or centre, and the unit vectors away from it."""
    if shape == "revolved tube":
        return places[..., 0], np.broadcast_to([1.0, 0.0], places.shape)
    radius = np.linalg.norm(places, axis=-1)
    return radius, places / radius[..., None]


def radial_stress(shape, state):
    """Return radius, radial Cauchy stress and volume of the quadrature points."""
    (part,) = fields(state)
    radius, outward = radial(shape, part.place)
    return radius, np.einsum("eqi,eqij,eqj->eq", outward, part.stress[..., :2, :2], outward), part.volume


@WALLS
@pytest.mark.parametrize("shape", SHAPES)
def test_thick_walls_expand_as_their_closed_form(shape, material):
    pressure = float(closed(shape)[0](material, INNER, OUTER, 1.3 * INNER))
    expected = closed(shape)[1](material, INNER, OUTER, pressure)
    assert expected == pytest.approx(1.3 * INNER)
    state = inflated(wall(shape, material, 3), pressure)
    assert mean_inner_radius(shape, state.volume["c"]) == pytest.approx(expected, rel=0.001)
    expansion = mean_inner_radius(shape, state.volume["c"]) - INNER
    assert expansion == pytest.approx(expected - INNER, rel=0.005)
    radius, stress, _ = radial_stress(shape, state)
    exact = closed(shape)[2](material, INNER, OUTER, expected, radius).radial_stress
    assert np.sqrt(np.mean((stress - exact) ** 2)) < 0.04 * pressure
    assert state.unstable_modes == 0


@WALLS
@pytest.mark.parametrize("shape", SHAPES)
def test_displacement_and_stress_converge_at_the_theoretical_rate(shape, material):
    """One pressure mode a cell bounds the rates in L2 to 2 (displacement) and 1 (stress); coarse meshes do better."""
    target = 1.3 * INNER
    pressure = float(closed(shape)[0](material, INNER, OUTER, target))
    power = 3 if shape == "sphere" else 2
    errors = []
    for cells in (2, 4, 8):
        state = inflated(wall(shape, material, cells), pressure)
        radius, outward = radial(shape, state.model.mesh.points)
        hoop = (1.0 + (target**power - INNER**power) / radius**power) ** (1.0 / power)
        displacement = state.displacement - ((hoop - 1.0) * radius)[:, None] * outward
        radius, stress, volume = radial_stress(shape, state)
        stress = stress - closed(shape)[2](material, INNER, OUTER, target, radius).radial_stress
        errors.append((np.sqrt(np.mean(displacement**2)), np.sqrt((volume * stress**2).sum() / volume.sum())))
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders[:, 0] > 1.9).all(), orders
    assert (orders[:, 0] < 3.4).all(), orders
    assert (orders[-1, 1] > 1.4).all(), orders
    assert (orders[:, 1] < 2.0).all(), orders


@pytest.mark.parametrize("shape", SHAPES)
def test_displacement_converges_with_linear_pressure_too(shape):
    """Three pressure modes a triangle over-constrain it: the displacement still converges, the stress does not."""
    material = MATERIALS[0]
    pressure = float(closed(shape)[0](material, INNER, OUTER, 1.3 * INNER))
    errors = []
    for cells in (2, 4):
        state = inflated(wall(shape, material, cells, pressure="linear"), pressure)
        radius, outward = radial(shape, state.model.mesh.points)
        power = 3 if shape == "sphere" else 2
        hoop = (1.0 + (1.3**power - 1.0) * INNER**power / radius**power) ** (1.0 / power)
        displacement = state.displacement - ((hoop - 1.0) * radius)[:, None] * outward
        errors.append(np.sqrt(np.mean(displacement**2)))
    assert 1.9 < np.log2(errors[0] / errors[1]) < 3.0


@pytest.mark.parametrize("shape", SHAPES)
def test_the_bulk_modulus_is_felt_by_the_wall(shape):
    """A compressible wall expands more than the closed form: the agreement above is not a matter of course."""
    soft = NeoHookean(0.3, bulk=3.0)
    pressure = float(closed(shape)[0](soft, INNER, OUTER, 1.2 * INNER))
    state = inflated(wall(shape, soft, 2), pressure)
    assert mean_inner_radius(shape, state.volume["c"]) > 1.205 * INNER


def test_a_balloon_goes_through_its_pressure_maximum_under_volume_control():
    material, inner, outer = NeoHookean(0.3, bulk=3e3), 10.0, 10.5
    mesh = rectangle(1, 10, bent(inner, outer), space="axisymmetric")
    cavity = Cavity("c", ("left",), VolumeSupply(), mirrors=("bottom",))
    model = Model(mesh, {"body": material}, (Symmetry("bottom"), Symmetry("top")), (), (cavity,))
    start = 2.0 / 3.0 * np.pi * inner**3
    assert model.surfaces["c"].reference_volume == pytest.approx(start, rel=1e-4)
    programme = Programme((Phase("fill", {"c": 14.0 * start}, first=0.01, largest=0.05),))
    states = list(march(model, programme))[1:]
    radius = np.array([mean_inner_radius("sphere", state.volume["c"]) for state in states])
    pressure = np.array([state.pressure["c"] for state in states])
    expected = thick_wall.sphere_pressure(material, inner, outer, radius)
    assert pressure == pytest.approx(expected, rel=0.01)
    assert len(states) > 15
    assert radius[-1] > 2.4 * inner
    top = int(np.argmax(pressure))
    assert 1.3 < radius[top] / inner < 1.5
    assert (np.diff(pressure[top:]) < 0.0).all()
    assert pressure[-1] < 0.75 * pressure[top]
    assert [state.unstable_modes for state in states] == [0] * len(states)
    assert [state.energies.viscous for state in states] == [0.0] * len(states)
