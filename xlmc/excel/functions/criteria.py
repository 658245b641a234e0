"""The criteria of `COUNTIF` and similar functions: `5`, `">=1/31/2024"`, `"b*"`, `TRUE`, `#N/A`, an empty cell.

The criterion of a trial is compared with the cells of the same trial. Letters: n trials, k cells.

* Without an operator, or with `=`, a number matches equal numbers and the texts that read as it; a text matches equal
  texts, in upper or lower case, and may hold wildcards; a logical or an error matches equal ones. An empty cell as
  criterion is the number 0.
* `<>` matches every cell that `=` does not, even an empty one or an error. Only `<>5` matches the text `5` as well.
* `<`, `<=`, `>` and `>=` match only cells of the operand's kind.
* Numbers are compared at 15 digits, those of the cells and the operand's: a text that a formula joins, `">"&A1`, holds
  no more of a number, and the cell that it came from is not above itself.
* `""` matches empty cells and empty texts, `"="` empty cells, `"<>"` all other cells.

A text with wildcards is a pattern for a whole text: `*` stands for any characters, `?` for one, and the character
after `~` for itself; a `~` at the end is nothing. A pattern is cut at its stars into pieces of fixed length, so that
each piece goes over the text once at most: one regular expression with many stars could take for ever.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import fill_blanks
from xlmc.excel.functions.fifteen_digits import COMPARISONS
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.number_text import SPACES, parse_number
from xlmc.excel.functions.ordering import Ordered, to_ordered
from xlmc.excel.functions.values import BLANK, ERROR, NUMBER, TEXT, Bools, Floats, Objects, Value, from_objects

__all__ = ["is_pattern", "pattern_of", "which_meet"]

_Read = Callable[[str], float | None]
"""How a text reads as a number."""

_OPERATOR: Final = re.compile(r"(<=|>=|<>|<|>|=|)(.*)", re.DOTALL)
_BEGINS: Final = "begins"
_LOGICALS: Final = {"true": True, "false": False}
_RELATIONS: Final = frozenset({"<", "<=", ">", ">="})


def which_meet(criterion: Value, cells: Value, *, begins: bool = False, date1904: bool = False) -> Bools:
    """Return which cells match the criterion.

    Args:
        criterion: (n,).
        cells: (n, r, c).
        begins: a text without an operator matches the texts that begin with it, as in database functions.
        date1904: dates in texts count from 1904.

    Returns:
        (n, k), the cells row by row.
    """
    read = partial(_read_stripped, date1904=date1904)
    operators, operand = _parse(criterion, _BEGINS if begins else "=", read)
    wanted, order = to_ordered(operand, cells)
    present = sorted(set(operators.tolist()))
    result = _match(present[0], wanted, order, read)
    for operator in present[1:]:
        result = np.where((operators == operator)[:, None], _match(operator, wanted, order, read), result)
    return result


def _read_stripped(text: str, date1904: bool) -> float | None:
    return parse_number(text.strip(SPACES), date1904)


def _parse(criterion: Value, plain: str, read: _Read) -> tuple[Objects, Value]:
    """Return the operator and the operand of each criterion; `plain` is the operator of a text without one."""
    operand = fill_blanks(criterion)
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
    """Split `">=5"` into `>=` and 5."""
    match = _OPERATOR.fullmatch(text)
    assert match is not None
    operator, rest = match.groups()
    if not rest:
        return (operator, None) if operator else ("=", "")
    return operator or plain, _read_operand(rest, read)


def _read_operand(text: str, read: _Read) -> object:
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


def _match(operator: str, wanted: Ordered, order: Ordered, read: _Read) -> Bools:
    if operator in _RELATIONS:
        comparable = (order.kinds == wanted.kinds) & (order.kinds != BLANK) & (order.kinds < ERROR)
        return np.asarray(comparable & COMPARISONS[operator](order.order, wanted.order))
    equal = _match_equal(wanted, order, operator == _BEGINS, read if operator != "<>" else None)
    return ~equal if operator == "<>" else equal


def _match_equal(wanted: Ordered, order: Ordered, begins: bool, read: _Read | None) -> Bools:
    """Return which cells equal the operand; with `read`, the texts that read as a number equal it too."""
    equal = COMPARISONS["="]
    result = (order.kinds == wanted.kinds) & equal(order.order, wanted.order)
    is_number, is_text = wanted.kinds == NUMBER, wanted.kinds == TEXT
    if read is not None and is_number.any() and (order.kinds == TEXT).any():
        result = result | (is_number & equal(_numbers_of_texts(order, read), wanted.order))
    for index in np.unique(wanted.order[is_text]).tolist():
        text = wanted.text(index)
        if not text or begins or is_pattern(text):
            fitting = order.kinds == BLANK if not text else _match_pattern(order, text, begins)
            result = np.where(is_text & (wanted.order == index), result | fitting if not text else fitting, result)
    return np.asarray(result)


def _numbers_of_texts(order: Ordered, read: _Read) -> Floats:
    """Return the number that each text reads as; NaN where there is no such number, or no text."""
    numbers = [read(text) for text in order.texts]
    table = np.array([np.nan if number is None else number for number in numbers])
    return np.asarray(_look_up_texts(order, table, np.nan))


def _match_pattern(order: Ordered, pattern: str, begins: bool) -> Bools:
    fits = pattern_of(pattern, begins).fits
    present = set(np.unique(order.order[order.kinds == TEXT]).astype(np.intp).tolist())
    table = np.array([index in present and fits(text) for index, text in enumerate(order.texts)])
    return np.asarray(_look_up_texts(order, table, False))


def _look_up_texts(order: Ordered, table: Any, otherwise: Any) -> Any:
    """Return the table's entry for each text, and `otherwise` where a cell holds none."""
    is_text = order.kinds == TEXT
    return np.where(is_text, table[np.where(is_text, order.order, 0).astype(np.intp)], otherwise)


_TOKEN = re.compile(r"~.|~$|.", re.DOTALL)


@dataclass(frozen=True, slots=True)
class _Pattern:
    """A pattern cut at its stars.

    Attributes:
        pieces: each compiled, with its length.
    """

    pieces: tuple[tuple[re.Pattern[str], int], ...]

    def fits(self, text: str) -> bool:
        """Return whether the whole text fits, in upper or lower case."""
        folded = text.casefold()
        head, length = self.pieces[0]
        if head.match(folded) is None:
            return False
        return self._rest_fits(folded, length) if len(self.pieces) > 1 else len(folded) == length

    def _rest_fits(self, text: str, start: int) -> bool:
        for piece, _ in self.pieces[1:-1]:
            match = piece.search(text, start)
            if match is None:
                return False
            start = match.end()
        tail, length = self.pieces[-1]
        return len(text) - length >= start and tail.match(text, len(text) - length) is not None


def is_pattern(text: str) -> bool:
    """Return whether the text holds a wildcard or a `~`."""
    return any(mark in text for mark in "*?~")


@lru_cache(maxsize=4096)
def pattern_of(text: str, begins: bool = False) -> _Pattern:
    """Compile the pattern that a text stands for; with `begins` any characters may follow it."""
    pieces: list[list[str]] = [[]]
    for token in _TOKEN.findall(text.casefold() + ("*" if begins else "")):
        if token == "*":
            pieces.append([])
        elif token != "~":
            pieces[-1].append("." if token == "?" else re.escape(token[-1]))
    return _Pattern(tuple((re.compile("".join(piece), re.DOTALL), len(piece)) for piece in pieces))
