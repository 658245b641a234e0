"""How many days, months and years lie between dates, and which day comes so many months later.

Bond markets count by five rules, Excel's `basis` argument. 0: months of 30 days (US), years of 360; 1: true days and
years; 2: true days, years of 360; 3: true days, years of 365; 4: months of 30 days (European), years of 360. Their
dates are serials of the 1900 system. `DATEDIF` counts whole years, months and days.

Sources for what Excel does: D. A. Wheeler, "YEARFRAC Incompatibilities between Excel 2007 and OOXML" (2008), and values
that Excel computed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from xlmc.excel.functions.dates.calendar import in_calendar, parts_of, serial_of
from xlmc.excel.functions.registry import Number, Text, excel
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import NUM, Bools, Floats, Objects

__all__ = [
    "by_basis",
    "days_between",
    "days_in_year",
    "european_360",
    "is_basis",
    "is_leap_year",
    "is_month_end",
    "month_length",
    "months_later",
    "us_360",
]


def is_leap_year(year: Any) -> Bools:
    """Return whether a year of the Gregorian calendar has a 29 February."""
    year = np.asarray(year)
    return np.asarray((year % 4 == 0) & ((year % 100 != 0) | (year % 400 == 0)))


def month_length(year: Any, month: Any, date1904: bool = False) -> Floats:
    """Return how many days a month has; months may run over. February 1900 has 29 in the 1900 system."""
    return serial_of(year, month + 1, 1, date1904) - serial_of(year, month, 1, date1904)


def is_month_end(serial: Any) -> Bools:
    """Return whether a day of the 1900 system is the last of its month."""
    year, month, day = parts_of(serial)
    return np.asarray(day == month_length(year, month))


def months_later(serial: Any, months: Any, to_end: Any = False) -> Floats:
    """Return the same day so many months later, or the last day of that month if it has no such day or `to_end` holds.

    Days are of the 1900 system. For a day outside Excel's calendar, `in_calendar` of the result is FALSE.
    """
    year, month, day = parts_of(serial)
    length = month_length(year, month + months)
    return serial_of(year, month + months, np.where(to_end, length, np.minimum(day, length)))


def is_basis(basis: Any) -> Bools:
    """Return whether a number, without its fraction, is one of the five bases."""
    return np.asarray((np.asarray(basis) >= 0) & (np.asarray(basis) < 5))


def by_basis(basis: Any, *choices: Callable[[], Any]) -> Floats:
    """Choose one of five results by each trial's basis, NaN for no basis; compute only what some trial needs."""
    codes = np.floor(basis)
    result = np.asarray(np.nan)
    for code, choice in enumerate(choices):
        here = codes == code
        if here.any():
            result = np.where(here, choice(), result)
    return np.asarray(result, np.float64)


def us_360(start: Any, end: Any, *, end_too: bool = False) -> Floats:
    """Count days with months of 30 days by the US rule: a 31st counts as a 30th, and so does the last of February.

    For the end this holds only if the start is such a day too, or with `end_too`.
    """
    (year, month, day), (last_year, last_month, last_day) = parts_of(start), parts_of(end)
    from_february = (month == 2) & is_month_end(start)
    to_february = (last_month == 2) & is_month_end(end)
    shortened = (last_day == 31) & ((day >= 30) | end_too) | to_february & (from_february | end_too)
    last_day = np.where(shortened, 30, last_day)
    day = np.where(from_february, 30, np.minimum(day, 30))
    return np.asarray((last_year - year) * 360 + (last_month - month) * 30 + last_day - day, np.float64)


def european_360(start: Any, end: Any) -> Floats:
    """Count days with months of 30 days by the European rule: a 31st counts as a 30th."""
    (year, month, day), (last_year, last_month, last_day) = parts_of(start), parts_of(end)
    days = np.minimum(last_day, 30) - np.minimum(day, 30)
    return np.asarray((last_year - year) * 360 + (last_month - month) * 30 + days, np.float64)


