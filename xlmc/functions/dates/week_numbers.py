"""Days of the week and weeks of the year."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.functions.dates.calendar import in_calendar, parts_of, serial_of, weekday_of
from xlmc.functions.registry import Number, excel
from xlmc.functions.toolpak_rows import DAYS_TO_1904, Date, toolpak
from xlmc.functions.values import NUM, Floats

__all__: list[str] = []

_ISO: Final = 21
"""Excel's number for weeks as ISO 8601 counts them."""

_WEEK_STARTS: Final = {1: 0, 2: 1, 11: 1, 12: 2, 13: 3, 14: 4, 15: 5, 16: 6, 17: 0}
"""The day with which the week starts, 0 for Sunday, by Excel's `return_type`."""


def _week_start(kind: Any) -> Floats:
    """NaN where there is no such kind."""
    whole = np.floor(kind)
    return np.select([whole == known for known in _WEEK_STARTS], list(_WEEK_STARTS.values()), np.nan)


@excel("WEEKDAY", Number, Number(default=1.0), dated=True)
def weekday(serial: Any, kind: Any, *, date1904: bool = False) -> Floats:
    """Number of the day in its week, from 1; kind 3 counts from 0 for Monday."""
    from_monday = np.floor(kind) == 3
    start = np.where(from_monday, 1.0, _week_start(kind))
    inside = in_calendar(np.asarray(serial), date1904)
    number = (weekday_of(np.where(inside, serial, 1.0), date1904) - start) % 7
    return np.where(inside, number + np.where(from_monday, 0, 1), NUM)


@toolpak("WEEKNUM", Date, Number(default=1.0))
def week_number(serial: Any, kind: Any) -> Floats:
    """Number of the week in the year, the first being that of 1 January; kind 21 counts as ISO 8601 does."""
    year = parts_of(serial)[0]
    new_year = serial_of(year, 1, 1)
    shift = (weekday_of(new_year) - _week_start(kind)) % 7
    return np.where(np.floor(kind) == _ISO, _iso_week(serial), np.floor((np.floor(serial) - new_year + shift) / 7) + 1)


def _iso_week(serial: Any) -> Floats:
    """Week by ISO 8601: that of the year's first Thursday is the first. Serials of the 1900 system."""
    thursday = np.floor(serial) + 3 - (weekday_of(serial) - 1) % 7
    new_year = serial_of(parts_of(thursday)[0], 1, 1)
    return np.asarray(np.floor((thursday - new_year) / 7) + 1)


@excel("ISOWEEKNUM", Number, dated=True)
def iso_week_number(serial: Any, *, date1904: bool = False) -> Floats:
    """Number of the week in the year by ISO 8601."""
    inside = in_calendar(np.asarray(serial), date1904)
    return np.where(inside, _iso_week(np.where(inside, serial, 1.0) + (DAYS_TO_1904 if date1904 else 0)), NUM)
