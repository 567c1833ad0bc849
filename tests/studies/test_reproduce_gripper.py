"""What the reproduction of system 3's gripper asks, and what it says of a run."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.geometry import Gripper
from pneumorph.mechanics import HalfSpace, Prescribed, Revolved, Roller
from pneumorph.mechanics.contact.free_body import moments
from pneumorph.solution import Column, History
from pneumorph.studies import reproductions
from pneumorph.studies.reproductions import finger_gripper as gripper

KINDS = {
    "phase": "text", "clock": "time", "value:holder": "length", "value:load": "force", "body_z:cup": "length",
    "contact_force_z:grip": "force", "contact_force_z:stand": "force", "contact_force_x:grip:outer_1": "force",
    "contact_force_x:grip:tip_1": "force",
}  # fmt: skip


def run_with(*states):
    """Return what stands for a solution: phase, holder, height of the cup, load, grip, stand, radial force."""
    rows = [
        {"phase": phase, "clock": float(n), "value:holder": holder, "value:load": load, "body_z:cup": height,
         "contact_force_z:grip": grip, "contact_force_z:stand": stand, "contact_force_x:grip:outer_1": radial,
         "contact_force_x:grip:tip_1": 0.5 * radial}
        for n, (phase, holder, height, load, grip, stand, radial) in enumerate(states)
    ]  # fmt: skip
    return SimpleNamespace(history=History([Column(key, key, kind) for key, kind in KINDS.items()], rows))


HELD = (
    ("rest", 0.0, -80.0, 0.0, 0.0, 0.0, 0.0),
    ("settle", 0.0, -81.0, 0.0, 0.0, 0.2, 0.0),
    ("close", 0.0, -80.5, 0.0, 0.1, 0.3, 0.4),
    ("lift", 20.0, -61.5, 0.0, -0.2, 0.0, 0.4),
    ("hold", 20.0, -61.75, 0.0, -0.2, 0.0, 0.4),
)
LOST = (
    ("load", 20.0, -63.0, 0.5, -0.7, 0.0, 0.4),
    ("load", 20.0, -65.0, 1.0, -1.1, 0.0, 0.4),
    ("load", 20.0, -70.0, 2.0, -1.4, 0.0, 0.4),
)


def rows_of(solution, *, half=False):
    study = SimpleNamespace(actuator=Gripper(half=half))  # all that is asked of it
    return {row.quantity: row for row in gripper.compare(solution, study)}


@pytest.mark.parametrize("quick", [True, False])
def test_the_cup_stands_below_the_fingers_and_the_holder_rises(quick):
    study = gripper.study(quick)
    assert study.actuator == Gripper(half=True)
    assert [phase.name for phase in study.programme.phases] == ["settle", "close", "lift", "hold", "load"]
    assert all(phase.inertia == "quasi-static" and phase.duration for phase in study.programme.phases)
    assert study.programme.phases[1].targets == dict.fromkeys(study.actuator.cavities, pytest.approx(0.1))
    assert Prescribed("clamp", "z", "holder") in study.supports
    assert Roller("cup", "x") in study.supports  # by symmetry it cannot tilt
    walls, grip, stand = study.contacts
    assert (walls.friction, grip.friction, stand.friction) == (0.0, 0.5, 0.5)
    assert grip.against == ("cup",)
    assert {name.rpartition("_")[0] for name in grip.faces} == {"outer", "tip"}
    assert isinstance(stand.against, HalfSpace)
    cup = study.file.body["cup"]
    assert cup.mass == pytest.approx(20e-6 / 6.0)
    surface = Revolved(cup.profile, cup.point)
    assert surface.facets(3)[0][:, 2].min() - stand.against.point[2] == pytest.approx(stand.reach)
    assert moments(*surface.facets(3), "cup")[0] > 0.0


def test_a_cup_that_rises_with_the_holder_is_lifted():
    rows = rows_of(run_with(*HELD, *LOST))
    assert rows["small cup lifted"].reported == rows["small cup lifted"].computed == 1.0
    assert rows["rise of the cup"].computed == pytest.approx(19.25)  # from -81 to -61.75
    assert rows["way of the cup behind the holder"].computed == pytest.approx(1.25)  # since it was at -80.5
    assert rows["radial force of a finger"].computed == pytest.approx(0.6)
    # at 70 mm it is 9.5 mm behind the holder: lost, and what it carried then does not count
    assert rows["largest weight held"].computed == pytest.approx(1.1)
    assert "112 g" in rows["largest weight held"].note
    assert all(row.reported is None for name, row in rows.items() if name != "small cup lifted")


def test_half_a_finger_stands_for_all():
    rows = rows_of(run_with(*HELD, *LOST), half=True)
    assert rows["radial force of a finger"].computed == pytest.approx(2.0 * 0.6)
    assert rows["largest weight held"].computed == pytest.approx(6.0 * 1.1)


def test_a_cup_that_stays_on_the_table_is_not_lifted():
    dropped = (*HELD[:4], ("hold", 20.0, -80.9, 0.0, -0.05, 0.15, 0.4))
    rows = rows_of(run_with(*dropped))
    assert rows["small cup lifted"].computed == 0.0
    assert rows["largest weight held"].computed is None
    still_on_it = (*HELD[:4], ("hold", 20.0, -61.75, 0.0, -0.05, 0.15, 0.4))
    assert rows_of(run_with(*still_on_it))["small cup lifted"].computed == 0.0


def test_what_was_not_reached_stays_empty():
    rows = gripper.compare(run_with(HELD[0]), gripper.study(True))
    assert all(row.computed is None for row in rows)
    assert gripper.profiles(run_with(HELD[0]), gripper.study(True)) == ()


def test_profiles_show_the_ways_and_the_force_that_is_carried():
    lift, carried = gripper.profiles(run_with(*HELD, *LOST), gripper.study(True))
    holder, cup = lift.series
    assert holder.y[-1] == 20.0
    assert cup.y[4] == pytest.approx(19.25)
    fingers, asked = carried.series
    assert asked.y == pytest.approx(20e-6 * 9810.0 + 6.0 * np.array([0.5, 1.0, 2.0]))
    assert fingers.y == pytest.approx(6.0 * np.array([0.7, 1.1, 1.4]))


def test_another_actuator_is_refused():
    with pytest.raises(InputError, match="expected a study of a gripper, received a HexagonalPrism"):
        gripper.compare(run_with(*HELD), reproductions.hexagonal_prism.study(True))


def test_it_is_known_by_name():
    assert reproductions.reproduction("finger-gripper").title.endswith("(system 3)")
