import numpy as np
import pytest

from pneumorph.geometry import Finger
from pneumorph.mesh import generate
from pneumorph.mesh.findings import cavities_found
from pneumorph.report import labels, named_faces
from pneumorph.report.labels import anchors, key_colours, labelled


def test_a_name_points_to_the_middle_of_what_shows_of_it():
    colours = key_colours(["left", "right", "unseen"])
    picture = np.full((40, 60, 3), 255, dtype=np.uint8)
    picture[5:36, :31] = np.rint(255 * np.array(colours["left"]))
    picture[10:21, 40:51] = np.rint(255 * np.array(colours["right"]))
    picture[0, :] = np.rint(255 * np.array(colours["unseen"]))  # one pixel wide: a border
    found = anchors(picture, colours)
    assert set(found) == {"left", "right"}
    assert found["left"] == pytest.approx((15, 20), abs=1)
    assert found["right"] == (45.0, 15.0)


def test_key_colours_differ_and_white_is_none_of_them():
    colours = key_colours([str(i) for i in range(200)])
    assert len(set(colours.values())) == 200
    assert (1.0, 1.0, 1.0) not in colours.values()


def test_labels_stand_apart_beside_the_picture():
    places = {str(i): (10.0 + i, 50.0) for i in range(5)}
    arranged = labels._arranged(places, 800.0, 0.0, 400.0)
    heights = sorted(place[1] for place, _ in arranged.values())
    assert np.diff(heights).min() >= labels._LINE - 1e-9
    panel = ("Here", np.zeros((300, 400, 3), np.uint8), places)
    picture = labelled([panel], dict.fromkeys(places, (1.0, 0.0, 0.0)), {})
    assert picture.shape == (300 + labels._CAPTION * 3 // 2, 400 + 2 * labels._MARGIN, 3)


def test_the_cut_shows_the_cavity_and_the_outside_hides_it(monkeypatch):
    """Names that the picture points to: the walls of a closed cavity in the cut only."""
    seen = []

    def listen(panels, colours, words):
        seen.extend((caption, set(places)) for caption, _, places in panels)
        return labelled(panels, colours, words)

    monkeypatch.setattr(named_faces, "labelled", listen)
    finger = Finger(chambers=2, length=30.0)
    mesh = generate(finger, coarse=True)
    picture = named_faces.named_faces_picture(mesh, cavities_found(mesh, finger))
    assert picture.dtype == np.uint8
    (_, first), (_, second), (caption, cut) = seen
    assert caption == "Cut along the body"
    assert "cavity" in cut
    assert "cavity" not in first | second
    assert {"clamp", "tip", "outer"} <= first | second
    assert "domain body" in cut
