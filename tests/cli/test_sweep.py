"""`pneumorph sweep` from the command line; the workers themselves are tested with the sweeps."""

from io import StringIO

import pytest
from rich.console import Console

from pneumorph.cli.sweeping import progress_of
from pneumorph.studies.sweeps import SweepProgress, Workers, load_sweep
from pneumorph.studies.sweeps.compute import Record

TEXT = 'study = "sphere.toml"\n[parameters]\nactuator.outer_radius = ["9 mm", "14 mm", "15 mm"]\n'


@pytest.fixture
def file(study, tmp_path):
    path = tmp_path / "radii.toml"
    path.write_text(TEXT)
    return path


@pytest.fixture
def here(monkeypatch):
    """Compute in this process; the calls are kept."""
    seen = []

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            seen.append((self, call))
            yield number, function(*call)

    monkeypatch.setattr(Workers, "compute", compute)
    return seen


def test_a_sweep_says_what_it_does_and_what_it_wrote(pneumorph, here, file, tmp_path):
    result = pneumorph("sweep", file, "--out", tmp_path / "out", "--workers", 1)
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    assert lines[0] == "Octant of a sphere: 3 designs, 1 worker of one thread on this machine"
    assert "0/2  starting workers" in lines[2]
    assert "1/2  design 2  actuator.outer_radius 14 mm  done in" in lines[3]
    assert "left about" in lines[3]
    assert lines[-1] == "1 refused, 2 done of 3 designs"
    assert (tmp_path / "out" / "report.html").exists()
    again = pneumorph("sweep", file, "--out", tmp_path / "out")
    assert again.exit_code == 2
    assert "already holds a sweep" in again.stderr
    again = pneumorph("sweep", file, "--out", tmp_path / "out", "--resume", "--no-report")
    assert again.exit_code == 0
    assert "2/2  kept from before" in again.stdout
    assert len(here) == 2


def test_a_sweep_with_a_failed_design_ends_with_exit_code_3(pneumorph, here, file, monkeypatch, tmp_path):
    def fail(*_, **__):
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("pneumorph.studies.sweeps.compute.run_study", fail)
    result = pneumorph("sweep", file, "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert "design 3  actuator.outer_radius 15 mm  failed in 0 s  ZeroDivisionError: oh" in result.stdout
    assert "1 refused, 2 failed of 3 designs" in result.stdout


def test_an_interrupted_sweep_says_how_to_go_on(pneumorph, file, monkeypatch, tmp_path):
    def stop(self, function, calls):
        raise KeyboardInterrupt

    monkeypatch.setattr(Workers, "compute", stop)
    result = pneumorph("sweep", file, "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert f"go on with: pneumorph sweep {file} --out {tmp_path / 'out'} --resume" in result.stderr
    assert (tmp_path / "out" / "table.csv").read_text().count("not computed") == 2


def test_the_slurm_section_is_used_unless_the_command_line_names_workers(pneumorph, file, monkeypatch, tmp_path):
    seen = []
    monkeypatch.setattr(Workers, "compute", lambda self, function, calls: seen.append(self) or [])
    file.write_text(TEXT + '[slurm]\njobs = 2\nmemory = "4 GB"\nwalltime = "01:00:00"\n')
    assert "2 SLURM jobs" in pneumorph("sweep", file, "--out", tmp_path / "a", "--no-report").stdout
    assert seen[-1].slurm.jobs == 2
    pneumorph("sweep", file, "--out", tmp_path / "b", "--no-report", "--workers", 1)
    assert seen[-1].slurm is None


def test_a_terminal_shows_a_bar_with_the_time_left_and_a_line_for_what_is_not_done(file):
    sweep, out = load_sweep(file), StringIO()
    stopped = Record("stopped", "at 0.5", wall_time=3.0)
    with progress_of(Console(file=out, force_terminal=True, width=120, highlight=False), sweep) as tell:
        tell(SweepProgress(None, None, 0, 2, 0.0, None))
        tell(SweepProgress(sweep.designs[1], Record("done"), 1, 2, 60.0, 61.0))
        tell(SweepProgress(sweep.designs[2], stopped, 2, 2, 121.0, 0.0))
    shown = out.getvalue()
    assert "designs" in shown
    assert "2/2" in shown
    assert "elapsed 2 min 01 s" in shown
    assert "design 3  actuator.outer_radius 15 mm  stopped in 3 s  at 0.5" in shown
    assert "design 2" not in shown


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (TEXT, ["--workers", "0"], "workers = 0: expected at least 1"),
        (TEXT, ["--workers", "2", "--scheduler", "tcp://a:1"], "a running scheduler has its own workers"),
        (TEXT, ["--retry"], "--retry goes with --resume"),
        (TEXT.replace("outer_radius", "outer_radis"), [], "unknown key 'outer_radis': did you mean 'outer_radius'?"),
        (TEXT.replace("9 mm", "9 kPa"), [], "outer_radius = '9 kPa': expected length"),
        (TEXT + "[sampling]\nmethod = 3\n", [], "sampling.method = 3"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(pneumorph, here, file, tmp_path, text, options, words):
    file.write_text(text)
    result = pneumorph("sweep", file, "--out", tmp_path / "out", *options)
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert words in result.stderr
    assert not (tmp_path / "out").exists()
    assert here == []
