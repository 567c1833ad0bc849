import csv
import io
import json
import sys

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from pneumorph.cli import rolling as command
from pneumorph.report import rolling as report
from pneumorph.studies import rolling
from pneumorph.studies.reproductions import soft_wheel
from pneumorph.terrain import Drive, courses

RIGID = ("reproduce", "soft-wheel", "--part", "rigid", "--quick")


class Here:
    """Workers that compute in this process, one call after the other."""

    text = "this process"

    def __init__(self, scheduler=None):
        assert scheduler is None

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            try:
                yield number, function(*call)
            except Exception as error:
                yield number, error


@pytest.fixture
def short(monkeypatch):
    """Runs of half a second on a coarse ground, in this process, and no robots drawn: those are what costs most."""
    pytest.importorskip("mujoco")
    caches = (rolling._field, rolling._ground_bytes)
    for cache in caches:
        cache.cache_clear()
    monkeypatch.setattr(courses, "CELL", 500.0)
    whole = soft_wheel.RigidStudy.__init__
    monkeypatch.setattr(
        soft_wheel.RigidStudy,
        "__init__",
        lambda self, *args, **kwargs: whole(self, *args, **{"drive": Drive(duration=0.5), **kwargs}),
    )

    monkeypatch.setattr(command, "Workers", Here)

    def fail(*_):
        raise report.EngineError("no OpenGL here")

    monkeypatch.setattr(report, "_shot", fail)
    yield
    for cache in caches:
        cache.cache_clear()


def test_the_part_rigid_writes_tables_comparison_and_report(pneumorph, short, tmp_path, monkeypatch):
    out = tmp_path / "out"
    result = pneumorph(*RIGID, "--out", out)
    assert result.exit_code == 0, result.stderr
    assert "100 %" in result.stdout
    assert "done: 18 runs" in result.stdout
    table = list(csv.DictReader((out / "distances.csv").open()))
    assert [row["wheel"] for row in table] == [wheel.name for wheel in soft_wheel.all_wheels()]
    assert set(table[0]) == {"wheel", "flat [m]", "smooth [m]"}
    assert len(list(csv.DictReader((out / "ranking.csv").open()))) == 9
    assert (out / "comparison.csv").read_text().startswith("quantity,condition,reported,computed,unit")
    page = (out / "report.html").read_text()
    assert "18 of 18 runs are done, 0 failed." in page
    assert "no OpenGL here" in page
    assert "Assumed: wheels of radius 140 mm" in page
    (out / "distances.csv").unlink()
    (out / "figures" / "plain_flat.mp4").write_bytes(b"a film of before")
    monkeypatch.setattr(report, "_shot", lambda folder, run, moment: np.zeros((20, 30, 3), np.uint8))
    assert pneumorph("report", out).exit_code == 0
    page = (out / "report.html").read_text()
    assert "The run plain_flat, in real time." in page
    assert "no OpenGL here" not in page
    assert (out / "figures" / "terrains.png").exists()
    assert list(csv.DictReader((out / "distances.csv").open())) == table
    assert pneumorph(*RIGID, "--out", out).exit_code == 2
    assert pneumorph(*RIGID, "--out", out, "--resume").exit_code == 0
    (out / "sweep.json").write_text(
        json.dumps(json.loads((out / "sweep.json").read_text()) | {"settings": {"reproduction": 1}})
    )
    assert "is damaged" in pneumorph("report", out).stderr


