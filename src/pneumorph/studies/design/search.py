"""The search: Optuna, which no other module imports, proposes designs; the rod of the law says how near they come."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, StorageError
from pneumorph.studies.design.law import TableLaw
from pneumorph.studies.design.skin import Part, SkinDesign
from pneumorph.studies.design.target import Target
from pneumorph.studies.design.task import DesignTask

Array = NDArray[np.float64]

FRACTIONS = np.linspace(0.0, 1.0, 41)
_BEND, _CUT, _PRESSURE = "bend", "cut", "pressure"


@dataclass(frozen=True)
class Deviation:
    """How far one line is from another at equal fractions of their lengths: root mean square and largest, mm."""

    rms: float
    largest: float

    @classmethod
    def of(cls, points: Array, target: Target, fractions: Array = FRACTIONS) -> Deviation:
        """Return the deviation of points (n, 3) at fractions (n,) of their line from a target."""
        distance = np.linalg.norm(points - target.at(fractions), axis=1)
        return cls(float(np.sqrt(np.mean(distance**2))), float(distance.max()))


@dataclass(frozen=True)
class SearchProgress:
    """ended: trials of all; best: least root-mean-square deviation so far, mm; elapsed, remaining: of this call, s."""

    ended: int
    total: int
    best: float
    elapsed: float
    remaining: float


@dataclass(frozen=True, eq=False)
class Found:
    """The best design, its deviation on the surrogate, its line (41, 3), and the deviation of every trial, mm."""

    design: SkinDesign
    deviation: Deviation
    line: Array
    trials: Array


def optuna() -> ModuleType:
    """Return Optuna. Raises EngineError where it is not installed."""
    try:
        import optuna as module
    except ImportError as error:
        raise EngineError("the inverse search needs Optuna: pip install 'pneumorph[design]'") from error
    module.logging.set_verbosity(module.logging.ERROR)
    return module


def search(
    task: DesignTask,
    law: TableLaw,
    storage: Path | None = None,
    progress: Callable[[SearchProgress], None] | None = None,
) -> Found:
    """Return the design whose rod comes nearest to the target, in the mean square.

    The trials are shared among a few independent starts: rows are whole, so that there are several minima.
    storage: journal of the trials; a search that was broken off goes on there, with the trials that are missing.
    progress: called after each trial; what it raises ends the search. The same seed proposes the same designs, as long
    as the search is not broken off. Raises EngineError without Optuna, StorageError for a damaged journal.
    """
    engine = optuna()
    rod = _Rods(task, law)
    studies = [_study(engine, task, storage, start) for start in range(task.file.search.starts)]
    shares = _shares(task.file.search.trials, len(studies))
    done, started = sum(len(study.trials) for study in studies), perf_counter()

    def tell(*_: Any) -> None:
        if progress is not None:
            ended, elapsed = sum(len(study.trials) for study in studies), perf_counter() - started
            left = elapsed / max(1, ended - done) * (sum(shares) - ended)
            best = min(study.best_value for study in studies if study.trials)
            progress(SearchProgress(ended, sum(shares), best, elapsed, left))

    for study, share in zip(studies, shares, strict=True):
        missing = max(0, share - len(study.trials))
        study.optimize(lambda trial: rod.deviation(rod.proposed(trial)).rms, n_trials=missing, callbacks=[tell])
    return _best(rod, studies)


def found_in(task: DesignTask, law: TableLaw, storage: Path) -> Found:
    """Return what a search that ended has found, from its journal.

    Raises StorageError for a journal that is missing, damaged, or of a search that was broken off.
    """
    engine = optuna()
    if not storage.is_file():
        raise StorageError(f"'{storage}' is missing: the search was not started; go on with --resume")
    studies = [_study(engine, task, storage, start) for start in range(task.file.search.starts)]
    ended = [len(study.trials) for study in studies]
    if any(count < share for count, share in zip(ended, _shares(task.file.search.trials, len(ended)), strict=True)):
        raise StorageError(
            f"'{storage}' holds {sum(ended)} of {task.file.search.trials} trials: go on with --resume, then report"
        )
    return _best(_Rods(task, law), studies)


def _best(rod: _Rods, studies: list[Any]) -> Found:
    best = rod.proposed(min(studies, key=lambda study: float(study.best_value)).best_trial)
    values = [trial.value for study in studies for trial in study.trials]
    known = np.array([math.inf if value is None else value for value in values])
    return Found(best, rod.deviation(best), rod.line(best), known)


def _shares(trials: int, starts: int) -> list[int]:
    """Return how many trials each start has, none of them none: what is left over goes to the first."""
    return [max(1, trials // starts + (start < trials % starts)) for start in range(starts)]


def _study(engine: ModuleType, task: DesignTask, storage: Path | None, start: int) -> Any:
    place: Any = None
    if storage is not None:
        journal = engine.storages.journal
        # a lock that symbolic links make is not to be had everywhere
        lock = journal.JournalFileOpenLock(str(storage))
        try:
            place = engine.storages.JournalStorage(journal.JournalFileBackend(str(storage), lock_obj=lock))
        except (OSError, ValueError, KeyError) as error:
            raise StorageError(f"the journal of the search '{storage}' is damaged: {error}; remove it") from error
    s = task.file.search
    name = f"start {start + 1}"
    study = engine.create_study(direction="minimize", storage=place, study_name=name, load_if_exists=True)
    # neither another start nor a resumed one must propose the same trials again
    seed = int(np.random.SeedSequence([s.seed, start, len(study.trials)]).generate_state(1)[0])
    if task.sampler == "cma-es":
        study.sampler = engine.samplers.CmaEsSampler(seed=seed, warn_independent_sampling=False)
    else:
        share = _shares(s.trials, s.starts)[start]
        study.sampler = engine.samplers.TPESampler(
            seed=seed, multivariate=True, n_startup_trials=min(100, max(10, share // 10))
        )
    return study


class _Rods:
    """Designs from the numbers of a trial, and the rods that they are on the surrogate."""

    def __init__(self, task: DesignTask, law: TableLaw) -> None:
        self.task, self.law, self.search = task, law, task.file.search
        self.lowest = float(law.cg[0])
        self.highest = min(float(law.pressure[-1]), self.search.pressure[1])

    def proposed(self, trial: Any) -> SkinDesign:
        """Return the design of a trial.

        A segment has one number for how much it bends: 0 for the largest gap, 1 for the smallest; to either side in a
        plane curve. So the design changes continuously from bending to one side over straight to the other.
        """
        s, planar = self.search, self.task.target.planar
        along = _chosen(trial, "cells_along", s.cells_along)
        around = _chosen(trial, "cells_around", s.cells_around)
        cuts = sorted(trial.suggest_float(f"{_CUT}_{i}", 0.0, 1.0) for i in range(1, s.segments))
        parts = []
        for i, rows in enumerate(_rows(cuts, along)):
            bend = trial.suggest_float(f"{_BEND}_{i}", -1.0 if planar else 0.0, 1.0)
            cg = float(self.law.cg[-1]) - abs(bend) * float(self.law.cg[-1] - self.lowest)
            share = _chosen(trial, f"reentrant_{i}", s.reentrant)
            place = 0 if planar else trial.suggest_int(f"middle_{i}", 0, around - 1)
            middle = around if bend < 0.0 else 2 * place
            columns = round(share * around)
            if columns % 2:
                middle += 1
            parts.append(Part(rows, round(cg, 4), columns, middle % (2 * around)))
        pressure = trial.suggest_float(_PRESSURE, s.pressure[0], self.highest)
        return SkinDesign(tuple(parts), around, pressure)

    def line(self, design: SkinDesign) -> Array:
        """Return the predicted line (41, 3), mm."""
        return design.line(self.law, self.task.tube.length, FRACTIONS)

    def deviation(self, design: SkinDesign) -> Deviation:
        """Return how far the predicted line is from the target."""
        return Deviation.of(self.line(design), self.task.target)


def _chosen(trial: Any, name: str, values: tuple[Any, ...]) -> Any:
    return values[0] if len(values) == 1 else trial.suggest_categorical(name, list(values))


def _rows(cuts: list[float], along: int) -> list[int]:
    """Return the rows of each segment: at least one each, borders at the cuts from 0 to 1."""
    spare = along - len(cuts) - 1
    borders = [0, *(round(cut * spare) for cut in cuts), spare]
    return [1 + after - before for before, after in pairwise(borders)]
