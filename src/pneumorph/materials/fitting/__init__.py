"""From the records of a testing machine to the constants of a law: reading, preparing, fitting, ranking."""

from pneumorph.materials.fitting.fit import WEIGHTS, fit
from pneumorph.materials.fitting.models import MODELS, Model, model
from pneumorph.materials.fitting.prepare import BRANCHES, prepare
from pneumorph.materials.fitting.ranking import Ranking, rank
from pneumorph.materials.fitting.read import ReadOptions, read_tests
from pneumorph.materials.fitting.result import Fit, LargestError
from pneumorph.materials.fitting.specimen import SpecimenTest, mode_named

__all__ = [
    "BRANCHES",
    "Fit",
    "LargestError",
    "MODELS",
    "Model",
    "Ranking",
    "ReadOptions",
    "SpecimenTest",
    "WEIGHTS",
    "fit",
    "mode_named",
    "model",
    "prepare",
    "rank",
    "read_tests",
]
