"""Studies of a skinned tube whose lattice is replaced by a closed layer with its homogenised law."""

from __future__ import annotations

from collections.abc import Mapping

from pneumorph.errors import StudyError
from pneumorph.geometry import Actuator
from pneumorph.geometry.bending_skin import BendingSkin
from pneumorph.homogenisation import skin_laws
from pneumorph.materials import Material
from pneumorph.mesh import Mesh
from pneumorph.mesh.smooth_tube import mesh_smooth_tube
from pneumorph.studies.schema import MeshSection


def check_homogenised(actuator: Actuator, section: MeshSection) -> None:
    """Raise StudyError where a homogenised mesh is asked of another actuator, or with settings it does not have."""
    if not section.homogenised:
        return
    if not isinstance(actuator, BendingSkin):
        raise StudyError("mesh: homogenised = true: only the template 'skinned-tube' has a skin to homogenise")
    for name in ("grading", "detail", "wall_size"):
        if getattr(section, name) is not None:
            raise StudyError(f"mesh: {name} is given with homogenised = true: expected a size only")


def homogenised(
    actuator: Actuator, section: MeshSection, materials: Mapping[str, Material]
) -> tuple[Mesh, dict[str, Material]]:
    """Return the smooth mesh and its materials; finding the laws takes a while for each kind of cell."""
    assert isinstance(actuator, BendingSkin)
    mesh = mesh_smooth_tube(
        actuator.tube, section.size if isinstance(section.size, float) else None, half=actuator.half
    )
    laws = skin_laws(actuator.tube, materials["tube"], materials["skin"])
    return mesh, {"tube": materials["tube"], "cap": materials["cap"], **laws}
