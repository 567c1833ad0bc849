"""Study files: what to build, how to drive it and what to measure, as checked data; reproductions of published work."""

from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.studies.running import run_study
from pneumorph.studies.study import Problem, Study, load_study, study_from

__all__ = ["Comparison", "Problem", "ReportedCurve", "Study", "load_study", "run_study", "study_from"]
