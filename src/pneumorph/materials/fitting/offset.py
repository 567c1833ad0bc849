"""The zero of a record: preload at the start, slack, or the set that earlier cycles left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumorph.errors import InputError
from pneumorph.materials.fitting.specimen import SpecimenTest
from pneumorph.materials.tension import principal_stretches
from pneumorph.units import show

Array = NDArray[np.float64]

# parts of the largest stress and strain: what counts as no stress, as no strain, and the stretch of curve looked at
_NO_STRESS, _NO_STRAIN, _WINDOW = 0.005, 0.005, 0.1
_FEWEST = 4
# shifts under this part of the largest strain stay: the start of a curve does not tell them from its curvature
_NEGLIGIBLE = 0.005
_LARGEST = 0.25
_SURE = 3.0  # standard errors


def without_offset(test: SpecimenTest) -> SpecimenTest:
    """Return a test whose stress is zero at stretch 1, shifted along the strain where it visibly is not.

    Visibly: the record starts at zero strain with a stress (the machine was zeroed under preload), or goes on straining
    without stress (slack, or the set that earlier cycles left). The stretch λ0 without stress comes from the start of
    the curve by a neo-Hookean arc. The specimen at λ0 is then the reference: λ' = λ/λ0, and since its area is A0/λ0 in
    each of the three tests, P' = λ0 P. Each sign of strain has the same λ0, that of the larger strain.

    Raises InputError, with the line, where the shift would be over a quarter of the largest strain.
    """
    side = np.sign(test.stretch[np.argmax(np.abs(test.stretch - 1.0))] - 1.0) or 1.0
    on = np.flatnonzero((test.stretch - 1.0) * side > -_NO_STRAIN * test.reach)
    order = on[np.argsort(test.stretch[on] * side, kind="stable")]
    strain, stress = (test.stretch[order] - 1.0) * side, test.stress[order] * side
    start = _visible_start(strain, stress)
    if start is None:
        return test
    window = order[start:][strain[start:] <= strain[start] + _WINDOW * test.reach]
    if len(window) < _FEWEST:
        window = order[start : start + _FEWEST]
    if len(np.unique(test.stretch[window])) < _FEWEST:
        return test
    zero, error = _stretch_without_stress(test.mode, test.stretch[window], test.stress[window])
    shift = abs(zero - 1.0)
    if shift > _LARGEST * test.reach:
        raise InputError(
            f"{test.where(order[0])}: stress = {show(float(test.stress[order[0]]), 'stress')} at stretch "
            f"{test.stretch[order[0]]:.4g} puts the unstressed state at stretch {zero:.3f}; allowed: a shift of up to "
            f"{_LARGEST:.0%} of the largest strain. Correct the zero of the record, or keep it with --keep-offset"
        )
    if shift < max(_NEGLIGIBLE * test.reach, _SURE * error):
        return test
    note = f"zero moved to stretch {zero:.4f} (preload, slack or set)"
    return replace(test, stretch=test.stretch / zero, stress=test.stress * zero, notes=(*test.notes, note))


def _visible_start(strain: Array, stress: Array) -> int | None:
    """Return the place from which the curve rises, None where the record shows no offset."""
    largest, reach = np.abs(stress).max(), np.abs(strain).max()
    unstressed = np.flatnonzero(np.abs(stress) <= _NO_STRESS * largest)
    if len(unstressed) and strain[unstressed[-1]] > _NEGLIGIBLE * reach:
        return int(unstressed[-1])
    if abs(strain[0]) <= _NO_STRAIN * reach and abs(stress[0]) > 2.0 * _NO_STRESS * largest:
        return 0
    return None


def _stretch_without_stress(mode: str, stretch: Array, stress: Array) -> tuple[float, float]:
    """Return λ0 and its standard error from P = mu f(λ/λ0)/λ0, f the neo-Hookean curve of the test."""

    def curve(x: Array) -> Array:
        first, _, third = np.moveaxis(principal_stretches(mode, stretch / x[1]), -1, 0)
        return np.asarray(x[0] * (first - third**2 / first) / x[1])

    scale = max(float(np.abs(stress).max()), 1e-300)
    # in uniaxial tension the initial slope is 3 mu; the search does not mind a factor of two
    start = np.array([scale / (3.0 * float(np.ptp(stretch))), 1.0])
    found = least_squares(
        lambda x: (curve(x) - stress) / scale, start, x_scale=start, bounds=((0.0, 0.2), (np.inf, 10.0))
    )
    variance = 2.0 * found.cost / max(len(stretch) - 2, 1) * np.linalg.pinv(found.jac.T @ found.jac)
    return float(found.x[1]), float(np.sqrt(max(variance[1, 1], 0.0)))
