"""Two kinds of error that never mix.

`ErrorCode` names the error *values* of Excel: they live in cells, one per trial, and propagate like numbers.
`XlmcError` and its subclasses are for people: each says where, what, and what to do.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import IntEnum

__all__ = [
    "DefinitionError",
    "DefinitionsError",
    "ErrorCode",
    "FormulaError",
    "Notice",
    "SimulationError",
    "WorkbookError",
    "XlmcError",
    "capitalised",
    "sentence",
    "shortened",
]


_LONGEST = 500
"""Characters of a text that a message quotes."""


class ErrorCode(IntEnum):
    """Excel's error values; the numbers are those of Excel's own `ERROR.TYPE`."""

    NULL = 1
    DIV0 = 2
    VALUE = 3
    REF = 4
    NAME = 5
    NUM = 6
    NA = 7
    GETTING_DATA = 8
    SPILL = 9
    CALC = 14

    @property
    def text(self) -> str:
        """The error as a cell shows it: `ErrorCode.DIV0.text == '#DIV/0!'`."""
        return _TEXT[self]

    @classmethod
    def from_text(cls, text: str) -> ErrorCode:
        """Return the code that a cell's text stands for.

        Raises:
            ValueError: the text is not an Excel error.
        """
        try:
            return _CODE[text.upper()]
        except KeyError:
            raise ValueError(f"{text!r} is not an Excel error value") from None


_TEXT = {
    ErrorCode.NULL: "#NULL!",
    ErrorCode.DIV0: "#DIV/0!",
    ErrorCode.VALUE: "#VALUE!",
    ErrorCode.REF: "#REF!",
    ErrorCode.NAME: "#NAME?",
    ErrorCode.NUM: "#NUM!",
    ErrorCode.NA: "#N/A",
    ErrorCode.GETTING_DATA: "#GETTING_DATA",
    ErrorCode.SPILL: "#SPILL!",
    ErrorCode.CALC: "#CALC!",
}
_CODE = {text: code for code, text in _TEXT.items()}


def sentence(text: str) -> str:
    """Return the text with a full stop, where it does not end as a sentence does."""
    return text if text.endswith(("?", "!", ".")) else f"{text}."


_AS_TYPED = ("xlmc", "pip", "nan", "inf")


def capitalised(text: str) -> str:
    """Return the text with a capital letter, as a sentence begins.

    A command, a number, a quotation, a cell and a name before a colon stay as they are.

    >>> capitalised("there is no file"), capitalised("xlmc new lists them"), capitalised("'road friction' is frozen")
    ('There is no file', 'xlmc new lists them', "'road friction' is frozen")
    """
    first = text.split(maxsplit=1)[0] if text.strip() else ""
    return text if first in _AS_TYPED or not re.sub("[-',;]", "", first).isalpha() else f"{text[0].upper()}{text[1:]}"


class XlmcError(Exception):
    """A message for the person at the keyboard: where it is, what is wrong, what to do.

    As text both sentences begin with a capital letter; `message` stays as given, for use within another sentence.

    Args:
        message: what is wrong, one sentence without a full stop.
        where: the cell, file or table it concerns; anything whose `str` a person recognises.
        hint: what to do about it, one sentence without a full stop.
    """

    def __init__(self, message: str, *, where: object = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = None if where is None else str(where)
        self.hint = hint

    def __str__(self) -> str:
        start = f"{shortened(self.where)}: " if self.where else ""
        spoken = sentence(f"{start}{shortened(capitalised(self.message))}")
        return sentence(f"{spoken} {capitalised(self.hint)}") if self.hint else spoken


def shortened(text: str) -> str:
    """Cut a text that may quote a file after 500 characters, so that a message stays one.

    >>> len(shortened("x" * 500)), len(shortened("x" * 501)), shortened("x" * 501)[-2:]
    (500, 501, 'x…')
    """
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"


class WorkbookError(XlmcError):
    """The file cannot be read or written."""


class DefinitionError(XlmcError):
    """An assumption, forecast, filter, correlation or setting is not what it must be."""


class DefinitionsError(DefinitionError):
    """Several of them, a line each; every line is as short as a message, and none is left out."""

    def __str__(self) -> str:
        return sentence(self.message)


class SimulationError(XlmcError):
    """The run cannot be done as asked."""


class FormulaError(XlmcError):
    """A formula that cannot be computed.

    Args:
        text: the formula as written, without its leading `=`.
        span: where the faulty part stands in `text`, as (start, end).
    """

    def __init__(
        self,
        message: str,
        *,
        where: object = None,
        hint: str | None = None,
        text: str | None = None,
        span: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(message, where=where, hint=hint)
        self.text = text
        self.span = span

    def at(self, where: object) -> FormulaError:
        """Return the same error, with where it is: a cell."""
        return FormulaError(self.message, where=where, hint=self.hint, text=self.text, span=self.span)

    def __str__(self) -> str:
        if self.text is None:
            return super().__str__()
        start, end = self.span or (0, 0)
        first = max(0, min(start - _LONGEST // 4, len(self.text) - _LONGEST))
        shown = f"{'…' * (first > 0)}{shortened(self.text[first:])}"
        lines = [super().__str__(), f"    ={shown}"]
        if self.span is not None:
            at = start - first + (first > 0)
            lines.append(" " * (5 + at) + "^" * max(1, min(end, first + _LONGEST) - start))
        return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Notice:
    """Something the person should know that does not stop the work."""

    message: str
    where: object = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "message", capitalised(self.message))

    def __str__(self) -> str:
        spoken = shortened(self.message)
        return f"{shortened(str(self.where))}: {spoken}" if self.where is not None else spoken
