"""The reduced limb against a chain whose law is known in closed form, and against statics."""

import json
from dataclasses import replace

import numpy as np
import pytest
from tests.terrain.limbs import HINGES, PRESSURES, data_of, known_limb

from pneumorph.errors import InputError, StorageError
from pneumorph.terrain.limb import ReducedLimb, chain
from pneumorph.terrain.limb_data import SHIPPED, LimbData, read_limb_data
from pneumorph.terrain.limb_fit import errors, fit_limb


def test_the_fit_recovers_a_known_law():
    limb, fit = known_limb(), fit_limb(data_of())
    np.testing.assert_allclose(fit.limb.rest, limb.rest, rtol=1e-6)
    np.testing.assert_allclose(fit.limb.compliance, limb.compliance, rtol=1e-6)
    assert fit.limb.pressures == (0.0, 0.03)
    assert fit.limb.monotone
    assert max(fit.fitted.bounds.values()) < 1e-6
    assert fit.held_out is None


def test_held_out_cases_do_not_move_the_fit_and_are_measured():
    data = data_of(held_out=((0.015, (0.0, 0.0)),))
    wrong = data.rotations.copy()
    wrong[-1] += np.radians(2.0) * np.arange(HINGES + 1)
    fit = fit_limb(replace(data, rotations=wrong))
    np.testing.assert_allclose(fit.limb.rest, known_limb().rest, rtol=1e-6)
    assert fit.held_out.data.held_out.all()
    np.testing.assert_allclose(np.degrees(fit.held_out.angle_error), -2.0, rtol=1e-6)
    assert fit.held_out.bounds["rotation_error"] == pytest.approx(np.radians(2.0) * HINGES, rel=1e-6)


def test_errors_are_bounds_of_angle_and_moment_that_belong_together():
    fit = fit_limb(data_of(noise=np.radians(0.1)))
    fitted = fit.fitted
    assert not fit.limb.stop_stiffness.any()
    stiffness = fit.limb.stiffness(fitted.data.pressures)
    np.testing.assert_allclose(fitted.moment_error, -stiffness * fitted.angle_error, rtol=1e-9, atol=1e-9)
    assert 0.0 < np.degrees(fitted.bounds["angle_error"]) < 0.4
    bound = fitted.bounds["angle_error"]
    assert np.abs(fitted.angle_error).max() == bound
    # noise of 0.1 degrees, of which the fit takes some
    assert 0.03 < np.degrees(np.sqrt(np.mean(fitted.angle_error**2))) < 0.12


def test_links_that_stretch_show_in_the_error_of_the_tip():
    data = data_of()
    fit = fit_limb(replace(data, load_points=data.load_points + np.array([0.0, 3.0])))
    assert fit.fitted.bounds["link_error"] == pytest.approx(3.0)
    assert fit.fitted.bounds["tip_error"] == pytest.approx(3.0, abs=1e-6)


def test_a_straight_chain_bends_under_a_small_force_as_its_hinges_say():
    limb = ReducedLimb(
        np.array([[10.0, 0.0], [30.0, 0.0]]), np.array([60.0, 0.0]), np.array([60.0, 0.0]), np.zeros((2, 1)),
        np.array([[1e-3], [2e-3]]), np.zeros((2, 1)), np.zeros(2), (0.0, 1.0), (1.0, 1.0), 10.0,
        0.0, (0.0, 0.0, 0.0),
    )  # fmt: skip
    # moment of 1 mN at 60 mm about hinges at 10 and 30 mm
    np.testing.assert_allclose(limb.equilibrium(0.0, (0.0, 1e-3)), [50e-6, 60e-6], rtol=1e-6)


def test_the_fit_finds_stops_where_pleats_touch():
    forces = [(-0.8 * k, 0.9 * k) for k in (0.3, 0.6, 1.0, 1.5)] + [(0.6, 0.5), (0.3, 0.2), (0.0, 0.0)]
    limb = known_limb(stops=True)
    fit = fit_limb(data_of(limb, forces=forces))
    assert fit.fitted.bounds["angle_error"] < np.radians(0.01)
    stopped = [
        n
        for n in range(HINGES)
        if (fit.fitted.angles[:, n] < limb.stop_angles(fit.fitted.data.pressures)[:, n]).sum() > 3
    ]
    assert len(stopped) >= 2
    np.testing.assert_allclose(fit.limb.stop_stiffness[stopped], 4_000.0, rtol=0.01)
    np.testing.assert_allclose(fit.limb.stop_angles(0.0)[stopped], -0.03, atol=1e-3)


