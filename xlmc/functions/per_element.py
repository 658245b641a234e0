"""Functions that have no vectorised form, texts above all: a body that calls Python once an element."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

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
        for place in np.ndindex(*shape):
            out[place] = function(*(_plain(array[place]) for array in spread))
        return from_objects(out)

    body.__doc__, body.__name__, body.__module__ = function.__doc__, function.__name__, function.__module__
    return body


def _is_array(array: object) -> bool:
    return isinstance(array, np.ndarray)


def _plain(item: Any) -> Any:
    return item.item() if isinstance(item, np.generic) else item
