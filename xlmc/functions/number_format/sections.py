"""A section's tokens as its condition and its layout."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.functions.number_format.decimals import decimal_layout, exponent_layout
from xlmc.functions.number_format.fractions import fraction_layout
from xlmc.functions.number_format.moments import is_moment, moment_layout
from xlmc.functions.number_format.placeholders import count_digits
from xlmc.functions.number_format.plain import BareLayout, GeneralLayout, Layout
from xlmc.functions.number_format.tokens import FormatError, Mark, Token

__all__ = ["Condition", "Section", "section_of"]

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
class Condition:
    """`[>=100]`."""

    relation: str
    limit: float

    def holds(self, x: float) -> bool:
        return _RELATIONS[self.relation](x, self.limit)

    @property
    def only_negative(self) -> bool:
        """Whether it holds for negative numbers alone: then the section minds the sign itself."""
        below = self.relation == "<" and self.limit <= 0
        return below or (self.relation in ("<=", "=") and self.limit < 0)

    @property
    def leaves_negative(self) -> bool:
        """Whether Excel takes what it leaves over for negative: any `<`, and `<>` of a negative number."""
        return self.relation in ("<", "<=") or (self.relation == "<>" and self.limit < 0)


@dataclass(frozen=True, slots=True)
class Section:
    """A section for numbers."""

    condition: Condition | None
    layout: Layout


def section_of(tokens: Sequence[Token]) -> Section:
    """The section for numbers that the tokens make.

    Raises:
        FormatError: they do not go together.
    """
    conditions = [token for token in tokens if token.mark is Mark.CONDITION]
    rest = [token for token in tokens if token.mark is not Mark.CONDITION]
    if len(conditions) > 1:
        raise FormatError("a section has one condition")
    return Section(_condition(conditions[0].text) if conditions else None, _layout(rest))


def _condition(text: str) -> Condition:
    match = _PARTS.fullmatch(text)
    assert match is not None
    try:
        return Condition(match[1], float(match[2]))
    except ValueError:
        raise FormatError(f"{match[2]} is not a number") from None


def _layout(tokens: Sequence[Token]) -> Layout:
    if any(token.mark is Mark.GENERAL for token in tokens):
        return _general(tokens)
    if is_moment(tokens):
        return moment_layout(tokens)
    kept = [token for token in tokens if token.mark is not Mark.LANGUAGE]
    marks = {token.mark for token in kept}
    if Mark.AT in marks:
        raise FormatError("a text stands in a section for numbers")
    if Mark.EXPONENT in marks:
        return exponent_layout(kept)
    if Mark.SLASH in marks:
        return fraction_layout(kept)
    if count_digits(kept):
        return decimal_layout(kept)
    return BareLayout("".join(token.text for token in kept))


def _general(tokens: Sequence[Token]) -> Layout:
    plain = [token for token in tokens if token.mark is not Mark.LANGUAGE]
    place = next(index for index, token in enumerate(plain) if token.mark is Mark.GENERAL)
    rest = plain[:place] + plain[place + 1 :]
    if any(token.mark in (Mark.GENERAL, Mark.DIGIT, Mark.PART, Mark.AT, Mark.EXPONENT) for token in rest):
        raise FormatError("General stands beside other places for the number")
    before, after = ("".join(token.text for token in part) for part in (rest[:place], rest[place:]))
    return GeneralLayout(before, after)
