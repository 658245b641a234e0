"""Functions that have no vectorised form, texts above all: a body that calls Python once an element."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from xlmc.functions.budget import ask_for_texts, counted
from xlmc.functions.values import Value, from_objects

__all__ = ["per_element"]


def per_element(function: Callable[..., object]) -> Callable[..., Value]:
    """A body for element arguments from a function of plain Python values.

    The function takes floats, bools and strings (defaults as they are). It returns one of these, an `ErrorCode`, or
    None for a blank.
    """

    def body(*arrays: Any) -> Value:
        shape = np.broadcast_shapes(*(np.shape(array) for array in arrays), (1,))
        spread = [np.broadcast_to(np.asarray(array, None if _is_array(array) else object), shape) for array in arrays]
        out = np.empty(shape, object)
        ask_for_texts(out.size)
        columns = [array.ravel().tolist() for array in spread]
        items = zip(*columns, strict=True) if columns else [()] * out.size
        out.reshape(-1)[:] = list(counted(function(*parts) for parts in items))
        return from_objects(out)

    body.__doc__, body.__name__, body.__module__ = function.__doc__, function.__name__, function.__module__
    return body


def _is_array(array: object) -> bool:
    return isinstance(array, np.ndarray)
