"""Layouts of dates, times and durations: `d-mmm-yyyy`, `h:mm:ss.00 AM/PM`, `[h]:mm`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from xlmc.excel.functions.dates.calendar import SECONDS_A_DAY, last_serial, parts_of, weekday_of
from xlmc.excel.functions.dates.date_text import MONTHS
from xlmc.excel.functions.number_format.placeholders import Written
from xlmc.excel.functions.number_format.tokens import FormatError, Mark, Token, UnknownFormat, literal, tokenise

__all__ = ["MomentLayout", "is_moment", "moment_layout"]

_SYSTEM: Final = {
    "f800": "dddd, mmmm d, yyyy",
    "x-sysdate": "dddd, mmmm d, yyyy",
    "f400": "h:mm:ss AM/PM",
    "x-systime": "h:mm:ss AM/PM",
}
"""Languages that stand for the system's own long date and time; here those of the United States."""

_FAR: Final = 1e7
"""A serial after 9999."""


@dataclass(frozen=True)
class MomentLayout:
    """Parts of dates and times.

    Attributes:
        tokens: with `n…` for minutes, and `.0…` for fractions of a second.
    """

    tokens: tuple[Token, ...]

    @cached_property
    def _decimals(self) -> int:
        """How many decimals of a second are written; the number is rounded to these."""
        return max((len(t.text) - 1 for t in self.tokens if t.mark is Mark.PART and t.text[0] == "."), default=0)

    @cached_property
    def _twelve_hours(self) -> bool:
        return any(token.mark is Mark.HALF for token in self.tokens)

    @property
    def only_elapsed(self) -> bool:
        """Whether it writes durations alone, which may be negative."""
        return all(token.mark in (Mark.ELAPSED, Mark.LITERAL) for token in self.tokens)

    def write(self, size: float, date1904: bool) -> Written:
        clock = _Clock(min(size, _FAR), self._decimals, date1904, self._twelve_hours)
        if clock.day > last_serial(date1904):
            raise FormatError("a date after 9999")
        return "".join(clock.write_token(token) for token in self.tokens), False


def is_moment(tokens: Sequence[Token]) -> bool:
    """Whether a section writes dates, times or durations. `e+` and `e-` are a year unless there are digits."""
    year = not any(t.mark is Mark.DIGIT for t in tokens) and any(map(_is_year, tokens))
    return year or any(t.mark in (Mark.PART, Mark.ELAPSED, Mark.HALF) or _is_system(t) for t in tokens)


def _is_year(token: Token) -> bool:
    return token.mark is Mark.EXPONENT and token.text[0] == "e"


def _is_system(token: Token) -> bool:
    return token.mark is Mark.LANGUAGE and token.text in _SYSTEM


def moment_layout(tokens: Sequence[Token]) -> MomentLayout:
    """Return the layout of a section with parts of dates or times.

    Raises:
        FormatError: it has digit placeholders as well.
        UnknownFormat: it asks for names in another language than English.
    """
    for token in tokens:
        if _is_system(token):
            return moment_layout(tokenise(_SYSTEM[token.text])[0])
    parts = _with_minutes(_with_fractions(_with_years(tokens)))
    if any(token.mark in (Mark.DIGIT, Mark.AT, Mark.PERCENT, Mark.EXPONENT) for token in parts):
        raise FormatError("parts of a date are mixed with digit placeholders")
    if any(_has_name(t) for t in parts) and any(_is_foreign(t) for t in parts):
        raise UnknownFormat("the names of months and days are known in English only")
    return MomentLayout(tuple(_literal_unless_part(token) for token in parts if token.mark is not Mark.LANGUAGE))


def _literal_unless_part(token: Token) -> Token:
    return token if token.mark in (Mark.PART, Mark.ELAPSED, Mark.HALF) else literal(token.text)


