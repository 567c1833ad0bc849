"""Reproductions of published systems: one file each, imported here so that they are known by name."""

from pneumorph.studies.reproductions import hexagonal_prism
from pneumorph.studies.reproductions.reproduction import Reproduction, names, reproduction

__all__ = ["Reproduction", "hexagonal_prism", "names", "reproduction"]
