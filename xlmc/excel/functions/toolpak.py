"""How the functions of the former Analysis ToolPak take their arguments, and how they are registered.

They give `#VALUE!` for a logical; they read a text that stands for a number as that number, in a range too, and a
blank as 0. Where they want one value, a range of several cells is `#VALUE!`, in array formulas too; an array is not:
`EDATE(A1:A3,1)` is `#VALUE!`, and `EDATE(+A1:A3,1)` in an array formula gives three dates. In the file format these
arguments are references, not values.

Their dates are whole days of Excel's calendar, anything else is `#NUM!`. Bodies get them as serials of the 1900 system
even if the workbook counts from 1904.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import align_ranges, first_error
from xlmc.excel.functions.dates.calendar import in_calendar
from xlmc.excel.functions.lookup.picked_cells import flatten_cells, join_cells
from xlmc.excel.functions.registry import Anything, Kind, Parameter, Ranges, excel
from xlmc.excel.functions.values import LOGICAL, NUM, Bools, Codes, Floats, Value, parse_number

__all__ = [
    "DAYS_TO_1904",
    "Date",
    "OneCell",
    "all_strict_numbers",
    "numbers_only",
    "strict_number",
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
    """Return days of the 1900 system, and where they are valid; an invalid day is replaced by a valid one."""
    valid = in_calendar(serial, date1904)
    return np.where(valid, np.floor(serial), 1.0) + (DAYS_TO_1904 if date1904 else 0), valid


def toolpak(
    name: str, *parameters: Parameter, gives_date: bool = False
) -> Callable[[Callable[..., Floats]], Callable[..., Floats]]:
    """Register a body of numbers as the Excel function `name`; the module says how it takes logicals and dates."""
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
    for value, parameter in zip(align_ranges(*values), parameters, strict=False):
        x, results = value.to_logicals() if parameter.kind is Kind.LOGICAL else strict_numbers(value)
        if isinstance(parameter, _DateParameter):
            x, valid = whole_days(x, date1904)
            all_valid = all_valid & valid
        arrays.append(x)
        errors = np.where(errors > 0, errors, results).astype(np.uint8)
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
    """Return the numbers and their errors, `#VALUE!` for a logical."""
    numbers, errors = value.to_numbers()
    return numbers, np.where(value.kinds == LOGICAL, np.uint8(ErrorCode.VALUE), errors).astype(np.uint8)


def strict_number(item: object) -> float | ErrorCode:
    """Do the same for one Python object of `Value.objects`."""
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
    """Make a body for `Anything` arguments from one that takes and gives arrays of numbers."""

    @wraps(body)
    def strict(*values: Value) -> Value:
        pairs = [strict_numbers(value) for value in align_ranges(*values)]
        result = np.atleast_1d(body(*(numbers for numbers, _ in pairs)))
        errors = first_error(*(results for _, results in pairs))
        return Value.of_logicals(result, errors) if result.dtype == bool else Value.of_numbers(result, errors)

    return strict


def all_strict_numbers(values: Sequence[Value]) -> tuple[Floats, Codes]:
    """Put all cells of all arguments side by side, as strict numbers and their errors: (n, k), (n, k)."""
    parts = [(value, *strict_numbers(value)) for value in values]
    numbers = join_cells([flatten_cells(x, value) for value, x, _ in parts])
    return numbers, join_cells([flatten_cells(codes, value) for value, _, codes in parts])
