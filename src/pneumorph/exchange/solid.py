"""STL and STEP files of a body in any state."""

from __future__ import annotations

from pathlib import Path

from pneumorph.exchange.step import step_text
from pneumorph.exchange.surface import WHOLE, surface_of
from pneumorph.exchange.written import Written, put
from pneumorph.geometry.stl import stl_bytes
from pneumorph.mechanics import Model, State
from pneumorph.solution.versions import versions


def write_stl(
    path: str | Path, model: Model, state: State | None = None, *, part: str = WHOLE, title: str = ""
) -> Written:
    """Write the surface of a body (None: undeformed) as a binary STL file in mm; see `surface_of` for `part`, errors.

    Each face of a cell becomes four or eight triangles on its own nodes, so the surface closes in every state.
    """
    surface = surface_of(model, None if state is None else state.positions, part)
    put(path, lambda file: file.write_bytes(stl_bytes(surface.points, surface.triangles, title or part)))
    return Written(Path(path), {"triangles": len(surface.triangles)})


def write_step(
    path: str | Path, model: Model, state: State | None = None, *, part: str = WHOLE, title: str = ""
) -> Written:
    """Write the same triangles as the plane faces of one solid, its cavities as voids, to a STEP file in mm.

    Raises as `surface_of`, and InputError for more faces than CAD programs open.
    """
    surface = surface_of(model, None if state is None else state.positions, part)
    text = step_text(surface, title or "body", versions()["pneumorph"])
    put(path, lambda file: file.write_text(text, encoding="ascii"))
    note = "plane faces of the mesh: a body that was meshed or deformed has no CAD surfaces"
    return Written(Path(path), {"plane faces": len(surface.triangles)}, (note,))
