"""Interest that has accrued on a bond since its issue. Dates are serials of the 1900 system."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.calendar import parts_of
from xlmc.functions.dates.day_count import by_basis, days_between, european_360, is_basis, us_360
from xlmc.functions.dates.months import is_month_end, months_later
from xlmc.functions.financial.coupons import is_frequency, months_between
from xlmc.functions.registry import Logical, Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Floats

__all__: list[str] = []


class _Schedule:
    """Coupon dates that would be, numbered from the first coupon on, which is number 0."""

    def __init__(self, first: Any, frequency: Any, basis: Any) -> None:
        self._first, self._to_end, self._basis = first, is_month_end(first), basis
        self._step = months_between(frequency)
        self.a_year = 12 / self._step

    def date(self, number: Any) -> Floats:
        return months_later(self._first, number * self._step, self._to_end)

    def last_up_to(self, serial: Any) -> Floats:
        """The number of the last coupon up to a day."""
        (year, month, _), (first_year, first_month, _) = parts_of(serial), parts_of(self._first)
        number = np.floor(((year - first_year) * 12 + month - first_month) / self._step)
        return np.asarray(number - (self.date(number) > serial))

    def length(self, number: Any) -> Floats:
        """Length of the period from a coupon to the next by the day count."""
        a_year = self.a_year
        return by_basis(
            self._basis,
            lambda: 360 / a_year,
            lambda: self.date(number + 1) - self.date(number),
            lambda: 360 / a_year,
            lambda: 365 / a_year,
            lambda: 360 / a_year,
        )

    def counted_length(self, number: Any) -> Floats:
        """The same as Excel has it for the period of the issue: by the dates, but with months of 30 days."""
        start, end = self.date(number), self.date(number + 1)
        return by_basis(
            self._basis,
            lambda: us_360(start, end, end_too=True),
            lambda: end - start,
            lambda: us_360(start, end),
            lambda: 365 / self.a_year,
            lambda: european_360(start, end),
        )


@toolpak("ACCRINT", Date, Date, Date, Number, Number, Number, Number(default=0.0), Logical(default=True))
def accrued_interest(
    issue: Any, first: Any, settlement: Any, rate: Any, par: Any, frequency: Any, basis: Any, from_issue: Any
) -> Floats:
    """Interest accrued from issue to settlement, period by period.

    Without `from_issue`, and settled after the first coupon, only from that on. `#NUM!` unless rate and par are above
    0.
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
    return np.where(wrong, NUM, par * rate / schedule.a_year * (before + at_end))