def test_springs_are_the_derivatives_of_their_energy_on_both_sides_of_a_stop():
    springs = known_limb(stops=True).springs(0.01)
    for angles in (springs.stop + 0.05, springs.stop - 0.05):
        step = 1e-6
        slope = (springs.energy(angles + step) - springs.energy(angles - step)) / (2.0 * step)
        np.testing.assert_allclose(springs.moment(angles), slope, rtol=1e-6)
        slope = (springs.moment(angles + step) - springs.moment(angles - step)) / (2.0 * step)
        np.testing.assert_allclose(springs.tangent(angles), slope, rtol=1e-6)
        np.testing.assert_allclose(springs.angles(springs.moment(angles)), angles)
        stiffness, rest = springs.as_lines(angles)
        np.testing.assert_allclose(stiffness * (angles - rest), springs.moment(angles))


def test_the_loaded_chain_has_the_least_potential_energy():
    limb, force = known_limb(), np.array([-0.9, 0.7])
    angles = limb.equilibrium(0.02, force)

    def energy(theta):
        strain = 0.5 * limb.stiffness(0.02) @ (theta - limb.rest_angles(0.02)) ** 2
        return strain - force @ limb.shape(theta)[1]

    least = energy(angles)
    for step in 1e-3 * np.vstack([np.eye(HINGES), -np.eye(HINGES)]):
        assert energy(angles + step) > least
    slope = [(energy(angles + s) - energy(angles - s)) / 2e-5 for s in 1e-5 * np.eye(HINGES)]
    np.testing.assert_allclose(slope, 0.0, atol=1e-4)
    assert np.abs(limb.equilibrium(0.02, (0.0, 0.0)) - angles).max() > 0.02


def test_a_chain_that_turns_as_a_whole_keeps_its_lengths():
    limb = known_limb()
    rest, tip = chain(limb.links, np.zeros(HINGES))
    np.testing.assert_allclose(rest, limb.hinges)
    np.testing.assert_allclose(tip, limb.load_point)
    turned, end = chain(limb.links, np.array([0.5, 0.0, 0.0, 0.0, 0.0]))
    lengths = [np.linalg.norm(np.diff(np.vstack([h, t]), axis=0), axis=1) for h, t in ((rest, tip), (turned, end))]
    np.testing.assert_allclose(lengths[0], lengths[1])


def test_rest_angles_that_turn_back_are_seen():
    limb = known_limb()
    back = replace(limb, rest=np.stack([np.full(HINGES, 1.0), np.full(HINGES, -50.0)], axis=1))
    assert limb.monotone
    assert not back.monotone


def test_a_pressure_outside_the_fitted_range_is_refused():
    limb = known_limb()
    with pytest.raises(InputError, match=r"pressure = 35 kPa: outside the range .* fitted in, 0 kPa to 30 kPa"):
        limb.rest_angles(0.035)
    with pytest.raises(InputError, match=r"pressure = -1 kPa: outside"):
        limb.stiffness(np.array([0.01, -0.001]))
    with pytest.raises(InputError, match=r"pressure = nan kPa: outside"):
        limb.equilibrium(float("nan"), (0.0, 0.0))


def test_a_force_that_no_shape_bears_is_refused(monkeypatch):
    from pneumorph.terrain import limb as module

    monkeypatch.setattr(module, "_STEPS", 1)
    with pytest.raises(InputError, match=r"tip force = \[-0.9, 0.7\] N: the limb finds no stable shape"):
        known_limb().equilibrium(0.02, (-0.9, 0.7))


