"""The skinned tube with a homogenised skin: its model, and how it inflates."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.geometry.lattice import SkinnedTube
from pneumorph.homogenisation.law import SKIN, TUBE, skin_law
from pneumorph.materials import Material, library
from pneumorph.materials.orthotropic import OrthotropicLayer
from pneumorph.measures.centre_line import centre_line
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Model,
    Phase,
    PressureSupply,
    Programme,
    Settings,
    State,
    Supply,
    Symmetry,
    VolumeSupply,
    march,
)
from pneumorph.mechanics.supports import Support
from pneumorph.mesh.smooth_tube import mesh_smooth_tube, skin_domains

Array = NDArray[np.float64]

CAP = library.material("auxetic-end-cap")


def homogenised_model(
    tube: SkinnedTube, laws: Mapping[str, OrthotropicLayer] | None = None, *, tube_material: Material = TUBE,
    skin_material: Material = SKIN, cap_material: Material = CAP, half: bool | None = None, supply: str = "volume",
    size: float | None = None,
) -> Model:  # fmt: skip
    """Return the model of a tube with a homogenised skin, clamped at z = 0, its cavity named 'cavity'.

    laws:   domain of `mesh.smooth_tube.skin_domains` -> layer; left out, `skin_law` of the materials.
    half:   the part y >= 0 only, with half the volume; left out, wherever the map of cells is its own mirror image.
    supply: 'volume' or 'pressure'. size: largest edge of the mesh, mm.

    Raises InputError for another supply, and as `mesh_smooth_tube` and `skin_law`.
    """
    supplies: dict[str, Supply] = {"volume": VolumeSupply(), "pressure": PressureSupply()}
    if supply not in supplies:
        raise InputError(f"homogenised skin: supply = {supply!r}, allowed: {', '.join(supplies)}")
    cut = tube.lattice.mirror is not None if half is None else half
    mesh = mesh_smooth_tube(tube, size, half=cut)
    if laws is None:
        laws = skin_laws(tube, tube_material, skin_material)
    supports: tuple[Support, ...] = (Clamp("clamp"), *((Symmetry("symmetry_y"),) if cut else ()))
    mirrors = ("symmetry_y",) if cut else ()
    cavity = Cavity("cavity", ("cavity",), supplies[supply], mirrors)
    return Model(mesh, {"tube": tube_material, "cap": cap_material, **laws}, supports, cavities=(cavity,))


def skin_laws(tube: SkinnedTube, tube_material: Material, skin_material: Material) -> dict[str, OrthotropicLayer]:
    """Return the layer of each domain of `mesh.smooth_tube.skin_domains`; raises as `skin_law`."""
    return {
        name: skin_law(cell, tube, tube_material=tube_material, skin_material=skin_material).layer
        for name, cell in skin_domains(tube.lattice).items()
    }


def inflate(model: Model, target: float, *, settings: Settings | None = None, first: float = 0.05) -> State:
    """Return the state of a `homogenised_model` at its target: added volume, mm³, of the whole tube, or pressure, MPa.

    Raises NotConvergedError.
    """
    share = 0.5 if "symmetry_y" in model.mesh.faces and not model.cavities[0].supply.sets_pressure else 1.0
    *_, last = march(model, Programme((Phase("inflate", {"cavity": share * target}, first=first),)), settings)
    return last


def inflated_line(
    tube: SkinnedTube, target: float, *, supply: str = "volume", sections: int = 24, size: float | None = None,
    laws: Mapping[str, OrthotropicLayer] | None = None,
) -> tuple[Array, State]:  # fmt: skip
    """Return the deformed centre line (n, 3), mm, from the clamp to the tip, of an inflated tube, and its state.

    target: added volume, mm³, or with supply = 'pressure' a pressure, MPa. Raises as `homogenised_model`, `inflate`.
    """
    state = inflate(homogenised_model(tube, laws, supply=supply, size=size), target)
    return centre_line(state, "clamp", "tip", sections).points, state
