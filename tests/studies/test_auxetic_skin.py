"""The reproduction of the auxetic skin: which designs, and what is made of their results; the runs are elsewhere."""

import json
import math

import pytest

from pneumorph.errors import NameNotFoundError
from pneumorph.report.skins import trend_figure, write_skin_report
from pneumorph.solution import Column, History
from pneumorph.studies import reproductions
from pneumorph.studies.reproductions import auxetic_skin as skins
from pneumorph.studies.reproductions.auxetic_skin import Skin, SkinStudy
from pneumorph.studies.reproductions.auxetic_tension import KINDS, WAYS, tension, tension_findings
from pneumorph.studies.sweeps import SweepTable

RESULTS = ("curvature", "edge_curvature", "diameter", "tip_rotation", "pressure")
KEYS = [f"{name}{place}" for place in ("", " at 75 mL", " at pressure") for name in RESULTS]


def reported(skin):
    """Both curvatures, diameter, tip rotation, pressure as the study describes them, and as it reports both corners."""
    nv, nh = (skin.along - 5) / 4.0, (20 - skin.around) / 8.0
    share = skin.reentrant
    bend = (0.5 - skin.cg) / 0.3 * 4.0 * share * (1.0 - share)
    curvature = bend * (0.0077 + 0.0018 * nv + 0.0002 * nh) * (1.0 + 1e-4 * skin.ratio)
    diameter = 44.0 - 2.0 * nv - 3.6 * nh + 2.0 * (share - 0.5) + 1e-4 * skin.ratio
    return curvature, curvature, diameter, 104.3 * curvature, 0.0005 * skin.ratio * (1.0 + 0.1 * nv - 0.05 * nh)


def table_of(study, values=reported, missing=()):
    columns = [Column(key, key, "number") for key in KEYS]
    columns += [Column("wall_time", "wall time", "time"), Column("status", "status", "text")]
    columns += [Column("message", "message", "text"), Column("identity", "identity", "text")]
    rows = []
    for skin in study.skins:
        numbers = [math.nan] * len(RESULTS) if skin in missing else values(skin)
        row = dict(zip(KEYS, [*numbers] * 3, strict=True))
        rows.append(row | {"wall_time": 1.0, "status": "done", "message": "", "identity": ""})
    return SweepTable((), (), History(columns, rows))


@pytest.mark.parametrize("quick", [True, False])
def test_all_reported_designs_are_in_the_sweep(quick):
    study = SkinStudy(quick)
    sweep = study.sweep
    assert len(sweep.designs) == len(study.skins) == (14 if quick else 19)
    assert all(design.study is not None for design in sweep.designs)
    assert len({design.identity for design in sweep.designs}) == len(sweep.designs)
    wanted = {Skin(*pair) for pair in skins.CORNERS} | {Skin(along=n) for n in (5, 7, 9)}
    wanted |= {Skin(around=n) for n in (12, 16, 20)} | {Skin(ratio=r) for r in (20, 50, 80)}
    wanted |= {Skin(cg=c) for c in (0.2, 0.4, 0.5)} | {Skin(reentrant=n / 12) for n in (0, 6, 12)}
    assert wanted <= set(study.skins)
    if not quick:
        assert {Skin(nv, nh) for nv in (5, 7, 9) for nh in (12, 16, 20)} <= set(study.skins)
        assert {Skin(reentrant=n / 12) for n in range(0, 13, 2)} <= set(study.skins)


def test_a_design_is_half_the_tube_at_half_the_volume_with_its_moduli():
    study = SkinStudy()
    made = dict(zip(study.skins, study.sweep.designs, strict=True))[Skin(ratio=80.0)].study
    assert made.actuator.half
    assert made.programme.phases[0].targets == {"cavity": pytest.approx(37500.0)}
    assert made.materials["skin"].mu == pytest.approx(80 * 0.037)
    assert made.materials["skin"].bulk == pytest.approx(50 * 80 * 0.037)
    assert made.materials["tube"].bulk == pytest.approx(50 * 0.037)


@pytest.mark.parametrize("quick", [True, False])
def test_every_statement_holds_for_numbers_as_the_study_reports_them(quick):
    study = SkinStudy(quick)
    found = skins.findings(study, table_of(study))
    assert [item.row.quantity for item in found if item.holds is not True] == []
    corner = [item.row for item in found if item.row.condition == "9 x 12 cells, 75 mL"]
    assert [row.reported for row in corner] == [0.0097, 38.4]


def test_no_statement_about_order_holds_for_numbers_the_other_way_round():
    study = SkinStudy(True)

    def turned(skin):
        curvature, _, diameter, tip, pressure = reported(skin)
        return 0.03 - curvature, 0.03 - curvature, 100.0 - diameter, 5.0 - tip, 0.1 - pressure

    for item in skins.findings(study, table_of(study, turned)):
        if "relative" not in item.row.quantity:
            assert item.holds is False, item.row.quantity


