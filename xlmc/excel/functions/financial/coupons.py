"""Coupon dates of bonds, the days around them, and the interest that has accrued since a bond's issue.

Coupons fall due every 12/frequency months, counted back from maturity; if that is the end of a month, all are.
Dates are serials of the 1900 system.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from xlmc.excel.functions.dates.calendar import parts_of
from xlmc.excel.functions.dates.day_count import (
    by_basis,
    days_between,
    european_360,
    is_basis,
    is_month_end,
    months_later,
    us_360,
)
from xlmc.excel.functions.registry import Logical, Number
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__ = ["Coupons", "is_frequency", "months_between"]


def is_frequency(frequency: Any) -> Bools:
    """Whether a number, its fraction dropped, is 1, 2 or 4 coupons a year."""
    whole = np.floor(frequency)
    return np.asarray((whole == 1) | (whole == 2) | (whole == 4))


def months_between(frequency: Any) -> Floats:
    """Months from one coupon to the next; 12 where the frequency is none of Excel's."""
    return np.where(is_frequency(frequency), 12 / np.where(is_frequency(frequency), np.floor(frequency), 1.0), 12.0)


@dataclass(frozen=True)
class Coupons:
    """The coupon period in which a bond is bought.

    Attributes:
        settlement: day of the purchase, (n,).
        maturity: day of the last coupon, (n,).
        frequency: coupons a year, 1, 2 or 4, (n,); others are taken for 1.
        basis: day count, 0 to 4, (n,).
    """

    settlement: Any
    maturity: Any
    frequency: Any
    basis: Any

    @cached_property
    def count(self) -> Floats:
        """How many coupons fall due after settlement."""
        (year, month, _), (last_year, last_month, _) = parts_of(self.settlement), parts_of(self.maturity)
        whole = np.floor(((last_year - year) * 12 + last_month - month) / self._step)
        return np.asarray(np.maximum(whole + (self._before_maturity(whole) > self.settlement), 1.0))

    @cached_property
    def previous(self) -> Floats:
        """The last coupon date up to settlement."""
        return self._before_maturity(self.count)

    @cached_property
    def next(self) -> Floats:
        """The first coupon date after settlement."""
        return self._before_maturity(self.count - 1)

    @cached_property
    def _step(self) -> Floats:
        return months_between(self.frequency)

    def _before_maturity(self, periods: Floats) -> Floats:
        return months_later(self.maturity, -periods * self._step, is_month_end(self.maturity))

    @property
    def days(self) -> Floats:
        """Length of the period by the day count."""
        per_year = 12 / self._step
        return by_basis(
            self.basis,
            lambda: 360 / per_year,
            lambda: self.next - self.previous,
            lambda: 360 / per_year,
            lambda: 365 / per_year,
            lambda: 360 / per_year,
        )

    @property
    def days_before(self) -> Floats:
        """Days from the previous coupon to settlement."""
        return days_between(self.previous, self.settlement, self.basis)

    @property
    def days_after(self) -> Floats:
        """Days from settlement to the next coupon."""

        def us() -> Floats:
            whole = us_360(self.previous, self.next, end_too=True)
            return np.asarray(whole - us_360(self.previous, self.settlement))

        def true_days() -> Floats:
            return np.asarray(self.next - self.settlement)

        return by_basis(
            self.basis, us, true_days, true_days, true_days, lambda: european_360(self.settlement, self.next)
        )

    @property
    def refused(self) -> Bools:
        """The trials in which Excel gives `#NUM!`: bought on or after maturity, or no such frequency or basis."""
        known = is_frequency(self.frequency) & is_basis(self.basis)
        return np.asarray(~known | np.greater_equal(self.settlement, self.maturity))


