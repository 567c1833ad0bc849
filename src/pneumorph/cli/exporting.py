"""What `export` does: find the model and state that are asked for, and write them by the suffix of the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneumorph.errors import InputError, StorageError, UnitError, unknown_name
from pneumorph.exchange import (
    PARTS,
    PressureTable,
    Written,
    pressures_of,
    up_to,
    write_bodies,
    write_inp,
    write_nodes,
    write_pressure_volume,
    write_step,
    write_stl,
    write_vtu,
)
from pneumorph.exchange.wheel import write_wheel
from pneumorph.exchange.written import put
from pneumorph.geometry import SoftLimb, occ
from pneumorph.mechanics import Model, Programme, State
from pneumorph.solution import Solution
from pneumorph.studies import Study, load_study, study_from
from pneumorph.units import parse, show

WHOLE, WHEEL, BODIES = PARTS[0], "wheel", "bodies"
MESH, STATE, CURVE, HISTORY = "mesh", "state", "pv", "history"
# suffix -> what can be written there, the default of a run first
ALLOWED = {
    ".inp": (MESH,),
    ".stl": (STATE, MESH),
    ".step": (STATE, MESH),
    ".stp": (STATE, MESH),
    ".vtu": (STATE, MESH),
    ".csv": (STATE, CURVE, HISTORY),
}
_NEAR = 1e-3  # a pressure that is asked for and that of a state may differ by this share


@dataclass(frozen=True)
class Wanted:
    """What the command line asks for; see `cli.export`. Raises InputError for a suffix or combination that is not."""

    to: Path
    state: str = "last"
    what: str | None = None
    part: str = "whole"
    dialect: str = "calculix"
    pressures: bool = False
    printed: tuple[str, ...] = ()
    cavities: tuple[str, ...] = ()
    force: bool = False

    def __post_init__(self) -> None:
        if self.suffix not in ALLOWED:
            raise InputError(f"--to {self.to}: {unknown_name('suffix', self.suffix, ALLOWED)}")
        allowed = ALLOWED[self.suffix]
        if self.what is not None and self.what not in allowed:
            raise InputError(f"--what {self.what}: allowed for {self.suffix}: {', '.join(allowed)}")
        if self.to.exists() and not self.force:
            raise StorageError(f"'{self.to}' is there already: add --force to replace it, or choose another name")

    @property
    def suffix(self) -> str:
        """Ending of the file, which says its format."""
        return self.to.suffix.lower()


def export_file(source: Path, wanted: Wanted) -> list[str]:
    """Write what is wanted of a run folder or a study file; return lines that say what was written.

    Raises InputError for a state or option that does not go with the source, and what loading and writing raise.
    """
    written = _of_run(Solution.open(source), wanted) if source.is_dir() else _of_study(source, wanted)
    return [written.text, *written.notes]


def _of_study(source: Path, wanted: Wanted) -> Written:
    study = load_study(source)
    if wanted.what not in (None, MESH) or wanted.state != "last" or wanted.pressures or wanted.suffix == ".csv":
        raise InputError(f"'{source}' is a study without states: run it, then export its run folder")
    if _is_exact(wanted) and not study.assembly.parts:  # several bodies have facets, in their places
        return _template(study, wanted)
    problem = study.build()
    if wanted.suffix == ".inp":
        return _inp(problem.model, problem.programme, wanted, study.title, {})
    return _body(problem.model, None, wanted, study.title)


def _of_run(solution: Solution, wanted: Wanted) -> Written:
    what = wanted.what or ALLOWED[wanted.suffix][0]
    if wanted.part == WHEEL:
        return _wheel(solution, wanted, what)
    title = str(solution.about.get("title") or solution.about.get("name") or "run")
    if what == HISTORY:
        solution.history.write_csv(wanted.to)
        return Written(wanted.to, {"states": len(solution.history), "columns": len(solution.history.columns)})
    if what == CURVE:
        return write_pressure_volume(wanted.to, solution.history, wanted.cavities)
    if wanted.suffix == ".inp":
        return _inp_of_run(solution, wanted, title)
    if what == MESH and _is_exact(wanted) and "study" in solution.about and not solution.about["study"].get("part"):
        return _template(study_from(solution.about["study"], str(solution.about["name"])), wanted)
    state = None if what == MESH else solution.states[find_state(solution, wanted.state)]
    if wanted.suffix == ".csv":
        assert state is not None
        return write_nodes(wanted.to, state)
    return _body(solution.model, state, wanted, title if state is None else f"{title}, state {state.index}")


def _wheel(solution: Solution, wanted: Wanted, what: str) -> Written:
    """Write the wheel of a soft limb's run, at any pressure that the run comes to."""
    if wanted.suffix != ".stl" or what != STATE:
        raise InputError(f"--part {WHEEL}: only a state as .stl, not {wanted.suffix} ({what})")
    limb = None
    if "study" in solution.about:
        actuator = study_from(solution.about["study"], str(solution.about["name"])).actuator
        if not isinstance(actuator, SoftLimb):
            raise InputError(f"--part {WHEEL}: expected a run of the template soft-limb, not {type(actuator).__name__}")
        limb = actuator
    try:
        pressure = parse(wanted.state, "pressure", "--state")
    except UnitError:
        state = solution.states[find_state(solution, wanted.state)]
        pressure = next(iter(state.pressure.values()), 0.0)
    return write_wheel(wanted.to, solution, pressure, limb=limb)


