"""Fitting: which distributions describe measurements, and how sure that is. Pure functions of arrays `(n,)`."""

from __future__ import annotations

from xlmc.analysis.studies.fitting.candidate import Unfit
from xlmc.analysis.studies.fitting.fit import (
    CRITERIA,
    FEW,
    KINDS,
    Fitted,
    Fitting,
    cautions,
    fit,
    parameter_texts,
    rounded_value,
    row_to_paste,
    share_at_most,
)

__all__ = [
    "CRITERIA",
    "FEW",
    "KINDS",
    "Fitted",
    "Fitting",
    "Unfit",
    "cautions",
    "fit",
    "parameter_texts",
    "rounded_value",
    "row_to_paste",
    "share_at_most",
]
