"""The operators of formulas, as functions of one or two arguments; `-x` is called `u-`, and `+x` `u+`.

Comparisons are those of Excel, at 15 digits; see `fifteen_digits`.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.fifteen_digits import COMPARISONS
from xlmc.excel.functions.registry import Anything, Function, Kind, Number, excel
from xlmc.excel.functions.values import BLANK, DIV0, ERROR, LOGICAL, NUM, TEXT, Floats, Value

__all__ = ["ALL_BITS", "IS_CASE", "compare"]

_Relation = Callable[[Any, Any], Any]

excel("+", Number, Number, ufunc=np.add, facts=Facts(never_errs=True, adds=True, measures=True))(np.add)
excel("-", Number, Number, ufunc=np.subtract, facts=Facts(never_errs=True, adds=True, measures=True))(np.subtract)
excel("*", Number, Number, ufunc=np.multiply, facts=Facts(never_errs=True, measures=True))(np.multiply)
excel("u-", Number, ufunc=np.negative, facts=Facts(never_errs=True, unrounded=True))(np.negative)
excel("u+", Anything, returns=Kind.ANY, facts=Facts(never_errs=True, unrounded=True))(lambda x: x)


@excel("/", Number, Number, ufunc=np.divide, facts=Facts(measures=True))
def divide(x: Floats, y: Floats) -> Floats:
    """Quotient; `#DIV/0!` if the divisor is 0."""
    return np.where(y == 0, DIV0, x / y)


@excel("%", Number, facts=Facts(never_errs=True))
def percent(x: Floats) -> Floats:
    """Return a hundredth of the number."""
    return x / 100


def _not_zero_to_zero(x: Floats, y: Floats) -> bool:
    return bool(np.all(y != 0) or np.all(x != 0))


@excel("^", Number, Number, aliases=("POWER",), ufunc=np.power, guard=_not_zero_to_zero, facts=Facts(measures=True))
def power(x: Floats, y: Floats) -> Floats:
    """Power; `0^0` is `#NUM!`, zero to a negative power `#DIV/0!`, a negative base needs a whole exponent."""
    result = np.power(x, y)
    result = np.where((x == 0) & (y < 0), DIV0, result)
    return np.where((x == 0) & (y == 0), NUM, result)


def compare(relation: _Relation, of_numbers: _Relation, x: Value, y: Value) -> Value:
    """Compare in Excel's order: numbers before texts before logicals; case does not count; a blank is 0, "" or FALSE.

    Args:
        relation: the comparison, for kinds and texts.
        of_numbers: the same comparison, for numbers.
        x: the value on the left.
        y: the value on the right.
    """
    if x.numbers.ndim != y.numbers.ndim:
        x, y = x.as_range(), y.as_range()
    if x.plain and y.plain and not _mixed(x, y):
        return Value.of_logicals(np.atleast_1d(of_numbers(x.numbers, y.numbers)))
    errors = np.where(x.errors > 0, x.errors, y.errors).astype(np.uint8)
    rank_x, rank_y = _ranks(x, y), _ranks(y, x)
    by_rank = relation(rank_x, rank_y)
    by_value = of_numbers(x.numbers, y.numbers)
    texts = (rank_x == TEXT) & (rank_y == TEXT)
    by_text = relation(_text_order(x, y), 0) if texts.any() else by_value
    result = np.where(rank_x == rank_y, np.where(texts, by_text, by_value), by_rank)
    return Value.of_logicals(np.atleast_1d(result), errors if errors.any() else None)


def _mixed(x: Value, y: Value) -> bool:
    """Return whether there are both logicals and numbers."""
    counts = [np.bincount(v.kinds.ravel()) for v in (x, y)]  # not `np.unique`, which imports masked arrays
    return len({int(kind) for each in counts for kind in np.flatnonzero(each)} - {BLANK}) > 1


def _ranks(x: Value, other: Value) -> Any:
    """Rank the kinds: 0 number, 2 text, 3 logical; a blank takes the rank of the other value."""
    ranks = np.array([0, 3, 2, 0], np.uint8)
    own = ranks[np.where(x.kinds >= ERROR, 0, x.kinds)]
    met = ranks[np.where(other.kinds >= ERROR, 0, other.kinds)]
    return np.where(x.kinds == BLANK, np.where(other.kinds == BLANK, 0, met), own)


def _text_order(x: Value, y: Value) -> Floats:
    """Return -1, 0 or 1 where x's text comes before, equals or comes after y's."""
    (left, _), (right, _) = x.to_texts(), y.to_texts()
    order = np.frompyfunc(lambda a, b: (a.casefold() > b.casefold()) - (a.casefold() < b.casefold()), 2, 1)
    return np.asarray(order(left, right), np.float64)


ALL_BITS: Final[dict[str, Function]] = {}
"""Comparisons of all bits, not of 15 digits: for SWITCH, CHOOSE and the limits in the tables of xlmc."""


def _register(symbol: str, relation: _Relation) -> None:
    digits = COMPARISONS[symbol]
    body = partial(compare, relation, digits)
    facts = Facts(never_errs=True, condition=True)
    excel(symbol, Anything, Anything, returns=Kind.LOGICAL, ufunc=digits, facts=facts)(body)
    exact = partial(compare, relation, digits.plain)
    ALL_BITS[symbol] = Function(symbol, (Anything, Anything), exact, Kind.LOGICAL, ufunc=digits.plain, facts=facts)


_register("=", operator.eq)
_register("<>", operator.ne)
_register("<", operator.lt)
_register("<=", operator.le)
_register(">", operator.gt)
_register(">=", operator.ge)


def _is_case(x: Value, y: Value) -> Value:
    """Whether two values are equal as SWITCH has it: a logical equals no empty cell."""
    if x.numbers.ndim != y.numbers.ndim:
        x, y = x.as_range(), y.as_range()
    value = compare(operator.eq, COMPARISONS["="].plain, x, y)
    apart = (x.kinds == BLANK) & (y.kinds == LOGICAL) | (x.kinds == LOGICAL) & (y.kinds == BLANK)
    return Value.of_logicals((value.numbers != 0) & ~apart, value.errors if value.errors.any() else None)


IS_CASE: Final = replace(ALL_BITS["="], body=_is_case)
"""How SWITCH compares its first argument with the others."""
