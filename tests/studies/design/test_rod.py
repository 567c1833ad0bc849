"""The rod of pieces with constant curvature against circles, helices and its own differential equation."""

import math

import numpy as np
import pytest

from pneumorph.studies.design.rod import Piece, rod_line


def bend(length, turn, stretch=1.0, twist=0.0):
    return Piece(length, stretch, np.array([0.0, -turn, twist]))


def test_a_piece_of_constant_curvature_is_a_circle():
    """Angle 1 rad over a stretched length of 150 mm: the radius is 150 mm, to -x."""
    angle = np.linspace(0.0, 1.0, 11)
    line = rod_line([bend(100.0, 0.01, stretch=1.5)], angle)
    circle = np.column_stack([-150.0 * (1.0 - np.cos(angle)), np.zeros(11), 150.0 * np.sin(angle)])
    np.testing.assert_allclose(line, circle, atol=1e-12)


def test_a_piece_that_twists_is_a_helix():
    """Curvature k and torsion t: radius k / (k² + t²); all points lie on a cylinder of it."""
    k, t = 0.02, 0.03
    line = rod_line([bend(400.0, k, twist=t)], np.linspace(0.0, 1.0, 101))
    radius = k / (k**2 + t**2)
    axis = np.array([0.0, -k, t]) / math.hypot(k, t)
    centre = np.array([-radius, 0.0, 0.0])  # the curve first bends to -x
    away = line - centre - np.outer((line - centre) @ axis, axis)
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), radius, rtol=1e-12)


def test_equal_pieces_make_one():
    fractions = np.linspace(0.0, 1.0, 17)
    whole = rod_line([bend(90.0, 0.013, 1.2)], fractions)
    np.testing.assert_allclose(rod_line([bend(30.0, 0.013, 1.2)] * 3, fractions), whole, atol=1e-12)


def test_its_length_is_the_stretched_one():
    line = rod_line([bend(30.0, 0.01, 1.1), bend(50.0, -0.02, 1.3), bend(20.0, 0.0, 0.9)], np.linspace(0.0, 1.0, 4001))
    assert np.linalg.norm(np.diff(line, axis=0), axis=1).sum() == pytest.approx(33.0 + 65.0 + 18.0, rel=1e-6)


def test_the_straight_limit_is_reached_smoothly():
    fractions = np.linspace(0.0, 1.0, 5)
    nearly = rod_line([bend(100.0, 2e-8)], fractions) - rod_line([bend(100.0, 0.0)], fractions)
    # deflection turn s² / 2
    np.testing.assert_allclose(nearly[:, 0], -1e-8 * (100.0 * fractions) ** 2, rtol=1e-6)
