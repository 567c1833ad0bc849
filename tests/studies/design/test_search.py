"""The search on laws in closed form: what is wanted is found, and what cannot be is refused."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError, NameNotFoundError, StudyError
from pneumorph.solution import Column, History
from pneumorph.studies.design import load_design, search
from pneumorph.studies.design.law import Lattice, TableLaw, law_of
from pneumorph.studies.design.search import _rows, _shares
from pneumorph.studies.design.skin import Part, SkinDesign
from pneumorph.studies.design.task import design_from

REST = 104.3
ARC = {"curve": "arc", "length": "106.386 mm", "angle": "30 deg"}  # stretch 1.02


def task(target=ARC, **changed):
    given = {"segments": 1, "cells_along": [8], "cg": [0.2, 0.5], "pressure": ["1 kPa", "20 kPa"], "trials": 300}
    return design_from({"target": target, "search": given | changed}, "x")


def linear_law(made, stretch=1.02, rate=0.3, end=0.0):
    """Turn in proportion to pressure and to 0.5 - cg: rate * p rad/mm at cg = 0.2; stretch constant."""
    cg, pressure = np.array(made.file.search.cg), np.linspace(0.0, 0.02, 21)
    turn = {item: np.outer((0.5 - cg) / 0.3, rate * pressure) for item in made.lattices}
    return TableLaw(cg, pressure, turn, {item: np.full((len(cg), 21), stretch) for item in made.lattices}, end)


@pytest.mark.parametrize("sampler", ["tpe", "cma-es"])
def test_an_arc_is_found(sampler):
    """Total turn = rate p (0.5 - cg) / 0.3 L: 30 degrees, whatever shares cg and pressure have in it."""
    made = task(sampler=sampler, trials=150)
    found = search(made, linear_law(made))
    (part,) = found.design.parts
    turn = 0.3 * found.design.pressure * (0.5 - part.cg) / 0.3 * REST
    assert math.degrees(turn) == pytest.approx(30.0, abs=0.5)
    assert found.deviation.rms < 0.2
    assert found.deviation.largest >= found.deviation.rms
    assert len(found.trials) == 150


def test_an_s_takes_two_segments_with_swapped_halves():
    made = task({"curve": "s", "length": "106.386 mm", "angle": "15 deg"}, segments=2, trials=1200)
    found = search(made, linear_law(made))
    assert [part.rows for part in found.design.parts] == [4, 4]
    assert [part.middle for part in found.design.parts] == [0, 12]
    assert found.deviation.rms < 0.05


def test_a_space_curve_turns_the_halves_around():
    """A helix with much twist: the second segment's re-entrant side looks elsewhere, and one plane does not do."""
    target = {"curve": "helix", "length": "106.386 mm", "angle": "30 deg", "twist": "90 deg"}
    made = task(target, segments=2, trials=600)
    found = search(made, linear_law(made))
    assert found.design.parts[0].middle != found.design.parts[1].middle
    assert found.deviation.rms < 1.5


def test_the_same_seed_finds_the_same():
    made = task(trials=40, seed=3)
    assert search(made, linear_law(made)).design == search(made, linear_law(made)).design
    other = task(trials=40, seed=4)
    assert search(other, linear_law(other)).design != search(made, linear_law(made)).design


def test_a_search_goes_on_where_it_was_broken_off(tmp_path):
    made, journal, seen = task(trials=30, starts=1, sampler="tpe"), tmp_path / "journal", []

    def broken(news):
        seen.append(news)
        if news.ended == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        search(made, linear_law(made), journal, broken)
    found = search(made, linear_law(made), journal, seen.append)
    assert [news.ended for news in seen] == list(range(1, 31))
    assert len(found.trials) == 30
    assert len(set(found.trials)) == 30  # nothing is tried twice
    assert found.deviation.rms == pytest.approx(found.trials.min())
    assert seen[-1].best == pytest.approx(found.deviation.rms)


