"""System 2, one segment alone: how it bends, by finite elements, for the closed form to be compared with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from pneumorph.errors import InputError
from pneumorph.geometry import PlaneCrawler
from pneumorph.materials import Material
from pneumorph.measures import fit_circle
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, march
from pneumorph.mesh import generate


def segment_curvatures(
    crawler: PlaneCrawler, materials: Mapping[str, Material], pressures: Sequence[float], size: float | None = None
) -> list[float]:
    """Return the curvature, 1/mm, of the layer under one segment at rising pressures, MPa, without weight and ground.

    The segment goes on into one without pressure that is held by its underside. The circle goes through the points of
    the underside below the middles of the channels, but for the first and last of five or more: between them the layer
    waves. size: of the mesh, mm; left out, that of the crawler. Raises InputError for less than three channels,
    NotConvergedError where there is no such state.
    """
    if crawler.channels < 3:
        raise InputError(f"curvature of a segment: {crawler.channels} channels, expected at least 3")
    beam = replace(crawler, segments=2)
    mesh = generate(beam, size)
    model = Model(mesh, dict(materials), (Clamp("rear_foot"),), (), (Cavity("PN2", ("PN2",)),))
    share = [pressure / pressures[-1] for pressure in pressures]
    phase = Phase("bend", {"PN2": pressures[-1]}, marks=tuple(share[:-1]), largest=0.1)
    side = 2.0 * beam.outer_radius
    ends = 1 if beam.channels >= 5 else 0
    places = side * (np.arange(beam.channels + ends, beam.length / side - ends) + 0.5)
    nodes = mesh.face_nodes("front_foot")
    under = [nodes[np.argmin(np.linalg.norm(mesh.points[nodes] - (place, 0.0), axis=1))] for place in places]
    found = []
    for state in march(model, Programme((phase,))):
        if any(abs(state.time - mark) < 1e-9 for mark in share):
            found.append(fit_circle(state.positions[under]).curvature)
    return found
