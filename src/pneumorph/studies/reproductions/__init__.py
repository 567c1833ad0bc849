"""Reproductions of published systems: one file each, imported here so that they are known by name."""

from pneumorph.studies.reproductions import auxetic_skin, finger, hexagonal_prism, pneunet_2d, soft_wheel
from pneumorph.studies.reproductions.reproduction import (
    Reproduction,
    SystemBySweep,
    SystemInParts,
    names,
    reproduction,
)

__all__ = [
    "Reproduction", "SystemBySweep", "SystemInParts", "auxetic_skin", "finger", "hexagonal_prism", "names",
    "pneunet_2d", "reproduction", "soft_wheel",
]  # fmt: skip
