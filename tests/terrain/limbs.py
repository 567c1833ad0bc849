"""A synthetic limb whose law is known in closed form: data from its own statics, for the tests of the reduced limb."""

import numpy as np

from pneumorph.terrain.limb import ReducedLimb, chain
from pneumorph.terrain.limb_data import LimbData

HINGES = 5
PRESSURES = (0.0, 0.01, 0.02, 0.03)
FORCES = ((0.0, 0.0), (-0.8, 0.9), (0.6, 0.5), (-0.5, -0.4))


def known_limb(stops=False):
    """A hook of five hinges on an arc of 120 degrees: rest angles of degree 3, compliance linear in the pressure.

    With stops, hinges are five times stiffer below an angle that is linear in the pressure.
    """
    turn = np.radians(np.linspace(12.0, 108.0, HINGES))
    hinges = 55.0 * np.stack([np.sin(turn), np.cos(turn) - 1.0], axis=1)
    end = 55.0 * np.array([np.sin(np.radians(120.0)), np.cos(np.radians(120.0)) - 1.0])
    grows = np.linspace(1.0, 1.3, HINGES)
    rest = np.stack([6.0 * grows, -40.0 * grows, 900.0 * grows], axis=1)
    compliance = np.stack([grows / 900.0, -grows / 90_000.0 * 1e3 / 4.0], axis=1)
    stop = np.stack([np.full(HINGES, -0.03), np.full(HINGES, 2.0)], axis=1)
    stiffness = np.full(HINGES, 4_000.0 if stops else 0.0)
    return ReducedLimb(
        hinges, end + np.array([2.0, 0.0]), end, rest, compliance, stop, stiffness, (0.0, 0.03), (20.0, 2.0), 40.0,
        5.0, (25.0, 0.0, 0.0),
    )  # fmt: skip


def data_of(limb=None, noise=0.0, held_out=(), forces=FORCES):
    """Return the data of a limb whose statics are solved for all pressures and forces, and some held out."""
    limb = limb or known_limb()
    cases = [(p, f, False) for p in PRESSURES for f in forces] + [(p, f, True) for p, f in held_out]
    angles = np.array([limb.equilibrium(p, f) for p, f, _ in cases])
    angles = angles + noise * np.random.default_rng(3).standard_normal(angles.shape)
    _, tips = chain(limb.links, angles)
    stations = np.vstack([np.zeros(2), 0.5 * (limb.hinges[1:] + limb.hinges[:-1]), limb.end])
    rotations = np.concatenate([np.zeros((len(cases), 1)), np.cumsum(angles, axis=1)], axis=1)
    return LimbData(
        stations=stations, hinges=limb.hinges, load_point=limb.load_point,
        pressures=np.array([p for p, _, _ in cases]),
        forces=np.array([f for _, f, _ in cases]), rotations=rotations,
        points=np.tile(stations, (len(cases), 1, 1)), load_points=tips,
        held_out=np.array([h for _, _, h in cases]),
        thickness=limb.thickness, width=limb.width, foot=limb.foot, mount=limb.mount,
        provenance={"inputs": "synthetic"},
    )  # fmt: skip
