"""Which assumptions to measure for each forecast where there are many: those that a first look at all of them finds.

The look sees any shape. An assumption is cut into 16 classes of equal probability, and three functions of a forecast
are averaged in each: its value, which shows a rare jump; its rank, which shows what a heavy tail would hide; and how
far its rank is from the middle, which shows an assumption that only widens the forecast, alone or together with others.
An assumption's score is the largest share of the variance of one of them that its classes explain (Pearson's
correlation ratio, adjusted as in `given_data`).

All functions are rounded to whole numbers, whose sums are exact in double precision: matrix products of them have the
same bits whatever adds them up, in whatever order and number of threads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.given_data import standardise
from xlmc.analysis.studies.sensitivity.ranked import Ranked
from xlmc.montecarlo.interruption import checkpoint

__all__ = ["LOOK_TRIALS", "FirstLook", "first_look"]

Floats = NDArray[np.float64]

LOOK_TRIALS: Final = 1 << 11
"""The trials of the look; 16 classes explain by chance 0.003 of a variance in them, as a standard error."""

_CLASSES = 16
_TOGETHER = 64
"""Assumptions in one matrix product."""

_FINE = 2.0**20
"""Parts of a standard deviation to which values are rounded."""


@dataclass(frozen=True)
class FirstLook:
    """What a first look at all assumptions shows.

    Attributes:
        scores: `(assumptions, forecasts)` shares of variance; −inf where one of the two does not vary.
        squares: `(assumptions, forecasts)` squared rank correlations; 0 where one of the two does not vary.
    """

    scores: Floats
    squares: Floats

    def first(self, forecast: int, most: int) -> NDArray[np.intp]:
        """Return the indices of the `most` assumptions with the largest scores for a forecast, in their order."""
        return np.sort(np.argsort(-self.scores[:, forecast], kind="stable")[:most])


def first_look(draws: Sequence[Floats], forecasts: Sequence[Floats]) -> FirstLook:
    """Look at every assumption and every forecast.

    Args:
        draws: `(n,)` each, of the assumptions; at most `LOOK_TRIALS`, so that sums are exact.
        forecasts: `(n,)` each; NaN where a forecast is no number, which counts as its mean.
    """
    seen = [_functions(y) for y in forecasts]
    tables = np.concatenate([np.array(function) for function in zip(*seen, strict=True)])  # (3 · forecasts, n)
    totals = np.sum(tables * tables, axis=1)
    scores, squares = [], []
    for start in range(0, len(draws), _TOGETHER):
        checkpoint()
        ranked = [Ranked.of(column) for column in draws[start : start + _TOGETHER]]
        share = _class_shares(ranked, tables, totals)
        scores.append(share.reshape(len(ranked), 3, len(forecasts)).max(axis=1))
        grades = np.array([_whole_grades(each) for each in ranked])
        products = grades @ tables[len(forecasts) : 2 * len(forecasts)].T
        size = np.sum(grades * grades, axis=1)[:, None] * totals[len(forecasts) : 2 * len(forecasts)]
        squares.append(np.divide(products**2, size, out=np.zeros_like(products), where=size > 0.0))
    return FirstLook(np.concatenate(scores), np.concatenate(squares))


def _class_shares(ranked: Sequence[Ranked], tables: Floats, totals: Floats) -> Floats:
    """Return `(assumptions, functions)` adjusted shares of the functions' variance that classes explain."""
    n = tables.shape[1]
    classes = [np.floor((each.grades + 0.5) * _CLASSES).astype(np.intp) for each in ranked]
    members = np.zeros((len(ranked), _CLASSES, n))
    for row, labels in zip(members, classes, strict=True):
        row[labels, np.arange(n)] = 1.0
    sizes = members.sum(axis=2)
    sums = (members.reshape(-1, n) @ tables.T).reshape(len(ranked), _CLASSES, -1)
    between = np.sum(sums**2 / np.maximum(sizes, 1.0)[:, :, None], axis=1)
    filled = np.count_nonzero(sizes, axis=1)[:, None]
    left = np.divide(totals - between, totals, out=np.full_like(between, np.inf), where=totals > 0.0)
    shares = 1.0 - left * (n - 1.0) / np.maximum(n - filled, 1.0)
    return np.where(filled > 1, shares, -np.inf)


def _functions(y: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the value, the rank and the distance of the rank from the middle: whole numbers whose mean is about 0."""
    known = ~np.isnan(y)
    value, grade, distance = np.zeros((3, y.size))
    if np.count_nonzero(known) > 1:
        z = standardise(y[known])
        if z is not None:
            value[known] = np.rint(z * _FINE)
            grade[known] = _whole_grades(Ranked.of(y[known]))
            distance[known] = np.abs(grade[known])
            distance[known] = np.rint(distance[known] - distance[known].mean())
    return value, grade, distance


def _whole_grades(ranked: Ranked) -> Floats:
    """Return `(n,)` grades in units of 1/(2n): whole numbers, also where values are equal."""
    return np.rint(2.0 * ranked.n * ranked.grades)