def test_a_trend_must_hold_at_every_step():
    study = SkinStudy(True)

    def bent(skin):
        curvature, edge, *rest = reported(skin)
        return (curvature, edge * (0.8 if skin == Skin() else 1.0), *rest)

    found = skins.findings(study, table_of(study, bent))
    trends = [item for item in found if item.row.quantity == "edge curvature, last / first"]
    (item,) = [item for item in trends if "cells along" in item.row.condition]
    assert item.row.computed > 1.0
    assert item.holds is False


def test_what_was_not_computed_has_no_value():
    study = SkinStudy(True)
    found = skins.findings(study, table_of(study, missing=[Skin(cg=0.5), Skin(9, 12)]))
    straight = next(item for item in found if item.row.quantity == "tip rotation, size")
    assert (straight.row.computed, straight.holds) == (None, None)
    assert all(item.holds is None for item in found if item.row.condition == "9 x 12 cells, 75 mL")


def test_cells_in_tension_scale_with_their_modulus():
    """Neo-Hookean with a bulk modulus in proportion: stress is, strains are not changed."""
    soft, stiff = (tension("re-entrant", "along", ratio=ratio) for ratio in (20.0, 80.0))
    assert stiff.stiffness == pytest.approx(4.0 * soft.stiffness, rel=1e-6)
    assert stiff.lateral == pytest.approx(soft.lateral, rel=1e-6)


def test_cells_in_tension_are_softer_than_what_they_are_made_of():
    """Beams parallel to the pull bear at most their share of the width: Voigt's bound."""
    solid = 3.0 * 50.0 * 0.037
    assert all(0.0 < tension(kind, way).stiffness < solid for kind in KINDS for way in WAYS)


@pytest.mark.slow
def test_flat_sheets_follow_the_reported_signs():
    signs = [item for item in tension_findings() if "lateral strain, " in item.row.quantity]
    assert len(signs) == 4
    assert all(item.holds for item in signs)


def test_a_report_is_written_of_what_there_is(tmp_path, monkeypatch):
    monkeypatch.setattr("pneumorph.report.skins.write_sweep_report", lambda sweep, table, folder, command: folder / "x")
    study = SkinStudy(True)
    table = table_of(study, missing=[Skin(cg=0.4)])
    path = write_skin_report(study, table, skins.findings(study, table), tmp_path, "pneumorph ...")
    text = path.read_text(encoding="utf-8")
    assert "not computed" in text
    assert "9 x 12 cells, 75 mL" in text
    lines = (tmp_path / "comparison.csv").read_text().splitlines()
    assert len(lines) == 1 + len(skins.findings(study, table))
    assert b"<svg" in trend_figure(study, table)


def test_it_is_known_by_its_name():
    item = reproductions.reproduction("auxetic-skin")
    assert isinstance(item, reproductions.SystemBySweep)
    assert "113334" in item.source
    assert "auxetic-skin" in reproductions.names()
    with pytest.raises(NameNotFoundError, match="'auxetic-skn': did you mean 'auxetic-skin'"):
        reproductions.reproduction("auxetic-skn")


def test_options_of_other_systems_are_refused():
    from typer.testing import CliRunner

    from pneumorph.cli.app import app

    for options, message in (
        (["--part", "rigid"], "--part: rigid, allowed for auxetic-skin: shapes; none for its sweep"),
        (["--beds", "2"], "--beds: the sweep does not take this option"),
        (["--part", "shapes", "--scheduler", "tcp://x"], "--scheduler: the part 'shapes' does not take this option"),
    ):
        result = CliRunner().invoke(app, ["reproduce", "auxetic-skin", *options])
        assert result.exit_code == 2
        assert message in result.output


@pytest.mark.parametrize(("status", "code"), [("done", 0), ("stopped", 3)])
def test_the_command_reports_and_says_how_it_ended(tmp_path, monkeypatch, status, code):
    from typer.testing import CliRunner

    from pneumorph.cli import skins as command
    from pneumorph.cli.app import app

    table = table_of(SkinStudy(True))
    table.rows.rows[0]["status"] = status
    monkeypatch.setattr(command, "run_sweep", lambda sweep, folder, **settings: table)
    monkeypatch.setattr(command, "tension_findings", tuple)
    written = []
    monkeypatch.setattr("pneumorph.report.skins.write_skin_report", lambda *given: written.append(given))
    out = tmp_path / "out"
    result = CliRunner().invoke(app, ["reproduce", "auxetic-skin", "--quick", "--out", str(out)])
    assert result.exit_code == code
    assert "14 designs, " in result.output
    held = sum(item.holds is True for item in skins.findings(SkinStudy(True), table))
    assert f"{held} of {held} statements of the study hold" in result.output
    assert written[0][1] is table
    assert json.loads((out / "skins.json").read_text())["quick"] is True
    assert written[0][3:] == (out, f"pneumorph reproduce auxetic-skin --quick --out {out}")
