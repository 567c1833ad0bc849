"""What a sweep file can say, and what is refused before anything runs."""

import numpy as np
import pytest
from tests.studies.sweeps.pretend import SPHERE, TWELVE

from pneumorph.errors import InputError, NameNotFoundError, StorageError, StudyError, UnitError
from pneumorph.studies.sweeps import load_sweep
from pneumorph.studies.sweeps.paths import replaced


def test_a_grid_has_every_combination_of_lists_and_steps(sweep):
    made = sweep(TWELVE)
    assert [p.path for p in made.parameters] == ["actuator.outer_radius", "material.mu"]
    radii = [design.study.actuator.outer_radius for design in made.designs]
    assert radii == [13.0] * 3 + [14.0] * 3 + [15.0] * 3 + [16.0] * 3
    np.testing.assert_allclose([d.study.materials["body"].mu for d in made.designs], [0.08, 0.1, 0.12] * 4)
    assert len({design.identity for design in made.designs}) == 12


def test_a_list_takes_the_values_side_by_side(sweep):
    text = '[parameters]\nactuator.outer_radius = ["13 mm", "15 mm"]\nphase[1].targets.cavity = ["1 kPa", "2 kPa"]\n'
    text = text.replace("phase[1].targets.cavity", '"phase[1].targets.cavity"') + '[sampling]\nmethod = "list"\n'
    designs = sweep(text).designs
    pairs = [(d.study.actuator.outer_radius, d.study.programme.phases[0].targets["cavity"]) for d in designs]
    assert pairs == [(13.0, 0.001), (15.0, 0.002)]


def test_logarithmic_steps_have_equal_ratios_and_whole_numbers_stay_whole(sweep):
    text = '[parameters]\nmaterial.mu = { low = "0.05 MPa", high = "0.2 MPa", steps = 3, spacing = "log" }\n'
    np.testing.assert_allclose([d.study.materials["body"].mu for d in sweep(text).designs], [0.05, 0.1, 0.2])
    values = [d.values[0] for d in sweep("[parameters]\nsolver.iterations = { low = 8, high = 16, steps = 3 }").designs]
    assert values == [8, 12, 16]
    assert all(type(value) is int for value in values)


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol"])
def test_samples_fill_their_bounds_and_come_again_with_their_seed(sweep, method):
    text = '[parameters]\nactuator.outer_radius = { low = "13 mm", high = "17 mm" }\nsolver.iterations = { low = 8, '
    text += f'high = 11 }}\nmesh.size = ["coarse", "automatic"]\n[sampling]\nmethod = "{method}"\nsamples = 16\nseed = '
    first = sweep(text + "3")
    radii = np.array([d.study.actuator.outer_radius for d in first.designs])
    # both are stratified: every 16th of the range holds one of 16 samples
    assert sorted(np.floor((radii - 13.0) / 4.0 * 16.0)) == list(range(16))
    counts = [[d.values[column] for d in first.designs].count(v) for column, v in [(1, 8), (1, 11), (2, "coarse")]]
    assert counts == [4, 4, 8]
    assert [d.identity for d in sweep(text + "3").designs] == [d.identity for d in first.designs]
    assert [d.identity for d in sweep(text + "4").designs] != [d.identity for d in first.designs]


def test_samples_need_not_be_a_power_of_two(sweep):
    text = '[parameters]\nmaterial.mu = { low = "0.05 MPa", high = "0.2 MPa", spacing = "log" }\n'
    designs = sweep(text + '[sampling]\nmethod = "sobol"\nsamples = 5').designs
    assert len(designs) == 5
    assert all(0.05 <= design.study.materials["body"].mu <= 0.2 for design in designs)


def test_dimensions_that_do_not_fit_make_a_design_without_a_study(sweep):
    designs = sweep('[parameters]\nactuator.outer_radius = ["9 mm", "15 mm"]').designs
    assert [design.study is None for design in designs] == [True, False]
    assert "leaves no wall" in designs[0].reason
    assert designs[0].identity == ""


def test_a_sweep_without_one_good_design_is_refused(sweep):
    with pytest.raises(InputError, match=r"every one of the 2 designs is refused; the first: .*leaves no wall"):
        sweep('[parameters]\nactuator.outer_radius = ["9 mm", "8 mm"]')


