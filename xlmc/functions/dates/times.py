"""Times of day: the fractions of serial dates."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.dates.calendar import SECONDS_A_DAY, in_calendar, time_of
from xlmc.functions.dates.date_text import parse_moment
from xlmc.functions.number_text import SPACES
from xlmc.functions.per_element import per_element
from xlmc.functions.registry import Number, Text, excel
from xlmc.functions.values import NUM, Floats

__all__: list[str] = []

_MOST = 32767
"""More hours, minutes or seconds than these `TIME` refuses."""


def _part(serial: Any, which: int, date1904: bool) -> Floats:
    """Hour, minute or second, `#NUM!` outside Excel's calendar."""
    inside = in_calendar(np.asarray(serial), date1904)
    return np.where(inside, time_of(np.where(inside, serial, 0.0))[which], NUM)


@excel("HOUR", Number, dated=True)
def hour(serial: Any, *, date1904: bool = False) -> Floats:
    """Hour, 0 to 23."""
    return _part(serial, 0, date1904)


@excel("MINUTE", Number, dated=True)
def minute(serial: Any, *, date1904: bool = False) -> Floats:
    """Minute, 0 to 59."""
    return _part(serial, 1, date1904)


@excel("SECOND", Number, dated=True)
def second(serial: Any, *, date1904: bool = False) -> Floats:
    """Second, 0 to 59, to the nearest."""
    return _part(serial, 2, date1904)


@excel("TIME", Number, Number, Number)
def time(hours: Any, minutes: Any, seconds: Any) -> Floats:
    """Time of day as a fraction; hours, minutes and seconds may run over, whole days drop out."""
    parts = [np.trunc(part) for part in (hours, minutes, seconds)]
    total = parts[0] * 3600 + parts[1] * 60 + parts[2]
    wrong = (total < 0) | (parts[0] > _MOST) | (parts[1] > _MOST) | (parts[2] > _MOST)
    return np.where(wrong, NUM, total % SECONDS_A_DAY / SECONDS_A_DAY)


def _time_value(text: str) -> float | ErrorCode:
    """Time of day in a text, as a fraction; 0 if it holds a date only, `#VALUE!` if neither."""
    moment = parse_moment(text.strip(SPACES))
    return ErrorCode.VALUE if moment is None else (moment.time or 0.0) % 1.0


excel("TIMEVALUE", Text)(per_element(_time_value))
