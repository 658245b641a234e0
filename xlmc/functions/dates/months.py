"""Steps of months through the calendar, as loans and bonds take them."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.calendar import parts_of, serial_of
from xlmc.functions.values import Bools, Floats

__all__ = ["is_leap_year", "is_month_end", "month_length", "months_later"]


def is_leap_year(year: Any) -> Bools:
    """Whether a year of the Gregorian calendar has a 29 February."""
    year = np.asarray(year)
    return np.asarray((year % 4 == 0) & ((year % 100 != 0) | (year % 400 == 0)))


def month_length(year: Any, month: Any, date1904: bool = False) -> Floats:
    """How many days a month has; months may run over. February 1900 has 29 in the 1900 system."""
    return serial_of(year, month + 1, 1, date1904) - serial_of(year, month, 1, date1904)


def is_month_end(serial: Any) -> Bools:
    """Whether a day of the 1900 system is the last of its month."""
    year, month, day = parts_of(serial)
    return np.asarray(day == month_length(year, month))


def months_later(serial: Any, months: Any, to_end: Any = False) -> Floats:
    """The same day so many months later, or the last day of that month where it has no such day or `to_end` holds.

    In the 1900 system. What lies outside Excel's calendar comes out outside of `in_calendar`.
    """
    year, month, day = parts_of(serial)
    length = month_length(year, month + months)
    return serial_of(year, month + months, np.where(to_end, length, np.minimum(day, length)))
