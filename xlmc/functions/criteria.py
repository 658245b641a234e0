"""Criteria, as `COUNTIF` and its kin take them: `5`, `">=1/31/2024"`, `"b*"`, `TRUE`, `#N/A`, an empty cell.

A criterion of one trial is held against the cells of the same trial. Letters: n trials, k cells.

* Without an operator, or with `=`, a number meets equal numbers and the texts that read as one; a text meets texts,
  with wildcards and whatever their case; a logical or an error meets its like. An empty cell as criterion is the number
  0.
* `<>` is the opposite in every cell, be it empty or an error; but `<>5` meets the text `5`, which `5` meets too.
* `<`, `<=`, `>` and `>=` meet cells of the operand's kind only.
* `""` meets what is empty or an empty text, `"="` what is empty, `"<>"` what is not.

Wildcards make a pattern that a whole text fits or not: `*` for any characters, `?` for one, `~` before one taken as it
is. A pattern is cut at its stars into pieces of fixed length, so that a text takes no more than one pass a piece: a
chain of stars in one regular expression could take for ever.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import if_blank
from xlmc.functions.logical import choose
from xlmc.functions.number_text import parse_number
from xlmc.functions.ordering import Ordered, ordered
from xlmc.functions.values import BLANK, ERROR, NUMBER, TEXT, Bools, Floats, Objects, Value, from_objects

__all__ = ["is_pattern", "met", "pattern_of"]

_Read = Callable[[str], float | None]
"""How a text reads as a number."""

_OPERATOR: Final = re.compile(r"(<=|>=|<>|<|>|=|)(.*)", re.DOTALL)
_BEGINS: Final = "begins"
_LOGICALS: Final = {"true": True, "false": False}
_RELATIONS: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
}


def met(criterion: Value, cells: Value, *, begins: bool = False, date1904: bool = False) -> Bools:
    """Which cells meet the criterion.

    Args:
        criterion: (n,).
        cells: (n, r, c).
        begins: a text without an operator meets the texts that begin with it: so it is in database functions.
        date1904: dates in texts count from 1904.

    Returns:
        (n, k), the cells row by row.
    """
    read = partial(parse_number, date1904=date1904)
    operators, operand = _parsed(criterion, _BEGINS if begins else "=", read)
    wanted, found = ordered(operand, cells)
    present = sorted(set(operators.tolist()))
    result = _holds(present[0], wanted, found, read)
    for operator in present[1:]:
        result = np.where((operators == operator)[:, None], _holds(operator, wanted, found, read), result)
    return result


def _parsed(criterion: Value, plain: str, read: _Read) -> tuple[Objects, Value]:
    """The operator and the operand of each criterion; `plain` is the operator of a text without one."""
    operand = if_blank(criterion)
    if criterion.texts is None:
        return np.full(1, "=", object), operand
    written = criterion.texts.tolist()
    pairs = {text: _split(text, plain, read) for text in dict.fromkeys(written)}
    index_of = {text: index for index, text in enumerate(pairs)}
    indices = np.array([index_of[text] for text in written])
    operators, items = np.empty((2, len(pairs)), object)
    operators[:], items[:] = zip(*pairs.values(), strict=True)
    is_text = operand.kinds == TEXT
    return np.where(is_text, operators[indices], "="), choose(is_text, from_objects(items).take(indices), operand)


def _split(text: str, plain: str, read: _Read) -> tuple[str, object]:
    """`">=5"` as `>=` and 5."""
    found = _OPERATOR.fullmatch(text)
    assert found is not None
    operator, rest = found.groups()
    if not rest:
        return (operator, None) if operator else ("=", "")
    return operator or plain, _operand(rest, read)


def _operand(text: str, read: _Read) -> object:
    number = read(text)
    if number is not None:
        return number
    folded = text.strip().casefold()
    if folded in _LOGICALS:
        return _LOGICALS[folded]
    try:
        return ErrorCode.from_text(folded)
    except ValueError:
        return text


def _holds(operator: str, wanted: Ordered, found: Ordered, read: _Read) -> Bools:
    if operator in _RELATIONS:
        comparable = (found.kinds == wanted.kinds) & (found.kinds != BLANK) & (found.kinds < ERROR)
        return np.asarray(comparable & _RELATIONS[operator](found.order, wanted.order))
    equal = _equal(wanted, found, operator == _BEGINS, read if operator != "<>" else None)
    return ~equal if operator == "<>" else equal


def _equal(wanted: Ordered, found: Ordered, begins: bool, read: _Read | None) -> Bools:
    """Which cells equal the operand; of a number also the texts that read as it, where `read` is given."""
    result = (found.kinds == wanted.kinds) & (found.order == wanted.order)
    is_number, is_text = wanted.kinds == NUMBER, wanted.kinds == TEXT
    if read is not None and is_number.any() and (found.kinds == TEXT).any():
        result = result | (is_number & (_text_numbers(found, read) == wanted.order))
    for index in np.unique(wanted.order[is_text]).astype(np.intp):
        text = wanted.texts[index]
        if not text or begins or is_pattern(text):
            fitting = found.kinds == BLANK if not text else _fitting(found, text, begins)
            result = np.where(is_text & (wanted.order == index), result | fitting if not text else fitting, result)
    return np.asarray(result)


def _text_numbers(found: Ordered, read: _Read) -> Floats:
    """The number each text reads as; NaN where it is none, or is no text."""
    numbers = [read(text) for text in found.texts]
    table = np.array([np.nan if number is None else number for number in numbers])
    return np.asarray(_by_text(found, table, np.nan))


def _fitting(found: Ordered, pattern: str, begins: bool) -> Bools:
    fits = pattern_of(pattern, begins).fits
    present = set(np.unique(found.order[found.kinds == TEXT]).astype(np.intp).tolist())
    table = np.array([index in present and fits(text) for index, text in enumerate(found.texts)])
    return np.asarray(_by_text(found, table, False))


def _by_text(found: Ordered, table: Any, otherwise: Any) -> Any:
    """What a table says of each text; something else where there is none."""
    is_text = found.kinds == TEXT
    return np.where(is_text, table[np.where(is_text, found.order, 0).astype(np.intp)], otherwise)


_TOKEN = re.compile(r"~[*?~]|.", re.DOTALL)


@dataclass(frozen=True, slots=True)
class _Pattern:
    """A pattern cut at its stars.

    Attributes:
        pieces: each compiled, with its length.
    """

    pieces: tuple[tuple[re.Pattern[str], int], ...]

    def fits(self, text: str) -> bool:
        """Whether the whole text fits, whatever its case."""
        folded = text.casefold()
        head, length = self.pieces[0]
        if head.match(folded) is None:
            return False
        return self._rest_fits(folded, length) if len(self.pieces) > 1 else len(folded) == length

    def _rest_fits(self, text: str, start: int) -> bool:
        for piece, _ in self.pieces[1:-1]:
            found = piece.search(text, start)
            if found is None:
                return False
            start = found.end()
        tail, length = self.pieces[-1]
        return len(text) - length >= start and tail.match(text, len(text) - length) is not None


def is_pattern(text: str) -> bool:
    """Whether the text holds a wildcard or a `~`."""
    return any(mark in text for mark in "*?~")


@lru_cache(maxsize=4096)
def pattern_of(text: str, begins: bool = False) -> _Pattern:
    """The pattern that a text stands for; with `begins` anything may follow it."""
    pieces: list[list[str]] = [[]]
    for token in _TOKEN.findall(text.casefold() + ("*" if begins else "")):
        if token == "*":
            pieces.append([])
        else:
            pieces[-1].append("." if token == "?" else re.escape(token[-1]))
    return _Pattern(tuple((re.compile("".join(piece), re.DOTALL), len(piece)) for piece in pieces))
