r"""A number format's text as tokens, section by section.

format   = section { ";" section }
token    = '"' text '"' | "\" any | "_" any (a space of its width) | "*" any (fills a column: nothing in a text)
         | "[" condition | colour | elapsed time | currency and language "]"
         | "General" | "AM/PM" | "A/P" | y… m… d… h… s… e g b…
         | 0 # ? . , % / @ | E+ E- | any other character, which stands for itself
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum, auto
from typing import Final

__all__ = ["FormatError", "Mark", "Token", "UnknownFormat", "literal", "tokenise"]


class FormatError(ValueError):
    """Excel does not take the text as a number format, or cannot show the number in it."""


class UnknownFormat(Exception):  # noqa: N818 - the text is a number format; it is we who do not know it
    """Excel takes the text as a number format, but it asks for what is not known here."""


class Mark(Enum):
    """What a token is."""

    LITERAL = auto()
    DIGIT = auto()
    NUMERAL = auto()
    POINT = auto()
    COMMA = auto()
    PERCENT = auto()
    EXPONENT = auto()
    SLASH = auto()
    AT = auto()
    GENERAL = auto()
    PART = auto()
    ELAPSED = auto()
    HALF = auto()
    CONDITION = auto()
    LANGUAGE = auto()


@dataclass(frozen=True, slots=True)
class Token:
    """One token.

    Attributes:
        text: what a literal writes, else the token as written; a part of a date or time in small letters.
    """

    mark: Mark
    text: str


def literal(text: str) -> Token:
    """Make a text that stands for itself."""
    return Token(Mark.LITERAL, text)


_TOKEN: Final = re.compile(
    r"""
      "(?P<quoted>[^"]*)"
    | \\(?P<escaped>.)
    | _(?P<width>.)
    | \*(?P<fill>.)
    | \[(?P<bracket>[^\]]*)\]
    | (?P<GENERAL>general)
    | (?P<HALF>am/pm|a/p)
    | (?P<EXPONENT>e[+-])
    | (?P<PART>y+|m+|d+|h+|s+|e+|g+|b+)
    | (?P<DIGIT>[0\#?])
    | (?P<NUMERAL>[1-9])
    | (?P<POINT>\.)
    | (?P<COMMA>,)
    | (?P<PERCENT>%)
    | (?P<SLASH>/)
    | (?P<AT>@)
    | (?P<end>;)
    | (?P<refused>["\\_*\[n])
    | (?P<other>.)
    """,
    re.VERBOSE | re.IGNORECASE | re.DOTALL,
)
_COLOUR: Final = re.compile(r"black|blue|cyan|green|magenta|red|white|yellow|colou?r *[0-9]{1,2}", re.IGNORECASE)
_ELAPSED: Final = re.compile(r"h+|m+|s+", re.IGNORECASE)
_OTHER_NUMERALS: Final = re.compile(r"dbnum[0-9]|natnum[0-9]+", re.IGNORECASE)
_CONDITION: Final = re.compile(r"(<=|>=|<>|<|>|=) *[+-]?[0-9.]+(E[+-]?[0-9]+)?", re.IGNORECASE)


def tokenise(text: str) -> list[list[Token]]:
    """Return the tokens of every section, at least one section.

    Raises:
        FormatError: a quote or bracket is not closed, or what stands in a bracket is nothing.
        UnknownFormat: it asks for other numerals than ours.
    """
    sections: list[list[Token]] = [[]]
    for match in _TOKEN.finditer(text):
        if match["end"]:
            sections.append([])
        else:
            sections[-1] += _tokens(match)
    return sections


def _tokens(match: re.Match[str]) -> list[Token]:
    kind, text = str(match.lastgroup), match[str(match.lastgroup)]
    match kind:
        case "quoted" | "escaped" | "other":
            return [literal(text)]
        case "width":
            return [literal(" ")]
        case "fill":
            return []
        case "bracket":
            return _in_brackets(text)
        case "refused":
            raise FormatError(f"{text!r} is not closed, or means nothing here")
        case _:
            return [Token(Mark[kind], text.lower() if kind == "PART" else text)]


def _in_brackets(text: str) -> list[Token]:
    if text.startswith("$"):
        currency, _, language = text[1:].partition("-")
        return [literal(currency), Token(Mark.LANGUAGE, language.lower())]
    if _ELAPSED.fullmatch(text):
        return [Token(Mark.ELAPSED, text.lower())]
    if _CONDITION.fullmatch(text):
        return [Token(Mark.CONDITION, text.replace(" ", ""))]
    if _COLOUR.fullmatch(text):
        return []
    if _OTHER_NUMERALS.fullmatch(text):
        raise UnknownFormat(f"the numerals of [{text}] are not known")
    raise FormatError(f"[{text}] is not known")
