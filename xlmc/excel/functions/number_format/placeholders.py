"""What the layouts of numbers are made of: `General`, `@`, bare texts, and digit placeholders.

Digits go into the placeholders `0`, `#` and `?`: an unused `0` writes 0, `?` a space, `#` nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final, Protocol

from xlmc.excel.functions.number_format.tokens import FormatError, Mark, Token, literal
from xlmc.excel.functions.number_text import round_to_15_digits

__all__ = [
    "BareLayout",
    "GeneralLayout",
    "Layout",
    "TextLayout",
    "Written",
    "count_digits",
    "fill_decimals",
    "fill_whole",
    "general_in_cell",
    "read_commas",
    "text_layout",
]

Written = tuple[str, bool]
"""What is written of a number's size, and whether all of its digits came out as 0, so that no minus goes before."""


class Layout(Protocol):
    """One section of a format."""

    def write(self, size: float, date1904: bool) -> Written:
        """Write a number, 0 or more.

        Raises:
            FormatError: it cannot be shown, as a date after 9999.
        """


@dataclass(frozen=True, slots=True)
class BareLayout:
    """A section without any placeholder for the number; it may be empty."""

    text: str

    def write(self, size: float, date1904: bool) -> Written:
        return self.text, False


@dataclass(frozen=True, slots=True)
class GeneralLayout:
    """`General`, with the texts before and after it."""

    before: str
    after: str

    def write(self, size: float, date1904: bool) -> Written:
        return f"{self.before}{general_in_cell(size)}{self.after}", False


@dataclass(frozen=True, slots=True)
class TextLayout:
    """A section for texts: `@`, or `General`, stands for the text."""

    tokens: tuple[Token, ...]

    def write_text(self, text: str) -> str:
        """Put the text into its placeholder or placeholders."""
        return "".join(text if t.mark in (Mark.AT, Mark.GENERAL) else t.text for t in self.tokens)


def text_layout(tokens: Sequence[Token]) -> TextLayout:
    """Return the layout of the section for texts.

    Raises:
        FormatError: it has a digit placeholder, or a part of a date.
    """
    if any(t.mark in (Mark.DIGIT, Mark.PART, Mark.ELAPSED, Mark.HALF, Mark.EXPONENT) for t in tokens):
        raise FormatError("a section for texts holds digit placeholders or parts of a date")
    return TextLayout(tuple(t for t in tokens if t.mark is not Mark.LANGUAGE))


_WIDTH: Final = 11
"""Characters of a cell in General format, without a minus."""

_WIDE: Final = Context(prec=400, rounding=ROUND_HALF_UP)
_SIX: Final = Context(prec=6, rounding=ROUND_HALF_UP)


def general_in_cell(size: float) -> str:
    """Write a number, 0 or more, in General format as a cell shows it: in 11 characters, with an exponent if
    need be.
    """
    number = round_to_15_digits(size)
    exponent = number.adjusted() if number else 0
    if -10 < exponent < _WIDTH:
        decimals = max(_WIDTH - 2 - max(exponent, 0), 0)
        rounded = number.quantize(Decimal(1).scaleb(-decimals), context=_WIDE)
        exact = exponent > -5 or rounded == number
        text = _trim_zeros(f"{rounded:f}")
        if exact and len(text) <= _WIDTH:
            return text
    six = _SIX.plus(number)
    exponent = six.adjusted()
    return f"{_trim_zeros(f'{six.scaleb(-exponent):f}')}E{exponent:+03d}"


def _trim_zeros(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


_UNUSED: Final = {"0": "0", "?": " ", "#": ""}


def count_digits(tokens: Sequence[Token]) -> int:
    """How many digit placeholders there are."""
    return sum(token.mark is Mark.DIGIT for token in tokens)


def fill_whole(tokens: Sequence[Token], digits: str, grouped: bool = False) -> str:
    """Write whole digits from the right; those that have no placeholder go before the first one."""
    written: list[str] = []
    unwritten, index, count = list(digits), 0, count_digits(tokens)
    for token in reversed(tokens):
        if token.mark is not Mark.DIGIT:
            written.append(token.text)
            continue
        glyphs = [unwritten.pop()] if unwritten else [_UNUSED[token.text]]
        while unwritten and index == count - 1:
            glyphs.append(unwritten.pop())
        written += [glyph + _separator(glyph, index + i) * grouped for i, glyph in enumerate(glyphs)]
        index += 1
    return "".join(reversed(written))


def _separator(glyph: str, index: int) -> str:
    """Return what stands to the right of every third placeholder: a comma, or a space if the placeholder writes a
    space.
    """
    if index == 0 or index % 3 or not glyph:
        return ""
    return " " if glyph == " " else ","


def fill_decimals(tokens: Sequence[Token], digits: str) -> str:
    """Write decimals, one in each placeholder; zeros at the end count as unused."""
    used, index, written = digits.rstrip("0"), 0, []
    for token in tokens:
        if token.mark is Mark.DIGIT:
            written.append(used[index] if index < len(used) else _UNUSED[token.text])
            index += 1
        else:
            written.append(token.text)
    return "".join(written)


def read_commas(tokens: Sequence[Token]) -> tuple[list[Token], bool, int]:
    """Read the commas: the other tokens, whether thousands are separated, and how often to divide by 1000.

    A comma right after a digit placeholder has a meaning: between two of the whole part it asks for separators, behind
    the last one it divides, between decimals it is ignored. Any other comma stands for itself, and stays a token.
    """
    remaining: list[Token] = []
    grouped, thousands, after_digit, in_whole = False, 0, False, True
    for index, token in enumerate(tokens):
        in_whole = in_whole and token.mark is not Mark.POINT
        if token.mark is not Mark.COMMA:
            remaining.append(token)
            after_digit = token.mark in (Mark.DIGIT, Mark.POINT)
        elif not after_digit:
            remaining.append(literal(","))
        elif _digits_follow(tokens[index:], in_whole):
            grouped = grouped or in_whole
        else:
            thousands += 1
    return remaining, grouped, thousands


def _digits_follow(tokens: Sequence[Token], in_whole: bool) -> bool:
    """Whether a digit placeholder follows, before the point where `in_whole`."""
    for token in tokens:
        if token.mark is Mark.DIGIT:
            return True
        if in_whole and token.mark is Mark.POINT:
            return False
    return False
