"""Closed forms: classic solutions that check the solver, and the analytic models of the published actuators."""

from pneumorph.closed_form import balloon, cantilever, hexagonal_prism, lame, pneunet, thick_wall

__all__ = ["balloon", "cantilever", "hexagonal_prism", "lame", "pneunet", "thick_wall"]