def test_results_unasked_are_measures_pressures_and_volumes_at_the_end_of_each_phase(sweep):
    names = [result.name for result in sweep('[parameters]\nactuator.outer_radius = ["15 mm"]').results]
    assert names == ["pressure:cavity", "added_volume:cavity"]
    two = SPHERE + '[[phase]]\nname = "more"\ntargets = { cavity = "3 kPa" }\n'
    names = [result.name for result in sweep('[parameters]\nactuator.outer_radius = ["15 mm"]', two).results]
    assert names[0] == "pressure:cavity after inflate"
    assert names[-1] == "added_volume:cavity after more"
    text = '[parameters]\nactuator.wall = ["3 mm"]'
    finger = '[actuator]\ntemplate = "finger"\n[[phase]]\ntargets = { cavity = "10 kPa" }\n'
    assert [result.name for result in sweep(text, finger).results][:2] == ["tip_rotation", "chord_angle"]


def test_a_sweep_writes_itself_out_as_an_equal_one(sweep, tmp_path):
    made = sweep(
        TWELVE + '[results]\np = "pressure:cavity"\nv = { column = "volume:cavity", at = { phase = "inflate" } }'
    )
    (tmp_path / "copy").mkdir()
    (tmp_path / "copy" / "sweep.toml").write_text(made.text())
    (tmp_path / "copy" / "study.toml").write_text(made.study_text())
    copied = load_sweep(tmp_path / "copy" / "sweep.toml")
    assert [d.identity for d in copied.designs] == [d.identity for d in made.designs]
    assert copied.results == made.results