def _with_years(tokens: Sequence[Token]) -> list[Token]:
    """`e+` and `e-` are a year and a sign here."""
    parts: list[Token] = []
    for token in tokens:
        parts += [Token(Mark.PART, "e"), literal(token.text[1])] if _is_year(token) else [token]
    return parts


def _with_fractions(tokens: Sequence[Token]) -> list[Token]:
    """`.000` is one token, a part of a second."""
    parts: list[Token] = []
    for token in tokens:
        last = parts[-1] if parts else None
        zero = token.mark is Mark.DIGIT and token.text == "0"
        if zero and last is not None and last.mark in (Mark.POINT, Mark.PART) and last.text[0] == ".":
            parts[-1] = Token(Mark.PART, last.text + "0")
        else:
            parts.append(token)
    return parts


def _with_minutes(tokens: Sequence[Token]) -> list[Token]:
    """`m` and `mm` after hours or before seconds are minutes: `n` here."""
    parts = list(tokens)
    numbered = [i for i, t in enumerate(parts) if t.mark is Mark.ELAPSED or (t.mark is Mark.PART and t.text[0] != ".")]
    for position, index in enumerate(numbered):
        before = parts[numbered[position - 1]].text[0] if position else ""
        after = parts[numbered[position + 1]].text[0] if position + 1 < len(numbered) else ""
        if parts[index] in (Token(Mark.PART, "m"), Token(Mark.PART, "mm")) and (before == "h" or after == "s"):
            parts[index] = Token(Mark.PART, "n" * len(parts[index].text))
    return parts


def _has_name(token: Token) -> bool:
    return token.mark is Mark.HALF or (token.mark is Mark.PART and token.text[:3] in ("mmm", "ddd"))


def _is_foreign(token: Token) -> bool:
    """Whether it asks for a language that is not English: by its tag, or by the last ten bits of its number."""
    if token.mark is not Mark.LANGUAGE or not token.text:
        return False
    try:
        return int(token.text, 16) & 0x3FF not in (0, 9)
    except ValueError:
        return not token.text.startswith("en")


_WEEKDAYS: Final = ("Sunday", "Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday")
_BUDDHIST: Final = 543
"""Years from the Buddhist calendar's beginning to ours."""

_SECONDS: Final = {"h": 3600, "m": 60, "s": 1}


class _Clock:
    """A serial date and time, rounded, and its parts."""

    def __init__(self, serial: float, decimals: int, date1904: bool, half_days: bool) -> None:
        self._unit = 10**decimals
        self._ticks = math.floor(serial * SECONDS_A_DAY * self._unit + 0.5)
        self.day, ticks = divmod(self._ticks, SECONDS_A_DAY * self._unit)
        self._second = ticks // self._unit
        self._fraction = f"{ticks % self._unit:0{decimals}d}" if decimals else ""
        self._date1904, self._twelve_hours = date1904, half_days

    def write_token(self, token: Token) -> str:
        """Return what a token writes."""
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
                return _pad((hour + 11) % 12 + 1 if self._twelve_hours else hour, count)
            case "n":
                return _pad(self._second // 60 % 60, count)
            case "s":
                return _pad(self._second % 60, count)
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
                return _number_or_name(month, count, MONTHS[month - 1])
            case "d":
                return _number_or_name(day, count, _WEEKDAYS[int(weekday_of(self.day, self._date1904))])
            case _:
                return ""  # an era: our calendar has none

    def _half(self, text: str) -> str:
        afternoon = self._second >= SECONDS_A_DAY // 2
        if len(text) == 3:
            return text[2] if afternoon else text[0]
        return "PM" if afternoon else "AM"


def _pad(number: int, count: int) -> str:
    return str(number).zfill(min(count, 2))


def _number_or_name(number: int, count: int, name: str) -> str:
    """Write a number (1 or 2 letters), or its name: short (3), in full (4), or the first letter (5, months only)."""
    if count < 3:
        return _pad(number, count)
    return name[:3] if count == 3 else name[0] if count == 5 and name in MONTHS else name