def _is_exact(wanted: Wanted) -> bool:
    return wanted.suffix in (".step", ".stp") and wanted.part == WHOLE


def _template(study: Study, wanted: Wanted) -> Written:
    """Write the solid of a template with its true surfaces."""
    put(wanted.to, lambda part: occ.write_step(study.actuator.shape(), part))
    return Written(wanted.to, {"solids": len(study.materials)}, ("the undeformed solid, with its exact surfaces",))


def _inp_of_run(solution: Solution, wanted: Wanted, title: str) -> Written:
    """Write the programme up to the state, in steps; a run that stopped early goes as far as it came."""
    number = find_state(solution, wanted.state)
    time = float(solution.history.values("time")[number])
    if time <= 0.0:
        raise InputError(f"--state {wanted.state}: state 0 is at rest, an .inp file needs a load: expected a later one")
    tables = pressures_of(solution.history, solution.model.surfaces, time) if wanted.pressures else {}
    return _inp(solution.model, up_to(solution.programme, time), wanted, title, tables)


def _inp(
    model: Model, programme: Programme, wanted: Wanted, title: str, tables: Mapping[str, PressureTable]
) -> Written:
    return write_inp(
        wanted.to, model, programme, dialect=wanted.dialect, title=title, pressures=tables, printed=wanted.printed
    )


def _body(model: Model, state: State | None, wanted: Wanted, title: str) -> Written:
    if wanted.part == BODIES:
        if wanted.suffix != ".stl":
            raise InputError(f"--part {BODIES}: only as .stl, not {wanted.suffix}")
        return write_bodies(wanted.to, model, state, title=title)
    if wanted.suffix == ".vtu":
        return write_vtu(wanted.to, model, state)
    if wanted.suffix == ".stl":
        return write_stl(wanted.to, model, state, part=wanted.part, title=title)
    return write_step(wanted.to, model, state, part=wanted.part, title=title)


def find_state(solution: Solution, text: str) -> int:
    """Return the number of a state: 'last', a number, or the first in which a cavity has a pressure such as '60 kPa'.

    Raises InputError for a state that the run does not have, with those that are nearest.
    """
    count = len(solution.states)
    if count == 0:
        raise InputError("the run has no states yet")
    if text == "last":
        return count - 1
    if text.isdigit():
        if int(text) >= count:
            raise InputError(f"--state {text}: the run has the states 0 to {count - 1}")
        return int(text)
    try:
        wanted = parse(text, "pressure", "--state")
    except UnitError:
        raise InputError(f"--state {text}: expected 'last', a number, or a pressure such as '60 kPa'") from None
    if not solution.model.surfaces:
        raise InputError(f"--state {text}: the model has no cavity, give the number of the state")
    table = np.array([solution.history.values(f"pressure:{name}") for name in solution.model.surfaces])
    away = np.abs(table - wanted).min(axis=0)
    found = np.flatnonzero(away <= _NEAR * max(abs(wanted), 1e-9))
    if len(found):
        return int(found[0])
    near = int(np.argmin(away))
    pressure = float(table[np.argmin(np.abs(table[:, near] - wanted)), near])
    raise InputError(f"--state {text}: no state has that pressure; the nearest is {near}, {show(pressure, 'pressure')}")
