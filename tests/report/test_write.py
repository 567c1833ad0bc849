import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from pneumorph.errors import EngineError, InputError, NameNotFoundError
from pneumorph.report import Curve, Table, animation, render, write_report
from pneumorph.report.compose import compose, encode
from pneumorph.report.findings import marked_rows
from pneumorph.report.pictures import caption
from pneumorph.report.render import Layer, Scene
from pneumorph.report.view import View
from pneumorph.solution import Solution, Status
from pneumorph.studies.comparison import Comparison, ReportedCurve


@pytest.fixture
def no_pictures(monkeypatch):
    """A machine on which VTK ends the process, as it does without OpenGL."""
    render.check.cache_clear()
    monkeypatch.setattr(render, "_PROBE", "import os; os._exit(139)")
    yield
    render.check.cache_clear()


def outside_resources(html):
    return [uri for uri in re.findall(r"(?:src|href|poster)=\"([^\"]*)\"", html) if not uri.startswith(("data:", "#"))]


@pytest.mark.usefixtures("drawable")
def test_a_run_folder_alone_gives_a_whole_self_contained_page(balloon, tmp_path):
    path = write_report(Solution.open(balloon.folder), tmp_path)
    html = path.read_text(encoding="utf-8")
    assert outside_resources(html) == []
    assert "url(" not in html
    for section in ("Results", "What was asked", "Mesh", "Checks", "Versions and how to repeat it"):
        assert f">{section}</h2>" in html
    assert "Done: the programme was computed to its end." in html
    assert "data:video/mp4" in html
    found = {file.name for file in (tmp_path / "figures").iterdir()}
    pictures = {"mesh.png", "shapes.png", "displacement.png", "von_mises.png", "stretch.png", "animation.mp4"}
    assert pictures | {"energy.svg", "convergence.svg", "stability.svg"} <= found
    assert (tmp_path / "figures" / "animation.mp4").stat().st_size < 2e6
    assert len(html) < 5e6


@pytest.mark.usefixtures("drawable")
def test_pictures_of_a_solid_show_it_on_white_in_colours(beam, tmp_path):
    html = write_report(beam, tmp_path, title="Beam").read_text(encoding="utf-8")
    assert "cut through a cavity" in html
    picture = np.asarray(Image.open(tmp_path / "figures" / "stretch.png"))
    assert (picture[5, -5] == 255).all()
    inked = (picture.min(axis=2) < 250).mean()
    assert 0.02 < inked < 0.9


@pytest.mark.usefixtures("no_pictures")
def test_a_report_without_pictures_says_so_and_why(balloon, tmp_path):
    html = write_report(balloon, tmp_path).read_text(encoding="utf-8")
    assert "Some pictures are missing." in html
    assert "VTK found no OpenGL" in html
    assert "exit code 139" in html
    assert "data:image/svg+xml" in html


@pytest.mark.usefixtures("no_pictures")
def test_all_text_of_the_user_is_escaped(balloon, tmp_path):
    html = write_report(
        balloon,
        tmp_path,
        source="<script>alert(1)</script>",
        command="run <x>",
        asked=[Table("<i>t</i>", ("<b>",), (("<td>",),))],
        comparison=[Comparison("<q>", "<c>", 1.0, 2.0, "<u>", "<n>")],
    ).read_text(encoding="utf-8")
    for raw in ("<script>", "<b>&amp;", "<note>", "<x>", "<i>", "<q>", "<c>", "<u>", "<n>"):
        assert raw not in html
    assert "Balloon &lt;b&gt;&amp; more&lt;/b&gt;" in html
    assert (tmp_path / "comparison.csv").exists()


@pytest.mark.usefixtures("no_pictures")
def test_a_comparison_that_the_folder_holds_is_shown_again(balloon, tmp_path):
    write_report(balloon, tmp_path, comparison=[Comparison("volume", "end", 1.0, 2.0, "mL", "far off")])
    html = write_report(balloon, tmp_path).read_text(encoding="utf-8")
    assert "far off" in html
    assert "+100.0 %" in html


@pytest.mark.usefixtures("no_pictures")
def test_a_reported_curve_without_a_figure_gets_one(balloon, tmp_path):
    other = ReportedCurve("paper", "time", "strain_energy", np.array([0.0, 1.0]), np.array([0.0, 5.0]))
    write_report(balloon, tmp_path, curves=[Curve("Volume", "time", ("volume:cavity",))], reported=[other])
    names = sorted(file.name for file in (tmp_path / "figures").glob("curve-*.svg"))
    assert names == ["curve-1-strain_energy.svg", "curve-2-volume_cavity.svg"]


