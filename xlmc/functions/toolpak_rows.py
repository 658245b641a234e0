"""Rows of the functions of the former Analysis ToolPak that take numbers and dates.

Their dates are whole days of Excel's calendar, anything else is `#NUM!`; bodies get them as serials of the 1900 system,
whichever system the workbook has.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import leveled
from xlmc.functions.dates.calendar import in_calendar
from xlmc.functions.registry import Kind, Parameter, Ranges, excel
from xlmc.functions.toolpak import strict_numbers
from xlmc.functions.values import NUM, Bools, Floats, Value

__all__ = ["DAYS_TO_1904", "Date", "toolpak", "whole_days"]

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
