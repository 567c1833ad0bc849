"""STL and STEP files of a body in any state."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pneumorph.errors import InputError
from pneumorph.exchange.step import step_text
from pneumorph.exchange.surface import WHOLE, surface_of
from pneumorph.exchange.written import Written, put
from pneumorph.geometry.stl import stl_bytes
from pneumorph.mechanics import Model, State
from pneumorph.mechanics.contact.outlines import outline, rigid_bodies, way_of
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


def write_bodies(path: str | Path, model: Model, state: State | None = None, *, title: str = "") -> Written:
    """Write the rigid bodies that a body may touch, where a state has them (None: at rest), as one STL file in mm.

    Planes and pipes go a tenth of the body's size beyond the body. Raises InputError for a model without rigid bodies,
    or that is not in space.
    """
    mesh = model.mesh
    bodies = rigid_bodies(model.contacts)
    count = len(bodies) + len(model.frames)
    if not count or mesh.dimension != 3:
        raise InputError(f"no rigid bodies: the model is {mesh.space}, with {count} of them; expected some in 3d")
    place = np.concatenate([mesh.points, mesh.points if state is None else state.positions])
    low, high = place.min(axis=0) - 0.1 * mesh.size, place.max(axis=0) + 0.1 * mesh.size
    values = {} if state is None else state.values
    parts = [outline(body, low, high, way_of(body, values)) for body in bodies.values()]
    now = mesh.points if state is None else state.positions
    parts += [(frame.surface(now), frame.facets) for frame in model.frames]
    first = np.cumsum([0, *(len(points) for points, _ in parts)])
    points = np.concatenate([points for points, _ in parts])
    triangles = np.concatenate([facets + start for (_, facets), start in zip(parts, first, strict=False)])
    put(path, lambda file: file.write_bytes(stl_bytes(points, triangles, title or "rigid bodies")))
    return Written(Path(path), {"bodies": count, "triangles": len(triangles)})


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
