"""A serial date and time taken apart, and how each part is written."""

from __future__ import annotations

import math
from typing import Final

from xlmc.functions.dates.calendar import SECONDS_A_DAY, parts_of, weekday_of
from xlmc.functions.dates.date_text import MONTHS
from xlmc.functions.number_format.tokens import Mark, Token

__all__ = ["Clock"]

_WEEKDAYS: Final = ("Sunday", "Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday")
_BUDDHIST: Final = 543
"""Years from the Buddhist calendar's beginning to ours."""

_SECONDS: Final = {"h": 3600, "m": 60, "s": 1}


class Clock:
    """A serial date and time, rounded, and its parts."""

    def __init__(self, serial: float, places: int, date1904: bool, half_days: bool) -> None:
        self._unit = 10**places
        self._ticks = math.floor(serial * SECONDS_A_DAY * self._unit + 0.5)
        self.day, ticks = divmod(self._ticks, SECONDS_A_DAY * self._unit)
        self._second = ticks // self._unit
        self._fraction = f"{ticks % self._unit:0{places}d}" if places else ""
        self._date1904, self._half_days = date1904, half_days

    def written(self, token: Token) -> str:
        """What a token writes."""
        match token.mark:
            case Mark.PART:
                return self._part(token.text[0], len(token.text))
            case Mark.ELAPSED:
                return str(self._ticks // (self._unit * _SECONDS[token.text[0]])).zfill(len(token.text))
            case Mark.HALF:
                return self._half(token.text)
            case _:
                return token.text

    def _part(self, letter: str, count: int) -> str:
        match letter:
            case "h":
                hour = self._second // 3600
                return _padded((hour + 11) % 12 + 1 if self._half_days else hour, count)
            case "n":
                return _padded(self._second // 60 % 60, count)
            case "s":
                return _padded(self._second % 60, count)
            case ".":
                return f".{self._fraction[: count - 1]}"
            case _:
                return self._date(letter, count)

    def _date(self, letter: str, count: int) -> str:
        year, month, day = (int(part) for part in parts_of(self.day, self._date1904))
        match letter:
            case "y":
                return f"{year % 100:02d}" if count < 3 else str(year)
            case "e":
                return str(year)
            case "b":
                return f"{(year + _BUDDHIST) % 100:02d}" if count < 3 else str(year + _BUDDHIST)
            case "m":
                return _named(month, count, MONTHS[month - 1])
            case "d":
                return _named(day, count, _WEEKDAYS[int(weekday_of(self.day, self._date1904))])
            case _:
                return ""  # eras, which our calendar has none of

    def _half(self, text: str) -> str:
        afternoon = self._second >= SECONDS_A_DAY // 2
        if len(text) == 3:
            return text[2] if afternoon else text[0]
        return "PM" if afternoon else "AM"


def _padded(number: int, count: int) -> str:
    return str(number).zfill(min(count, 2))


def _named(number: int, count: int, name: str) -> str:
    """A number, or its name in short (3 letters), in full (4), or by its first letter (5, months only)."""
    if count < 3:
        return _padded(number, count)
    return name[:3] if count == 3 else name[0] if count == 5 and name in MONTHS else name
