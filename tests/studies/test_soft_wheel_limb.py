"""The soft wheel's limb: what its cases are, and what is compared with the study."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.closed_form.soft_limb import limb_angle, limb_section
from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.geometry import SoftLimb
from pneumorph.mechanics import Phase, Programme
from pneumorph.mesh import generate
from pneumorph.solution import solve
from pneumorph.solution.history import Column, History
from pneumorph.studies.reproductions import soft_wheel_limb as part
from pneumorph.units import EARTH

STUDY = part.LimbStudy(quick=True, limb=SoftLimb(chambers=2, length=55.0, half=True))


@pytest.fixture(scope="module")
def mesh():
    return generate(STUDY.limb, 10.0, detail=0.2)


class Run:
    """A solution with a history and no states."""

    def __init__(self, **columns):
        rows = [dict(zip(columns, line, strict=True)) for line in zip(*columns.values(), strict=True)]
        self.history = History([Column(key, key, "number") for key in columns], rows)
        self.states = ()


def bent(pressure, angle):
    count = len(pressure)
    names = ("peak_stress", "stress_99", "peak_stretch", "stretch_99", "chamber_spread")
    return Run(**{part.PRESSURE: pressure, "tip_rotation": angle}, **dict.fromkeys(names, [1.5] * count))


def test_the_difference_is_nothing_for_a_run_that_follows_the_closed_form_and_an_offset_for_one_beside_it():
    study = part.LimbStudy()
    grid = np.linspace(0.0, part.FULL, 301)
    exact = part.closed_form_angles(study, grid)
    assert exact[-1] == limb_angle(limb_section(study.limb), study.materials["body"], part.FULL)
    assert part.closed_form_difference(study, bent(grid, exact)) == pytest.approx(0.0, abs=1e-9)
    assert part.closed_form_difference(study, bent(grid, exact + 0.05)) == pytest.approx(0.05)
    assert part.closed_form_difference(study, bent(grid[:-1], exact[:-1])) is None


def test_chambers_count_as_even_up_to_the_last_state_before_their_growth_differs_too_much():
    pressure = [0.0, 0.01, 0.02, 0.03]
    assert part.uniform_until(Run(**{part.PRESSURE: pressure, "chamber_spread": [0.0, 0.05, 0.11, 0.05]})) == 0.01
    assert part.uniform_until(Run(**{part.PRESSURE: pressure, "chamber_spread": [0.0, 0.01, 0.02, 0.03]})) == 0.03
    assert part.uniform_until(Run(**{part.PRESSURE: [], "chamber_spread": []})) is None


def test_the_first_touch_is_the_first_state_with_contact():
    columns = {part.PRESSURE: [0.0, 0.01, 0.02], "contact_area:walls": [0.0, 0.0, 3.0]}
    assert part.first_touch(Run(**columns)) == 0.02
    assert part.first_touch(Run(**(columns | {"contact_area:walls": [0.0] * 3}))) is None


def test_what_was_not_computed_has_no_value_and_every_reported_number_has_a_row():
    rows = part.compare(part.LimbStudy(), {})
    assert all(row.computed is None for row in rows)
    assert {row.reported for row in rows} >= {2.51, 449.0, 0.69, 848.0, 0.37, 1.98, 3.0, 878.0, 1.23, 230.0, 280.0}


def test_the_foot_is_pushed_from_the_axle_and_the_limb_hangs_down_to_it():
    down = np.array(STUDY.down)
    assert np.linalg.norm(down) == pytest.approx(1.0)
    assert np.array(STUDY.limb.axle) + down * np.linalg.norm(
        np.array(STUDY.limb.foot_point) - STUDY.limb.axle
    ) == pytest.approx(STUDY.limb.foot_point)


@pytest.mark.parametrize("name", part.CASES)
def test_every_case_makes_a_model_that_its_programme_drives(mesh, name):
    case = STUDY.case(name, mesh)
    case.programme.check(case.model)
    assert [contact.name for contact in case.model.contacts] == ["walls"]


def test_a_held_foot_bears_the_weight_of_its_share_and_pressure_pushes_it_outwards(mesh):
    """Forces of the whole limb: twice those of the half, clamp and foot bear weight and nothing else."""
    case = STUDY.case("blocked", mesh)
    programme = Programme((case.programme.phases[0], Phase("press", {part.CAVITY: 0.002}, first=1.0, largest=1.0)))
    solution = solve(case.model, programme, measures=case.measures)
    settled = solution.states[2]
    reactions = settled.reactions.reshape(-1, 3).sum(axis=0)
    densities = {domain: material.density for domain, material in STUDY.materials.items()}
    mass = sum(densities[block.domain] * volume for block, volume in _volumes(case.model))
    weight = mass * EARTH * np.array(STUDY.down)
    assert reactions[[0, 2]] == pytest.approx(-weight[[0, 2]], rel=1e-4)
    force, outwards = (solution.history.values(key) for key in ("blocked_force", "force_from_axle"))
    assert force[-1] >= abs(outwards[-1])
    assert outwards[-1] > outwards[2] > 0.0


def _volumes(model):
    from pneumorph.mechanics.body import cell_volumes

    return [(block, float(cell_volumes(model.mesh, block).sum())) for block in model.mesh.blocks]


def test_the_reported_curves_are_the_closed_form_and_two_forces():
    angle, force = part.reported_curves(part.LimbStudy())
    assert angle.y_values[0] == 0.0
    assert (np.diff(angle.y_values) > 0.0).all()
    assert force.y_values.tolist() == [1.98, 3.0]
    assert math.degrees(angle.y_values[-1]) > 20.0


def test_a_whole_limb_and_an_unknown_case_are_refused(mesh):
    with pytest.raises(InputError, match=r"limb.half = False: expected True"):
        part.LimbStudy(limb=replace(STUDY.limb, half=False))
    with pytest.raises(NameNotFoundError, match="blocked"):
        STUDY.case("block", mesh)
