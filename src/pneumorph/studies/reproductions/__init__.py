"""Reproductions of published systems: one file each, imported here so that they are known by name."""

from pneumorph.studies.reproductions import hexagonal_prism, soft_wheel
from pneumorph.studies.reproductions.reproduction import Reproduction, SystemInParts, names, reproduction

__all__ = ["Reproduction", "SystemInParts", "hexagonal_prism", "names", "reproduction", "soft_wheel"]
