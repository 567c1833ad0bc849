import contextlib
import csv
import io
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.progress import clock, facts, plain_line, progress_on
from pneumorph.measures import ChordAngle
from pneumorph.solution import Solution, Status
from pneumorph.studies import load_study

ROOT = Path(__file__).parents[2]


def test_a_study_is_solved_into_a_folder_with_progress_line_by_line(pneumorph, study, tmp_path):
    out = tmp_path / "out"
    result = pneumorph("run", study, "--out", out, "--no-report")
    assert result.exit_code == 0
    assert result.stderr == ""
    assert re.search(r"50 %  state 1  phase inflate  pressure 10 kPa  iterations \d+ \(\d+ in all\)", result.stdout)
    assert "done: 3 states" in result.stdout
    assert Solution.open(out).status is Status.DONE
    assert load_study(out / "study.toml").resolved() == load_study(study).resolved()
    rows = list(csv.DictReader((out / "history.csv").open()))
    assert float(rows[-1]["pressure:cavity [kPa]"]) == pytest.approx(20.0)


def test_the_default_folder_bears_the_name_of_the_study(pneumorph, study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert pneumorph("run", study, "--no-report").exit_code == 0
    assert (tmp_path / "runs" / "sphere" / "history.csv").exists()


def test_a_run_that_cannot_reach_its_target_ends_with_3_and_keeps_its_states(pneumorph, study, tmp_path):
    # above the pressure maximum of the sphere there is no state at all
    study.write_text(study.read_text().replace("20 kPa", "80 kPa") + "smallest_increment = 0.05\n")
    result = pneumorph("run", study, "--out", tmp_path / "out", "--no-report")
    assert result.exit_code == 3
    assert result.stderr.startswith("stopped before the target: ")
    assert "states are kept in" in result.stderr
    solution = Solution.open(tmp_path / "out")
    assert solution.status is Status.STOPPED
    assert len(solution.states) > 1


def test_a_killed_run_goes_on_with_resume(pneumorph, study, tmp_path):
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    assert pneumorph("run", study, "--out", whole, "--no-report").exit_code == 0
    assert pneumorph("run", study, "--out", broken, "--no-report").exit_code == 0
    (broken / "states" / "state_00002.vtkhdf").unlink()
    record = (broken / "run.json").read_text().replace('"status": "done"', '"status": "running"')
    (broken / "run.json").write_text(record)
    result = pneumorph("run", study, "--out", broken, "--no-report", "--resume")
    assert result.exit_code == 0
    assert "state 0" not in result.stdout
    assert (broken / "history.csv").read_text() == (whole / "history.csv").read_text()


def test_ctrl_c_says_how_to_go_on(study, tmp_path):
    study.write_text(study.read_text().replace("_increment = 0.5", "_increment = 0.001"))
    command = [sys.executable, "-c", "from pneumorph.cli.app import main; main()", "run", str(study)]
    run = subprocess.Popen(
        [*command, "--out", str(tmp_path / "out")], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # jobs in the background ignore it
    )  # fmt: skip
    end = time.monotonic() + 60.0
    while not (tmp_path / "out" / "states" / "state_00002.vtkhdf").exists() and time.monotonic() < end:
        time.sleep(0.05)
    run.send_signal(signal.SIGINT)
    _, complaint = run.communicate(timeout=60)
    assert run.returncode == 130
    assert f"go on with: pneumorph run {study} --out {tmp_path / 'out'} --resume" in complaint
    assert "Traceback" not in complaint


@pytest.fixture
def listening():
    """Ctrl-C as in the foreground, also where the tests run in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_an_interrupt_that_is_dropped_is_raised_at_the_next_state(listening):
    with Interrupt() as interrupt:
        interrupt.check()
        with contextlib.suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)
        with pytest.raises(KeyboardInterrupt):
            interrupt.check()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_the_version_is_printed(pneumorph):
    result = pneumorph("--version")
    assert result.exit_code == 0
    assert re.fullmatch(r"pneumorph \d+\.\d+\.\d+\n", result.stdout)


def test_the_entry_point_is_the_command_line():
    result = subprocess.run(
        [sys.executable, "-c", "from pneumorph.cli.app import main; main()", "--help"],
        capture_output=True, text=True, check=True, env={**os.environ, "TERM": "dumb", "COLUMNS": "120"},
    )  # fmt: skip
    for command in ("run", "reproduce", "report", "doctor"):
        assert command in result.stdout


def _news(pressure):
    state = SimpleNamespace(index=7, phase="inflate", pressure=pressure, iterations=4, unstable_modes=1)
    row = {"chord_angle": 0.5}
    return SimpleNamespace(state=state, row=row, fraction=0.42, elapsed=75.0, remaining=None, total_iterations=31)


def test_progress_names_step_pressure_angle_iterations_and_time_left():
    line = plain_line(_news({"a": 0.04, "b": 0.04}), (ChordAngle(),))
    assert line.startswith(" 42 %  state 7  phase inflate  pressure 40 kPa  chord angle 28.65 deg  iterations 4 (31 in")
    assert "unstable modes 1" in line
    assert line.endswith("elapsed 1 min 15 s  left not known yet")


def test_cavities_with_their_own_pressures_are_named():
    told = facts(_news({"a": 0.04, "b": 0.0, "c": 0.0}), ())
    assert told["pressure a"] == "40 kPa"
    assert told["pressure b, c"] == "0 kPa"


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0 s"), (59.7, "1 min 00 s"), (185, "3 min 05 s"), (4020, "1 h 07 min")]
)
def test_times_are_written_for_people(seconds, text):
    assert clock(seconds) == text


def test_a_terminal_gets_a_live_display():
    screen = io.StringIO()
    with progress_on(Console(file=screen, force_terminal=True, width=80), (ChordAngle(),)) as tell:
        tell(_news({"a": 0.04}))
    shown = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", screen.getvalue())
    for text in ("42 %", "inflate", "40 kPa", "28.65 deg", "4 (31 in all)", "not known yet"):
        assert text in shown


def test_a_job_that_ignores_ctrl_c_goes_on_ignoring_it(listening):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with Interrupt():
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_the_last_line_says_how_close_surfaces_and_cells_came(pneumorph, study, tmp_path):
    done = r"done: \d+ states, \d+ Newton iterations, smallest det F \d\.\d+"
    result = pneumorph("run", study, "--out", tmp_path / "free", "--no-report")
    assert re.search(done + "$", result.stdout.strip())
    wall = '[body.wall]\nshape = "half-space"\npoint = ["{} mm", "0 mm", "0 mm"]\nnormal = "-x"\n'
    touch = '[[contact]]\nfaces = ["outer"]\nbody = "wall"\n'
    for place, said in (("15.02", r"0\.\d+ mm"), ("50", "none within reach")):
        study.write_text(study.read_text().split("[body.wall]")[0] + wall.format(place) + touch)
        result = pneumorph("run", study, "--out", tmp_path / place, "--no-report")
        assert re.search(f"{done}, smallest distance {said}$", result.stdout.strip())
