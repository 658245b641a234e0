"""Digits put into the places `0`, `#` and `?` of a format: an unused `0` writes 0, `?` a space, `#` nothing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from xlmc.functions.number_format.tokens import Mark, Token, literal

__all__ = ["count_digits", "fill_decimals", "fill_whole", "settle_commas"]

_UNUSED: Final = {"0": "0", "?": " ", "#": ""}


def count_digits(tokens: Sequence[Token]) -> int:
    """How many places for digits there are."""
    return sum(token.mark is Mark.DIGIT for token in tokens)


def fill_whole(tokens: Sequence[Token], digits: str, grouped: bool = False) -> str:
    """Whole digits, from the right; what the places do not hold goes before the first of them."""
    written: list[str] = []
    unwritten, place, places = list(digits), 0, count_digits(tokens)
    for token in reversed(tokens):
        if token.mark is not Mark.DIGIT:
            written.append(token.text)
            continue
        glyphs = [unwritten.pop()] if unwritten else [_UNUSED[token.text]]
        while unwritten and place == places - 1:
            glyphs.append(unwritten.pop())
        written += [glyph + _separator(glyph, place + i) * grouped for i, glyph in enumerate(glyphs)]
        place += 1
    return "".join(reversed(written))


def _separator(glyph: str, place: int) -> str:
    """What stands to the right of every third place: a comma, a space if the place is empty."""
    if place == 0 or place % 3 or not glyph:
        return ""
    return " " if glyph == " " else ","


def fill_decimals(tokens: Sequence[Token], digits: str) -> str:
    """Decimals, as many as there are places; zeros at the end are not used."""
    used, place, written = digits.rstrip("0"), 0, []
    for token in tokens:
        if token.mark is Mark.DIGIT:
            written.append(used[place] if place < len(used) else _UNUSED[token.text])
            place += 1
        else:
            written.append(token.text)
    return "".join(written)


def settle_commas(tokens: Sequence[Token]) -> tuple[list[Token], bool, int]:
    """The tokens without commas that mean something, whether thousands are set apart, and how often to divide by 1000.

    A comma means something right after a digit's place: between the places of the whole part it sets thousands apart,
    behind the last place it divides, between decimals it is ignored. Any other stands for itself.
    """
    kept: list[Token] = []
    grouped, thousands, after_digit, in_whole = False, 0, False, True
    for index, token in enumerate(tokens):
        in_whole = in_whole and token.mark is not Mark.POINT
        if token.mark is not Mark.COMMA:
            kept.append(token)
            after_digit = token.mark in (Mark.DIGIT, Mark.POINT)
        elif not after_digit:
            kept.append(literal(","))
        elif _digits_follow(tokens[index:], in_whole):
            grouped = grouped or in_whole
        else:
            thousands += 1
    return kept, grouped, thousands


def _digits_follow(tokens: Sequence[Token], in_whole: bool) -> bool:
    """Whether a place for a digit comes, in the whole part only if this is it."""
    for token in tokens:
        if token.mark is Mark.DIGIT:
            return True
        if in_whole and token.mark is Mark.POINT:
            return False
    return False
