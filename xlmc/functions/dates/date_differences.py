"""`DATEDIF`: whole years, months and days between two dates."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from xlmc.functions.dates.calendar import in_calendar, parts_of, serial_of
from xlmc.functions.dates.months import month_length
from xlmc.functions.registry import Number, Text, excel
from xlmc.functions.values import NUM, Floats, Objects

__all__: list[str] = []

Dates = tuple[Any, Any, bool]
"""Start, end, and whether they count from 1904."""


def _days(dates: Dates) -> Floats:
    start, end, _ = dates
    return np.asarray(np.floor(end) - np.floor(start))


def _months(dates: Dates) -> Floats:
    """Whole months."""
    start, end, date1904 = dates
    (year, month, day), (last_year, last_month, last_day) = (parts_of(serial, date1904) for serial in (start, end))
    months = (last_year - year) * 12 + last_month - month - (last_day < day)
    return np.asarray(months, np.float64)


def _years(dates: Dates) -> Floats:
    return np.floor(_months(dates) / 12)


def _months_beyond_years(dates: Dates) -> Floats:
    return np.mod(_months(dates), 12)


def _days_beyond_months(dates: Dates) -> Floats:
    """From the day of the start in the month of the end, or in the one before, which may have no such day: then Excel
    counts on into the next month, and may come to less than 0.
    """
    start, end, date1904 = dates
    day, (last_year, last_month, last_day) = parts_of(start, date1904)[2], parts_of(end, date1904)
    borrowed = np.where(last_day >= day, 0.0, month_length(last_year, last_month - 1, date1904))
    return np.asarray(borrowed + last_day - day, np.float64)


def _days_beyond_years(dates: Dates) -> Floats:
    """To the day of the end within the year from the start on; a start on 29 February is 1 March in another year."""
    start, end, date1904 = dates
    (year, month, day), (last_year, last_month, last_day) = (parts_of(serial, date1904) for serial in (start, end))
    next_year = (last_month < month) | ((last_month == month) & (last_day < day))
    until = serial_of(year + next_year, last_month, last_day, date1904)
    leap_day = (month == 2) & (day == 29) & (last_year > year)
    return np.asarray(np.maximum(until - np.floor(start) - leap_day, 0.0))


_UNITS: Final[dict[str, Callable[[Dates], Floats]]] = {
    "Y": _years,
    "M": _months,
    "D": _days,
    "MD": _days_beyond_months,
    "YM": _months_beyond_years,
    "YD": _days_beyond_years,
}


@excel("DATEDIF", Number, Number, Text, dated=True)
def difference(start: Any, end: Any, unit: Objects, *, date1904: bool = False) -> Floats:
    """What the unit names, from one date to a later one; `#NUM!` for other units and for dates in the wrong order."""
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
