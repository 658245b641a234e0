"""Depreciation by French accounting rules: the first period is what is left of the year of purchase.

Excel's documents leave out most of the rules; these give what Excel computes. Dates are serials of the 1900 system.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.calendar import parts_of
from xlmc.functions.dates.day_count import by_basis, days_between, is_basis
from xlmc.functions.dates.months import is_leap_year
from xlmc.functions.math.powers import powered
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Bools, Floats

__all__: list[str] = []


def _refused(cost: Any, salvage: Any, bought: Any, first: Any, period: Any, rate: Any, basis: Any) -> Bools:
    below = (np.asarray(salvage) < 0) | (np.asarray(period) < 0) | (np.asarray(rate) <= 0)
    wrong_basis = ~is_basis(basis) | (np.floor(basis) == 2)
    return np.asarray(below | np.less(cost, salvage) | np.greater(bought, first) | wrong_basis)


def _first_loss(cost: Any, bought: Any, first: Any, rate: Any, basis: Any) -> Floats:
    """Loss from the day of purchase to the end of the first period, at a rate a year; 0 where they are one day."""
    true_year = np.where(is_leap_year(parts_of(bought)[0]), 366.0, 365.0)
    year = by_basis(basis, lambda: 360.0, lambda: true_year, lambda: 360.0, lambda: 365.0, lambda: 360.0)
    days = days_between(_not_leap_day(bought, basis), _not_leap_day(first, basis), basis)
    return np.asarray(days / year * rate * cost)


def _not_leap_day(serial: Any, basis: Any) -> Floats:
    """Where days are counted truly, 29 February counts as the 28th."""
    _, month, day = parts_of(serial)
    true_days = (np.floor(basis) == 1) | (np.floor(basis) == 3)
    return np.where(true_days & (month == 2) & (day == 29), np.asarray(serial) - 1, serial)


@toolpak("AMORLINC", Number, Date, Date, Number, Number, Number, Number(default=0.0))
def linear(cost: Any, bought: Any, first: Any, salvage: Any, period: Any, rate: Any, basis: Any) -> Floats:
    """The same loss in each period, down to the salvage value."""
    wrong = _refused(cost, salvage, bought, first, period, rate, basis)
    yearly = np.multiply(cost, np.where(wrong, 1.0, rate))
    to_lose = np.subtract(cost, salvage)
    at_first = _first_loss(cost, bought, first, rate, basis)
    at_first = np.minimum(np.where(at_first == 0, yearly, at_first), to_lose)
    before = at_first + yearly * (np.floor(period) - 1)
    later = np.where(np.floor(period) < 1, yearly, np.clip(to_lose - before, 0.0, yearly))
    gone = np.greater(period, np.ceil(1 / np.where(wrong, 1.0, rate))) | (to_lose == 0)
    return np.where(wrong, NUM, np.where(gone, 0.0, np.where(np.asarray(period) == 0, at_first, later)))


def _factor(life: Floats) -> Floats:
    """By how much the rate is raised: 1.5 for assets of 3 or 4 years, 2 for 5 or 6, 2.5 beyond."""
    return np.select([life > 6, life >= 5, life >= 3], [2.5, 2.0, 1.5], 1.0)


def _to_whole(x: Floats) -> Floats:
    """To the nearest whole number, halves upwards, as Excel sees them in the first 13 digits."""
    return np.asarray(np.floor(x * (1 + 1e-13) + 0.5))


@toolpak("AMORDEGRC", Number, Date, Date, Number, Number, Number, Number(default=0.0))
def degressive(cost: Any, bought: Any, first: Any, salvage: Any, period: Any, rate: Any, basis: Any) -> Floats:
    """A loss at a raised rate of what is left, to whole numbers; half of what is left in the last period but one, and
    all of it in the last. `#NUM!` for assets of less than 3 years, or of 4 to 5.
    """
    wrong = _refused(cost, salvage, bought, first, period, rate, basis)
    years = 1 / np.where(wrong, 1.0, rate)
    wrong = wrong | (years <= 3) | ((years >= 4) & (years <= 5))
    life = np.ceil(years)
    raised = np.where(wrong, 0.5, rate) * _factor(life)
    at_first = _first_loss(cost, bought, first, raised, basis)
    life = np.where(at_first == 0, life, life + 1)
    at_first = np.where(at_first == 0, np.multiply(cost, raised), at_first)
    at_first = _to_whole(np.minimum(at_first, np.subtract(cost, salvage)))
    later = _degressed(cost - at_first, salvage, raised, life, np.floor(period))
    gone = np.greater(period, np.ceil(years)) | np.equal(cost, salvage)
    return np.where(wrong, NUM, np.where(gone, 0.0, np.where(np.asarray(period) == 0, at_first, _to_whole(later))))


def _degressed(value: Floats, salvage: Any, rate: Floats, life: Floats, period: Floats) -> Floats:
    """Loss in a period from 1 on, of an asset that starts it at `value`; 0 before.

    The value falls by the rate in each period until it lies below the salvage value, from when on nothing is lost.
    """
    half = life - 3  # the period in which half of the value goes: the last but one, of those after the first
    declined = value * powered(np.maximum(1 - rate, 0.0), np.clip(period - 1, 0.0, half - 1))
    before = np.where(period > half, declined / 2, declined)
    share = np.select([period < half, period == half, period == half + 1], [rate, 0.5, 1.0], 0.0)
    return np.where((period < 1) | (before < salvage), 0.0, before * share)
