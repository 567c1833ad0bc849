import csv
import io
import math
from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.closed_form import hexagonal_prism as published
from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.geometry import HexagonalPrism
from pneumorph.solution import Column, History
from pneumorph.studies import Comparison, reproductions, study_from
from pneumorph.studies.comparison import COLUMNS, to_csv
from pneumorph.studies.reproductions import hexagonal_prism


def run_to(*pressures):
    """Return what stands for a solution: chord angles 1 rad/MPa, tip rotations twice that, contact from 50 kPa on."""
    columns = [Column("pressure:cavity_2", "", "pressure"), Column("chord_angle", "", "angle")]
    columns += [Column("tip_rotation", "", "angle"), Column("contact_area:walls", "", "area")]
    rows = [
        {"pressure:cavity_2": p, "chord_angle": p, "tip_rotation": 2.0 * p, "contact_area:walls": max(0.0, p - 0.05)}
        for p in (0.0, *pressures)
    ]
    return SimpleNamespace(history=History(columns, rows))


def test_the_hexagonal_prism_is_half_of_the_published_one_with_two_neighbouring_cavities_at_one_pressure():
    study = hexagonal_prism.study(quick=False)
    assert study.actuator == HexagonalPrism(half=True, end_wall=4.0, end_plate=4.0)
    assert (study.actuator.blocks[0][0], study.actuator.blocks[-1][1]) == (0.0, 112.0)
    # its image in the cut is cavity_3
    assert [cavity.name for cavity in study.cavities] == ["cavity_2"]
    assert study.materials["body"].c10 == 0.11
    assert study.materials["plate"].shear_modulus > 40.0 * study.materials["body"].shear_modulus
    (phase,) = study.programme.phases
    assert phase.targets == {"cavity_2": 0.28}
    pressures = [study.programme.values(mark)["cavity_2"] for mark in phase.marks]
    np.testing.assert_allclose(pressures, [0.04, 0.08, 0.12, 0.16, 0.20, 0.24], rtol=1e-14)
    walls, insides, image = study.contacts
    assert (walls.faces, walls.against) == (("outer", "core"), None)
    assert insides.faces == tuple(face for face in study.build().model.mesh.faces if face.startswith("cavity"))
    assert walls.friction == insides.friction > 0.0 == image.friction
    # the plane of the cut, where walls meet those of the other half: out of reach of what lies in it at rest
    assert image.reach < -image.against.point[0] < 1.1 * image.reach
    assert tuple(image.against.normal) == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("quick", [True, False])
def test_the_viscosity_of_the_prism_lags_by_less_than_a_hundredth_of_the_largest_pressure(quick):
    study = hexagonal_prism.study(quick)
    prony = study.materials["body"].prony
    (phase,) = study.programme.phases
    # under a steady ramp the overstress is that of the rise of the pressure in sum of g tau, over the long-term share
    lag = float(np.dot(prony.g, prony.tau)) / prony.long_term_share * phase.targets["cavity_2"] / phase.duration
    assert 0.0 < lag < 0.0028


def test_the_quick_run_has_the_same_mesh_and_stops_at_80_kpa():
    study, full = hexagonal_prism.study(quick=True), hexagonal_prism.study(quick=False)
    assert study.file.mesh == full.file.mesh
    assert study.file.mesh.hexahedra
    assert study.programme.phases[0].targets["cavity_2"] == 0.08
    assert study.programme.phases[0].marks == (0.5,)


def test_both_angles_are_compared_with_all_three_sources_at_all_seven_pressures():
    study = hexagonal_prism.study(quick=False)
    rows = hexagonal_prism.compare(run_to(0.04, 0.08, 0.12), study)
    assert len(rows) == 2 * 3 * 7 + 1
    table = [row for row in rows if row.quantity == "chord_angle (Table 2, finite elements)"]
    assert [(row.condition, row.unit) for row in table] == [(f"{p} kPa", "deg") for p in range(40, 281, 40)]
    assert [row.reported for row in table] == pytest.approx([5.5, 13.7, 22.6, 32.5, 41.5, 47.4, 50.5])
    assert table[0].computed == pytest.approx(math.degrees(0.04))
    assert table[0].relative_difference == pytest.approx(math.degrees(0.04) / 5.5 - 1.0)
    assert "the angle that Table 2 is nearest to" in table[0].note
    tip = [row for row in rows if row.quantity == "tip_rotation (Table 2, finite elements)"]
    assert tip[0].computed == pytest.approx(2.0 * table[0].computed)


