"""All laws fitted to the same tests, best first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pneumorph.errors import InputError
from pneumorph.materials.fitting.fit import fit
from pneumorph.materials.fitting.models import MODELS, Model
from pneumorph.materials.fitting.result import Fit
from pneumorph.materials.fitting.specimen import SpecimenTest


@dataclass(frozen=True)
class Ranking:
    """Fits of several laws, by AICc, best first. skipped: name of each law that could not be fitted -> why."""

    fits: tuple[Fit, ...]
    skipped: tuple[tuple[str, str], ...] = ()

    @property
    def recommended(self) -> Fit:
        """The best fit that is stable wherever was looked; else the best one stable inside its tests; else the best."""
        stable = next((item for item in self.fits if item.stable), None)
        return stable or next((item for item in self.fits if not item.inside), self.fits[0])


def rank(
    tests: Sequence[SpecimenTest],
    models: Sequence[Model] = MODELS,
    weights: str = "equal",
    listen: Callable[[str], object] | None = None,
) -> Ranking:
    """Return the fits of models to tests, ranked by Akaike's corrected information criterion.

    listen: called with the name of each model before it is fitted. A model with too many constants for the points is
    skipped; raises InputError, that of the last one, where all are, and as `fit` does.
    """
    fits, skipped, refusal = [], [], InputError("no models to fit, expected one or more")
    for item in models:
        if listen is not None:
            listen(item.name)
        try:
            fits.append(fit(tests, item, weights))
        except InputError as error:
            skipped.append((item.name, str(error)))
            refusal = error
    if not fits:
        raise refusal
    return Ranking(tuple(sorted(fits, key=lambda item: item.aicc)), tuple(skipped))
