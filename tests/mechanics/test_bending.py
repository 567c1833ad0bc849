"""Bending: slender cantilevers in large rotation, Cook's membrane and a bonded beam."""

import numpy as np
import pytest

from pneumorph.closed_form.cantilever import end_load
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Clamp, Force, Model, Phase, Programme, march
from pneumorph.mesh.mesh import CellBlock, Mesh
from pneumorph.mesh.structured import box, rectangle

LENGTH, HEIGHT = 20.0, 1.0


def loaded(model, target, increments=8):
    step = 1.0 / increments
    *_, last = march(model, Programme((Phase("load", {"pull": target}, first=step, largest=step),)))
    return last


def tip(state, face):
    """Return the mean displacement of a face."""
    return state.displacement[state.model.mesh.face_nodes(face)].mean(axis=0)


def beam(mesh, clamp, end, direction, pressure="constant"):
    material = NeoHookean(0.3, bulk=300.0)
    return Model(mesh, {"body": material}, (Clamp(clamp),), (Force(end, direction, "pull"),), pressure=pressure)


@pytest.mark.parametrize("pressure", ["constant", "linear"])
def test_a_plane_strain_cantilever_bends_as_the_elastica(pressure):
    """PL2/EI = 3 turns the tip by 56 degrees. Across the plane an incompressible beam has E / (1 - nu2) = 4 mu."""
    stiffness = 4.0 * 0.3 * HEIGHT**3 / 12.0
    force = 3.0 * stiffness / LENGTH**2
    expected = end_load(stiffness, LENGTH, force)
    assert np.degrees(expected.rotation) > 50.0
    errors = []
    for cells in (1, 2, 4):
        mesh = rectangle(20 * cells, cells, width=LENGTH, height=HEIGHT)
        end = tip(loaded(beam(mesh, "left", "right", (0, 1), pressure), force), "right")
        errors.append(max(abs(end[1] / expected.transverse - 1.0), abs((LENGTH + end[0]) / expected.axial - 1.0)))
    if pressure == "constant":
        assert errors[0] < 0.025
    assert errors[2] < 0.005
    assert errors[0] > 2.5 * errors[1] > 5.0 * errors[2]


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_a_solid_cantilever_bends_as_the_elastica(kind):
    stiffness = 3.0 * 0.3 / 12.0
    force = 3.0 * stiffness / LENGTH**2
    expected = end_load(stiffness, LENGTH, force)
    errors = []
    for cells in (1, 2):
        mesh = box(12 * cells, cells, cells, kind, lengths=(LENGTH, HEIGHT, HEIGHT))
        end = tip(loaded(beam(mesh, "x0", "x1", (0, 0, 1)), force, 8), "x1")
        errors.append(abs(end[2] / expected.transverse - 1.0))
    assert errors[0] < 0.06
    assert errors[1] < 0.02
    assert errors[1] < errors[0]


def cook(cells, pressure, bulk):
    """Return the vertical displacement of the upper corner of Cook's membrane, mm."""

    def tapered(x):
        return np.column_stack([48.0 * x[:, 0], 44.0 * x[:, 0] + x[:, 1] * (44.0 - 28.0 * x[:, 0])])

    mesh = rectangle(cells, cells, tapered)
    model = Model(
        mesh, {"body": NeoHookean(80.1938, bulk=bulk)}, (Clamp("left"),), (Force("right", (0, 1), "pull"),),
        pressure=pressure,
    )  # fmt: skip
    state = loaded(model, 100.0, 2)
    return state.displacement[np.argmax(mesh.points.sum(axis=1)), 1]


def test_cooks_membrane_converges_without_locking():
    """mu = 80.1938, K = 5000 mu, F = 100: the upper corner rises by 6.9 (Simo and Armero, IJNME 33, 1992, fig. 4)."""
    bulk = 5000.0 * 80.1938
    constant, linear = ([cook(n, pressure, bulk) for n in (8, 32)] for pressure in ("constant", "linear"))
    assert constant[0] == pytest.approx(constant[1], rel=0.03)
    assert linear[0] == pytest.approx(linear[1], rel=0.06)
    assert constant[1] == pytest.approx(linear[1], rel=0.01)
    assert constant[1] == pytest.approx(6.9, rel=0.01)
    # a hundredfold bulk modulus costs the 3 to 4 % that the compression itself gives, on the coarse mesh as on the fine
    for cells in (8, 32):
        loss = cook(cells, "constant", bulk) / cook(cells, "constant", 20.0 * 80.1938) - 1.0
        assert -0.05 < loss < -0.02


def test_a_bonded_beam_in_tension_bends_to_the_stiff_side():
    """A composite section in the theory of slender beams gives the rotation of the tip under a small axial force."""
    mesh = rectangle(20, 4, width=LENGTH, height=HEIGHT)
    (block,) = mesh.blocks
    upper = mesh.points[block.nodes].mean(axis=1)[:, 1] > 0.5 * HEIGHT
    blocks = (CellBlock("triangle6", "soft", block.nodes[~upper]), CellBlock("triangle6", "stiff", block.nodes[upper]))
    materials = {"soft": NeoHookean(0.1, bulk=100.0), "stiff": NeoHookean(0.4, bulk=400.0)}
    model = Model(
        Mesh(mesh.points, blocks, mesh.faces, "plane_strain"), materials, (Clamp("left"),),
        (Force("right", (1, 0), "pull"),),
    )  # fmt: skip
    force = 1e-6  # so small that it does not straighten the bent beam
    end = loaded(model, force, 1)
    low, high = 4.0 * 0.1 * 0.5, 4.0 * 0.4 * 0.5  # E / (1 - nu2) times half the height
    section = np.array([[low + high, 0.25 * (high - low)], [0.25 * (high - low), (low + high) / 12.0]])
    _, curvature = np.linalg.solve(section, [force, 0.0])  # strain = e - curvature y: negative, to the upper side
    assert tip(end, "right")[1] > 0.0
    assert tip(end, "right")[1] == pytest.approx(0.5 * abs(curvature) * LENGTH**2, rel=0.04)
