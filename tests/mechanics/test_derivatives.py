"""Every derivative of the solver against central differences."""

import numpy as np
import pytest
import scipy.sparse as sparse

from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics.body import Body
from pneumorph.mechanics.cavity import Cavity, CavitySurface
from pneumorph.mesh.structured import box, rectangle

MESHES = {
    "tetra10": lambda: box(1, 1, 2, distortion=0.1),
    "wedge18": lambda: box(1, 1, 1, kind="wedge18", distortion=0.1),
    "hexahedron27": lambda: box(1, 1, 1, kind="hexahedron27", distortion=0.1),
    "plane strain": lambda: rectangle(2, 1, distortion=0.1),
    "axisymmetric": lambda: rectangle(2, 1, space="axisymmetric", distortion=0.1),
}


def moved(mesh, size=0.05):
    rng = np.random.default_rng(3)
    return mesh.points + size * rng.standard_normal(mesh.points.shape)


@pytest.fixture(params=MESHES, ids=str)
def mesh(request):
    return MESHES[request.param]()


@pytest.mark.parametrize("pressure", ["constant", "linear"])
def test_internal_force_is_the_slope_of_the_condensed_energy(mesh, pressure):
    body = Body(mesh, {mesh.domains[0]: Yeoh(0.11, 0.03, bulk=30.0)}, pressure)
    position = moved(mesh)
    zero = body.zero_pressure()
    change = body.pressure_step(body.assemble(position, zero).gains, np.zeros_like(position))
    force = body.assemble(position, change).force
    assert np.linalg.norm(force) > 0.01
    step = 1e-6
    for direction in np.random.default_rng(1).standard_normal((3, *position.shape)):
        plus = body.energies(position + step * direction, zero)[0]
        minus = body.energies(position - step * direction, zero)[0]
        assert (plus - minus) / (2 * step) == pytest.approx(force @ direction.ravel(), rel=1e-6)


@pytest.mark.parametrize("pressure", ["constant", "linear"])
def test_tangent_and_pressure_update_are_the_slopes_of_the_residual(mesh, pressure):
    """With q updated linearly, the two-field residuals at u + du, q + dq differ by their exact tangent's product."""
    body = Body(mesh, {mesh.domains[0]: NeoHookean(0.3, bulk=5.0)}, pressure)
    position = moved(mesh)
    rng = np.random.default_rng(2)
    modes = [0.1 * rng.standard_normal(q.shape) for q in body.zero_pressure()]
    here = body.assemble(position, modes)
    n = body.unknowns
    upper = sparse.csr_matrix((here.values, body.pattern.indices, body.pattern.indptr), shape=(n, n))
    tangent = upper + sparse.triu(upper, 1).T
    start = body.pressure_step(here.gains, np.zeros_like(position))
    step = 1e-6
    for direction in rng.standard_normal((3, *position.shape)):

        def condensed(factor, direction=direction):
            at = position + factor * direction
            change = body.pressure_step(here.gains, factor * direction)
            return body.assemble(at, [q + d for q, d in zip(modes, change, strict=True)]).force

        # along the linear update the residual of the pressure equations stays zero to first order
        slope = (condensed(step) - condensed(-step)) / (2 * step)
        base = body.assemble(position, [q + d for q, d in zip(modes, start, strict=True)])
        upper2 = sparse.csr_matrix((base.values, body.pattern.indices, body.pattern.indptr), shape=(n, n))
        expected = (upper2 + sparse.triu(upper2, 1).T) @ direction.ravel()
        assert np.linalg.norm(expected) > 0.1
        assert slope == pytest.approx(expected, rel=1e-5, abs=1e-5 * np.abs(expected).max())
    assert np.abs(tangent - tangent.T).max() < 1e-12


