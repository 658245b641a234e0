"""A trial evaluated again with 50 digits: what the formulas mean, without the rounding of doubles.

Numbers typed into cells count as the decimals that were typed, draws as the doubles they are, and π as π. A result that
differs from 0 in the last digits alone is 0, as COS of 270° is. What Excel does about the last digits of doubles is
left out: comparisons are exact, and the sum that a formula ends with is what it is. A function that is not known here
is evaluated as in the run, on arguments rounded to doubles, and its cell is reported as not checked.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import mpmath
import numpy as np
from mpmath import mp, mpf

from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Range, Select
from xlmc.engine.passes.random_rounding import Graph, formula_of
from xlmc.errors import ErrorCode
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.values import ShapeVaries, Value, constant, from_objects

__all__ = ["DIGITS", "Exact", "as_double"]

DIGITS: Final = 50
_NOTHING: Final = 10
"""A sum that cancels to within this many of the last digits is 0."""

Item = Any
"""A number `mpf`, a logical, a text, None for a blank, an `ErrorCode`; rows of rows for a range."""


class Exact:
    """The exact values of the trials so far.

    Attributes:
        unchecked: nodes of functions that are not known here.
    """

    def __init__(self, dag: Graph, nodes: Sequence[int]) -> None:
        self._dag, self._nodes = dag, nodes
        self.unchecked: set[int] = set()

    def trial(self, draws: Mapping[str, float]) -> dict[int, Item]:
        """Every node's value."""
        result: dict[int, Item] = {}
        with mp.workdps(DIGITS):
            for node in self._nodes:
                result[node] = self._value(node, draws, result)
        return result

    def _value(self, node_id: int, draws: Mapping[str, float], results: Mapping[int, Item]) -> Item:
        node = formula_of(self._dag, node_id)
        match node:
            case Input(name):
                return mpf(float(draws[name]))
            case Constant(value):
                return _constant_items(value)
            case Range(rows):
                return [[_single(results[part]) for part in row] for row in rows]
            case Select(condition, yes, no):
                return _choose(results[condition], results[yes], results[no])
            case IfErrorNode(value, instead, only_na):
                item = results[value]
                lost = item is ErrorCode.NA if only_na else isinstance(item, ErrorCode)
                return _zero_if_blank(results[instead] if lost else item)
            case Apply(function, arguments):
                items = [results[argument] for argument in arguments]
                body = EXACT.get(function.name)
                if body is not None:
                    result = _apply(body, items)
                    if result is not NotImplemented:
                        return result
                if function.facts.exact_steps:
                    return _decimal(_as_in_the_run(function, items))
                self.unchecked.add(node_id)
                return _as_in_the_run(function, items)


def as_double(value: Item) -> float:
    """Return the value as a double; NaN if it is not a number."""
    value = _single(value)
    if isinstance(value, bool):
        return float(value)
    return float(value) if isinstance(value, mpf) else float("nan")


def _constant_items(value: Value) -> Item:
    if value.numbers.ndim == 3:
        return [[_exact_item(item) for item in row] for row in value.objects()[0]]
    return _exact_item(value.objects()[0])


def _exact_item(item: object) -> Item:
    if isinstance(item, bool | np.bool_):
        return bool(item)
    if isinstance(item, float | int):
        factor = {np.pi / 180: mp.pi / 180, 180 / np.pi: 180 / mp.pi, np.pi: +mp.pi}.get(float(item))
        return mpf(repr(float(item))) if factor is None else factor
    return item


def _single(item: Item) -> Item:
    while isinstance(item, list):
        item = item[0]
    return item


def _zero_if_blank(item: Item) -> Item:
    return mpf(0) if item is None else item


def _choose(condition: Item, yes: Item, no: Item) -> Item:
    condition = _single(condition)
    if isinstance(condition, ErrorCode):
        return condition
    if isinstance(condition, str):
        return ErrorCode.VALUE
    return _zero_if_blank(yes if condition else no)


def _apply(body: Callable[..., Item], items: Sequence[Item]) -> Item:
    try:
        return body(*items)
    except ZeroDivisionError:
        return ErrorCode.DIV0
    except (ValueError, OverflowError, mpmath.libmp.NoConvergence):
        return ErrorCode.NUM
    except _CellError as error:
        return error.code


class _CellError(Exception):
    """An error as a value."""

    def __init__(self, code: ErrorCode) -> None:
        super().__init__()
        self.code = code


def _number(item: Item) -> mpf:
    """Return a single value as arithmetic reads it."""
    item = _single(item)
    if isinstance(item, ErrorCode):
        raise _CellError(item)
    if isinstance(item, str):
        raise _CellError(ErrorCode.VALUE)
    return mpf(0) if item is None else mpf(item)


def _of_numbers(function: Callable[..., mpf]) -> Callable[..., Item]:
    def body(*items: Item) -> Item:
        if any(isinstance(item, list) and (len(item) > 1 or len(item[0]) > 1) for item in items):
            return NotImplemented
        if any(isinstance(_single(item), str) for item in items):
            return NotImplemented
        result = function(*map(_number, items))
        if not mp.isfinite(result) or isinstance(result, mpmath.mpc):
            raise ValueError
        return result

    return body


