"""How the functions of the former Analysis ToolPak take their arguments, and how they are registered.

To them a logical is no number but `#VALUE!`; a text that stands for a number is one wherever it stands, in a range
too, and a blank is 0. Where they want one value, a range of several cells is `#VALUE!`, in array formulas too; an array
is not: `EDATE(A1:A3,1)` is `#VALUE!`, and `EDATE(+A1:A3,1)` in an array formula gives three dates. The file format has
these arguments as references, not values.

Their dates are whole days of Excel's calendar, anything else is `#NUM!`; bodies get them as serials of the 1900 system,
whichever system the workbook has.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import earliest, leveled
from xlmc.functions.dates.calendar import in_calendar
from xlmc.functions.lookup.picked_cells import flattened as in_rows
from xlmc.functions.registry import Anything, Kind, Parameter, Ranges, excel
from xlmc.functions.values import LOGICAL, NUM, Bools, Codes, Floats, Value, parse_number

__all__ = [
    "DAYS_TO_1904",
    "Date",
    "OneCell",
    "flattened",
    "number_of",
    "numbers_only",
    "strict_numbers",
    "toolpak",
    "whole_days",
]

DAYS_TO_1904: Final = 1462
"""The 1900 system's serial of 1 January 1904."""


@dataclass(frozen=True, slots=True)
class _DateParameter(Parameter):
    """A number that stands for a day."""


Date: Final = _DateParameter(Kind.NUMBER)


def whole_days(serial: Floats, date1904: bool) -> tuple[Floats, Bools]:
    """Days of the 1900 system and where they are valid; a valid one stands in where they are not."""
    valid = in_calendar(serial, date1904)
    return np.where(valid, np.floor(serial), 1.0) + (DAYS_TO_1904 if date1904 else 0), valid


def toolpak(
    name: str, *parameters: Parameter, gives_date: bool = False
) -> Callable[[Callable[..., Floats]], Callable[..., Floats]]:
    """Register a body of numbers as the Excel function `name`; logicals are `#VALUE!`, `Date`s as the module says."""
    taken = [replace(p, kind=Kind.ANY, ranges=Ranges.ONE_CELL) for p in parameters]

    def register(body: Callable[..., Floats]) -> Callable[..., Floats]:
        def of_values(*values: Value, date1904: bool = False) -> Value:
            result = _of_values(body, parameters, values, date1904)
            return _as_date(result, date1904) if gives_date else result

        of_values.__doc__, of_values.__name__ = body.__doc__, body.__name__
        excel(name, *taken, dated=any(isinstance(p, _DateParameter) for p in parameters))(of_values)
        return body

    return register


def _of_values(
    body: Callable[..., Floats], parameters: Sequence[Parameter], values: Sequence[Value], date1904: bool
) -> Value:
    arrays: list[Any] = []
    errors, all_valid = np.zeros(1, np.uint8), np.ones(1, bool)
    x: Any
    for value, parameter in zip(leveled(*values), parameters, strict=False):
        x, found = value.to_logicals() if parameter.kind is Kind.LOGICAL else strict_numbers(value)
        if isinstance(parameter, _DateParameter):
            x, valid = whole_days(x, date1904)
            all_valid = all_valid & valid
        arrays.append(x)
        errors = np.where(errors > 0, errors, found).astype(np.uint8)
    arrays += [parameter.default for parameter in parameters[len(values) :]]
    result = np.where(all_valid, body(*arrays), NUM)
    return Value.of_numbers(np.broadcast_to(result, np.broadcast_shapes(result.shape, errors.shape)), errors)


def _as_date(result: Value, date1904: bool) -> Value:
    serial = result.numbers - (DAYS_TO_1904 if date1904 else 0)
    wrong = ~in_calendar(serial, date1904) & (result.errors == 0)
    return Value.of_numbers(serial, np.where(wrong, np.uint8(ErrorCode.NUM), result.errors))


OneCell: Final = Anything(ranges=Ranges.ONE_CELL)
"""An argument that takes one value of any kind."""


def strict_numbers(value: Value) -> tuple[Floats, Codes]:
    """The numbers and their errors, `#VALUE!` for a logical."""
    numbers, errors = value.to_numbers()
    return numbers, np.where(value.kinds == LOGICAL, np.uint8(ErrorCode.VALUE), errors).astype(np.uint8)


def number_of(item: object) -> float | ErrorCode:
    """The same for one Python object of `Value.objects`."""
    match item:
        case None:
            return 0.0
        case bool():
            return ErrorCode.VALUE
        case str():
            number = parse_number(item)
            return ErrorCode.VALUE if number is None else number
        case ErrorCode() | float():
            return item
        case _:
            raise TypeError(f"{item!r} is no Excel value")


def numbers_only(body: Callable[..., Any]) -> Callable[..., Value]:
    """A body for `Anything` arguments from one that takes and gives arrays, as those of `Number` arguments do."""

    @wraps(body)
    def strict(*values: Value) -> Value:
        pairs = [strict_numbers(value) for value in leveled(*values)]
        result = np.atleast_1d(body(*(numbers for numbers, _ in pairs)))
        errors = earliest(*(found for _, found in pairs))
        return Value.of_logicals(result, errors) if result.dtype == bool else Value.of_numbers(result, errors)

    return strict


def flattened(values: Sequence[Value]) -> tuple[Floats, Codes]:
    """All cells of all arguments side by side as strict numbers, and their errors: (n, k), (n, k)."""
    parts = [(value, *strict_numbers(value)) for value in values]
    n = max(value.shape[0] for value in values)
    numbers = np.concatenate([_tall(in_rows(x, value), n) for value, x, _ in parts], axis=1)
    errors = np.concatenate([_tall(in_rows(codes, value), n) for value, _, codes in parts], axis=1)
    return numbers, errors


def _tall(rows: NDArray[Any], n: int) -> NDArray[Any]:
    return np.broadcast_to(rows, (n, rows.shape[1]))
