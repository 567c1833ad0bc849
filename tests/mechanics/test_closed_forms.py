"""Tubes, spheres and the balloon against their closed forms."""

import numpy as np
import pytest

from pneumorph.closed_form import thick_wall
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics import Cavity, Model, Phase, Programme, Roller, Symmetry, VolumeSupply, march
from pneumorph.mechanics.fields import fields
from pneumorph.mesh.structured import rectangle

INNER, OUTER = 5.0, 8.0
# so stiff in volume that the closed forms, which are incompressible, hold to 1e-5
MATERIALS = [NeoHookean(0.3, bulk=3e4), Yeoh(0.11, 0.03, bulk=3e4)]
SHAPES = ["tube", "revolved tube", "sphere"]
WALLS = pytest.mark.parametrize("material", MATERIALS, ids=["neo-Hookean", "Yeoh"])


def bent(inner, outer):
    """Radius along x, angle from the x axis along y: a quarter of a ring."""

    def mapping(points):
        radius, angle = inner + (outer - inner) * points[:, 0], 0.5 * np.pi * points[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    return mapping


def wall(shape, material, radial, supply=None, pressure="constant"):
    """Return the model of a wall with `radial` cells across it and square cells."""
    cavity = {} if supply is None else {"supply": supply}
    if shape == "revolved tube":
        mesh = rectangle(
            radial, radial, lambda x: x + [INNER, 0.0], width=OUTER - INNER, height=3.0, space="axisymmetric"
        )
        supports = (Roller("bottom", "y"), Roller("top", "y"))
        mirrors = ("bottom", "top")
    else:
        space = "plane_strain" if shape == "tube" else "axisymmetric"
        mesh = rectangle(radial, 3 * radial, bent(INNER, OUTER), space=space)
        supports = (Symmetry("bottom"), Symmetry("top"))
        mirrors = ("bottom", "top") if shape == "tube" else ("bottom",)
    return Model(
        mesh, {"body": material}, supports, (), (Cavity("c", ("left",), mirrors=mirrors, **cavity),), pressure=pressure
    )


def closed(shape):
    return (thick_wall.sphere_pressure, thick_wall.sphere_inner_radius, thick_wall.sphere_state) if shape == "sphere" \
        else (thick_wall.tube_pressure, thick_wall.tube_inner_radius, thick_wall.tube_state)


def inflated(model, target):
    *_, last = march(model, Programme((Phase("inflate", {"c": target}, first=0.5, largest=0.5),)))
    return last


def mean_inner_radius(shape, state):
    """The radius of the round cavity with the volume that is enclosed."""
    volume = state.volume["c"]
    if shape == "tube":
        return np.sqrt(4 * volume / np.pi)
    if shape == "revolved tube":
        return np.sqrt(volume / (3.0 * np.pi))
    return np.cbrt(1.5 * volume / np.pi)


if __name__ == "__main__":
    import time
    for shape in SHAPES:
        for material in MATERIALS:
            p = float(closed(shape)[0](material, INNER, OUTER, 1.3 * INNER))
            for mode in ("constant", "linear"):
                errs = []
                t = time.time()
                for n in (1, 2, 4):
                    s = inflated(wall(shape, material, n, pressure=mode), p)
                    errs.append(mean_inner_radius(shape, s) / (1.3 * INNER) - 1)
                print(shape, type(material).__name__, mode, p, errs, [errs[i]/errs[i+1] for i in range(2)], s.unstable_modes, round(time.time() - t, 1), flush=True)
