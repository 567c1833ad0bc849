"""Every bad input: one message on stderr that names it, exit code 2, nothing solved, no traceback."""

import pytest

from pneumorph.errors import MeshError
from pneumorph.geometry import occ

PHASE = '\n[[phase]]\ntargets = { cavity = "10 kPa" }\n'
FINGER = '[actuator]\ntemplate = "finger"\n'
TUBE = '[actuator]\ntemplate = "thick-tube"\ncap = "0 mm"\n[material]\nname = "lsr-finger"\n[mesh]\nsize = "coarse"'


def refused(result, *words):
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert "Traceback" not in result.stderr + result.stdout
    for word in words:
        assert word in result.stderr


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (FINGER + 'length = "90 kPa"' + PHASE, ["actuator: length = '90 kPa'", "such as '1 mm'"]),
        (FINGER + "length = 90" + PHASE, ["actuator: length = 90", "such as '1 mm'"]),
        (FINGER + '[[phase]]\ntargets = { cavity = "10 mL" }', ["targets.cavity = '10 mL'", "such as '1 kPa'"]),
        (FINGER + 'lengt = "90 mm"' + PHASE, ["actuator: unknown key 'lengt': did you mean 'length'?"]),
        (FINGER + "[solvr]" + PHASE, ["unknown key 'solvr': did you mean 'solver'?"]),
        (FINGER + '[[support]]\ntype = "clamp"\nface = "clmp"' + PHASE, ["unknown face 'clmp': did you mean 'clamp'?"]),
        (FINGER + '[[cavity]]\nname = "cavity"\nfaces = ["cavity", "cavity"]' + PHASE, ["face 'cavity' is named in"]),
        (
            FINGER
            + '[[support]]\ntype = "clamp"\nface = "tip"\n' * 1
            + '[[support]]\ntype = "clamp"\nface = "tip"'
            + PHASE,
            ["face 'tip' is named in support[1] and in support[2]"],
        ),
        (TUBE + PHASE, ["cavity 'cavity' leaks", "open edges"]),
        (FINGER + '[[cavity]]\nname = "cavity"\nfaces = ["outer"]' + PHASE, ["cavity 'cavity'"]),
        (FINGER + 'wall = "-2 mm"' + PHASE, ["wall = -2 mm"]),
        (FINGER + 'wall = "8 mm"' + PHASE, ["overlap"]),
        (
            FINGER + '[material]\nname = "lsr-fingr"' + PHASE,
            ["material 'lsr-fingr': did you mean 'lsr-finger'?"],
        ),
        (FINGER + '[mesh]\nsize = "-1 mm"' + PHASE, ["mesh: size = -1"]),
        ("[actuator\n", ["is not a TOML file"]),
    ],
)
def test_a_wrong_study_is_refused(pneumorph, tmp_path, text, words):
    study = tmp_path / "wrong.toml"
    study.write_text(text)
    refused(pneumorph("run", study, "--out", tmp_path / "out"), *words)
    assert not (tmp_path / "out" / "run.json").exists()


def test_a_missing_study_is_refused(pneumorph, tmp_path):
    refused(
        pneumorph("run", tmp_path / "nothing.toml", "--out", tmp_path / "out"), "cannot read the study", "nothing.toml"
    )


def test_a_solid_that_cannot_be_meshed_is_refused(pneumorph, study, tmp_path, monkeypatch):
    def fail(*arguments, **settings):
        raise MeshError("Netgen cannot mesh the solid in (0, 0, 0) to (15, 15, 15) mm at sizes 3 mm: surfaces cross")

    monkeypatch.setattr(occ, "mesh_solid", fail)
    refused(pneumorph("run", study, "--out", tmp_path / "out"), "cannot mesh the solid", "surfaces cross")


def test_a_folder_that_holds_a_run_is_refused_before_anything_is_meshed(pneumorph, study, tmp_path, monkeypatch):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "run.json").write_text("{}")
    monkeypatch.setattr(occ, "mesh_solid", None)
    refused(pneumorph("run", study, "--out", tmp_path / "out"), f"'{tmp_path / 'out'}' already holds a run", "--resume")


def test_a_folder_that_cannot_be_made_is_refused(pneumorph, study, tmp_path):
    (tmp_path / "file").write_text("")
    refused(pneumorph("run", study, "--out", tmp_path / "file" / "out"), str(tmp_path / "file"))


def test_another_study_cannot_go_on_in_a_folder(pneumorph, study, tmp_path):
    assert pneumorph("run", study, "--out", tmp_path / "out", "--no-report").exit_code == 0
    study.write_text(study.read_text().replace("100 kPa", "200 kPa"))
    refused(pneumorph("run", study, "--out", tmp_path / "out", "--resume"), "holds another run", "mu")


def test_an_unknown_reproduction_is_refused(pneumorph):
    refused(pneumorph("reproduce", "hexagonal-prim"), "'hexagonal-prim': did you mean 'hexagonal-prism'?")


def test_a_report_of_no_run_is_refused(pneumorph, tmp_path):
    refused(pneumorph("report", tmp_path), "is not the folder of a run")


def test_a_wrong_number_of_threads_is_refused(pneumorph, monkeypatch):
    from pneumorph.threads import thread_count

    monkeypatch.setenv("PNEUMORPH_THREADS", "many")
    thread_count.cache_clear()
    try:
        refused(pneumorph("doctor"), "PNEUMORPH_THREADS = 'many'")
    finally:
        thread_count.cache_clear()