def days_between(start: Any, end: Any, basis: Any) -> Floats:
    """Count the days from one date to a later one."""

    def true_days() -> Floats:
        return np.asarray(end - start, np.float64)

    return by_basis(
        basis, lambda: us_360(start, end), true_days, true_days, true_days, lambda: european_360(start, end)
    )


def days_in_year(start: Any, end: Any, basis: Any) -> Floats:
    """Return the length of the year by which the days from one date to a later one are divided."""
    return by_basis(basis, lambda: 360.0, lambda: _true_year(start, end), lambda: 360.0, lambda: 365.0, lambda: 360.0)


def _true_year(start: Any, end: Any) -> Floats:
    """Return the length of a year for basis 1.

    If the dates are at most a year apart, it is 366 days if a 29 February lies between them or both lie in one leap
    year, else 365. If they are further apart, it is the mean length of all years from the first to the last. 1900 has a
    29 February, as in Excel's calendar.
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


_Dates = tuple[Any, Any, bool]
"""The start, the end, and whether they count from 1904."""


def _days(dates: _Dates) -> Floats:
    start, end, _ = dates
    return np.asarray(np.floor(end) - np.floor(start))


def _months(dates: _Dates) -> Floats:
    """Whole months."""
    start, end, date1904 = dates
    (year, month, day), (last_year, last_month, last_day) = (parts_of(serial, date1904) for serial in (start, end))
    months = (last_year - year) * 12 + last_month - month - (last_day < day)
    return np.asarray(months, np.float64)


def _years(dates: _Dates) -> Floats:
    return np.floor(_months(dates) / 12)


def _months_beyond_years(dates: _Dates) -> Floats:
    return np.mod(_months(dates), 12)


def _days_beyond_months(dates: _Dates) -> Floats:
    """Count from the start's day in the month of the end, or in the month before.

    If that month has no such day, Excel counts on into the next one, and the result may be below 0.
    """
    start, end, date1904 = dates
    day, (last_year, last_month, last_day) = parts_of(start, date1904)[2], parts_of(end, date1904)
    borrowed = np.where(last_day >= day, 0.0, month_length(last_year, last_month - 1, date1904))
    return np.asarray(borrowed + last_day - day, np.float64)


def _days_beyond_years(dates: _Dates) -> Floats:
    """Count to the first day, from the start on, that has the end's month and day.

    A start on 29 February counts as 1 March if the end is in another year.
    """
    start, end, date1904 = dates
    (year, month, day), (last_year, last_month, last_day) = (parts_of(serial, date1904) for serial in (start, end))
    next_year = (last_month < month) | ((last_month == month) & (last_day < day))
    until = serial_of(year + next_year, last_month, last_day, date1904)
    leap_day = (month == 2) & (day == 29) & (last_year > year)
    return np.asarray(np.maximum(until - np.floor(start) - leap_day, 0.0))


_UNITS: Final[dict[str, Callable[[_Dates], Floats]]] = {
    "Y": _years,
    "M": _months,
    "D": _days,
    "MD": _days_beyond_months,
    "YM": _months_beyond_years,
    "YD": _days_beyond_years,
}


@excel("DATEDIF", Number, Number, Text, dated=True)
def difference(start: Any, end: Any, unit: Objects, *, date1904: bool = False) -> Floats:
    """Time from one date to a later one in the unit; `#NUM!` for unknown units and for dates in the wrong order."""
    names = np.vectorize(lambda text: str(text).upper(), otypes=[object])(unit)
    inside = in_calendar(np.asarray(start), date1904) & in_calendar(np.asarray(end), date1904)
    wrong = ~inside | np.greater(np.floor(start), np.floor(end))
    dates = np.where(wrong, 1.0, start), np.where(wrong, 1.0, end), date1904
    result = np.full(np.broadcast_shapes(wrong.shape, names.shape), NUM)
    for name, count in _UNITS.items():
        here = names == name
        if here.any():
            result = np.where(here & ~wrong, count(dates), result)
    return result
