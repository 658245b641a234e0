"""Bodies that call a Python function for each element: for functions without a vectorised form, mostly of texts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import align_ranges
from xlmc.excel.functions.budget import ask_for_texts, count_characters
from xlmc.excel.functions.number_text import general_text
from xlmc.excel.functions.values import Value, from_objects

__all__ = ["object_text", "per_element", "per_object"]


def per_element(function: Callable[..., object]) -> Callable[..., Value]:
    """Make a body for element arguments from a function of plain Python values.

    The function takes floats, bools and strings, and defaults as they are. It returns one of these, an `ErrorCode`, or
    None for a blank.
    """

    def body(*arrays: Any) -> Value:
        shape = np.broadcast_shapes(*(np.shape(array) for array in arrays), (1,))
        spread = [np.broadcast_to(np.asarray(array, None if _is_array(array) else object), shape) for array in arrays]
        out = np.empty(shape, object)
        ask_for_texts(out.size)
        columns = [array.ravel().tolist() for array in spread]
        items = zip(*columns, strict=True) if columns else [()] * out.size
        out.reshape(-1)[:] = list(count_characters(function(*parts) for parts in items))
        return from_objects(out)

    body.__doc__, body.__name__, body.__module__ = function.__doc__, function.__name__, function.__module__
    return body


def _is_array(array: object) -> bool:
    return isinstance(array, np.ndarray)


def per_object(function: Callable[..., object]) -> Callable[..., Value]:
    """Make a body for `Anything` arguments from a function of floats, bools, strings and None (a blank).

    If arguments are errors, the first of them is the result. The function returns one of the types it takes, or an
    `ErrorCode`.
    """

    def body(*values: Value, **options: object) -> Value:
        columns = [value.objects() for value in align_ranges(*values)]
        shape = np.broadcast_shapes(*(column.shape for column in columns))
        spread = [np.broadcast_to(column, shape) for column in columns]
        out = np.empty(shape, object)
        ask_for_texts(out.size)
        rows = zip(*(column.ravel().tolist() for column in spread), strict=True)
        out.reshape(-1)[:] = list(count_characters(_call(function, items, options) for items in rows))
        return from_objects(out)

    body.__doc__, body.__name__, body.__module__ = function.__doc__, function.__name__, function.__module__
    return body


def _call(function: Callable[..., object], items: tuple[object, ...], options: Mapping[str, object]) -> object:
    """Call the function, unless an argument is an error: the first one is the result then."""
    error = next((item for item in items if isinstance(item, ErrorCode)), None)
    return function(*items, **options) if error is None else error


def object_text(item: object) -> str:
    """Write a value as `&` does, and an error by its name."""
    match item:
        case None:
            return ""
        case ErrorCode():
            return item.text
        case bool():
            return "TRUE" if item else "FALSE"
        case float():
            return general_text(item)
        case _:
            return str(item)
