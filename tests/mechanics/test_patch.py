"""Patch tests: an affine motion of the boundary moves the whole of a distorted mesh alike, with one exact stress."""

from types import MappingProxyType

import numpy as np
import pytest

from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics import Model, Phase, Prescribed, Programme, Roller, march
from pneumorph.mechanics.fields import fields
from pneumorph.mesh.structured import box, rectangle

MESHES = {
    "tetra10": lambda: box(2, 2, 2, distortion=0.3),
    "wedge18": lambda: box(2, 2, 2, kind="wedge18", distortion=0.3),
    "hexahedron27": lambda: box(2, 2, 2, kind="hexahedron27", distortion=0.3),
    "plane strain": lambda: rectangle(3, 3, distortion=0.3),
    "axisymmetric": lambda: rectangle(3, 3, space="axisymmetric", distortion=0.3),
}
MATERIALS = pytest.mark.parametrize(
    "material", [NeoHookean(0.3, bulk=3e3), Yeoh(0.11, 0.03, bulk=2e3)], ids=["neo-Hookean", "Yeoh"]
)
PRESSURES = pytest.mark.parametrize("pressure", ["constant", "linear"])
SIDES = {"x": ("x0", "x1"), "y": ("y0", "y1"), "z": ("z0", "z1")}
PLANE_SIDES = {"x": ("left", "right"), "y": ("bottom", "top")}


class Affine(Model):
    """A model whose held nodes move as u = F X - X, with F - I growing with the target 'motion'."""

    kinds = MappingProxyType({"motion": "number"})
    motion = None

    def prescribed(self, values):
        moved = values.get("motion", 0.0) * self.mesh.points @ self.motion.T
        result = np.zeros(self.mesh.points.size)
        result[self.held] = moved.ravel()[self.held]
        return result


def pulled(mesh, material, axes, stretch, pressure="constant"):
    """Return the last state of a block pulled along `axes` between smooth plates, and its sides."""
    sides = SIDES if mesh.space == "3d" else PLANE_SIDES
    rollers = [Roller(low, axis) for axis, (low, _) in sides.items()]
    plates = [Prescribed(sides[axis][1], axis, f"pull {axis}") for axis in axes]
    targets = {plate.name: stretch - 1.0 for plate in plates}
    model = Model(mesh, {"body": material}, (*rollers, *plates), pressure=pressure)
    *_, last = march(model, Programme((Phase("pull", targets, first=0.5, largest=0.5),)))
    return last, sides


def uniform(state):
    """Return the one F and Cauchy stress of a state, after checking that there is one of each, to 1e-6."""
    (part,) = fields(state)
    gradient, stress = part.gradient.reshape(-1, 3, 3), part.stress.reshape(-1, 3, 3)
    assert gradient == pytest.approx(np.broadcast_to(gradient[0], gradient.shape), abs=1e-6)
    assert stress == pytest.approx(np.broadcast_to(stress[0], stress.shape), abs=1e-6 * np.abs(stress).max())
    return gradient[0], stress[0]


def isochoric_stress(material, gradient):
    """Return the deviatoric Cauchy stress 2 W1 dev(J^-2/3 b) / J, written out for the two laws."""
    ratio = np.linalg.det(gradient)
    b = gradient @ gradient.T / ratio ** (2.0 / 3.0)
    strain = np.trace(b) - 3.0
    w1 = 0.5 * material.mu if isinstance(material, NeoHookean) else material.c10 + 2.0 * material.c20 * strain
    return 2.0 * w1 * (b - np.trace(b) / 3.0 * np.eye(3)) / ratio


def assert_exact(state, material):
    """Check inner nodes and the deviator of the stress to 1e-6; return F and the stress."""
    gradient, stress = uniform(state)
    d = state.model.mesh.dimension
    motion = state.model.mesh.points @ (gradient[:d, :d] - np.eye(d)).T
    assert state.displacement == pytest.approx(motion, abs=1e-6)
    deviator = stress - np.trace(stress) / 3.0 * np.eye(3)
    expected = isochoric_stress(material, gradient)
    assert np.abs(expected).max() > 0.05
    assert deviator == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())
    return gradient, stress