def test_the_identity_changes_with_a_file_that_the_study_names(sweep, tmp_path):
    from pneumorph.geometry import ThickTube, export

    export(ThickTube(), tmp_path / "tube.step")
    study = '[actuator]\nfile = "tube.step"\n[material]\nname = "lsr-finger"\n[[phase]]\ntargets = { g = "1 N" }\n'
    study += '[[load]]\ntype = "force"\nname = "g"\nface = "tip"\ndirection = "x"\n[mesh]\nsize = "coarse"\n'
    first = sweep('[parameters]\nmaterial.bulk = ["20 MPa"]', study).designs[0]
    identity = first.identity
    assert str(tmp_path / "tube.step") in sweep('[parameters]\nmaterial.bulk = ["20 MPa"]', study).study_text()
    with (tmp_path / "tube.step").open("a") as file:
        file.write("\n")
    again = sweep('[parameters]\nmaterial.bulk = ["20 MPa"]', study).designs[0]
    assert again.identity != identity
    object.__delattr__(again, "identity")
    (tmp_path / "tube.step").unlink()
    with pytest.raises(StorageError, match=r"tube\.step cannot be read"):
        _ = again.identity


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ('[parameters]\nactuator.outer_radis = ["15 mm"]', StudyError, "unknown key 'outer_radis': did you mean"),
        (
            '[parameters]\nactuatr.outer_radius = ["15 mm"]',
            StudyError,
            "unknown key 'actuatr': did you mean 'actuator'",
        ),
        ('[parameters]\nactuator.outer_radius = ["15 kPa"]', UnitError, "outer_radius = '15 kPa'.*such as '1 mm'"),
        ("[parameters]\nactuator.outer_radius = [15]", UnitError, "outer_radius = 15: expected length"),
        ("[parameters]\nactuator.outer_radius = []", StudyError, r"'actuator.outer_radius' = \[\]: expected at least"),
        ("[parameters]\n", StudyError, "parameters: expected at least one"),
        ("[parameters]\nactuator = {}", StudyError, "parameters: actuator = {}: expected a list"),
        ("", StudyError, "parameters: missing"),
        ('[parameters]\nmaterial.law = ["yeo"]', StudyError, "unknown law 'yeo'"),
        ('[parameters]\n"phase[2].name" = ["x"]', StudyError, r"'phase\[2\].name': there is no \[2\], allowed: \[1\]"),
        ('[parameters]\n"phase.inflat.name" = ["x"]', StudyError, "unknown name 'inflat': did you mean 'inflate'"),
        ('[parameters]\n"title.name" = ["x"]', StudyError, "'title' is no table in the study"),
        ('[parameters]\n"actuator[1].name" = ["x"]', StudyError, "'actuator' is no list in the study"),
        ('[parameters]\n"actuator..name" = ["x"]', StudyError, "expected a dotted path"),
        ('[parameters]\nactuator.wall = ["1 mm"]\n"actuator.wall " = ["1 mm"]', StudyError, "unknown key 'wall"),
        ('[parameters]\n"mesh.size" = ["5 mm"]\nmesh.size = ["4 mm"]', StudyError, "'mesh.size' is given twice"),
        ('[parameters]\nmesh.size = { low = "5 mm" }', StudyError, "high: missing"),
        ('[parameters]\nmesh.size = { low = "5 mm", high = "6 kPa" }', UnitError, "two quantities of one kind"),
        ('[parameters]\nmesh.size = { low = "5 mm", high = "4 mm", steps = 2 }', StudyError, "expected low below high"),
        ('[parameters]\nmesh.size = { low = "0 mm", high = "4 mm", spacing = "log" }', StudyError, "above zero"),
        (
            '[parameters]\nmesh.size = { low = "4 mm", high = "5 mm", steps = 1 }',
            StudyError,
            "steps = 1: expected at l",
        ),
        ("[parameters]\nsolver.iterations = { low = 8, high = 11, steps = 3 }", StudyError, "fall on whole numbers"),
        ('[parameters]\nmesh.size = { low = "4 mm", high = "5 mm" }', StudyError, "steps missing"),
        ('[parameters]\nmesh.size = ["4 mm"]\n[sampling]\nsamples = 3', StudyError, "samples = 3: only for method"),
        ('[parameters]\nmesh.size = ["4 mm"]\n[sampling]\nmethod = "sobol"', StudyError, "samples = None: expected 1"),
        (
            '[parameters]\nmesh.size = ["4 mm"]\n[sampling]\nmethod = "sobol"\nsamples = 2\nseed = -1',
            StudyError,
            "seed = -1: expected at least 0",
        ),
        (
            '[parameters]\nmesh.size = { low = "4 mm", high = "5 mm", steps = 2 }\n[sampling]\nmethod = "sobol"\n'
            "samples = 2",
            StudyError,
            "steps are for a grid",
        ),
        (
            '[parameters]\nmesh.size = ["4 mm"]\ntitle = ["a", "b"]\n[sampling]\nmethod = "list"',
            StudyError,
            "as many values of each, got 'mesh.size' 1, 'title' 2",
        ),
        (
            "[parameters]\nsolver.iterations = { low = 1, high = 100001, steps = 100001 }",
            StudyError,
            "the grid has 100001 designs: expected at most 100000",
        ),
        ('[parameters]\nmesh.size = ["4 mm"]\n[sampling]\nmethod = "grd"', StudyError, "sampling.method = 'grd'"),
        ('[parameters]\nmesh.size = ["4 mm"]\n[results]\na = "tip"', StudyError, "results: 'a': unknown column 'tip'"),
        ('[parameters]\nmesh.size = ["4 mm"]\n[results]\na = "phase"', StudyError, "unknown column 'phase'"),
        (
            '[parameters]\nmesh.size = ["4 mm"]\n[results]\na = { column = "time", at = { phase = "inflat" } }',
            StudyError,
            "results: 'a': unknown phase 'inflat': did you mean 'inflate'",
        ),
        (
            '[parameters]\nmesh.size = ["4 mm"]\n[results]\na.column = "time"\na.at."pressure:cavity" = "1 mm"',
            UnitError,
            "results: 'a': at: pressure:cavity = '1 mm'",
        ),
        (
            '[parameters]\nmesh.size = ["4 mm"]\n[results]\na = { column = "time", at = {} }',
            StudyError,
            "expected one entry",
        ),
        ('study = 3\n[parameters]\nmesh.size = ["4 mm"]', StudyError, "study = 3: expected the name of a study file"),
        ('study = "no.toml"\n[parameters]\nmesh.size = ["4 mm"]', StudyError, "cannot read the study file '.*no.toml'"),
        ('study = "sweep.toml"\n[parameters]\nmesh.size = ["4 mm"]', StudyError, "unknown key 'study'"),
        ("study = [", StudyError, "is not a TOML file"),
    ],
)
def test_a_wrong_sweep_is_refused_with_one_message(sweep, text, kind, words):
    with pytest.raises(kind, match=words) as caught:
        sweep(text)
    assert caught.type is kind
    assert "\n" not in str(caught.value)


def test_a_name_that_the_study_does_not_know_is_refused(sweep):
    with pytest.raises(NameNotFoundError, match=r"design 1 .*did you mean 'lsr-finger'"):
        sweep('[parameters]\nmaterial = [{ name = "lsr-fingr" }]')


def test_a_missing_sweep_file_is_refused(tmp_path):
    with pytest.raises(StudyError, match="cannot read the sweep file"):
        load_sweep(tmp_path / "none.toml")


def test_a_path_leads_through_tables_that_are_left_out_and_leaves_the_original_alone():
    table = {"phase": [{"name": "a", "targets": {"cavity": "1 kPa"}}], "cells": [[1, 2]]}
    assert replaced(table, "mesh.size", "coarse")["mesh"] == {"size": "coarse"}
    assert replaced(table, "phase.a.targets.cavity", "2 kPa")["phase"][0]["targets"] == {"cavity": "2 kPa"}
    assert replaced(table, "cells[1][2]", 3)["cells"] == [[1, 3]]
    assert table["phase"][0]["targets"] == {"cavity": "1 kPa"}
    assert "mesh" not in table
