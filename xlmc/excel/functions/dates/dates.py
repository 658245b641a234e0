"""Dates, times of day and their parts.

`calendar` describes serial dates; times are their fractions. Dates outside Excel's calendar are `#NUM!`.
"""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from typing import Any

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.dates.calendar import SECONDS_A_DAY, in_calendar, parts_of, serial_of, time_of
from xlmc.excel.functions.dates.date_text import parse_moment
from xlmc.excel.functions.dates.day_count import months_later
from xlmc.excel.functions.number_text import SPACES
from xlmc.excel.functions.per_element import per_element
from xlmc.excel.functions.registry import Logical, Number, Text, excel
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import NUM, Floats, Objects, Value

__all__ = ["serial_at"]

_FIRST_FULL_YEAR = 1900
_LAST_YEAR = 9999


def _part_of_date(serial: Any, date1904: bool, part: Callable[[Floats], Any]) -> Floats:
    """Return a part of the date; `#NUM!` outside Excel's calendar."""
    inside = in_calendar(np.asarray(serial), date1904)
    return np.where(inside, part(np.where(inside, serial, 1.0)), NUM)


@excel("DATE", Number, Number, Number, dated=True)
def date(year: Any, month: Any, day: Any, *, date1904: bool = False) -> Floats:
    """Return the serial of a date; years up to 1899 count from 1900, months and days may run over."""
    years = np.trunc(year)
    full = np.where(years < _FIRST_FULL_YEAR, years + _FIRST_FULL_YEAR, years)
    serial = serial_of(full, np.trunc(month), np.trunc(day), date1904)
    known = (years >= 0) & (years <= _LAST_YEAR)
    return np.where(known & in_calendar(serial, date1904), serial, NUM)


@excel("DATEVALUE", Text, dated=True)
def date_value(text: Objects, *, date1904: bool = False) -> Value:
    """Return the serial of the date in a text; 0 if it holds a time only, `#VALUE!` if neither."""

    def read(written: str) -> float | ErrorCode:
        moment = parse_moment(written.strip(SPACES), date1904)
        return ErrorCode.VALUE if moment is None else moment.day or 0.0

    return per_element(read)(text)


@excel("YEAR", Number, dated=True)
def year(serial: Any, *, date1904: bool = False) -> Floats:
    """Year of a date."""
    return _part_of_date(serial, date1904, lambda s: parts_of(s, date1904)[0])


@excel("MONTH", Number, dated=True)
def month(serial: Any, *, date1904: bool = False) -> Floats:
    """Month of a date, 1 to 12."""
    return _part_of_date(serial, date1904, lambda s: parts_of(s, date1904)[1])


@excel("DAY", Number, dated=True)
def day(serial: Any, *, date1904: bool = False) -> Floats:
    """Day of the month."""
    return _part_of_date(serial, date1904, lambda s: parts_of(s, date1904)[2])


@excel("DAYS", Number, Number, dated=True)
def days(end: Any, start: Any, *, date1904: bool = False) -> Floats:
    """Days from the second date to the first."""
    inside = in_calendar(np.asarray(end), date1904) & in_calendar(np.asarray(start), date1904)
    return np.where(inside, np.floor(end) - np.floor(start), NUM)


@excel("DAYS360", Number, Number, Logical(default=False), dated=True)
def days_360(start: Any, end: Any, european: Any, *, date1904: bool = False) -> Floats:
    """Days between two dates with months of 30 days.

    By the US rule, a start on the last day of February counts as a 30th, an end on it does not; an end on a 31st counts
    as a 30th only if the start does.
    """
    inside = in_calendar(np.asarray(start), date1904) & in_calendar(np.asarray(end), date1904)
    start, end = np.where(inside, start, 1.0), np.where(inside, end, 1.0)
    (year, month, day), (last_year, last_month, last_day) = (parts_of(serial, date1904) for serial in (start, end))
    ends_february = (month == 2) & (parts_of(np.floor(start) + 1, date1904)[1] == 3) & ~np.asarray(european, bool)
    day = np.where(ends_february, 30, np.minimum(day, 30))
    last_day = np.where((last_day == 31) & (np.asarray(european, bool) | (day == 30)), 30, last_day)
    return np.where(inside, (last_year - year) * 360.0 + (last_month - month) * 30.0 + last_day - day, NUM)


@toolpak("EDATE", Date, Number, gives_date=True)
def date_months_later(start: Any, months: Any) -> Floats:
    """Return the same day so many months later, or the last day of that month if it has no such day."""
    return months_later(start, np.trunc(months))


@toolpak("EOMONTH", Date, Number, gives_date=True)
def month_end_months_later(start: Any, months: Any) -> Floats:
    """Return the last day of the month so many months later."""
    return months_later(start, np.trunc(months), to_end=True)


@excel("TODAY", volatile=True, dated=True)
def today(*, date1904: bool = False) -> Floats:
    """Return the day on which it is computed."""
    return np.asarray(np.floor(now(date1904=date1904)))


@excel("NOW", volatile=True, dated=True)
def now(*, date1904: bool = False) -> Floats:
    """Return the day and time at which it is computed, by the clock of the machine."""
    return np.atleast_1d(serial_at(datetime.now(), date1904))


def serial_at(moment: datetime, date1904: bool) -> float:
    """Return the serial number of a day and its time."""
    since_midnight = moment - moment.replace(hour=0, minute=0, second=0, microsecond=0)
    today = serial_of(moment.year, moment.month, moment.day, date1904)
    return float(today + since_midnight.total_seconds() / SECONDS_A_DAY)


_MOST_IN_TIME = 32767
"""`TIME` refuses more hours, minutes or seconds than this."""


def _part_of_time(serial: Any, which: int, date1904: bool) -> Floats:
    """Return the hour, minute or second; `#NUM!` outside Excel's calendar."""
    inside = in_calendar(np.asarray(serial), date1904)
    return np.where(inside, time_of(np.where(inside, serial, 0.0))[which], NUM)


@excel("HOUR", Number, dated=True)
def hour(serial: Any, *, date1904: bool = False) -> Floats:
    """Hour, 0 to 23."""
    return _part_of_time(serial, 0, date1904)


@excel("MINUTE", Number, dated=True)
def minute(serial: Any, *, date1904: bool = False) -> Floats:
    """Minute, 0 to 59."""
    return _part_of_time(serial, 1, date1904)


@excel("SECOND", Number, dated=True)
def second(serial: Any, *, date1904: bool = False) -> Floats:
    """Second, 0 to 59, to the nearest."""
    return _part_of_time(serial, 2, date1904)


@excel("TIME", Number, Number, Number)
def time(hours: Any, minutes: Any, seconds: Any) -> Floats:
    """Time of day as a fraction; hours, minutes and seconds may run over, whole days are dropped."""
    parts = [np.trunc(part) for part in (hours, minutes, seconds)]
    total = parts[0] * 3600 + parts[1] * 60 + parts[2]
    wrong = (total < 0) | (parts[0] > _MOST_IN_TIME) | (parts[1] > _MOST_IN_TIME) | (parts[2] > _MOST_IN_TIME)
    return np.where(wrong, NUM, total % SECONDS_A_DAY / SECONDS_A_DAY)


def _time_value(text: str) -> float | ErrorCode:
    """Time of day in a text, as a fraction; 0 if it holds a date only, `#VALUE!` if neither."""
    moment = parse_moment(text.strip(SPACES))
    return ErrorCode.VALUE if moment is None else (moment.time or 0.0) % 1.0


excel("TIMEVALUE", Text)(per_element(_time_value))
