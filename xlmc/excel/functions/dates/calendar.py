"""Serial dates: how Excel counts days, and how they become dates. Arguments broadcast to the shape of the result.

The 1900 system counts 1 January 1900 as day 1 and believes in a 29 February 1900 (serial 60), so that the calendar's
own count is one less from then on; serial 0 is "0 January 1900". The 1904 system counts 1 January 1904 as day 0.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["SECONDS_A_DAY", "in_calendar", "last_serial", "parts_of", "serial_of", "time_of", "weekday_of"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Whole = NDArray[np.int64]

SECONDS_A_DAY: Final = 86400

_EPOCH_1900: Final = np.datetime64("1899-12-31", "D").astype(np.int64)
_EPOCH_1904: Final = np.datetime64("1904-01-01", "D").astype(np.int64)
_MARCH_1900: Final = np.datetime64("1900-03-01", "D").astype(np.int64)
_NO_SUCH_DAY: Final = 60
"""29 February 1900."""

_FAR: Final = 1e7
"""Years, months and days are cut to this number, which lies far outside the calendar."""


def last_serial(date1904: bool = False) -> int:
    """Return the serial of 31 December 9999, Excel's last day."""
    return 2957003 if date1904 else 2958465


def in_calendar(serial: Floats, date1904: bool = False) -> Bools:
    """Return whether the serial is a day of Excel's calendar, from serial 0 to the end of 9999."""
    return np.asarray((serial >= 0) & (serial < last_serial(date1904) + 1))


def serial_of(year: Any, month: Any, day: Any, date1904: bool = False) -> Floats:
    """Return the serial of a date with a full year; months and days may run over, backwards too, as in Excel's `DATE`.

    Numbers are rounded down. For a date outside Excel's calendar, `in_calendar` of the result is FALSE.
    """
    years, months, days = (np.clip(np.floor(part), -_FAR, _FAR).astype(np.int64) for part in (year, month, day))
    month_count = (years - 1970) * 12 + months - 1
    first = month_count.astype("datetime64[M]").astype("datetime64[D]").astype(np.int64)
    epoch = _EPOCH_1904 if date1904 else np.where(first >= _MARCH_1900, _EPOCH_1900 - 1, _EPOCH_1900)
    return np.asarray(first - epoch + days - 1, np.float64)


def parts_of(serial: Any, date1904: bool = False) -> tuple[Whole, Whole, Whole]:
    """Return year, month (1 to 12) and day of a serial for which `in_calendar` holds; the time of day is ignored.

    Serial 0 of the 1900 system is (1900, 1, 0), serial 60 is (1900, 2, 29).
    """
    whole = np.clip(np.floor(serial), -_FAR, _FAR).astype(np.int64)
    if date1904:
        return _split_days(whole + _EPOCH_1904)
    zeroth, no_such_day = whole == 0, whole == _NO_SUCH_DAY
    year, month, day = _split_days(whole - (whole >= _NO_SUCH_DAY) + zeroth + _EPOCH_1900)
    return year, month, day - zeroth + no_such_day


def _split_days(days: Whole) -> tuple[Whole, Whole, Whole]:
    """Return year, month and day of days since 1970."""
    date = days.astype("datetime64[D]")
    months = date.astype("datetime64[M]")
    month_count = months.astype(np.int64)
    day = (date - months.astype("datetime64[D]")).astype(np.int64) + 1
    return month_count // 12 + 1970, month_count % 12 + 1, day


def weekday_of(serial: Any, date1904: bool = False) -> Whole:
    """Return 0 for Sunday to 6 for Saturday, as Excel does: before 1 March 1900 it is one day off the true one."""
    whole = np.clip(np.floor(serial), -_FAR, _FAR).astype(np.int64)
    return np.asarray((whole + (5 if date1904 else 6)) % 7)


def time_of(serial: Any) -> tuple[Whole, Whole, Whole]:
    """Return hour, minute and second of a serial, to the nearest second; 24:00:00 is 0:00:00."""
    fraction = np.asarray(serial, np.float64) % 1.0
    seconds = np.floor(fraction * SECONDS_A_DAY + 0.5).astype(np.int64) % SECONDS_A_DAY
    return seconds // 3600, seconds // 60 % 60, seconds % 60