def _dust_to_zero(result: mpf, size: mpf) -> mpf:
    """0 where the result differs from 0 only in the last digits of numbers of that size."""
    return mpf(0) if abs(result) < size * mpf(10) ** (_NOTHING - DIGITS) else result


def _power(x: mpf, y: mpf) -> mpf:
    if x == 0 and y <= 0:
        raise _CellError(ErrorCode.DIV0 if y < 0 else ErrorCode.NUM)
    if x < 0 and y != int(y):
        raise ValueError
    return x**y


def _real(function: Callable[[mpf], Any], low: float = -np.inf, high: float = np.inf) -> Callable[..., Item]:
    """Limit the domain of a function of a number; the limits themselves are allowed."""

    def bounded(x: mpf) -> mpf:
        if not low <= x <= high:
            raise ValueError
        return function(x)

    return _of_numbers(bounded)


def _log(x: mpf, base: mpf | None = None) -> mpf:
    if x <= 0 or (base is not None and base <= 0):
        raise ValueError
    return mp.log(x) / mp.log(mpf(10) if base is None else base)


def _atan2(x: mpf, y: mpf) -> mpf:
    if x == 0 and y == 0:
        raise ZeroDivisionError
    return mp.atan2(y, x)


def _cells(items: Sequence[Item]) -> list[mpf]:
    """Return the numbers that count in a sum: those in ranges, and all that is given directly, as numbers."""
    result: list[mpf] = []
    for item in items:
        if not isinstance(item, list):
            result.append(_number(item))
            continue
        for cell in (cell for row in item for cell in row):
            if isinstance(cell, ErrorCode):
                raise _CellError(cell)
            if isinstance(cell, mpf):
                result.append(cell)
    return result


def _of_cells(function: Callable[[list[mpf]], mpf]) -> Callable[..., Item]:
    def body(*items: Item) -> Item:
        return function(_cells(items))

    return body


def _total(x: Sequence[mpf]) -> mpf:
    return _dust_to_zero(mp.fsum(x), mp.fsum(x, absolute=True))


def _spread(x: list[mpf], lost: int) -> mpf:
    mean = mp.fsum(x) / len(x)
    return mp.fsum((one - mean) ** 2 for one in x) / (len(x) - lost)


def _covariance(lost: int) -> Callable[..., Item]:
    def body(first: Item, second: Item) -> Item:
        x, y = _cells([first]), _cells([second])
        if len(x) != len(y) or len(x) <= lost:
            return NotImplemented
        of_x, of_y = mp.fsum(x) / len(x), mp.fsum(y) / len(y)
        return mp.fsum((a - of_x) * (b - of_y) for a, b in zip(x, y, strict=True)) / (len(x) - lost)

    return body


def _sum_product(*items: Item) -> Item:
    grids = [item if isinstance(item, list) else [[item]] for item in items]
    if len({(len(grid), len(grid[0])) for grid in grids}) > 1:
        return ErrorCode.VALUE
    flat = [[cell for row in grid for cell in row] for grid in grids]
    for cell in (cell for cells in flat for cell in cells):
        if isinstance(cell, ErrorCode):
            return cell
    terms = [
        mp.fprod(cells) if all(isinstance(cell, mpf) for cell in cells) else mpf(0) for cells in zip(*flat, strict=True)
    ]
    return _total(terms)


def _compare(relation: Callable[[mpf, mpf], bool]) -> Callable[..., Item]:
    def body(left: Item, right: Item) -> Item:
        left, right = _single(left), _single(right)
        if isinstance(left, mpf) and isinstance(right, mpf):
            return bool(relation(left, right))
        return NotImplemented

    return body


def _join(decide: Callable[[list[bool]], bool]) -> Callable[..., Item]:
    def body(*items: Item) -> Item:
        result: list[bool] = []
        for item in items:
            cells = [cell for row in item for cell in row] if isinstance(item, list) else [item]
            for cell in cells:
                if isinstance(cell, ErrorCode):
                    return cell
                if isinstance(cell, str):
                    return NotImplemented
                if cell is not None:
                    result.append(bool(cell))
        return decide(result) if result else ErrorCode.VALUE

    return body


_FROM_1 = _real(mp.acosh, 1)

