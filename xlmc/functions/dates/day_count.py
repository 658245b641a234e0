"""How many days and years lie between dates by the rules of the bond markets: Excel's `basis` argument.

0: months of 30 days (US), years of 360; 1: true days and years; 2: true days, years of 360; 3: true days, years of 365;
4: months of 30 days (European), years of 360. Dates are serials of the 1900 system.

Sources: D. A. Wheeler, "YEARFRAC Incompatibilities between Excel 2007 and OOXML" (2008), for what Excel does; values
that Excel computed, for the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from xlmc.functions.dates.calendar import parts_of, serial_of
from xlmc.functions.dates.months import is_leap_year, is_month_end
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Bools, Floats

__all__ = ["by_basis", "days_between", "days_in_year", "european_360", "is_basis", "us_360"]


def is_basis(basis: Any) -> Bools:
    """Whether a number, its fraction dropped, is one of the five bases."""
    return np.asarray((np.asarray(basis) >= 0) & (np.asarray(basis) < 5))


def by_basis(basis: Any, *choices: Callable[[], Any]) -> Floats:
    """Of five results the one of each trial's basis; those that no trial needs are not computed. NaN for no basis."""
    codes = np.floor(basis)
    result = np.asarray(np.nan)
    for code, choice in enumerate(choices):
        here = codes == code
        if here.any():
            result = np.where(here, choice(), result)
    return np.asarray(result, np.float64)


def us_360(start: Any, end: Any, *, end_too: bool = False) -> Floats:
    """Days between two dates with months of 30 days, the US way: a 31st is a 30th, and so is the last of February.

    At the end that holds only where the start is such a day too, unless `end_too`.
    """
    (year, month, day), (last_year, last_month, last_day) = parts_of(start), parts_of(end)
    from_february = (month == 2) & is_month_end(start)
    to_february = (last_month == 2) & is_month_end(end)
    shortened = (last_day == 31) & ((day >= 30) | end_too) | to_february & (from_february | end_too)
    last_day = np.where(shortened, 30, last_day)
    day = np.where(from_february, 30, np.minimum(day, 30))
    return np.asarray((last_year - year) * 360 + (last_month - month) * 30 + last_day - day, np.float64)


def european_360(start: Any, end: Any) -> Floats:
    """Days between two dates with months of 30 days, the European way: a 31st is a 30th."""
    (year, month, day), (last_year, last_month, last_day) = parts_of(start), parts_of(end)
    days = np.minimum(last_day, 30) - np.minimum(day, 30)
    return np.asarray((last_year - year) * 360 + (last_month - month) * 30 + days, np.float64)


def days_between(start: Any, end: Any, basis: Any) -> Floats:
    """Days from one date to a later one."""

    def true_days() -> Floats:
        return np.asarray(end - start, np.float64)

    return by_basis(
        basis, lambda: us_360(start, end), true_days, true_days, true_days, lambda: european_360(start, end)
    )


def days_in_year(start: Any, end: Any, basis: Any) -> Floats:
    """Length of the year by which the days from one date to a later one are divided."""
    return by_basis(basis, lambda: 360.0, lambda: _true_year(start, end), lambda: 360.0, lambda: 365.0, lambda: 360.0)


def _true_year(start: Any, end: Any) -> Floats:
    """Up to a year apart: 366 days if a 29 February lies between the dates, or both lie in one leap year; else 365.
    Further apart: the mean length of all years that they touch. 1900 has a 29 February, as it has in Excel's calendar.
    """
    (year, month, day), (last_year, last_month, last_day) = parts_of(start), parts_of(end)
    passed = (month > last_month) | ((month == last_month) & (day >= last_day))
    within_year = (year == last_year) | ((last_year == year + 1) & passed)
    mean = (serial_of(last_year + 1, 1, 1) - serial_of(year, 1, 1)) / (last_year - year + 1)
    leap, leap_end = (is_leap_year(each) | (each == 1900) for each in (year, last_year))
    has_29 = (leap & (month <= 2)) | (leap_end & (last_month > 2)) | ((last_month == 2) & (last_day == 29))
    long = np.where(year == last_year, leap, has_29)
    return np.where(within_year, np.where(long, 366.0, 365.0), mean)


@toolpak("YEARFRAC", Date, Date, Number(default=0.0))
def year_fraction(start: Any, end: Any, basis: Any) -> Floats:
    """Years between two dates, whichever comes first."""
    start, end = np.minimum(start, end), np.maximum(start, end)
    return np.where(is_basis(basis), days_between(start, end, basis) / days_in_year(start, end, basis), NUM)
