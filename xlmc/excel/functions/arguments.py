"""How a body that gets `Value`s reads its arguments: numbers, defaults, and errors in Excel's order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.values import BLANK, ERROR, NUMBER, Bools, Codes, Floats, ShapeVaries, Value

__all__ = [
    "align_ranges",
    "error_everywhere",
    "error_where",
    "errors_unless_range",
    "fill_blanks",
    "first_error",
    "first_error_in_row",
    "require_same_in_all_trials",
    "whole_numbers",
    "with_errors",
]


def align_ranges(*values: Value) -> list[Value]:
    """Return all values as ranges if one of them is a range, so that they broadcast."""
    many = any(value.numbers.ndim == 3 for value in values)
    return [value.as_range() if many else value for value in values]


def fill_blanks(value: Value, instead: float = 0.0) -> Value:
    """Put a number in place of each blank, as Excel does with an empty cell or an argument left out."""
    blank = value.kinds == BLANK
    numbers = np.where(blank, instead, value.numbers)
    return Value(numbers, np.where(blank, np.uint8(NUMBER), value.kinds).astype(np.uint8), value.texts)


def whole_numbers(value: Value) -> tuple[Floats, Codes]:
    """Return the numbers that arithmetic sees, without their fractions, and the errors."""
    numbers, errors = value.to_numbers()
    return np.trunc(numbers), errors


def require_same_in_all_trials(array: NDArray[Any]) -> NDArray[Any]:
    """Return one trial of an array (n, …) that decides on the shape of a result: all trials must agree.

    Raises:
        ShapeVaries: they do not.
    """
    first: NDArray[Any] = array[0]
    if array.shape[0] > 1 and not (array == first).all():
        raise ShapeVaries
    return first


def error_where(condition: Bools, code: int) -> Codes:
    """Return the error code where the condition holds, else 0."""
    return np.where(condition, np.uint8(code), np.uint8(0))


def first_error(*codes: Codes) -> Codes:
    """Return, element by element, the first code that is an error; the codes broadcast."""
    result = np.zeros(1, np.uint8)
    for values in codes:
        result = np.where(result > 0, result, values)
    return result


def first_error_in_row(codes: Codes) -> Codes:
    """Return the first error of each trial, 0 for none: (n, k) -> (n,)."""
    return np.asarray(np.take_along_axis(codes, (codes > 0).argmax(axis=1, keepdims=True), axis=1)[:, 0])


def errors_unless_range(cells: Value, like: Value | None = None) -> Codes:
    """Return the errors of an argument that is no range, though it should be; the cells of a range may hold errors.

    The errors broadcast with the argument `like`.
    """
    if cells.numbers.ndim == 3:
        return np.zeros(1, np.uint8)
    return cells.errors if like is None or like.numbers.ndim == 1 else cells.errors.reshape(-1, 1, 1)


def error_everywhere(like: Value, code: int, errors: Codes) -> Value:
    """Return the error `code` in the shape of `like`, except where `errors` has another one."""
    shape = np.broadcast_shapes(like.shape, errors.shape)
    kinds = np.where(errors > 0, errors, np.uint8(code)) + np.uint8(ERROR)
    return Value(np.zeros(shape), np.broadcast_to(kinds, shape))


def with_errors(value: Value, errors: Codes) -> Value:
    """Return the value with these errors put over it."""
    if not errors.any() and np.broadcast_shapes(errors.shape, value.shape) == value.shape:
        return value
    kinds = np.where(errors > 0, errors + np.uint8(ERROR), value.kinds).astype(np.uint8)
    return Value(np.where(errors > 0, 0.0, value.numbers), kinds, value.texts)
