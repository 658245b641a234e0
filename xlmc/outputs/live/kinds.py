"""The kinds of distribution that an assumption of the window can be given, with numbers that suit what it was.

What a kind makes of an assumption depends on the workbook alone: ends stay ends, and a kind without ends has the mean
and the standard deviation that the assumption has. The numbers can be moved then as any others.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from xlmc.excel.address import InFormula
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["KINDS", "distribution_in_kind", "in_kind", "kinds_of"]

KINDS: Final = ("Uniform", "Triangular", "BetaPERT", "Normal", "Lognormal")
"""Those that can be chosen, beside the workbook's own."""

_PROBABILITIES: Final = (np.arange(2_000) + 0.5) / 2_000
_DIGITS: Final = 4
"""Digits of the difference between an assumption's ends to which its new numbers are rounded."""


def kinds_of(assumption: Assumption) -> tuple[str, ...]:
    """Return the kinds that an assumption can be given, its own first; none where formulas or data say what it is."""
    if assumption.data is not None or assumption.call is not None or isinstance(assumption.cell, InFormula):
        return ()
    if assumption.own_family is not None or assumption.cells:
        return ()
    return (assumption.distribution, *(kind for kind in KINDS if kind != assumption.distribution))


def in_kind(assumption: Assumption, kind: str) -> Assumption:
    """Return an assumption of the workbook in another kind; itself in its own, or where it cannot be given another."""
    if kind == assumption.distribution or kind not in kinds_of(assumption):
        return assumption
    distribution = distribution_in_kind(assumption, kind)
    return replace(assumption, distribution=kind, given=distribution.given, checked=None, stated={})


def distribution_in_kind(assumption: Assumption, kind: str) -> Distribution:
    """Return what an assumption of the workbook is drawn from in another kind."""
    draws = np.sort(
        Draw.of(assumption.name, assumption.family, assumption.given).distribution.percentile(_PROBABILITIES)
    )
    low, middle, high = (float(draws[place]) for place in (0, draws.size // 2, -1))
    given = assumption.parameters
    if {"low", "high"} <= given.keys() and not assumption.cutoffs:
        low, high = float(given["low"]), float(given["high"])  # type: ignore[arg-type]  # numbers, as there are no cells
        middle = float(given.get("likeliest", 0.5 * (low + high)))  # type: ignore[arg-type]  # likewise
    if not low < high:
        low, high = middle - (abs(middle) or 1.0) * 0.1, middle + (abs(middle) or 1.0) * 0.1
    step = 10.0 ** (math.floor(math.log10(high - low)) - _DIGITS + 1)
    spread = float(draws.std()) or 0.25 * (high - low)
    parameters = {
        "low": _rounded(low, step),
        "likeliest": _rounded(middle, step),
        "high": _rounded(high, step),
        "location": 0.0 if low > 0.0 else _rounded(low - (high - low), step),
        "mean": _rounded(float(draws.mean()), step),
        "std_dev": _rounded(spread, step),
    }
    return Distribution(kind, *(parameters[key] for key in FAMILIES[kind].keys))


def _rounded(value: float, step: float) -> float:
    """Return 0.6875, not 0.6874999999999999."""
    return float(f"{round(value / step) * step:.12g}")