def test_every_start_has_its_trials():
    assert _shares(10, 4) == [3, 3, 2, 2]
    assert _shares(2, 4) == [1, 1, 1, 1]


def test_every_row_belongs_to_a_segment():
    assert _rows([0.5], 8) == [4, 4]
    assert _rows([0.0, 1.0], 9) == [1, 7, 1]
    assert all(
        sum(_rows(sorted(cuts), 7)) == 7 and min(_rows(sorted(cuts), 7)) > 0
        for cuts in np.random.default_rng(0).random((50, 3))
    )


def test_without_optuna_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "optuna", None)
    made = task()
    with pytest.raises(EngineError, match=r"pip install 'pneumorph\[design\]'"):
        search(made, linear_law(made))


def test_ends_that_caps_hold_do_not_bend():
    made = task()
    part = SkinDesign((Part(8, 0.2, 6, 0),), 12, 0.02)
    pieces = part.pieces(linear_law(made, end=8.0), REST)
    assert [piece.length for piece in pieces] == pytest.approx([8.0, REST - 16.0, 8.0])
    assert [np.linalg.norm(piece.turn) for piece in pieces] == pytest.approx([0.0, 0.006, 0.0])


def test_it_bends_away_from_its_reentrant_middle():
    """Middle at column border 3 of 12, a quarter around, so at y > 0: the tip goes to y < 0."""
    made = task()
    line = SkinDesign((Part(8, 0.2, 6, 6),), 12, 0.02).line(linear_law(made), REST, [1.0])
    assert line[0, 1] < -10.0
    assert line[0, 0] == pytest.approx(0.0, abs=1e-9)


def run(turn, tip, length, pressure):
    keys = {"pressure:cavity": "pressure", "turn_rate": "curvature", "tip_rotation": "angle", "line_length": "length"}
    rows = [dict(zip(keys, row, strict=True)) for row in zip(pressure, turn, tip, length, strict=True)]
    return History([Column(key, key, kind) for key, kind in keys.items()], rows)


def test_the_law_of_a_table_is_that_of_its_runs():
    """Turn 0.4 p, tip of a tube of 100 mm whose ends of 5 mm do not bend, stretch 1 + p."""
    pressure = np.linspace(0.0, 0.03, 7)
    bent = run(0.4 * pressure, 0.4 * pressure * 90.0, 100.0 * (1.0 + pressure), pressure)
    short = pressure[:5]
    straight = run(0.0 * short, 0.0 * short, 100.0 * (1.0 + short), short)
    item = Lattice(8, 12, 6)
    law = law_of({(item, 0.2): bent, (item, 0.5): straight}, 100.0, 0.025)
    assert law.pressure[-1] == pytest.approx(0.02)  # as far as all runs got
    assert law.end == pytest.approx(5.0)
    half = law.bend(item, 0.35, 0.01)
    assert (half.turn, half.stretch) == pytest.approx((0.002, 1.01))
    with pytest.raises(InputError, match=r"cg = 0\.6: the table covers 0\.2 to 0\.5"):
        law.bend(item, 0.6, 0.01)
    with pytest.raises(InputError, match=r"pressure = 0\.03: the table covers 0 to 0\.02"):
        law.bend(item, 0.2, 0.03)
    with pytest.raises(InputError, match="the table holds no Lattice"):
        law.bend(Lattice(7, 12, 6), 0.2, 0.01)
    with pytest.raises(InputError, match=r"no run of .* with cg = 0\.5"):
        law_of({(item, 0.2): bent, (Lattice(7, 12, 6), 0.5): bent}, 100.0, 0.02)
    with pytest.raises(InputError, match="no state under pressure"):
        law_of({(item, 0.2): run([0.0], [0.0], [100.0], [0.0])}, 100.0, 0.02)


