"""Fitting: which distributions describe measurements, and how sure that is. Pure functions of arrays `(n,)`."""

from __future__ import annotations

from xlmc.fitting.candidate import Unfit
from xlmc.fitting.cautions import FEW, cautions
from xlmc.fitting.fit import CRITERIA, KINDS, Fitted, Fitting, fit
from xlmc.fitting.paste import row_to_paste

__all__ = ["CRITERIA", "FEW", "KINDS", "Fitted", "Fitting", "Unfit", "cautions", "fit", "row_to_paste"]
