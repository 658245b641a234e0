"""Layouts without places for digits: `General`, `@`, and bare texts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final, Protocol

from xlmc.functions.number_format.tokens import FormatError, Mark, Token
from xlmc.functions.number_text import shown

__all__ = ["BareLayout", "GeneralLayout", "Layout", "TextLayout", "Written", "general_in_cell", "text_layout"]

Written = tuple[str, bool]
"""What is written of a number's size, and whether all of its digits came out as 0, so that no minus goes before."""


class Layout(Protocol):
    """One section of a format."""

    def write(self, size: float, date1904: bool) -> Written:
        """A number, 0 or more.

        Raises:
            FormatError: it cannot be shown, as a date after 9999.
        """


@dataclass(frozen=True, slots=True)
class BareLayout:
    """A section without any place for the number; it may be empty."""

    text: str

    def write(self, size: float, date1904: bool) -> Written:
        return self.text, False


@dataclass(frozen=True, slots=True)
class GeneralLayout:
    """`General`, with texts around."""

    before: str
    after: str

    def write(self, size: float, date1904: bool) -> Written:
        return f"{self.before}{general_in_cell(size)}{self.after}", False


@dataclass(frozen=True, slots=True)
class TextLayout:
    """A section for texts: `@`, or `General`, stands for the text."""

    tokens: tuple[Token, ...]

    def write_text(self, text: str) -> str:
        """The text in its place or places."""
        return "".join(text if t.mark in (Mark.AT, Mark.GENERAL) else t.text for t in self.tokens)


def text_layout(tokens: Sequence[Token]) -> TextLayout:
    """The layout of the section for texts.

    Raises:
        FormatError: it has a place for a digit, or a part of a date.
    """
    if any(t.mark in (Mark.DIGIT, Mark.PART, Mark.ELAPSED, Mark.HALF, Mark.EXPONENT) for t in tokens):
        raise FormatError("a section for texts holds places for digits or parts of a date")
    return TextLayout(tuple(t for t in tokens if t.mark is not Mark.LANGUAGE))


_WIDTH: Final = 11
"""Characters of a cell in General format, without a minus."""

_WIDE: Final = Context(prec=400, rounding=ROUND_HALF_UP)
_SIX: Final = Context(prec=6, rounding=ROUND_HALF_UP)


def general_in_cell(size: float) -> str:
    """A number, 0 or more, in General format as a cell shows it: in 11 characters, with an exponent if need be."""
    number = shown(size)
    exponent = number.adjusted() if number else 0
    if -10 < exponent < _WIDTH:
        decimals = max(_WIDTH - 2 - max(exponent, 0), 0)
        rounded = number.quantize(Decimal(1).scaleb(-decimals), context=_WIDE)
        exact = exponent > -5 or rounded == number
        text = _trimmed(f"{rounded:f}")
        if exact and len(text) <= _WIDTH:
            return text
    six = _SIX.plus(number)
    exponent = six.adjusted()
    return f"{_trimmed(f'{six.scaleb(-exponent):f}')}E{exponent:+03d}"


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text
