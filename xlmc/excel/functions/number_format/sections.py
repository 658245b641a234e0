"""The sections of a format: what each writes, which of them writes a number, and with which sign.

One section writes all numbers, a minus before the negative ones. Of two, the second is for negative numbers; of three,
the third is for zero; the fourth, or a last one with `@`, is for texts. Conditions go before these rules. A section
that gets only negative numbers must hold a minus itself if one is wanted.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from xlmc.excel.functions.number_format.date_times import MomentLayout, is_moment, moment_layout
from xlmc.excel.functions.number_format.numbers import decimal_layout, exponent_layout, fraction_layout
from xlmc.excel.functions.number_format.placeholders import (
    BareLayout,
    GeneralLayout,
    Layout,
    TextLayout,
    count_digits,
    text_layout,
)
from xlmc.excel.functions.number_format.tokens import FormatError, Mark, Token, tokenise
from xlmc.excel.functions.number_text import general_text

__all__ = ["NumberFormat", "parse_format"]

_NO_SECTION: Final = "#" * 255
"""What Excel writes for a number that no section is for."""

_LONGEST: Final = 255

_GENERAL: Final = GeneralLayout("", "")


@dataclass(frozen=True, slots=True)
class NumberFormat:
    """A number format: how it writes numbers and texts."""

    sections: tuple[_Section, ...]
    for_texts: TextLayout | None

    def number(self, x: float, date1904: bool = False) -> str:
        """Write a number as the format does.

        Raises:
            FormatError: it cannot be shown, as a date before 1900.
        """
        if not self.sections:
            return general_text(x)
        chosen = self._choose(x)
        if chosen is None:
            return _NO_SECTION
        layout, without_minus = chosen
        if x < 0 and isinstance(layout, MomentLayout) and not (date1904 or layout.only_elapsed or without_minus):
            raise FormatError("a date before 1900")
        text, zero = layout.write(abs(x), date1904)
        return f"-{text}" if x < 0 and not (without_minus or zero) else text

    def text(self, text: str) -> str:
        """Write a text as the format does: as it is, unless a section is for texts."""
        return text if self.for_texts is None else self.for_texts.write_text(text)

    def _choose(self, x: float) -> tuple[Layout, bool] | None:
        """Choose the layout for a number; and whether it is written without a minus, even if negative."""
        first = self.sections[0]
        if first.condition.holds(x) if first.condition else self._first_writes(x):
            return first.layout, first.condition is not None and first.condition.only_negative
        if len(self.sections) == 1:
            return _GENERAL, self._rest_is_negative()
        second = self.sections[1]
        if second.condition is None:
            return self._second_or_third(x)
        if second.condition.holds(x):
            return second.layout, second.condition.only_negative
        return (self.sections[2].layout, False) if len(self.sections) == 3 else None

    def _first_writes(self, x: float) -> bool:
        return {1: True, 2: x >= 0, 3: x > 0}[len(self.sections)]

    def _second_or_third(self, x: float) -> tuple[Layout, bool]:
        if len(self.sections) == 2:
            return self.sections[1].layout, self._rest_is_negative()
        return (self.sections[1].layout, True) if x < 0 else (self.sections[2].layout, False)

    def _rest_is_negative(self) -> bool:
        """Whether Excel treats the numbers that the first section leaves over as negative."""
        condition = self.sections[0].condition
        return condition is None or condition.leaves_negative


@lru_cache(maxsize=1024)
def parse_format(text: str) -> NumberFormat:
    """Read the number format of a text.

    Raises:
        FormatError: Excel does not take it as one.
        UnknownFormat: it asks for numerals or names that are not known here.
    """
    parts = tokenise(text)
    if len(parts) > 4 or len(text) > _LONGEST:
        raise FormatError(f"a format has four sections and {_LONGEST} characters at most")
    last = parts[-1]
    has_texts = len(parts) == 4 or any(token.mark is Mark.AT for token in last)
    sections = tuple(_section_of(part) for part in (parts[:-1] if has_texts else parts))
    if any(section.condition for section in sections[2:]):
        raise FormatError("the first two sections alone have conditions")
    return NumberFormat(sections, text_layout(last) if has_texts else None)


_RELATIONS: Final[dict[str, Callable[[float, float], bool]]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "<>": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "=": operator.eq,
}
_PARTS: Final = re.compile("([<>=]+)(.*)")


@dataclass(frozen=True, slots=True)
class _Condition:
    """`[>=100]`."""

    relation: str
    limit: float

    def holds(self, x: float) -> bool:
        return _RELATIONS[self.relation](x, self.limit)

    @property
    def only_negative(self) -> bool:
        """Whether it holds for negative numbers alone: then no minus goes before what the section writes."""
        below = self.relation == "<" and self.limit <= 0
        return below or (self.relation in ("<=", "=") and self.limit < 0)

    @property
    def leaves_negative(self) -> bool:
        """Whether Excel treats what it leaves over as negative: after any `<`, and after `<>` of a negative number."""
        return self.relation in ("<", "<=") or (self.relation == "<>" and self.limit < 0)


@dataclass(frozen=True, slots=True)
class _Section:
    """A section for numbers."""

    condition: _Condition | None
    layout: Layout


def _section_of(tokens: Sequence[Token]) -> _Section:
    """Return the section for numbers that the tokens make.

    Raises:
        FormatError: they do not go together.
    """
    conditions = [token for token in tokens if token.mark is Mark.CONDITION]
    rest = [token for token in tokens if token.mark is not Mark.CONDITION]
    if len(conditions) > 1:
        raise FormatError("a section has one condition")
    return _Section(_condition(conditions[0].text) if conditions else None, _layout(rest))


def _condition(text: str) -> _Condition:
    match = _PARTS.fullmatch(text)
    assert match is not None
    try:
        return _Condition(match[1], float(match[2]))
    except ValueError:
        raise FormatError(f"{match[2]} is not a number") from None


def _layout(tokens: Sequence[Token]) -> Layout:
    if any(token.mark is Mark.GENERAL for token in tokens):
        return _general(tokens)
    if is_moment(tokens):
        return moment_layout(tokens)
    remaining = [token for token in tokens if token.mark is not Mark.LANGUAGE]
    marks = {token.mark for token in remaining}
    if Mark.AT in marks:
        raise FormatError("a section for numbers holds a text placeholder")
    if Mark.EXPONENT in marks:
        return exponent_layout(remaining)
    if Mark.SLASH in marks:
        return fraction_layout(remaining)
    if count_digits(remaining):
        return decimal_layout(remaining)
    return BareLayout("".join(token.text for token in remaining))


def _general(tokens: Sequence[Token]) -> Layout:
    plain = [token for token in tokens if token.mark is not Mark.LANGUAGE]
    start = next(index for index, token in enumerate(plain) if token.mark is Mark.GENERAL)
    rest = plain[:start] + plain[start + 1 :]
    if any(token.mark in (Mark.GENERAL, Mark.DIGIT, Mark.PART, Mark.AT, Mark.EXPONENT) for token in rest):
        raise FormatError("General is mixed with other placeholders")
    before, after = ("".join(token.text for token in part) for part in (rest[:start], rest[start:]))
    return GeneralLayout(before, after)