@pytest.mark.usefixtures("no_pictures")
def test_a_run_that_stopped_says_where_and_why(balloon, tmp_path):
    rows = balloon.history.rows[:3]
    history = type(balloon.history)(balloon.history.columns, rows)
    stopped = replace(
        balloon, states=list(balloon.states)[:3], history=history, status=Status.STOPPED, message="a <wall> buckles"
    )
    html = write_report(stopped, tmp_path).read_text(encoding="utf-8")
    assert "Stopped before the target, after 50 % of phase" in html
    assert "a &lt;wall&gt; buckles" in html
    assert ">warn<" in html


@pytest.mark.usefixtures("no_pictures")
def test_a_run_with_the_state_at_rest_alone_has_a_report(balloon, tmp_path):
    history = type(balloon.history)(balloon.history.columns, balloon.history.rows[:1])
    first = replace(balloon, states=[balloon.states[0]], history=history, status=Status.RUNNING)
    assert "Not finished" in write_report(first, tmp_path).read_text(encoding="utf-8")


def test_a_solution_without_folder_needs_one(beam):
    with pytest.raises(InputError, match="needs a folder"):
        write_report(beam)


def test_a_solution_without_states_is_refused(beam, tmp_path):
    with pytest.raises(InputError, match="no converged state"):
        write_report(replace(beam, states=[]), tmp_path)


def test_a_curve_of_an_unknown_column_is_refused(balloon, tmp_path):
    with pytest.raises(NameNotFoundError, match="unknown column"):
        write_report(balloon, tmp_path, curves=[Curve("x", "time", ("nothing",))])


def test_marks_and_ends_of_phases_are_found(balloon):
    time = balloon.history.values("time")
    assert time[marked_rows(balloon)] == pytest.approx([0.5, 1.0])


def test_captions_name_pressures_or_loads(balloon, beam):
    assert caption(balloon.states[0]) == "at rest"
    assert caption(balloon.states[-1]).endswith("kPa")
    assert caption(beam.states[-1]) == "0.0015 MPa"
    assert caption(replace(beam.states[-1], clock=0.25)) == "0.25 s: 0.0015 MPa"
    assert caption(replace(beam.states[0], clock=0.25)) == "0.25 s"


@pytest.mark.usefixtures("no_pictures")
def test_a_scene_without_opengl_is_an_engine_error():
    with pytest.raises(EngineError, match="cannot be drawn"):
        Scene(View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)))


def test_a_probe_that_cannot_start_is_an_engine_error(monkeypatch):
    render.check.cache_clear()
    monkeypatch.setattr(render.sys, "executable", "/nowhere/python")
    with pytest.raises(EngineError, match="did not run"):
        render.check()
    render.check.cache_clear()


@pytest.mark.usefixtures("drawable")
def test_a_triangle_is_drawn_where_it_is_and_shows_its_colour():
    points = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
    view = View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (2.0, 2.0, 0.0), 4.0, 4.0)
    with Scene(view, 100) as scene:
        picture = scene.draw([Layer(points, np.array([[0, 1, 2]]), colour=(1.0, 0.0, 0.0), shaded=False)])
    assert picture.shape == (100, 100, 3)
    assert tuple(picture[80, 20]) == (255, 0, 0)  # lower left
    assert tuple(picture[20, 80]) == (255, 255, 255)


@pytest.mark.usefixtures("drawable")
def test_a_film_that_cannot_be_encoded_is_an_engine_error(monkeypatch, balloon, tmp_path):
    import imageio_ffmpeg

    from pneumorph.report.drawing import Drawing
    from pneumorph.report.fields import FIELDS

    def broken(*args, **kwargs):
        raise OSError("no ffmpeg here")

    monkeypatch.setattr(imageio_ffmpeg, "write_frames", broken)
    states = list(balloon.states)[:2]
    with pytest.raises(EngineError, match="no ffmpeg here"):
        animation.write_animation(Drawing(states), FIELDS[0], states, tmp_path / "film.mp4")


def test_pictures_are_put_together_without_being_scaled():
    red = np.zeros((60, 80, 3), dtype=np.uint8) + np.array([200, 0, 0], dtype=np.uint8)
    whole = compose([("one", red), ("two", red)], legend={"body": (0.5, 0.5, 0.5)})
    assert (whole == [200, 0, 0]).all(axis=2).sum() == 2 * 60 * 80
    assert encode(whole).startswith(b"\x89PNG")
    assert encode(whole, "webp")[8:12] == b"WEBP"