EXACT: Final[Mapping[str, Callable[..., Item]]] = {
    "+": _of_numbers(lambda x, y: _dust_to_zero(x + y, abs(x) + abs(y))),
    "-": _of_numbers(lambda x, y: _dust_to_zero(x - y, abs(x) + abs(y))),
    "*": _of_numbers(lambda x, y: x * y),
    "/": _of_numbers(lambda x, y: x / y),
    "^": _of_numbers(_power),
    "u-": _of_numbers(lambda x: -x),
    "%": _of_numbers(lambda x: x / 100),
    "u+": _single,
    SNAP_TO_ZERO.name: lambda result, first: _single(result),
    "shown": lambda item: _zero_if_blank(_single(item)),
    "PI": lambda: +mp.pi,
    "SQRT": _real(mp.sqrt, 0),
    "SQRTPI": _real(lambda x: mp.sqrt(x * mp.pi), 0),
    "EXP": _real(mp.exp),
    "LN": _of_numbers(lambda x: _log(x, mp.e)),
    "LOG10": _of_numbers(_log),
    "LOG": _of_numbers(_log),
    "SIN": _real(lambda x: _dust_to_zero(mp.sin(x), mpf(1))),
    "COS": _real(lambda x: _dust_to_zero(mp.cos(x), mpf(1))),
    "TAN": _real(lambda x: _dust_to_zero(mp.sin(x), mpf(1)) / _dust_to_zero(mp.cos(x), mpf(1))),
    "SEC": _real(lambda x: 1 / _dust_to_zero(mp.cos(x), mpf(1))),
    "CSC": _real(lambda x: 1 / _dust_to_zero(mp.sin(x), mpf(1))),
    "COT": _real(lambda x: _dust_to_zero(mp.cos(x), mpf(1)) / _dust_to_zero(mp.sin(x), mpf(1))),
    "ASIN": _real(mp.asin, -1, 1),
    "ACOS": _real(mp.acos, -1, 1),
    "ATAN": _real(mp.atan),
    "ACOT": _real(lambda x: mp.pi / 2 - mp.atan(x)),
    "ATAN2": _of_numbers(_atan2),
    "SINH": _real(mp.sinh),
    "COSH": _real(mp.cosh),
    "TANH": _real(mp.tanh),
    "ASINH": _real(mp.asinh),
    "ACOSH": _FROM_1,
    "ATANH": _real(mp.atanh, -1, 1),
    "ABS": _real(abs),
    "SIGN": _real(mp.sign),
    "INT": _real(mp.floor),
    "MOD": _of_numbers(lambda x, y: x - y * mp.floor(x / y)),
    "SUM": _of_cells(_total),
    "SUMSQ": _of_cells(lambda x: mp.fsum(x, squared=True)),
    "PRODUCT": _of_cells(lambda x: mp.fprod(x) if x else mpf(0)),
    "AVERAGE": _of_cells(lambda x: _total(x) / len(x)),
    "MIN": _of_cells(lambda x: min(x, default=mpf(0))),
    "MAX": _of_cells(lambda x: max(x, default=mpf(0))),
    "MIN so far": _of_cells(lambda x: min(x, default=None)),
    "MAX so far": _of_cells(lambda x: max(x, default=None)),
    "PRODUCT so far": _of_cells(lambda x: mp.fprod(x) if x else None),
    "VAR.S": _of_cells(lambda x: _spread(x, 1)),
    "VAR.P": _of_cells(lambda x: _spread(x, 0)),
    "STDEV.S": _of_cells(lambda x: mp.sqrt(_spread(x, 1))),
    "STDEV.P": _of_cells(lambda x: mp.sqrt(_spread(x, 0))),
    "DEVSQ": _of_cells(lambda x: _spread(x, len(x) - 1)),
    "COVARIANCE.P": _covariance(0),
    "COVARIANCE.S": _covariance(1),
    "SUMPRODUCT": _sum_product,
    "=": _compare(lambda x, y: x == y),
    "<>": _compare(lambda x, y: x != y),
    "<": _compare(lambda x, y: x < y),
    "<=": _compare(lambda x, y: x <= y),
    ">": _compare(lambda x, y: x > y),
    ">=": _compare(lambda x, y: x >= y),
    "AND": _join(all),
    "OR": _join(any),
    "NOT": lambda item: (
        NotImplemented if isinstance(item, list | str) else (not item) if not isinstance(item, ErrorCode) else item
    ),
}
"""Name of the function's row in the registry -> its body."""


def _as_in_the_run(function: Any, items: Sequence[Item]) -> Item:
    """Call the run's own body, on doubles."""
    arguments = [_to_value(item) for item in items]
    try:
        with np.errstate(all="ignore"):
            return _result_items(function(arguments))
    except ShapeVaries:  # of one trial there is but one shape
        return ErrorCode.VALUE


def _to_value(item: Item) -> Value:
    if isinstance(item, list):
        out = np.empty((1, len(item), len(item[0])), object)
        for r, row in enumerate(item):
            for c, cell in enumerate(row):
                out[0, r, c] = float(cell) if isinstance(cell, mpf) else cell
        return from_objects(out)
    return constant(float(item) if isinstance(item, mpf) else item)


def _result_items(value: Value) -> Item:
    objects = value.objects()
    if value.numbers.ndim == 3:
        return [[_double(cell) for cell in row] for row in objects[0]]
    return _double(objects[0])


def _decimal(item: Item) -> Item:
    """Round as the run does, to the decimal that a rounding means."""
    return mpf(repr(float(item))) if isinstance(item, mpf) else item


def _double(item: object) -> Item:
    return mpf(item) if isinstance(item, float) else item