def test_failed_runs_are_told_with_exit_code_3(pneumorph, short, tmp_path, monkeypatch):
    whole = rolling.travel

    def sometimes(run):
        if run.name == "curved-2_flat":
            raise report.EngineError("unstable before 1 s")
        return whole(run)

    monkeypatch.setattr(rolling, "travel", sometimes)
    result = pneumorph(*RIGID, "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert "1 of 18 runs failed" in result.stderr
    assert "curved-2_flat" in result.stderr
    page = (tmp_path / "out" / "report.html").read_text()
    assert "unstable before 1 s" in page


def test_an_interruption_says_how_to_go_on(pneumorph, short, tmp_path, monkeypatch):
    def stop(run):
        raise KeyboardInterrupt

    monkeypatch.setattr(rolling, "travel", stop)
    result = pneumorph(*RIGID, "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert f"--part rigid --quick --out {tmp_path / 'out'} --resume" in result.stderr


def test_a_further_terrain_comes_from_an_image(pneumorph, short, tmp_path):
    Image.fromarray((np.arange(64 * 64) % 200).astype(np.uint8).reshape(64, 64)).save(tmp_path / "Dune 1.png")
    out = tmp_path / "out"
    result = pneumorph(
        *RIGID, "--terrain", tmp_path / "Dune 1.png", "--relief", "200 mm", "--radius", "150 mm", "--out", out
    )
    assert result.exit_code == 0, result.stderr
    assert "done: 27 runs" in result.stdout
    assert "dune-1 [m]" in (out / "distances.csv").read_text()
    assert pneumorph("report", out).exit_code == 0


def refused(result, *words):
    """Check for one message, exit code 2 and no traceback."""
    assert result.exit_code == 2
    lines = result.stderr.strip().splitlines()
    assert len(lines) == 1
    for word in words:
        assert word in lines[0]


def test_terrain_images_that_make_no_terrain_are_refused(pneumorph, tmp_path):
    Image.new("RGB", (8, 8), "red").save(tmp_path / "red.png")
    Image.new("L", (8, 8), 7).save(tmp_path / "level.png")
    out = ("--out", tmp_path / "out")
    refused(pneumorph(*RIGID, *out, "--terrain", tmp_path / "red.png", "--relief", "1 m"), "RGB", "grey-scale")
    refused(pneumorph(*RIGID, *out, "--terrain", tmp_path / "level.png", "--relief", "1 m"), "no relief")
    refused(pneumorph(*RIGID, *out, "--terrain", tmp_path / "none.png", "--relief", "1 m"), "cannot be read")
    refused(pneumorph(*RIGID, *out, "--terrain", tmp_path / "red.png"), "needs --relief")
    refused(pneumorph(*RIGID, *out, "--relief", "1 m"), "only with --terrain")
    assert not (tmp_path / "out").exists()


def test_wheels_larger_than_the_track_unknown_parts_and_runs_are_refused(pneumorph, tmp_path):
    out = ("--out", tmp_path / "out")
    refused(pneumorph(*RIGID, *out, "--radius", "300 mm"), "larger than the wheelbase", "600 mm")
    refused(pneumorph(*RIGID, *out, "--radius", "20 mm"), "hub_radius")
    refused(pneumorph(*RIGID, *out, "--video", "curved-3_flt"), "--video", "did you mean 'curved-3_flat'")
    refused(pneumorph("reproduce", "soft-wheel"), "--part: missing, allowed for soft-wheel: limb, rigid")
    refused(pneumorph("reproduce", "soft-wheel", "--part", "limbs"), "--part: limbs, allowed for soft-wheel: limb, ")
    refused(pneumorph("reproduce", "hexagonal-prism", "--part", "rigid"), "allowed for hexagonal-prism: bending")
    assert not (tmp_path / "out").exists()


def test_without_mujoco_nothing_is_begun_and_the_message_says_what_to_install(pneumorph, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    result = pneumorph(*RIGID, "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert "pip install 'pneumorph[terrain]'" in result.stderr
    assert not (tmp_path / "out").exists()


def test_parts_are_listed(pneumorph):
    result = pneumorph("reproduce")
    assert "soft-wheel: Adaptive soft wheel" in result.stdout
    assert "--part rigid: nine rigid wheels" in result.stdout


def test_a_terminal_sees_a_bar_with_the_time_left():
    screen = Console(file=io.StringIO(), force_terminal=True, width=120)
    news = rolling.RollingNews(3, 9, {"run": "plain_flat", "status": "done", "distance [m]": 8.78}, 4.0, 66.0)
    with command.progress_on(screen, command._result) as listen:
        listen(news)
    assert "3 of 9" in screen.file.getvalue()
    assert "about 1 min 06 s left  plain_flat: 8780 mm" in screen.file.getvalue()
    failed = rolling.RollingNews(1, 2, {"run": "a", "status": "failed", "reason": "why"}, 1.0, 1.0)
    assert command._line(failed, command._result(failed)) == " 50 %  a: failed, why  elapsed 1 s  left about 1 s"
