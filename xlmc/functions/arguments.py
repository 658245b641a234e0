"""What a body that gets `Value`s asks of its arguments: numbers, defaults, and their errors in Excel's order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.values import BLANK, ERROR, NUMBER, Bools, Codes, Floats, ShapeVaries, Value

__all__ = [
    "direct_errors",
    "earliest",
    "first_errors",
    "if_blank",
    "leveled",
    "refused",
    "same_in_all_trials",
    "where_wrong",
    "whole_numbers",
    "with_errors",
]


def leveled(*values: Value) -> list[Value]:
    """All as ranges where one of them is one, so that they broadcast."""
    many = any(value.numbers.ndim == 3 for value in values)
    return [value.as_range() if many else value for value in values]


def if_blank(value: Value, instead: float = 0.0) -> Value:
    """A number where there is nothing: what Excel takes an empty cell for, or an argument left out."""
    blank = value.kinds == BLANK
    numbers = np.where(blank, instead, value.numbers)
    return Value(numbers, np.where(blank, np.uint8(NUMBER), value.kinds).astype(np.uint8), value.texts)


def whole_numbers(value: Value) -> tuple[Floats, Codes]:
    """As arithmetic sees it, the fraction dropped; and errors."""
    numbers, errors = value.to_numbers()
    return np.trunc(numbers), errors


def same_in_all_trials(array: NDArray[Any]) -> NDArray[Any]:
    """What decides on the shape of a result, (n, …), as it is in any trial.

    Raises:
        ShapeVaries: it differs between trials.
    """
    first: NDArray[Any] = array[0]
    if array.shape[0] > 1 and not (array == first).all():
        raise ShapeVaries
    return first


def where_wrong(condition: Bools, code: int) -> Codes:
    """That error where the condition holds."""
    return np.where(condition, np.uint8(code), np.uint8(0))


def earliest(*codes: Codes) -> Codes:
    """The first that is an error; they broadcast."""
    result = np.zeros(1, np.uint8)
    for found in codes:
        result = np.where(result > 0, result, found)
    return result


def first_errors(codes: Codes) -> Codes:
    """The first error of each trial, 0 for none: (n, k) -> (n,)."""
    return np.asarray(np.take_along_axis(codes, (codes > 0).argmax(axis=1, keepdims=True), axis=1)[:, 0])


def direct_errors(cells: Value, like: Value | None = None) -> Codes:
    """The errors of an argument that should be a range and is a single value; cells of ranges may hold errors.

    They broadcast with the argument `like`.
    """
    if cells.numbers.ndim == 3:
        return np.zeros(1, np.uint8)
    return cells.errors if like is None or like.numbers.ndim == 1 else cells.errors.reshape(-1, 1, 1)


def refused(like: Value, code: int, errors: Codes) -> Value:
    """One error instead of every result, in the shape of `like`; but these errors where there are any."""
    shape = np.broadcast_shapes(like.shape, errors.shape)
    kinds = np.where(errors > 0, errors, np.uint8(code)) + np.uint8(ERROR)
    return Value(np.zeros(shape), np.broadcast_to(kinds, shape))


def with_errors(value: Value, errors: Codes) -> Value:
    """The value, but these errors where there are any."""
    if not errors.any() and np.broadcast_shapes(errors.shape, value.shape) == value.shape:
        return value
    kinds = np.where(errors > 0, errors + np.uint8(ERROR), value.kinds).astype(np.uint8)
    return Value(np.where(errors > 0, 0.0, value.numbers), kinds, value.texts)
