"""`pneumorph design` from the command line, on a stub of a tube; the search itself is tested with the studies."""

import pytest

from pneumorph.studies.sweeps import Workers

TEXT = """
[target]
curve = "arc"
length = "44.75 mm"
angle = "0.6 deg"
[actuator]
length = "44.7 mm"
[search]
segments = 1
cells_along = [3]
cells_around = [4]
cg = [0.2, 0.5]
pressure = ["0.5 kPa", "2 kPa"]
trials = 24
[steps]
first_increment = 1.0
largest_increment = 1.0
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "stub.toml"
    path.write_text(TEXT)
    return path


@pytest.fixture
def here(monkeypatch):
    """Compute in this process; how often is kept."""
    seen = []

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            seen.append(call)
            yield number, function(*call)

    monkeypatch.setattr(Workers, "compute", compute)
    return seen


@pytest.mark.slow
def test_a_design_is_found_verified_reported_and_resumed(pneumorph, here, file, tmp_path):
    out = tmp_path / "out"
    result = pneumorph("design", file, "--out", out)
    assert result.exit_code == 0
    assert len(here) == 2
    assert "uniform tubes: 2 runs" in result.stdout
    assert "24/24  nearest" in result.stdout
    assert "segment 1: 3 rows" in result.stdout
    assert "full model: " in result.stdout
    for name in ("report.html", "found.toml", "target.toml", "search.journal", "figures/map.svg", "table/table.csv"):
        assert (out / name).exists(), name
    assert (out / "verification" / "history.csv").exists()
    assert "nearest on the way" in (out / "report.html").read_text()

    again = pneumorph("design", file, "--out", out)
    assert again.exit_code == 2
    assert "already holds a search: resume it" in again.stderr
    again = pneumorph("design", file, "--out", out, "--resume", "--no-report")
    assert again.exit_code == 0
    assert len(here) == 2  # nothing is computed twice
    before = (out / "found.toml").read_text()
    (out / "report.html").unlink()
    assert pneumorph("report", out).exit_code == 0
    assert "nearest on the way" in (out / "report.html").read_text()
    assert (out / "found.toml").read_text() == before
    file.write_text(TEXT.replace("trials = 24", "trials = 25"))
    again = pneumorph("design", file, "--out", out, "--resume")
    assert again.exit_code == 2
    assert "holds another search" in again.stderr


def test_a_target_that_the_table_cannot_reach_is_refused(pneumorph, here, file, tmp_path):
    file.write_text(TEXT.replace("44.75 mm", "60 mm"))
    result = pneumorph("design", file, "--out", tmp_path / "out", "--no-verify")
    assert result.exit_code == 2
    assert "the curve is 60 mm long, the actuator 44." in result.stderr
    assert "expected a curve that it can reach" in result.stderr


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('curve = "arc"', 'curve = "ark"', "unknown curve 'ark': did you mean 'arc'"),
        ('length = "44.75 mm"', 'length = "44.75"', "length = '44.75': expected length with its unit"),
        ("segments = 1", "segments = 0", "expected at least 1: the map would be empty"),
        ("cells_around = [4]", "cells_around = [72]", "beam = 1.57 mm: expected less than the width of the cell"),
    ],
)
def test_bad_input_is_one_message(pneumorph, file, tmp_path, old, new, message):
    file.write_text(TEXT.replace(old, new))
    result = pneumorph("design", file, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert message in result.stderr
    assert not (tmp_path / "out").exists()
