"""SUBTOTAL and AGGREGATE: other functions by number.

Cells in hidden rows, and cells that hold SUBTOTAL or AGGREGATE themselves, are not known here: the caller leaves them
out of the ranges, as `Skips` says, or makes them blank.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.arguments import align_ranges, error_everywhere, whole_numbers
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.lookup.picked_cells import flatten_cells, map_parts
from xlmc.excel.functions.registry import Arrays, Cells, Number, excel, row_of
from xlmc.excel.functions.values import BLANK, ERROR, ShapeVaries, Value, constant

__all__ = ["Skips", "aggregate", "aggregate_skips", "subtotal", "subtotal_skips"]

_OF_SETS: Final = {
    1: "AVERAGE",
    2: "COUNT",
    3: "COUNTA",
    4: "MAX",
    5: "MIN",
    6: "PRODUCT",
    7: "STDEV.S",
    8: "STDEV.P",
    9: "SUM",
    10: "VAR.S",
    11: "VAR.P",
}
_MORE_OF_SETS: Final = {12: "MEDIAN", 13: "MODE.SNGL"}
_OF_ARRAYS: Final = {
    14: "LARGE",
    15: "SMALL",
    16: "PERCENTILE.INC",
    17: "QUARTILE.INC",
    18: "PERCENTILE.EXC",
    19: "QUARTILE.EXC",
}
_WITHOUT_ERRORS: Final = {2, 3, 6, 7}


@dataclass(frozen=True, slots=True)
class Skips:
    """Which cells a call leaves out.

    Attributes:
        nested: those that hold SUBTOTAL or AGGREGATE.
        filtered: those in rows that a filter hides.
        hidden: those in rows hidden by hand.
    """

    nested: bool
    filtered: bool
    hidden: bool


def subtotal_skips(number: int) -> Skips:
    """Return what `SUBTOTAL(number, …)` leaves out: with 101 to 111 also what is hidden by hand."""
    return Skips(nested=True, filtered=True, hidden=number > 100)


def aggregate_skips(options: int) -> Skips:
    """Return what `AGGREGATE(…, options, …)` leaves out."""
    hidden = options in (1, 3, 5, 7)
    return Skips(nested=options < 4, filtered=hidden, hidden=hidden)


def subtotal(number: int, values: Sequence[Value]) -> Value:
    """`SUBTOTAL` of ranges that hold only what counts; numbers from 101 on are the same functions."""
    name = _OF_SETS.get(number - 100 if number > 100 else number)
    return constant(ErrorCode.VALUE) if name is None else row_of(name)(_ranges(values))


def aggregate(number: int, options: int, values: Sequence[Value]) -> Value:
    """`AGGREGATE` of ranges that hold only what counts, and errors: these are left out here, if `options` say so."""
    if not 0 <= options <= 7:
        return constant(ErrorCode.VALUE)
    keep = _without_errors if options in _WITHOUT_ERRORS else lambda value: value
    if number in _OF_ARRAYS:
        if len(values) != 2:
            return constant(ErrorCode.VALUE)
        return row_of(_OF_ARRAYS[number])([keep(values[0].as_range()), _rank(values[1])])
    name = (_OF_SETS | _MORE_OF_SETS).get(number)
    return constant(ErrorCode.VALUE) if name is None else row_of(name)([keep(v) for v in _ranges(values)])


def _rank(value: Value) -> Value:
    """Return the rank that is asked for: a range of one cell becomes a single value, so that the result is
    single, too.
    """
    return map_parts(value, lambda part: part[:, 0, 0]) if value.shape[1:] == (1, 1) else value


def _ranges(values: Sequence[Value]) -> list[Value]:
    return [value.as_range() for value in values]


def _without_errors(value: Value) -> Value:
    """Blanks instead of errors."""
    kinds = np.where(value.kinds >= ERROR, np.uint8(BLANK), value.kinds)
    return Value(value.numbers, kinds.astype(np.uint8), value.texts)


def _by_number(number: Value, compute: Callable[[int], Value]) -> Value:
    """`compute(number)` for each number that occurs, should it differ between trials.

    Raises:
        ShapeVaries: the results are arrays of different shapes.
        FormulaError: the number is an array, and the results are arrays of a size that does not fit it.
    """
    numbers, errors = whole_numbers(number)
    result = error_everywhere(number, ErrorCode.VALUE, errors)
    present = np.unique(flatten_cells(numbers, number)[flatten_cells(errors, number) == 0]).tolist()
    results = {wanted: compute(int(wanted)) for wanted in present}
    shapes = {value.shape[1:] for value in results.values()} | ({()} if errors.any() else set())
    if number.numbers.ndim == 1 and len(shapes) > 1:
        raise ShapeVaries
    try:
        np.broadcast_shapes(number.shape[1:], *shapes)
    except ValueError:
        hint = "give one number, or arrays of one size"
        raise FormulaError("AGGREGATE is given arrays of different sizes", hint=hint) from None
    for wanted, value in results.items():
        result = choose((numbers == wanted) & (errors == 0), value, result)
    return result


@excel("SUBTOTAL", Number, Cells(repeat=True))
def _subtotal(number: Value, *values: Value) -> Value:
    """Return the function of that number of the ranges: 1 AVERAGE, 2 COUNT, 3 COUNTA, 4 MAX, 5 MIN, 6 PRODUCT, …, 9
    SUM, ….
    """
    return _by_number(number, lambda chosen: subtotal(chosen, values))


@excel("AGGREGATE", Number, Number, Arrays(repeat=True))
def _aggregate(number: Value, options: Value, *values: Value) -> Value:
    """Return the function of that number of the ranges: as SUBTOTAL, and 12 MEDIAN to 19 QUARTILE.EXC.

    With options 2, 3, 6 and 7 errors are left out.
    """
    number, options = align_ranges(number, options)
    cells = np.broadcast_shapes(number.shape[1:], options.shape[1:])
    number = map_parts(number, lambda part: np.broadcast_to(part, (part.shape[0], *cells)))
    return _by_number(number, lambda chosen: _by_number(options, lambda wanted: aggregate(chosen, wanted, values)))
