"""Circle through points: algebraic fit, then the geometric one; straight lines are circles of curvature 0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumorph.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Circle:
    """curvature: 1/mm, not negative; residual: root mean square distance of the points from the circle, mm;
    normal (3,): of its plane, such that the points run counter-clockwise about it."""

    curvature: float
    residual: float
    normal: Array


def fit_circle(points: Array) -> Circle:
    """Return the circle nearest to points (n, 2) or (n, 3), n >= 3, in their order.

    The plane is the best one in the sense of least squares. In it a circle or line is A (x^2 + y^2) + D x + E y + F = 0
    with D^2 + E^2 - 4 A F = 1, so that the curvature is 2 |A| and nothing becomes infinite on the way to a line. Start:
    Pratt's algebraic fit; then the squared distances are minimised. Source: Chernov, Circular and Linear Regression
    (2010), sections 3.4, 4.5 and 5.8. Raises InputError for fewer than three points or points that coincide.
    """
    if points.ndim != 2 or len(points) < 3 or not np.isfinite(points).all():
        raise InputError(f"points of shape {points.shape}: expected at least three, finite, for a circle")
    space = np.zeros((len(points), 3))
    space[:, : points.shape[1]] = points
    centred = space - space.mean(axis=0)
    scale = float(np.sqrt((centred**2).sum(axis=1).mean()))
    if scale < 1e-12 * max(1.0, float(np.abs(space).max())):
        raise InputError("the points of a circle coincide")
    if points.shape[1] == 2:
        frame = np.eye(3)
    else:
        _, values, frame = np.linalg.svd(centred / scale)
        if values[1] < 1e-12 * values[0]:  # a straight line: any plane through it
            return Circle(0.0, 0.0, frame[2])
    flat = centred @ frame.T / scale
    x, y, off = (flat - [*flat[len(flat) // 2, :2], 0.0]).T  # from a point of the circle: D and E do not vanish
    found = least_squares(_distances, _pratt(x, y), args=(x, y), method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    residual = scale * float(np.sqrt(np.mean(found.fun**2 + off**2)))
    step = np.diff(flat[:, :2], axis=0)
    turned = float(np.sum(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0]))
    normal = np.cross(frame[0], frame[1]) * (1.0 if turned >= 0.0 else -1.0)
    return Circle(2.0 * abs(float(found.x[0])) / scale, residual, normal)


def _distances(unknowns: Array, x: Array, y: Array) -> Array:
    """Return signed distances of points from the circle (A, angle, F); D, E = sqrt(1 + 4 A F) (cos, sin)(angle)."""
    a, angle, f = unknowns
    root = np.sqrt(max(1.0 + 4.0 * a * f, 0.0))
    value = a * (x * x + y * y) + root * (np.cos(angle) * x + np.sin(angle) * y) + f
    result: Array = 2.0 * value / (1.0 + np.sqrt(np.maximum(1.0 + 4.0 * a * value, 0.0)))
    return result


def _pratt(x: Array, y: Array) -> Array:
    """Return (A, angle, F) of the algebraic fit under Pratt's constraint."""
    columns = np.column_stack([x * x + y * y, x, y, np.ones_like(x)])
    constraint_inverse = np.array([[0, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0], [-0.5, 0, 0, 0]])
    values, vectors = np.linalg.eig(constraint_inverse @ (columns.T @ columns))
    best, error = np.zeros(3), np.inf
    for vector in vectors.T[np.isreal(values)].real:
        norm = vector[1] ** 2 + vector[2] ** 2 - 4.0 * vector[0] * vector[3]
        if norm <= 0.0:
            continue
        a, d, e, f = vector / np.sqrt(norm)
        start = np.array([a, np.arctan2(e, d), f])
        size = float((_distances(start, x, y) ** 2).sum())
        if size < error:
            best, error = start, size
    return best
