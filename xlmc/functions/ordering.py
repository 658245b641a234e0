"""Values made comparable: within a kind, a comparison of values is one of floats.

A number is its own order, a logical 1 or 0, a text its place among all texts that take part, in Excel's order and
whatever its case. Letters: n trials, k values of a trial.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.collation import order_key
from xlmc.functions.values import ERROR, TEXT, Codes, Floats, Objects, Value

__all__ = ["Ordered", "ordered"]


@dataclass(frozen=True, slots=True)
class Ordered:
    """Values of any kind, side by side.

    Attributes:
        kinds: (n, k).
        order: (n, k); 0 for blanks and errors.
        texts: folded, each once, in rising order; a text's `order` is its place here.
    """

    kinds: Codes
    order: Floats
    texts: tuple[str, ...]

    def column(self, place: int) -> Ordered:
        """The values at one place: (n, 1)."""
        return Ordered(self.kinds[:, place : place + 1], self.order[:, place : place + 1], self.texts)


def ordered(*values: Value) -> list[Ordered]:
    """Values that compare among each other, each flattened to (n, k)."""
    arrays = [value.texts for value in values if value.texts is not None]
    written = dict.fromkeys(text for array in arrays for text in array.ravel().tolist())
    texts = tuple(sorted({text.casefold() for text in written}, key=order_key))
    places = {text: float(place) for place, text in enumerate(texts)}
    ranks = {text: places[text.casefold()] for text in written}
    return [_ordered(value, ranks, texts) for value in values]


def _ordered(value: Value, ranks: dict[str, float], texts: tuple[str, ...]) -> Ordered:
    order = np.where(value.kinds >= ERROR, 0.0, value.numbers)
    if value.texts is not None:
        order = np.where(value.kinds == TEXT, _looked_up(value.texts, ranks), order)
    return Ordered(_two_axes(value.kinds, value), _two_axes(order, value), texts)


def _looked_up(texts: Objects, ranks: dict[str, float]) -> Floats:
    return np.array([ranks[text] for text in texts.ravel().tolist()], np.float64).reshape(texts.shape)


def _two_axes(array: NDArray[Any], value: Value) -> NDArray[Any]:
    return np.broadcast_to(array, value.shape).reshape(value.shape[0], -1)
