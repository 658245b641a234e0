"""Why an answer that was given once is off: the part of the filters, and that of the formulas, measured apart.

Its error is its distance from the answer without filters, which the method made of the formulas alone, and the distance
from there to the answer with them, which it cannot see.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.studies.methods.curve import Curve
from xlmc.studies.methods.need import Shortfall
from xlmc.studies.methods.number_words import percent_words, rounded, spelt
from xlmc.studies.methods.study import Study

__all__ = ["Parts", "missed", "parts_of"]

_BEYOND: Final = 3.0
"""Standard errors from which on a part counts as measured."""

_LEFT_OUT: Final = {
    "taylor-1": "it takes every curve for straight and every answer for normally distributed",
    "taylor-2": "over these ranges the formulas are more than quadratic polynomials",
}
_ELSE: Final = "it leaves something out of the formulas"


@dataclass(frozen=True, slots=True)
class Parts:
    """Of an error, in the forecast's units, with its sign.

    Attributes:
        filters: what the filters do, which the method does not see.
        formulas: what it leaves out of the formulas.
        error: the standard error of each of them.
    """

    filters: float
    formulas: float
    error: float


def parts_of(study: Study, found: Shortfall) -> Parts | None:
    """The parts of an error; None where there are no filters that reject anything, or no answer without them."""
    if study.unfiltered is None:
        return None
    free, own = study.unfiltered.answers[found.forecast], study.unfiltered.errors[found.forecast]
    truth = study.reference.answers[found.forecast]
    filters = float(getattr(free, found.statistic)) - float(getattr(truth, found.statistic))
    error = float(np.nan_to_num(getattr(own, found.statistic)))
    return Parts(filters, found.error - filters, float(np.hypot(error, np.nan_to_num(found.own))))


def missed(study: Study, curve: Curve, found: Shortfall) -> str:
    """What a method misses by the most, and why, in a sentence or two."""
    if not np.isfinite(found.times):
        return f"{curve.method.name} has no number for {found.forecast}."
    units = next((f" {f.units}" for f in study.model.forecasts if f.name == found.forecast and f.units), "")
    share = abs(found.error) / study.reference.widths[found.forecast]
    text = (
        f"{curve.method.name} misses the {spelt(found.statistic)} of {found.forecast} by "
        f"{rounded(abs(found.error))}{units}, {percent_words(share)} of its 5–95 % range"
    )
    why = _LEFT_OUT.get(curve.method.key, _ELSE)
    rejected = 1.0 - study.reference.acceptance.value
    if not study.model.filters or rejected == 0.0:
        return f"{text}: {why}."
    seen = f"it does not see the filters, which reject {percent_words(rejected)} of the trials"
    parts = parts_of(study, found)
    if parts is None:
        return (
            f"{text}. {seen[0].upper()}{seen[1:]}; and {why}. Without the filters there is no answer to part them by."
        )
    filters = _part(parts.filters, parts, units, f"because {seen}", "for the filters, which it does not see")
    formulas = _part(parts.formulas, parts, units, f"because {why}", "for what it leaves out of the formulas")
    return f"{text}. Measured apart: {filters}; {formulas}."


def _part(value: float, parts: Parts, units: str, because: str, otherwise: str) -> str:
    if abs(value) <= _BEYOND * parts.error:
        return f"no more than chance (±{rounded(_BEYOND * parts.error)}{units}) {otherwise}"
    return f"{'+' if value > 0.0 else '−'}{rounded(abs(value))}{units} {because}"
