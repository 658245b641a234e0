"""What an asset loses in value, period by period; the last functions follow French accounting rules.

Letters of the formulas: C cost, S salvage value, L life, r = factor/L the declining rate. Time runs from 0 to L; within
a period the loss is spread evenly.

By the French rules (`AMORLINC`, `AMORDEGRC`) the first period is what is left of the year of purchase. Excel's
documents leave out most of the rules; these give what Excel computes. Dates are serials of the 1900 system.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.excel.functions.dates.calendar import parts_of
from xlmc.excel.functions.dates.day_count import by_basis, days_between, is_basis, is_leap_year
from xlmc.excel.functions.math.arithmetic import raise_to_power
from xlmc.excel.functions.registry import Logical, Number, excel
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import DIV0, NUM, Bools, Floats

__all__: list[str] = []

_MOST_PERIODS: Final = 2.0**53
"""A double counts up to here."""


@excel("SLN", Number, Number, Number)
def straight_line(cost: Any, salvage: Any, life: Any) -> Floats:
    """Return the same loss in every period; `#DIV/0!` without a life."""
    none = np.asarray(life) == 0
    return np.where(none, DIV0, np.subtract(cost, salvage) / np.where(none, 1.0, life))


@excel("SYD", Number, Number, Number, Number)
def sum_of_years(cost: Any, salvage: Any, life: Any, per: Any) -> Floats:
    """Return a loss that falls by the same step every period; `#NUM!` for a period outside 1 to the life."""
    wrong = (np.asarray(life) <= 0) | (np.asarray(per) <= 0) | np.greater(per, life) | (np.asarray(salvage) < 0)
    years = np.where(wrong, 1.0, life)
    return np.where(wrong, NUM, np.subtract(cost, salvage) * (life - np.asarray(per) + 1) * 2 / (years * (years + 1)))


@excel("DB", Number, Number, Number, Number, Number(default=12.0))
def fixed_declining(cost: Any, salvage: Any, life: Any, period: Any, month: Any) -> Floats:
    """Loss at a fixed rate, 1 - (S/C)^(1/L) to three decimals; the first year has `month` months."""
    cost, salvage, life = (np.asarray(x, np.float64) for x in (cost, salvage, life))
    whole, months = np.floor(period), np.floor(month)
    years = np.floor(life) + (months < 12)
    wrong = (cost < 0) | (salvage < 0) | (life <= 0) | (whole < 1) | (whole > years) | (months < 1) | (months > 12)
    gone = wrong | (cost == 0)
    remaining = raise_to_power(salvage / np.where(gone, 1.0, cost), 1 / np.where(gone, 1.0, life))
    rate = np.floor((1 - remaining) * 1000 + 0.5) / 1000
    first = cost * rate * months / 12
    later = (cost - first) * raise_to_power(1 - rate, np.maximum(whole - 2, 0.0)) * rate
    last = np.where(whole > life, (12 - months) / 12, 1.0)
    return np.where(wrong, NUM, np.where(gone, 0.0, np.where(whole == 1, first, later * last)))


def _is_refused(cost: Any, salvage: Any, life: Any, factor: Any) -> Bools:
    below = (np.asarray(cost) < 0) | (np.asarray(salvage) < 0)
    return np.asarray(below | (np.asarray(life) <= 0) | (np.asarray(factor) <= 0))


@excel("DDB", Number, Number, Number, Number, Number(default=2.0))
def double_declining(cost: Any, salvage: Any, life: Any, period: Any, factor: Any) -> Floats:
    """Loss at the rate factor/L of what is left, never below the salvage value; a part of the first period counts
    as the whole period.
    """
    wrong = _is_refused(cost, salvage, life, factor) | (np.asarray(period) <= 0) | np.greater(period, life)
    asset = _Declining(cost, salvage, np.where(wrong, 1.0, life), np.where(wrong, 1.0, factor))
    end = np.where(wrong, 1.0, np.maximum(period, 1.0))
    start = np.where(end < 2, 0.0, end - 1)
    return np.where(wrong, NUM, asset.left(start) - asset.left(end))


@excel("VDB", Number, Number, Number, Number, Number, Number(default=2.0), Logical(default=False))
def variable_declining(cost: Any, salvage: Any, life: Any, start: Any, end: Any, factor: Any, no_switch: Any) -> Floats:
    """Loss between two times, declining; unless `no_switch`, in equal parts as soon as these are more.

    With the switch, Excel counts whole periods from `start`, so that the time before it begins with a part of a period.
    """
    start, end = np.asarray(start, np.float64), np.asarray(end, np.float64)
    wrong = _is_refused(cost, salvage, life, factor) | (start < 0) | (end < start) | np.greater(end, life)
    start, end = np.where(wrong, 0.0, start), np.where(wrong, 0.0, end)
    switches = ~np.asarray(no_switch, bool)
    part = np.where(switches, start - np.floor(start), 0.0)
    asset = _Declining(cost, salvage, np.where(wrong, 1.0, life), np.where(wrong, 1.0, factor), part)
    declining = asset.left(start) - asset.left(end)
    switched = asset.left_switching(start) - asset.left_switching(end)
    return np.where(wrong, NUM, np.where(switches, switched, declining))


class _Declining:
    """An asset that loses the share r of what is left in every period, but never falls below its salvage value.

    The periods end at part, part + 1, part + 2, …; the first one is shortened to `part` unless that is 0.
    """

    def __init__(self, cost: Any, salvage: Any, life: Floats, factor: Floats, part: Any = 0.0) -> None:
        self._salvage, self._life, self._part = np.asarray(salvage, np.float64), life, np.asarray(part)
        self._rate = factor / life
        self._cost = np.asarray(cost, np.float64)
        self._after_part = self._cost - self._part * self._loss(self._cost)

    def _loss(self, value: Floats) -> Floats:
        """Return what a whole period takes from a value."""
        return np.maximum(np.minimum(value * self._rate, value - self._salvage), 0.0)

    def _after(self, periods: Floats) -> Floats:
        """Return the value at the end of the shortened period and so many whole ones."""
        remaining = np.maximum(1 - self._rate, 0.0)
        grown = self._after_part * raise_to_power(remaining, periods)
        return np.where(self._after_part > self._salvage, np.maximum(grown, self._salvage), self._after_part)

    def left(self, time: Floats) -> Floats:
        """Return the value at a time."""
        since = time - self._part
        whole = np.floor(np.maximum(since, 0.0))
        value = self._after(whole)
        later = value - (since - whole) * self._loss(value)
        return np.where(since < 0, self._cost - time * self._loss(self._cost), later)

    def left_switching(self, time: Floats) -> Floats:
        """Return the value at a time, if the asset changes to equal losses as soon as these are more."""
        switch = self._switch()
        value = self.left(switch)
        ahead = np.maximum(self._life - switch, np.finfo(float).tiny)
        even = value - (value - self._salvage) * np.minimum((time - switch) / ahead, 1.0)
        return np.where((time <= switch) | (value <= self._salvage), self.left(time), even)

    def _switch(self) -> Floats:
        """Return the end of the first period after which equal losses are more than declining ones; the end of life if
        none.

        With V(t) the declining value, equal losses are more where factor·(1 - t/L) + S/V(t) < 1. The left side is
        convex in t, so that up to its lowest point it falls, and halving finds that period.
        """
        last = np.clip(np.ceil(self._life - self._part) - 1, 0.0, _MOST_PERIODS)
        lowest = np.minimum(self._lowest(), last)
        beside = np.minimum(lowest + 1, last)
        high = np.where(self._even_is_more(lowest), lowest, np.where(self._even_is_more(beside), beside, last))
        ever, low = self._even_is_more(high), np.full(high.shape, -1.0)
        while (high - low > 1).any():
            middle = np.floor((low + high) / 2)
            more = self._even_is_more(middle)
            low, high = np.where(more, low, middle), np.where(more, middle, high)
        at_once = self._is_less(np.asarray(self._cost), self._life)
        return np.where(at_once, 0.0, np.where(ever, np.minimum(self._part + high, self._life), self._life))

    def _even_is_more(self, periods: Floats) -> Bools:
        return self._is_less(self._after(periods), self._life - self._part - periods)

    def _is_less(self, value: Floats, ahead: Floats) -> Bools:
        """Whether a value loses less by the rate than in equal parts over the time ahead."""
        return np.asarray((self._loss(value) * ahead < value - self._salvage) & (ahead > 0))

    def _lowest(self) -> Floats:
        """How many whole periods lie before the lowest point of the convex function of `_switch`."""
        pace = -np.log1p(-np.minimum(self._rate, 1 - np.finfo(float).epsneg))
        value, some = self._after_part, (self._salvage > 0) & (self._after_part > 0)
        ratio = np.where(some, value, 1.0) * self._rate / (np.where(some, self._salvage, 1.0) * pace)
        period_before = np.floor(np.log(np.maximum(ratio, 1.0)) / pace)
        return np.where(some, period_before, np.where(self._salvage > 0, 0.0, np.inf))


def _is_refused_french(cost: Any, salvage: Any, bought: Any, first: Any, period: Any, rate: Any, basis: Any) -> Bools:
    below = (np.asarray(salvage) < 0) | (np.asarray(period) < 0) | (np.asarray(rate) <= 0)
    wrong_basis = ~is_basis(basis) | (np.floor(basis) == 2)
    return np.asarray(below | np.less(cost, salvage) | np.greater(bought, first) | wrong_basis)


def _first_loss(cost: Any, bought: Any, first: Any, rate: Any, basis: Any) -> Floats:
    """Loss from the day of purchase to the end of the first period, at a rate a year; 0 where they are one day."""
    true_year = np.where(is_leap_year(parts_of(bought)[0]), 366.0, 365.0)
    year = by_basis(basis, lambda: 360.0, lambda: true_year, lambda: 360.0, lambda: 365.0, lambda: 360.0)
    days = days_between(_leap_day_as_28th(bought, basis), _leap_day_as_28th(first, basis), basis)
    return np.asarray(days / year * rate * cost)


def _leap_day_as_28th(serial: Any, basis: Any) -> Floats:
    """Return the date, but 29 February as the 28th where the basis counts true days."""
    _, month, day = parts_of(serial)
    true_days = (np.floor(basis) == 1) | (np.floor(basis) == 3)
    return np.where(true_days & (month == 2) & (day == 29), np.asarray(serial) - 1, serial)


@toolpak("AMORLINC", Number, Date, Date, Number, Number, Number, Number(default=0.0))
def linear(cost: Any, bought: Any, first: Any, salvage: Any, period: Any, rate: Any, basis: Any) -> Floats:
    """Return the same loss in each period, down to the salvage value."""
    wrong = _is_refused_french(cost, salvage, bought, first, period, rate, basis)
    yearly = np.multiply(cost, np.where(wrong, 1.0, rate))
    to_lose = np.subtract(cost, salvage)
    at_first = _first_loss(cost, bought, first, rate, basis)
    at_first = np.minimum(np.where(at_first == 0, yearly, at_first), to_lose)
    before = at_first + yearly * (np.floor(period) - 1)
    later = np.where(np.floor(period) < 1, yearly, np.clip(to_lose - before, 0.0, yearly))
    gone = np.greater(period, np.ceil(1 / np.where(wrong, 1.0, rate))) | (to_lose == 0)
    return np.where(wrong, NUM, np.where(gone, 0.0, np.where(np.asarray(period) == 0, at_first, later)))


def _rate_factor(life: Floats) -> Floats:
    """Return the factor on the rate: 1.5 for assets of 3 or 4 years, 2 for 5 or 6, 2.5 beyond."""
    return np.select([life > 6, life >= 5, life >= 3], [2.5, 2.0, 1.5], 1.0)


def _to_whole(x: Floats) -> Floats:
    """Round to the nearest whole number, halves upwards; what is a half in its first 13 digits counts as one."""
    return np.asarray(np.floor(x * (1 + 1e-13) + 0.5))


@toolpak("AMORDEGRC", Number, Date, Date, Number, Number, Number, Number(default=0.0))
def degressive(cost: Any, bought: Any, first: Any, salvage: Any, period: Any, rate: Any, basis: Any) -> Floats:
    """Return a loss at a raised rate of what is left, in whole numbers; the last period but one takes half of what is
    left, and the last takes all. `#NUM!` for assets of less than 3 years, or of 4 to 5.
    """
    wrong = _is_refused_french(cost, salvage, bought, first, period, rate, basis)
    years = 1 / np.where(wrong, 1.0, rate)
    wrong = wrong | (years <= 3) | ((years >= 4) & (years <= 5))
    life = np.ceil(years)
    raised = np.where(wrong, 0.5, rate) * _rate_factor(life)
    at_first = _first_loss(cost, bought, first, raised, basis)
    life = np.where(at_first == 0, life, life + 1)
    at_first = np.where(at_first == 0, np.multiply(cost, raised), at_first)
    at_first = _to_whole(np.minimum(at_first, np.subtract(cost, salvage)))
    later = _degressive_loss(cost - at_first, salvage, raised, life, np.floor(period))
    gone = np.greater(period, np.ceil(years)) | np.equal(cost, salvage)
    return np.where(wrong, NUM, np.where(gone, 0.0, np.where(np.asarray(period) == 0, at_first, _to_whole(later))))


def _degressive_loss(value: Floats, salvage: Any, rate: Floats, life: Floats, period: Floats) -> Floats:
    """Loss in a period from 1 on, of an asset that starts it at `value`; 0 before.

    The value falls by the rate in each period until it lies below the salvage value; then nothing more is lost.
    """
    half = life - 3  # the last period but one, which takes half of the value; counted without the first period
    declined = value * raise_to_power(np.maximum(1 - rate, 0.0), np.clip(period - 1, 0.0, half - 1))
    before = np.where(period > half, declined / 2, declined)
    share = np.select([period < half, period == half, period == half + 1], [rate, 0.5, 1.0], 0.0)
    return np.where((period < 1) | (before < salvage), 0.0, before * share)
