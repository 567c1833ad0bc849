"""`pneumorph new` and `pneumorph schema`."""

import json

from pneumorph.studies import load_study
from pneumorph.studies.json_schema import SCHEMA_FILE, study_schema
from pneumorph.studies.schema import TEMPLATES


def test_without_a_template_they_are_listed(pneumorph):
    result = pneumorph("new")
    assert result.exit_code == 0
    assert {line.split(": ")[0] for line in result.stdout.splitlines()} == {*TEMPLATES, "import"}


def test_a_study_file_is_written_where_asked_or_here(pneumorph, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = pneumorph("new", "finger")
    assert result.exit_code == 0
    assert "pneumorph run finger.toml" in result.stdout
    assert load_study("finger.toml").actuator == TEMPLATES["finger"]()
    assert pneumorph("new", "pneunet", tmp_path / "beam.toml", "--schema").exit_code == 0
    assert load_study(tmp_path / "beam.toml").name == "beam"
    assert json.loads((tmp_path / SCHEMA_FILE).read_text(encoding="utf-8")) == study_schema()


def test_an_existing_file_and_an_unknown_template_are_refused(pneumorph, tmp_path):
    (tmp_path / "mine.toml").write_text("")
    result = pneumorph("new", "finger", tmp_path / "mine.toml")
    assert result.exit_code == 2
    assert "exists already" in result.stderr
    result = pneumorph("new", "fingr", tmp_path / "other.toml")
    assert result.exit_code == 2
    assert "did you mean 'finger'" in result.stderr
    assert not (tmp_path / "other.toml").exists()


def test_the_schema_is_printed_or_written(pneumorph, tmp_path):
    assert json.loads(pneumorph("schema").stdout) == study_schema()
    assert pneumorph("schema", "--out", tmp_path / "s.json").exit_code == 0
    assert json.loads((tmp_path / "s.json").read_text(encoding="utf-8")) == study_schema()