@pytest.mark.parametrize(
    ("target", "changed", "error", "message"),
    [
        (ARC | {"curve": "ark"}, {}, NameNotFoundError, "unknown curve 'ark': did you mean 'arc'"),
        (ARC | {"length": "3 m"}, {}, InputError, "the curve is 3000 mm long, the actuator 104.3 mm at rest"),
        ({"curve": "arc", "angle": "1 deg"}, {}, StudyError, r"target\.length: missing for the curve 'arc'"),
        ({}, {}, StudyError, "expected either curve, the name of one, or file"),
        ({"file": "x.csv", "length": "1 mm"}, {}, StudyError, r"target\.length: only for a named curve"),
        (ARC, {"segments": 0}, StudyError, r"search\.segments = 0: expected at least 1: the map would be empty"),
        (ARC, {"starts": 0}, StudyError, r"search\.starts = 0: expected at least 1"),
        (ARC, {"segments": 9}, StudyError, "expected at least 9, one row for each segment"),
        (ARC, {"cells_around": []}, StudyError, "expected one or more different numbers"),
        (ARC, {"cells_around": [11]}, StudyError, "expected even numbers for a plane curve"),
        (ARC, {"cg": [0.2, 0.7]}, InputError, "cg = 0.7 of a re-entrant cell: the gap g"),
        (ARC, {"cg": [0.5, 0.2]}, StudyError, "expected rising numbers"),
        (ARC, {"pressure": ["20 kPa", "1 kPa"]}, StudyError, "expected the lowest, above 0, and the highest"),
        (ARC, {"cells_around": [100]}, InputError, "beam = 1.57 mm: expected less than the width of the cell"),
        (ARC, {"trails": 3}, StudyError, "'trails': did you mean 'trials'"),
    ],
)
def test_what_cannot_be_searched_is_refused(target, changed, error, message):
    with pytest.raises(error, match=message):
        task(target, **changed)


@pytest.mark.parametrize(("model", "closed"), [("full", False), ("homogenised", True)])
def test_the_table_is_of_uniform_half_tubes_of_the_model_that_is_asked_for(model, closed):
    made = task(model=model, cg=[0.2, 0.3, 0.5], cells_along=[7, 8])
    studies = [design.study for design in made.table.designs]
    assert len(studies) == 6
    assert {(study.actuator.cells_along, study.actuator.cg) for study in studies} == {
        (along, cg) for along in (7, 8) for cg in (0.2, 0.3, 0.5)
    }
    assert all(study.actuator.half and study.file.mesh.homogenised is closed for study in studies)
    assert not made.verification(SkinDesign((Part(8, 0.2, 6, 0),), 12, 0.02)).file.mesh.homogenised


def test_a_table_that_misses_a_run_is_refused(tmp_path):
    made = task()
    with pytest.raises(InputError, match="misses design 1 of the table: compute it first"):
        made.runs(tmp_path)


def test_a_law_that_does_not_reach_the_target_or_its_pressure_is_refused():
    made, pressure = task(ARC | {"length": "130 mm"}), np.linspace(0.0, 0.02, 5)

    def runs(pressure):
        history = run(0.3 * pressure, 0.3 * pressure * REST, REST * (1.0 + pressure), pressure)
        return {(item, cg): history for item in made.lattices for cg in made.file.search.cg}

    with pytest.raises(InputError, match=r"the curve is 130 mm long, the actuator 104\.3 to 106\.4 mm"):
        made.law(runs(pressure))
    with pytest.raises(InputError, match=r"pressure from 1 kPa: the runs of the table reached 0\.5 kPa only"):
        made.law(runs(pressure / 40.0))


def test_the_example_is_a_search():
    made = load_design(Path(__file__).parents[3] / "examples" / "targets" / "s.toml")
    assert made.target.planar
    assert made.target.length == pytest.approx(115.0, rel=1e-4)
    assert made.sampler == "cma-es"
    with pytest.raises(StudyError, match=r"cannot read the target file 'none\.toml'"):
        load_design("none.toml")


def test_searched_keys_of_the_actuator_are_refused():
    with pytest.raises(StudyError, match="actuator: 'cg' is what is searched"):
        design_from({"target": ARC, "actuator": {"cg": 0.3}}, "x")