def test_carried_stresses_are_the_slope_of_the_stresses(mesh):
    """Along a step the stresses change by what is carried, and by second order in the step."""
    body = Body(mesh, {mesh.domains[0]: Yeoh(0.11, 0.03, bulk=30.0)})
    position = moved(mesh)
    here = body.assemble(position, body.zero_pressure())
    still = body.carry(here, position, np.zeros_like(position))
    step, memory = 1e-6, body.zero_memory()
    for direction in np.random.default_rng(4).standard_normal((3, *position.shape)):
        carried = body.carry(here, position, direction)
        plus = body.stresses(position + step * direction, memory)
        minus = body.stresses(position - step * direction, memory)
        for a, b, c, d in zip(plus, minus, carried, still, strict=True):
            slope = c - d
            assert np.abs(slope).min(axis=(0, 1))[:3].max() > 1e-4
            assert (a - b) / (2.0 * step) == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


def test_the_tangent_takes_the_carried_stresses_and_the_residual_does_not(mesh):
    body = Body(mesh, {mesh.domains[0]: NeoHookean(0.3, bulk=5.0)})
    position, modes = moved(mesh), body.zero_pressure()
    here = body.assemble(position, modes)
    same = body.assemble(position, modes, carried=body.stresses(position, body.zero_memory()))
    other = body.assemble(position, modes, carried=[2.0 * s for s in body.stresses(position, body.zero_memory())])
    assert same.values == pytest.approx(here.values, rel=1e-12)
    assert (other.force == here.force).all()
    assert np.abs(other.values - here.values).max() > 1e-3 * np.abs(here.values).max()


def shell(kind):
    """A mesh whose outer boundary is taken for a cavity's wall turned inside out: volumes come out negative."""
    if kind == "solid":
        mesh = box(1, 1, 1)
        return mesh, ("x0", "x1", "y0", "y1", "z0", "z1"), ()
    if kind == "solid, wedges":
        mesh = box(1, 1, 1, kind="wedge18")
        return mesh, ("x0", "x1", "y0", "y1", "z0", "z1"), ()
    if kind == "three mirrors":
        return box(1, 1, 1), ("x1", "y1", "z1"), ("x0", "y0", "z0")
    if kind == "one mirror":
        return box(1, 1, 1), ("x0", "x1", "y0", "y1", "z1"), ("z0",)
    space = "axisymmetric" if kind == "revolved" else "plane_strain"
    return rectangle(1, 1, space=space), ("left", "right", "bottom", "top"), ()


@pytest.mark.parametrize("kind", ["solid", "solid, wedges", "three mirrors", "one mirror", "plane", "revolved"])
def test_volume_gradient_and_hessian_match_differences(kind, monkeypatch):
    mesh, faces, mirrors = shell(kind)
    body = Body(mesh, {mesh.domains[0]: NeoHookean(1.0)})
    monkeypatch.setattr(CavitySurface, "volume", lambda self, x: -_volume(self, x))
    surface = CavitySurface(Cavity("c", faces, mirrors=mirrors), mesh, body.pattern)
    expected = np.pi if kind == "revolved" else 1.0
    assert -_volume(surface, mesh.points) == pytest.approx(expected, rel=1e-12)
    position = moved(mesh, 0.1)
    gradient = surface.gradient(position)
    values = np.zeros(body.pattern.indptr[-1])
    surface.add_hessian(position, 1.0, values)
    upper = sparse.csr_matrix((values, body.pattern.indices, body.pattern.indptr), shape=(body.unknowns,) * 2)
    hessian = upper + sparse.triu(upper, 1).T
    assert np.linalg.norm(gradient) > 0.1
    assert abs(hessian).max() > 0.01
    step = 1e-5
    for direction in np.random.default_rng(5).standard_normal((3, *position.shape)):
        change = _volume(surface, position + step * direction) - _volume(surface, position - step * direction)
        assert change / (2 * step) == pytest.approx(gradient @ direction.ravel(), rel=1e-7)
        slopes = surface.gradient(position + step * direction) - surface.gradient(position - step * direction)
        assert slopes / (2 * step) == pytest.approx(hessian @ direction.ravel(), abs=1e-7)


def _volume(surface, position):
    return sum(surface._evaluate(block, position, 0)[0] for block in surface.blocks)
