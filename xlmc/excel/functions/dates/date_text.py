"""Read dates and times as Excel for the United States does: month before day.

    1/15/2020   15-Jan-20   January 15, 2020   2020-01-15   Jan 2020   13:45   1:30:15 PM   2020-01-15 13:45

Excel takes a date without a year for one of this year. xlmc does not read it: results must not depend on the day they
are computed.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from xlmc.excel.functions.dates.calendar import SECONDS_A_DAY, in_calendar, parts_of, serial_of

__all__ = ["MONTHS", "parse_date", "parse_moment", "parse_time"]

MONTHS: Final = (
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
)


@dataclass(frozen=True, slots=True)
class _Moment:
    """The day, the time, or both that a text gives.

    Attributes:
        day: the serial of the date; None when the text has none.
        time: in days; 1 or more for 24:00 and beyond; None when the text has none.
    """

    day: float | None
    time: float | None

    @property
    def serial(self) -> float:
        """The number that the text stands for."""
        return (self.day or 0.0) + (self.time or 0.0)


_MONTH: Final = "(?P<month>[0-9]{1,2})"
_NAME: Final = "(?P<name>[a-z]{3,9})"
_DAY: Final = "(?P<day>[0-9]{1,2})"
_YEAR: Final = "(?P<year>[0-9]{4}|[0-9]{1,2})"
_FULL_YEAR: Final = "(?P<year>[0-9]{4})"
_STROKE: Final = " *[/-] *"
_GAP: Final = f"(?:{_STROKE}| )"

_WITH_DAY: Final = [
    re.compile(form)
    for form in (
        _MONTH + _STROKE + _DAY + _STROKE + _YEAR,
        _FULL_YEAR + _STROKE + _MONTH + _STROKE + _DAY,
        _DAY + _GAP + _NAME + _GAP + _YEAR,
        _DAY + _NAME + _YEAR,
        _NAME + ",? +" + _DAY + ", +" + _YEAR,
    )
]
_WITHOUT_DAY: Final = [
    re.compile(form)
    for form in (_MONTH + _STROKE + _YEAR, _NAME + f"(?:{_GAP})?" + _YEAR, _FULL_YEAR + _STROKE + _MONTH)
]
_TIME: Final = re.compile(
    r"(?P<first>[0-9]{1,4}):(?P<second>[0-9]{1,2})?(?P<colon>:(?P<third>[0-9]{1,2})?)?(?P<part>\.[0-9]{0,10})?"
    r"(?: +(?P<half>[ap])m?)?"
)
_HOUR: Final = re.compile(r"(?P<hour>[0-9]{1,2}) +(?P<half>[ap])m?")


def parse_moment(text: str, date1904: bool = False) -> _Moment | None:
    """Read a date, a time, or a date followed by a time; None for any other text."""
    time = parse_time(text)
    if time is not None:
        return _Moment(None, time)
    day = parse_date(text, date1904)
    if day is not None:
        return _Moment(day, None)
    for space in re.finditer(" +", text):
        day, time = parse_date(text[: space.start()], date1904), parse_time(text[space.end() :])
        if day is not None and time is not None:
            return _Moment(day, time)
    return None


def parse_date(text: str, date1904: bool = False) -> float | None:
    """Read a date as a serial; None if the text is no date of Excel's calendar."""
    folded = text.lower()
    for form in _WITH_DAY:
        if match := form.fullmatch(folded):
            return _serial(match, int(match["day"]), date1904)
    for form in _WITHOUT_DAY:
        if (match := form.fullmatch(folded)) and not _is_day_of_this_year(match):
            return _serial(match, 1, date1904)
    return None


def _is_day_of_this_year(match: re.Match[str]) -> bool:
    """Return whether Excel reads the number after a month as a day of this year: `Oct 7`, but not `Oct 82`."""
    month, number = _month(match), match["year"]
    if month is None or len(number) == 4 or int(number) == 0:
        return False
    return int(number) <= (29 if month == 2 else 30 if month in (4, 6, 9, 11) else 31)


def _month(match: re.Match[str]) -> int | None:
    parts = match.groupdict()
    if parts.get("month"):
        return int(parts["month"])
    return next((i for i, name in enumerate(MONTHS, 1) if name.lower().startswith(parts["name"])), None)


def _serial(match: re.Match[str], day: int, date1904: bool) -> float | None:
    month, year = _month(match), int(match["year"])
    if month is None:
        return None
    if len(match["year"]) < 4:
        year += 2000 if year < 30 else 1900
    serial = serial_of(year, month, day, date1904)
    ran_over = [int(part) for part in parts_of(serial, date1904)] != [year, month, day]
    return float(serial) if in_calendar(serial, date1904) and not ran_over else None


def parse_time(text: str) -> float | None:
    """Read a time in days: `h:mm`, `h:mm:ss` or, with a fraction of a second, `mm:ss.0`; None for any other text."""
    folded = text.lower()
    if match := _HOUR.fullmatch(folded):
        return _to_days(int(match["hour"]), 0, 0, match["half"])
    match = _TIME.fullmatch(folded)
    if match is None or (match["part"] and not (match["third"] or (match["second"] and not match["colon"]))):
        return None
    first, second, third = (int(match[name] or 0) for name in ("first", "second", "third"))
    if match["part"] and not match["third"]:
        first, second, third = 0, first, second
    return _to_days(first, second, third, match["half"], _milliseconds(match["part"]))


def _milliseconds(part: str | None) -> int:
    return round(float(f"0{part}0") * 1000) if part else 0


def _to_days(hours: int, minutes: int, seconds: int, half: str | None, milliseconds: int = 0) -> float | None:
    """Convert a time to days; None if two of the three run over, or one (as in `13:60`) with AM or PM."""
    over = [hours > (12 if half else 23), minutes > 59, seconds > 59].count(True)
    if over > (0 if half else 1):
        return None
    if half:
        hours = hours % 12 + (12 if half == "p" else 0)
    return (hours * 3600 + minutes * 60 + seconds + milliseconds / 1000) / SECONDS_A_DAY
