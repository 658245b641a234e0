"""What `xlmc methods` found, as a document."""

from __future__ import annotations

from xlmc.analysis.studies.methods import Study
from xlmc.outputs.methods.methods_report import methods_report as with_figures
from xlmc.outputs.study_report import StudyReport

__all__ = ["methods_report"]


def methods_report(study: Study) -> StudyReport:
    """Return the report without the figures that matplotlib draws."""
    return with_figures(study, figures=False)
