"""A small crawler on the ground: weight, mirrored motion, size of the steps, energy, slip and cost."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.gaits import Foot, Locomotion, locomotion, undulation
from pneumorph.geometry import PlaneCrawler
from pneumorph.materials import library
from pneumorph.measures import CentreOfMass, slip
from pneumorph.mechanics import Cavity, Contact, Gravity, HalfSpace, Model, Phase, march
from pneumorph.mechanics.body import cell_volumes
from pneumorph.mesh import generate

BEAM = PlaneCrawler(channels=2)
MATERIALS = {"body": library.material("ecoflex-pneunet"), "base": library.material("pdms-pneunet")}
FEET = (Foot("rear_foot"), Foot("front_foot"))
SWAP = {"PN1": "PN3", "PN3": "PN1"}


WEIGHT = (Gravity((0, -1)),)


def crawler(materials=MATERIALS, loads=WEIGHT):
    ground = Contact("ground", ("rear_foot", "front_foot"), HalfSpace((0, -0.06), (0, 1)), 0.7, reach=0.06, creep=0.05)
    cavities = tuple(Cavity(name, (name,)) for name in BEAM.cavities)
    return Model(generate(BEAM, 2.0), materials, (), loads, cavities, contacts=(ground,))


def wave(largest=0.2):
    ramp = {"duration": 1.0, "inertia": "quasi-static", "first": largest, "largest": largest}
    settle = (Phase("gravity", {"gravity": 9810.0}, **ramp),)
    return undulation(BEAM.cavities, 0.013, settle=settle, **ramp)


def run(gait):
    return list(march(crawler(), gait.programme))


def moved(gait, states):
    return locomotion(states, gait.ends, FEET, (1.0, 0.0))


@pytest.fixture(scope="module")
def forward():
    return run(wave())


def test_the_ground_bears_the_weight_at_rest_half_on_each_foot(forward):
    found = moved(wave(), forward)
    density = {name: MATERIALS[name].density for name in MATERIALS}
    areas = {block.domain: 0.0 for block in forward[0].model.mesh.blocks}
    for block in forward[0].model.mesh.blocks:
        areas[block.domain] += cell_volumes(forward[0].model.mesh, block).sum()
    assert found.weight == pytest.approx(9810.0 * sum(density[name] * area for name, area in areas.items()))
    for time in (1.0, 7.0):
        forces = [force[found.at(time), 1] for force in found.force.values()]
        assert sum(forces) == pytest.approx(found.weight, rel=0.02)
        assert forces[0] == pytest.approx(forces[1], rel=0.05)  # the node in the middle counts for the rear


def test_a_mirrored_schedule_gives_the_mirrored_motion(forward):
    gait = wave()
    there = moved(gait, forward)
    back = moved(gait.renamed(SWAP), run(gait.renamed(SWAP)))
    way = there.displacements[0, 0]
    assert abs(way) > 0.05
    assert back.displacements[0] == pytest.approx([-way, 0.0], rel=0.01, abs=1e-3)
    middle = 0.5 * BEAM.length
    for time in range(1, 8):
        one, other = there.centre[there.at(time)], back.centre[back.at(time)]
        assert one - (middle, 0.0) == pytest.approx((other - (middle, 0.0)) * (-1.0, 1.0), abs=0.01 * abs(way))


@pytest.mark.slow
def test_displacement_per_cycle_does_not_depend_on_the_size_of_the_steps(forward):
    fine = wave(0.1)
    coarse, finer = moved(wave(), forward), moved(fine, run(fine))
    assert finer.displacements[0, 0] == pytest.approx(coarse.displacements[0, 0], rel=0.05)


def test_the_work_of_the_supply_is_found_as_strain_weight_friction_and_damping(forward):
    before, after = (next(s for s in forward if s.time == time).energies for time in (1.0, 2.0))
    work = after.supply - before.supply
    kept = sum(
        getattr(after, name) - getattr(before, name)
        for name in ("strain", "kinetic", "contact", "viscous", "numerical", "friction")
    )
    assert work > 0.0
    assert kept - (after.load - before.load) == pytest.approx(work, rel=0.02)
    assert after.friction >= before.friction


def test_slip_is_the_way_of_what_bears_and_none_in_the_air(forward):
    settled = next(s for s in forward if s.time == 1.0)
    shoved = replace(settled, displacement=settled.displacement + np.array([0.3, 0.0]))
    assert slip(settled, shoved, "ground", "rear_foot") == pytest.approx([0.3, 0.0])
    lifted = replace(settled, displacement=settled.displacement + np.array([0.3, 1.0]))
    assert slip(settled, lifted, "ground", "rear_foot") == pytest.approx([0.0, 0.0])
    assert CentreOfMass("x")(shoved) - CentreOfMass("x")(settled) == pytest.approx(0.3)
    assert CentreOfMass("y")(forward[0]) == pytest.approx(5.0, abs=0.3)


def test_ways_and_cost_are_sums_over_whole_cycles():
    foot = np.array([[0.0, 0.0], [0.5, 0.1], [-0.2, 0.0], [0.4, 0.0], [0.3, 0.0]])
    centre = np.array([[0.0, 5.0], [1.0, 6.0], [2.0, 5.0], [2.0, 6.0], [1.5, 5.0]])
    found = Locomotion(
        np.arange(5.0), centre, {"foot": foot}, {"foot": foot}, np.array([0.0, 3.0, 4.0, 6.0, 7.0]), 0.01,
        (0, 2, 4, 6), np.array([1.0, 0.0]),
    )  # fmt: skip
    assert found.displacements == pytest.approx(np.array([[2.0, 0.0], [-0.5, 0.0]]))  # the third cycle was not run
    assert found.forward_slip["foot"] == pytest.approx([0.5, 0.7])
    assert found.backward_slip["foot"] == pytest.approx([0.2, 0.0])
    assert found.cost_of_transport == pytest.approx([4.0 / (0.01 * 2.0), np.nan], nan_ok=True)


def test_work_that_a_cavity_gives_back_is_not_counted(forward):
    found = moved(wave(), forward)
    assert (np.diff(found.delivered) >= 0.0).all()
    assert found.delivered[-1] > forward[-1].energies.supply  # which takes it off again


def test_what_a_gait_cannot_be_measured_by_is_refused(forward):
    with pytest.raises(NameNotFoundError, match="slip: unknown contact 'floor'"):
        slip(forward[0], forward[1], "floor", "rear_foot")
    with pytest.raises(NameNotFoundError, match="slip: unknown face of the contact 'ground' 'top'"):
        slip(forward[0], forward[1], "ground", "top")
    with pytest.raises(InputError, match=r"forward = .*, expected 2 finite numbers, not all zero"):
        locomotion(forward, (1, 7), FEET, (0.0, 0.0))
    with pytest.raises(InputError, match="axis = 'up', allowed: x, y, z"):
        CentreOfMass("up")
    with pytest.raises(InputError, match="a plane model has no axis z"):
        CentreOfMass("z")(forward[0])
    bare = [replace(forward[0], model=crawler(loads=()))]
    with pytest.raises(InputError, match="feet need gravity"):
        locomotion(bare, (1, 7), FEET, (1.0, 0.0))


def test_feet_need_densities_and_phases_cavities_that_are_there():
    light = MATERIALS | {"base": replace(MATERIALS["base"], density=None)}
    with pytest.raises(InputError, match="gravity needs a density for the material of 'base'"):
        crawler(light)
    gait = undulation(("PN1", "PN7"), 0.01)
    with pytest.raises(NameNotFoundError, match=r"phase '\+PN7': unknown target 'PN7'"):
        next(march(crawler(loads=()), gait.programme))
