"""`pneumorph reproduce soft-wheel --part limb`: folder, report, resuming, export of the wheel, bad input."""

import csv
import json

import pytest

from pneumorph.geometry import SoftLimb
from pneumorph.mechanics import Phase, Programme
from pneumorph.mesh import generate
from pneumorph.report import limb as report
from pneumorph.studies.reproductions import soft_wheel_limb as part

COMMAND = ("reproduce", "soft-wheel", "--part", "limb", "--quick")
SMALL = SoftLimb(chambers=2, length=55.0, half=True)


@pytest.fixture
def small(monkeypatch):
    """Two pleats on a coarse mesh, each phase in one increment, and no pictures: those are what costs most."""
    whole, case = part.LimbStudy.__init__, part.LimbStudy.case
    monkeypatch.setattr(part.LimbStudy, "__init__", lambda self, quick=False, limb=SMALL: whole(self, quick, limb))
    monkeypatch.setattr(part.LimbStudy, "mesh", lambda self: generate(self.limb, 10.0, detail=0.2))

    def short(self, name, mesh):
        made = case(self, name, mesh)
        phases = tuple(
            Phase(p.name, {key: 0.02 * value for key, value in p.targets.items()}, first=1.0, largest=1.0)
            for p in made.programme.phases
        )
        return part.LimbCase(made.name, made.title, made.model, Programme(phases), made.measures)

    monkeypatch.setattr(part.LimbStudy, "case", short)

    def fail():
        raise report.EngineError("no OpenGL here")

    monkeypatch.setattr(report, "check", fail)


def test_the_cases_are_run_and_reported_resumed_and_exported(pneumorph, small, tmp_path):
    folder = tmp_path / "run"
    result = pneumorph(*COMMAND, "--out", folder)
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in folder.iterdir() if path.is_dir()) == [
        "bending", "blocked", "figures", "load", "wheels",
    ]  # fmt: skip
    with (folder / "comparison.csv").open() as file:
        rows = {(row["quantity"], row["condition"]): row for row in csv.DictReader(file)}
    assert rows["height of the wheel", "neutral"]["computed"]
    assert rows["height of the wheel", "full"]["computed"] == ""  # the short run does not get there
    assert (folder / "wheels" / "neutral.stl").stat().st_size > 84
    assert not (folder / "wheels" / "full.stl").exists()
    page = (folder / "report.html").read_text()
    assert "no OpenGL here" in page
    assert "Blocked force, foot held" in page

    again = pneumorph(*COMMAND, "--out", folder)
    assert again.exit_code == 2
    assert "already holds a run: resume it (--resume)" in again.output
    assert pneumorph(*COMMAND, "--out", folder, "--resume").exit_code == 0
    (folder / "report.html").unlink()
    assert pneumorph("report", folder).exit_code == 0
    assert (folder / "report.html").exists()

    wheel = tmp_path / "wheel.stl"
    exported = pneumorph("export", folder / "bending", "--to", wheel, "--part", "wheel", "--state", "0.3 kPa")
    assert exported.exit_code == 0, exported.output
    assert "4 closed limbs" in exported.output
    beyond = pneumorph("export", folder / "bending", "--to", tmp_path / "w.stl", "--part", "wheel", "--state", "30 kPa")
    assert beyond.exit_code == 2
    assert "allowed: 0 kPa to 0.6 kPa" in beyond.output
    other = pneumorph("export", folder / "bending", "--to", tmp_path / "w.vtu", "--part", "wheel")
    assert other.exit_code == 2
    assert "--part wheel: only a state as .stl" in other.output

    record = json.loads((folder / "limb.json").read_text())
    (folder / "limb.json").write_text(json.dumps(record | {"quick": False}))
    assert "another run of this part" in pneumorph(*COMMAND, "--out", folder, "--resume").output
    (folder / "limb.json").write_text(json.dumps({"part": "limb"}))
    assert "limb.json is damaged" in pneumorph("report", folder).output
    (folder / "limb.json").write_text("{")
    assert "limb.json cannot be read" in pneumorph("report", folder).output


def test_options_of_other_parts_are_refused(pneumorph):
    result = pneumorph(*COMMAND, "--radius", "140 mm")
    assert result.exit_code == 2
    assert "--radius: the part 'limb' does not take this option" in result.output


def test_a_folder_without_states_has_nothing_to_report(tmp_path):
    with pytest.raises(report.InputError, match="holds no converged state"):
        report.write_limb_report(tmp_path, part.LimbStudy(True), {})