def test_the_closed_form_and_the_experiment_stand_in_the_rows():
    study = hexagonal_prism.study(quick=False)
    rows = {(row.quantity, row.condition): row for row in hexagonal_prism.compare(run_to(0.04), study)}
    measured = rows["chord_angle (eq. 13, polynomial through the experiment)", "80 kPa"]
    assert measured.reported == pytest.approx(float(np.degrees(published.measured_bending_angle(0.08))))
    closed = rows["chord_angle (eqs. 1-12, closed form as printed)", "80 kPa"]
    angle = math.radians(closed.reported)
    assert published.prism_pressure(study.actuator, study.materials["body"], angle) == pytest.approx(0.08)
    assert "as printed" in closed.note


def test_the_pressure_at_which_walls_touch_is_that_of_the_first_state_with_contact():
    study = hexagonal_prism.study(quick=False)
    *_, touch = hexagonal_prism.compare(run_to(0.04, 0.06, 0.08), study)
    assert (touch.reported, touch.computed, touch.unit) == (200.0, pytest.approx(60.0), "kPa")
    *_, none = hexagonal_prism.compare(run_to(0.04), study)
    assert none.computed is None


def test_rows_that_were_not_reached_stay_empty_and_say_so():
    rows = hexagonal_prism.compare(run_to(0.04, 0.08), hexagonal_prism.study(quick=True))
    late = [row for row in rows if row.condition == "120 kPa"]
    assert len(late) == 6
    assert all(row.computed is None and row.relative_difference is None for row in late)
    assert all("not reached: the run ended at 80 kPa" in row.note for row in late)


def test_reported_curves_pass_through_the_reported_points():
    table, measured, printed = hexagonal_prism.curves(hexagonal_prism.study(quick=False))
    assert table.marks
    assert (table.x, table.y) == ("pressure:cavity_2", "chord_angle")
    assert math.degrees(table.y_values[1]) == pytest.approx(13.7)
    assert np.interp(0.08, measured.x_values, measured.y_values) == pytest.approx(
        float(published.measured_bending_angle(0.08)), rel=1e-3
    )
    assert printed.x_values[-1] == pytest.approx(0.1)


def test_another_actuator_is_refused():
    study = study_from({"actuator": {"template": "finger"}, "phase": [{"targets": {"cavity": "1 kPa"}}]}, "x")
    with pytest.raises(InputError, match="expected a study of a hexagonal prism, received a Finger"):
        hexagonal_prism.curves(study)


def test_reproductions_are_known_by_name():
    assert "hexagonal-prism" in reproductions.names()
    assert "doi 10.3390/act11050125" in reproductions.reproduction("hexagonal-prism").source
    with pytest.raises(NameNotFoundError, match="'hexagonal-prsm': did you mean 'hexagonal-prism'"):
        reproductions.reproduction("hexagonal-prsm")


def test_comparison_csv_has_its_columns_and_empty_fields():
    rows = [Comparison("a, b", "1 kPa", 2.0, 2.5, "deg", 'say "so"'), Comparison("c", "", 1.0, None, "")]
    lines = list(csv.reader(io.StringIO(to_csv(rows))))
    assert tuple(lines[0]) == COLUMNS
    assert lines[1] == ["a, b", "1 kPa", "2", "2.5", "deg", "0.25", 'say "so"']
    assert lines[2] == ["c", "", "1", "", "", "", ""]
    assert Comparison("c", "", 0.0, 1.0, "").relative_difference is None