def test_limbs_that_are_none_are_refused():
    limb = known_limb()
    with pytest.raises(InputError, match=r"is the shape of hinges, .* expected \(n, 2\), \(n, a\)"):
        replace(limb, rest=limb.rest[:2])
    with pytest.raises(InputError, match=r"stop_stiffness = -1, expected at least 0"):
        replace(limb, stop_stiffness=np.full(HINGES, -1.0))
    with pytest.raises(InputError, match=r"pressures from 10 kPa to 30 kPa, expected a range that holds 0"):
        replace(limb, pressures=(0.01, 0.03))
    with pytest.raises(InputError, match=r"hinge 1 has a compliance of -0.001 .* expected more than 0"):
        replace(limb, compliance=np.full((HINGES, 1), -1e-3))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: {"pressures": d.pressures[:-1]}, r"pressures has the shape \(15,\), expected \(16,\)"),
        (lambda d: {"stations": d.stations[:2]}, r"stations of shape \(2, 2\), expected 3 or more"),
        (lambda d: {"forces": np.full_like(d.forces, np.nan)}, "forces has a number that is not finite"),
        (lambda d: {"width": 0.0}, "thickness = .* width = 0, expected two numbers"),
        (lambda d: {"mount": (1.0, 2.0)}, "mount has 2 numbers"),
        (lambda d: {"foot": -2.0}, r"foot = -2.0, expected at least 0"),
    ],
)
def test_limb_data_that_does_not_fit_together_is_refused(change, message):
    data = data_of()
    if "pressures" in change(data):
        data = replace(data)  # the number of cases is that of the pressures: cut something else to the old number
        with pytest.raises(InputError, match=r"forces has the shape \(16, 2\), expected \(15, 2\)"):
            replace(data, **change(data))
        return
    with pytest.raises(InputError, match=message):
        replace(data, **change(data))


def test_too_little_data_for_the_polynomials_is_refused():
    data = data_of()
    with pytest.raises(InputError, match=r"rest_degree = 7, compliance_degree = 1, expected 1 to 6, 0 to 3"):
        fit_limb(data, rest_degree=7)
    with pytest.raises(InputError, match=r"3 pressures above 0, the polynomials need 4"):
        fit_limb(data, rest_degree=4)
    unloaded = data.chosen(np.linalg.norm(data.forces, axis=1) == 0.0)
    with pytest.raises(InputError, match=r"0 pressures with tip forces, the polynomials need 2"):
        fit_limb(unloaded)
    # a force at a hinge has no moment about it
    with pytest.raises(InputError, match=r"hinge 5 has data for 3 of 5 coefficients"):
        fit_limb(replace(data, load_point=data.hinges[-1]))
    with pytest.raises(InputError, match=r"hinge \d has a compliance of -.* expected more than 0"):
        fit_limb(replace(data, forces=-data.forces))


def test_limb_data_survives_its_file(tmp_path):
    data = data_of(held_out=((0.015, (-1.0, 1.0)),))
    (tmp_path / "limb.json").write_text(data.text())
    back = read_limb_data(tmp_path / "limb.json")
    for name in ("stations", "hinges", "pressures", "forces", "rotations", "points", "load_points", "held_out"):
        np.testing.assert_allclose(getattr(back, name), getattr(data, name), atol=1e-6)
    assert (back.thickness, back.width, back.foot, back.mount) == (data.thickness, data.width, data.foot, data.mount)
    assert back.provenance == data.provenance


def test_files_that_are_no_limb_data_are_refused(tmp_path):
    path = tmp_path / "x.json"
    with pytest.raises(StorageError, match=r"limb data '.*x.json' cannot be read"):
        read_limb_data(path)
    for text, message in (
        ("pressure,angle\n0,1\n", "is no limb data"),
        ('{"kind": "study"}', 'is no limb data: expected a JSON file with "kind": "pneumorph limb data"'),
        ('{"kind": "pneumorph limb data", "format": 9}', "has the format 9, this version reads 1"),
        ('{"kind": "pneumorph limb data", "format": 1}', "is damaged: no stations, hinges"),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_limb_data(path)
    content = json.loads(data_of().text())
    for key, value in (("pressures", ["a"]), ("mount", 3.0)):
        path.write_text(json.dumps(content | {key: value}))
        with pytest.raises(InputError, match="is damaged: "):
            read_limb_data(path)


def test_the_limb_of_the_package_is_fitted_well_and_monotone():
    data = read_limb_data()
    assert SHIPPED.exists()
    assert isinstance(data, LimbData)
    fit = fit_limb(data)
    assert fit.limb.monotone
    assert set(PRESSURES[:1]) <= set(data.pressures)
    assert fit.held_out is not None
    # against the range of angles that the hinges go through
    turned = np.abs(data.angles).max()
    assert fit.fitted.bounds["angle_error"] < 0.15 * turned
    assert errors(fit.limb, data).bounds["tip_error"] < 0.15 * np.linalg.norm(data.load_point)