@toolpak("COUPDAYS", Date, Date, Number, Number(default=0.0))
def days_in_period(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """Days of the coupon period that holds settlement."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.days)


@toolpak("COUPDAYBS", Date, Date, Number, Number(default=0.0))
def days_from_coupon(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """Days from the coupon before settlement to settlement."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.days_before)


@toolpak("COUPDAYSNC", Date, Date, Number, Number(default=0.0))
def days_to_coupon(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """Days from settlement to the next coupon."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.days_after)


@toolpak("COUPNUM", Date, Date, Number, Number(default=0.0))
def coupon_count(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """How many coupons fall due from settlement to maturity."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.count)


@toolpak("COUPPCD", Date, Date, Number, Number(default=0.0), gives_date=True)
def previous_coupon(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """Date of the coupon before settlement."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.previous)


@toolpak("COUPNCD", Date, Date, Number, Number(default=0.0), gives_date=True)
def next_coupon(settlement: Any, maturity: Any, frequency: Any, basis: Any) -> Floats:
    """Date of the coupon after settlement."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    return np.where(coupons.refused, NUM, coupons.next)


class _Schedule:
    """Coupon dates without end, before the first coupon too, which is number 0."""

    def __init__(self, first: Any, frequency: Any, basis: Any) -> None:
        self._first, self._to_end, self._basis = first, is_month_end(first), basis
        self._step = months_between(frequency)
        self.per_year = 12 / self._step

    def date(self, number: Any) -> Floats:
        return months_later(self._first, number * self._step, self._to_end)

    def last_up_to(self, serial: Any) -> Floats:
        """Return the number of the last coupon up to a day."""
        (year, month, _), (first_year, first_month, _) = parts_of(serial), parts_of(self._first)
        number = np.floor(((year - first_year) * 12 + month - first_month) / self._step)
        return np.asarray(number - (self.date(number) > serial))

    def length(self, number: Any) -> Floats:
        """Length of the period from a coupon to the next by the day count."""
        per_year = self.per_year
        return by_basis(
            self._basis,
            lambda: 360 / per_year,
            lambda: self.date(number + 1) - self.date(number),
            lambda: 360 / per_year,
            lambda: 365 / per_year,
            lambda: 360 / per_year,
        )

    def counted_length(self, number: Any) -> Floats:
        """Return the same length as Excel counts it for the period of the issue: by the dates, with months of
        30 days.
        """
        start, end = self.date(number), self.date(number + 1)
        return by_basis(
            self._basis,
            lambda: us_360(start, end, end_too=True),
            lambda: end - start,
            lambda: us_360(start, end),
            lambda: 365 / self.per_year,
            lambda: european_360(start, end),
        )


@toolpak("ACCRINT", Date, Date, Date, Number, Number, Number, Number(default=0.0), Logical(default=True))
def accrued_interest(
    issue: Any, first: Any, settlement: Any, rate: Any, par: Any, frequency: Any, basis: Any, from_issue: Any
) -> Floats:
    """Interest accrued from issue to settlement, period by period.

    Without `from_issue`, a bond settled after its first coupon accrues only from there. `#NUM!` unless rate and par
    are above 0.
    """
    wrong = np.greater_equal(issue, settlement) | ~is_frequency(frequency) | ~is_basis(basis)
    wrong = wrong | (np.asarray(rate) <= 0) | (np.asarray(par) <= 0)
    schedule = _Schedule(first, frequency, basis)
    late = np.greater(settlement, first)
    begin = np.where(late & ~np.asarray(from_issue, bool), np.maximum(issue, first), issue)
    last = np.where(late, schedule.last_up_to(settlement), -1.0)
    start = np.maximum(begin, schedule.date(last))
    at_end = days_between(start, settlement, basis) / schedule.length(last)
    first_period = schedule.last_up_to(begin)
    next_date = schedule.date(first_period + 1)
    whole = schedule.date(first_period) == begin
    at_begin = np.where(whole, 1.0, days_between(begin, next_date, basis) / schedule.counted_length(first_period))
    before = np.where(first_period < last, last - first_period - 1 + at_begin, 0.0)
    return np.where(wrong, NUM, par * rate / schedule.per_year * (before + at_end))
