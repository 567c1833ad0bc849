"""Parts of system 1 in the pipe: studies, holding pressures, comparison rows. No run of a study."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.closed_form.hexagonal_prism import measured_moment
from pneumorph.geometry import PipeRobot
from pneumorph.materials.library import material as material_named
from pneumorph.measures import CentreOfMass, NormalForce
from pneumorph.mechanics import (
    Cavity,
    Contact,
    Gravity,
    Model,
    Phase,
    Pipe,
    Programme,
    Roller,
    Symmetry,
    march,
)
from pneumorph.mesh import generate
from pneumorph.solution import Column, History
from pneumorph.studies import reproductions, study_from
from pneumorph.studies.reproductions import hexagonal_anchoring as anchoring
from pneumorph.studies.reproductions import hexagonal_earthworm as earthworm
from pneumorph.studies.reproductions import hexagonal_expansion as expansion
from pneumorph.studies.reproductions import hexagonal_moment as moment
from pneumorph.studies.reproductions import pipe_gaits

PARTS = ("expansion", "anchoring", "moment", "earthworm")


def test_each_part_is_known_by_name_and_its_study_can_be_written_and_read_again():
    for part in PARTS:
        known = reproductions.reproduction(f"hexagonal-prism-{part}")
        assert "act11050125" in known.source
        for quick in (True, False):
            study = known.study(quick)
            assert study_from(study.resolved(), study.name).resolved() == study.resolved()
            assert known.curves(study) is not None


def test_only_planes_of_symmetry_hold_a_body_in_the_pipe():
    for study in (expansion.study(True), anchoring.study(True), earthworm.study(True)):
        assert study.supports == tuple(Symmetry(face) for face in study.actuator.cuts)


def test_quick_studies_have_a_shorter_prism():
    for module in (expansion, anchoring, moment):
        quick, full = (module.study(q) for q in (True, False))
        assert quick.actuator.chambers == 3 < full.actuator.chambers


# --- expansion


def history(pressure, **columns):
    heads = [Column("pressure:cavity_1", "", "pressure"), *(Column(name, "", "length") for name in columns)]
    rows = [
        {"pressure:cavity_1": p, **{name: float(values[i]) for name, values in columns.items()}}
        for i, p in enumerate(pressure)
    ]
    return SimpleNamespace(history=History(heads, rows))


def test_a_crossing_lies_on_the_line_between_two_states():
    pressure, values = np.array([0.0, 0.1, 0.2]), np.array([1.0, 2.0, 6.0])
    assert expansion.crossing(pressure, values, 3.0) == pytest.approx(0.125)
    assert expansion.crossing(pressure, values, 0.5) == 0.0
    assert expansion.crossing(pressure, values, 7.0) is None


def test_the_diameter_is_compared_at_its_pressure_and_the_pressure_at_its_diameter():
    pressure = np.array([0.0, 0.05, 0.1, 0.15])
    contact = {"contact_area:walls": np.array([0.0, 2.0, 3.0, 4.0])}
    run = history(pressure, circumscribed_diameter=80.0 + 80.0 * pressure, **contact)
    diameter, reached, touch = expansion.compare(run, expansion.study(False))
    assert (diameter.reported, diameter.computed) == (84.0, pytest.approx(92.0))
    assert (reached.reported, reached.computed) == (150.0, pytest.approx(50.0))
    assert touch.computed == pytest.approx(50.0)
    short = history(pressure[:1], circumscribed_diameter=[81.0], **{"contact_area:walls": [0.0]})
    assert [row.computed for row in expansion.compare(short, expansion.study(True))] == [None, None, None]


# --- anchoring: a prism whose normal force grows by 100 N a MPa from 0.15 MPa on

PRESSURE = np.linspace(0.0, 0.25, 26)
NORMAL = np.maximum(0.0, 100.0 * (PRESSURE - 0.15))


@pytest.mark.parametrize("tilt", [0.0, 30.0, 60.0, 90.0])
def test_friction_times_the_normal_force_holds_the_weight_along_the_pipe(tilt):
    held = anchoring.holding_pressure(PRESSURE, NORMAL, 2.0, tilt, 0.5)
    assert held == pytest.approx(0.15 + 2.0 * math.sin(math.radians(tilt)) / (0.5 * 100.0), abs=1e-6)


def test_what_is_never_held_has_no_pressure():
    assert anchoring.holding_pressure(PRESSURE, NORMAL, 50.0, 90.0, 0.5) is None


def test_the_fitted_friction_makes_the_step_from_the_level_to_the_vertical_pipe_right():
    friction = anchoring.fitted_friction(PRESSURE, NORMAL, 2.0)
    assert friction == pytest.approx(2.0 / (100.0 * 0.065))
    held = anchoring.holding_pressure(PRESSURE, NORMAL, 2.0, 90.0, friction)
    assert held == pytest.approx(0.15 + 0.065, abs=1e-6)
    assert anchoring.fitted_friction(PRESSURE[:20], NORMAL[:20], 2.0) is None  # the run ends before the step


SLICE = PipeRobot(modules=1, quarter=True, chambers=1, length=12.0)  # one ring of chambers


def sliced(friction, supports, *phases):
    """Return states of a slice of the prism in the vertical pipe; its sum of normal forces and place along it."""
    pipe = Contact("pipe", ("outer",), Pipe((0, 0, 0), 42.0, (0, 0, 1)), friction, reach=0.1, creep=0.02)
    cavities = tuple(Cavity(name, (name,), mirrors=SLICE.cuts) for name in SLICE.cavities)
    cuts = tuple(Symmetry(face) for face in SLICE.cuts)
    material = {"body": material_named("shore-a45-platinum")}
    loads = () if supports else (Gravity((0, 0, -1)),)
    model = Model(generate(SLICE, 20.0), material, (*cuts, *supports), loads, cavities, contacts=(pipe,))
    return list(march(model, Programme(phases)))


def test_a_prism_that_moves_freely_sticks_above_the_holding_pressure_and_slides_below_it():
    def inflated(pressure):
        return dict.fromkeys(SLICE.cavities, pressure)

    friction, weigh = 0.02, {"duration": 0.2, "inertia": "quasi-static", "first": 0.5, "largest": 0.5}
    states = sliced(0.0, (Roller("clamp", "z"),), Phase("expand", inflated(0.105), first=0.1, largest=0.1))
    pressure = np.array([state.pressure["cavity_1"] for state in states])
    normal = np.array([NormalForce("pipe")(state) for state in states])
    held = anchoring.holding_pressure(pressure, normal, anchoring.weight(states[0].model), 90.0, friction)
    sunk = {}
    for share in (0.96, 1.04):
        phases = Phase("hold", inflated(share * held), **weigh), Phase("gravity", {"gravity": 9810.0}, **weigh)
        *_, end = sliced(friction, (), *phases, Phase("wait", {"gravity": 9810.0}, **weigh))
        sunk[share] = -CentreOfMass("z")(end) + CentreOfMass("z")(states[0])
    assert sunk[1.04] < 0.3  # mm, with what it sags in itself
    assert sunk[0.96] > 10.0


def test_the_prism_weighs_its_silicone_however_it_is_cut():
    study = anchoring.study(True)
    model, robot = study.build().model, study.actuator
    block = robot.block_length * robot.block_width * robot.block_height
    air = robot.chamber_length * robot.chamber_width * robot.chamber_height
    column = (1.5 * math.sqrt(3.0) * robot.side**2 - math.pi * robot.core_radius**2) * robot.length
    volume = column + 6 * robot.chambers * (block - air)
    assert anchoring.weight(model) == pytest.approx(1.13e-9 * 9810.0 * volume, rel=1e-3)


def test_tilts_and_normal_forces_stand_in_the_rows_of_the_comparison(monkeypatch):
    monkeypatch.setattr(anchoring, "weight", lambda model: 2.0)
    run = history(PRESSURE, **{anchoring.NORMAL: NORMAL})
    run.model = None
    rows = {(row.quantity, row.condition): row for row in anchoring.compare(run, anchoring.study(False))}
    level = rows["least pressure that holds (friction 0.7, assumed)", "tilt 0 deg"]
    assert (level.reported, level.computed) == (160.0, pytest.approx(150.0, abs=1e-3))
    # the normal force grows evenly here, so steps go like sin(tilt)
    half = rows["the same over that when level (friction fitted at 90 deg)", "tilt 30 deg"]
    assert (half.reported, half.computed) == (pytest.approx(15.0), pytest.approx(32.5, abs=1e-3))
    friction = rows["friction that the reported step to 90 deg asks for", "tilt 90 deg"]
    assert friction.computed == pytest.approx(2.0 / 6.5)
    (profile,) = anchoring.profiles(run, anchoring.study(False))
    assert [series.label for series in profile.series][-1] == "experiment"
    short = history(PRESSURE[:10], **{anchoring.NORMAL: NORMAL[:10]})
    short.model = None
    assert all(row.computed is None for row in anchoring.compare(short, anchoring.study(True)))
    (profile,) = anchoring.profiles(short, anchoring.study(True))
    assert len(profile.series) == 2


# --- moment


def test_the_unit_is_the_one_in_which_the_printed_number_is_nearest():
    printed = float(measured_moment(0.16))
    assert moment.nearest_unit(0.16, 1.5 * printed) == "N mm"
    assert moment.nearest_unit(0.16, 7.0 * printed) == "N cm"
    assert moment.nearest_unit(0.16, 700.0 * printed) == "N m"


def test_the_moment_is_compared_at_the_pressures_that_were_reached(monkeypatch):
    monkeypatch.setattr(moment, "moments", lambda solution: (np.array([0.0, 0.08]), np.array([0.0, 300.0])))
    rows = moment.compare(None, moment.study(False))
    assert [row.computed for row in rows[:3]] == [pytest.approx(150.0), pytest.approx(300.0), None]
    assert rows[0].reported == pytest.approx(float(measured_moment(0.04)))
    assert len(rows) == 7
    assert "the nearest at 80 kPa is N mm" in rows[0].note
    assert "the run ends at 80 kPa" in rows[2].note
    (profile,) = moment.profiles(None, moment.study(False))
    assert profile.series[0].x[-1] == pytest.approx(80.0)


# --- gaits


def test_the_robot_holds_before_gravity_comes_along_the_pipe_and_climbs_once_if_quick():
    quick, full = earthworm.study(True), earthworm.study(False)
    assert quick.loads[0].direction == (0.0, 0.0, -1.0)
    assert [phase.name for phase in quick.programme.phases[:3]] == ["hold", "gravity", "+middle"]
    assert (quick.cycle_ends, full.cycle_ends) == ((2, 8), (2, 8, 14))
    assert quick.contacts[0].friction == pipe_gaits.FRICTION


def test_a_run_that_did_not_finish_its_cycle_has_no_way(monkeypatch):
    found = SimpleNamespace(ends=(2, 8), displacements=np.zeros((0, 3)))
    monkeypatch.setattr(earthworm, "motion", lambda solution, study: found)
    run = SimpleNamespace(history=SimpleNamespace(smallest=lambda prefix: 0.05))
    *rows, least = earthworm.compare(run, earthworm.study(True))
    assert all(row.computed is None for row in rows)
    assert least.computed == 0.05


def test_ways_slips_and_cost_of_each_cycle_stand_in_the_rows(monkeypatch):
    found = SimpleNamespace(
        ends=(2, 8),
        displacements=np.array([[0.0, 0.0, 12.0]]),
        backward_slip={"rear": np.array([0.5]), "front": np.array([0.25])},
        cost_of_transport=np.array([math.nan]),
    )
    monkeypatch.setattr(earthworm, "motion", lambda solution, study: found)
    run = SimpleNamespace(history=SimpleNamespace(smallest=lambda prefix: 0.05))
    way, rear, front, cost, _ = earthworm.compare(run, earthworm.study(True))
    assert (way.computed, rear.computed, front.computed, cost.computed) == (12.0, 0.5, 0.25, None)
