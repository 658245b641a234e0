"""Many trials on wide ranges, a portion of the trials at a time, so that memory stays bounded."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.lookup.picking import each_part, joined
from xlmc.functions.values import ShapeVaries, Value

__all__ = ["by_portions", "width_of"]

_MOST: Final = 2**21
"""Cells of all trials together that a body spreads out at once."""


def width_of(*values: Value) -> int:
    """How many cells a trial has, in those values that differ between trials."""
    return max((int(np.prod(value.shape[1:])) for value in values if value.shape[0] > 1), default=0)


def by_portions(compute: Callable[..., Value], values: Sequence[Value], width: int) -> Value:
    """`compute(*values)`, where each trial takes memory for `width` cells.

    Raises:
        ShapeVaries: the portions' results differ in shape.
    """
    n = max(value.shape[0] for value in values)
    size = max(1, _MOST // max(1, width))
    if n <= size:
        return compute(*values)
    parts = [slice(start, min(start + size, n)) for start in range(0, n, size)]
    results = [_tall(compute(*(_trials(v, part) for v in values)), part.stop - part.start) for part in parts]
    if len({result.shape[1:] for result in results}) > 1:
        raise ShapeVaries
    return joined(results, axis=0)


def _trials(value: Value, part: slice) -> Value:
    """Some of the trials; a constant stays as it is."""
    texts = None if value.texts is None else _some(value.texts, part)
    return Value(_some(value.numbers, part), _some(value.kinds, part), texts)


def _some(array: NDArray[Any], part: slice) -> NDArray[Any]:
    return array if array.shape[0] == 1 else array[part]


def _tall(value: Value, n: int) -> Value:
    return each_part(value, lambda part: np.broadcast_to(part, (n, *part.shape[1:])))