@MATERIALS
@PRESSURES
@pytest.mark.parametrize(("kind", "axes"), [("tetra10", "x"), ("wedge18", "y"), ("axisymmetric", "y")])
def test_uniaxial_tension_is_exact(kind, axes, material, pressure):
    state, sides = pulled(MESHES[kind](), material, axes, 1.5, pressure)
    gradient, stress = assert_exact(state, material)
    axis = "xyz".index(axes)
    others = [i for i in range(3) if i != axis]
    assert gradient[axis, axis] == pytest.approx(1.5, abs=1e-9)
    assert np.abs(stress[others]).max() < 1e-6 * stress[axis, axis]
    area = np.pi if kind == "axisymmetric" else 1.0
    plate = state.model.mesh.dimension * state.model.mesh.face_nodes(sides[axes][1]) + axis
    nominal = state.reactions[plate].sum() / area
    # the formula is that of an incompressible bar: p / K is 1e-4 here
    assert nominal == pytest.approx(float(material.uniaxial_tension(1.5)), rel=3e-4)
    assert nominal == pytest.approx(stress[axis, axis] * np.linalg.det(gradient) / 1.5, rel=1e-6)


@MATERIALS
@PRESSURES
@pytest.mark.parametrize(("kind", "axes"), [("tetra10", "xz"), ("wedge18", "xy"), ("axisymmetric", "x")])
def test_equibiaxial_tension_is_exact(kind, axes, material, pressure):
    state, _ = pulled(MESHES[kind](), material, axes, 1.3, pressure)
    gradient, stress = assert_exact(state, material)
    free = "y" if axes in ("xz", "x") else "z"
    third = "xyz".index(free)
    first, second = (i for i in range(3) if i != third)
    assert gradient[[first, second], [first, second]] == pytest.approx(1.3, abs=1e-6)
    assert abs(stress[third, third]) < 1e-6 * stress[first, first]
    nominal = stress[first, first] * np.linalg.det(gradient) / 1.3
    assert nominal == pytest.approx(float(material.equibiaxial_tension(1.3)), rel=5e-4)


@MATERIALS
@PRESSURES
def test_planar_tension_is_exact(material, pressure):
    state, _ = pulled(MESHES["plane strain"](), material, "x", 1.5, pressure)
    gradient, stress = assert_exact(state, material)
    assert abs(stress[1, 1]) < 1e-6 * stress[0, 0]
    nominal = stress[0, 0] * np.linalg.det(gradient) / 1.5
    assert nominal == pytest.approx(float(material.planar_tension(1.5)), rel=5e-4)


@MATERIALS
@PRESSURES
@pytest.mark.parametrize("kind", ["tetra10", "wedge18", "plane strain"])
def test_simple_shear_is_exact(kind, material, pressure):
    mesh = MESHES[kind]()
    d, amount = mesh.dimension, 0.6
    sides = SIDES if d == 3 else PLANE_SIDES
    rollers = tuple(Roller(face, axis) for pair in sides.values() for face in pair for axis in "xyz"[:d])
    model = Affine(mesh, {"body": material}, rollers, pressure=pressure)
    direction = np.zeros((d, d))
    direction[0, 1] = 1.0
    object.__setattr__(model, "motion", direction)
    *_, last = march(model, Programme((Phase("shear", {"motion": amount}, first=0.5, largest=0.5),)))
    inner = np.setdiff1d(np.arange(len(mesh.points)), model.held // d)
    assert len(inner) > 5
    gradient, stress = assert_exact(last, material)
    expected = np.eye(3)
    expected[0, 1] = amount
    assert gradient == pytest.approx(expected, abs=1e-6)
    # Rivlin's universal relation: the difference of the normal stresses is the shear stress times the amount
    assert stress[0, 0] - stress[1, 1] == pytest.approx(amount * stress[0, 1], rel=1e-6)
    assert abs(np.trace(stress)) < 1e-6 * stress[0, 1]


@pytest.mark.parametrize("kind", MESHES)
def test_small_strain_answers_with_the_initial_moduli(kind):
    """At a strain of 1e-6 Young's modulus, or that of plane strain, comes out with the given Poisson's ratio."""
    material = NeoHookean(0.3, bulk=0.9)
    nu = material.poisson_ratio
    young = 2.0 * material.shear_modulus * (1.0 + nu)
    state, _ = pulled(MESHES[kind](), material, "y", 1.0 + 1e-6)
    _, stress = uniform(state)
    modulus = young / (1.0 - nu**2) if kind == "plane strain" else young
    assert stress[1, 1] / 1e-6 == pytest.approx(modulus, rel=1e-4)
