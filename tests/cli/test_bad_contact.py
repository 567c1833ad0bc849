"""What is wrong with contacts, feet and gaits: one message and exit code 2; a run that stops keeps its states."""

import pytest

GROUND = 'shape = "half-space"\npoint = ["0 mm", "-0.06 mm"]\nnormal = "y"'
CRAWLER = f"""
[actuator]
template = "crawler-2d"
channels = 2
[mesh]
size = "2.5 mm"
[gravity]
direction = "-y"
[body.ground]
{GROUND}
[[contact]]
name = "floor"
faces = ["rear_foot", "front_foot"]
body = "ground"
friction = 0.7
reach = "0.06 mm"
[[phase]]
name = "rest"
targets = {{ gravity = "9.81 m/s2" }}
duration = "1 s"
inertia = "quasi-static"
first_increment = 0.5
largest_increment = 0.5
[[phase]]
name = "up"
targets = {{ PN1 = "5 kPa" }}
duration = "1 s"
inertia = "quasi-static"
[cycle]
phases = ["up"]
repeat = 1
"""
SOFT = '[material.body]\nlaw = "neo-hookean"\nmu = "30 kPa"\n'
OTHER = """
[part.other]
shift = ["20 mm", "3 mm"]
[part.other.actuator]
template = "crawler-2d"
channels = 2
[part.other.mesh]
size = "2.5 mm"
[[contact]]
name = "pair"
faces = ["outer"]
against = ["other.rear_foot", "other.front_foot", "other.outer"]
"""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("friction = 0.7", "friction = -0.1", ["contact 'floor': friction = -0.1, allowed: 0 to 5"]),
        ("friction = 0.7", "friction = 5.5", ["contact 'floor': friction = 5.5, allowed: 0 to 5"]),
        ("PN1 =", "PN9 =", ["phase 'up': unknown target 'PN9'", "Allowed: PN1, PN2, PN3, gravity"]),
        ("repeat = 1", "repeat = 0", ["cycle: repeat = 0, allowed: a whole number of at least 1; every cycle has an"]),
        ("repeat = 1", "repeat = inf", ["cycle.repeat = inf"]),
        ("[mesh]", SOFT + "[mesh]", ["material of 'body' has no density"]),
        (
            '"-0.06 mm"',
            '"0.5 mm"',
            ["contact 'floor': rear_foot, front_foot and HalfSpace 'ground' intersect at (", "by 0.56 mm along (0"],
        ),
        (
            GROUND,
            'shape = "block"\nlower = ["10 mm", "-5 mm"]\nupper = ["70 mm", "0.5 mm"]',
            ["rear_foot, front_foot and Block 'ground' intersect at (", "free is 0.50", "along (0, 1)"],
        ),
        ("[gravity]", OTHER + "[gravity]", ["part 'other' intersect at (", "the smallest shift along an axis"]),
    ],
    ids=[
        "friction below 0", "friction above 5", "unknown cavity", "no cycle", "no end", "no density", "in the ground",
        "in a block", "in another body",
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_gait_is_refused_with_one_message(pneumorph, tmp_path, old, new, words):
    assert CRAWLER.count(old) == 1
    study = tmp_path / "wrong.toml"
    study.write_text(CRAWLER.replace(old, new))
    result = pneumorph("run", study, "--no-report", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    for word in words:
        assert word in result.stderr
    assert not (tmp_path / "out" / "run.json").exists()


PRESSED = """
[body.lid]
shape = "block"
lower = ["20 mm", "10.5 mm"]
upper = ["40 mm", "15 mm"]
direction = "-y"
[[contact]]
name = "top"
faces = ["outer"]
body = "lid"
[[phase]]
name = "press"
targets = { lid = "20 mm" }
duration = "1 s"
inertia = "quasi-static"
first_increment = 0.1
largest_increment = 0.2
smallest_increment = 0.08
"""


def test_a_contact_that_cannot_go_on_stops_with_its_states_and_says_which_pair(pneumorph, tmp_path):
    study = tmp_path / "pressed.toml"
    study.write_text(CRAWLER[: CRAWLER.index('[[phase]]\nname = "up"')] + PRESSED)
    result = pneumorph("run", study, "--no-report", "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert "stopped in phase 'press'" in result.stderr
    assert "'top' between outer and Block 'lid'" in result.stderr
    assert len(list((tmp_path / "out" / "states").iterdir())) >= 3
