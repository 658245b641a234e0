"""Values made comparable: within a kind, a comparison of values is one of floats.

A number is its own order, a logical 1 or 0, a text its rank among all texts that take part. Excel sorts texts, and
compares them in approximate lookups, so: case does not count; symbols come before digits, digits before letters; a
letter with an accent stands with its own; hyphens and apostrophes count only between texts that are otherwise equal.
Letters: n trials, k values of a trial.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.functions.lookup.picked_cells import Indices, flattened
from xlmc.functions.values import ERROR, TEXT, Codes, Floats, Objects, Value

__all__ = ["Ordered", "order_key", "ordered", "searched"]


@dataclass(frozen=True, slots=True)
class Ordered:
    """Values of any kind, side by side.

    Attributes:
        kinds: (n, k).
        order: (n, k); 0 for blanks and errors.
        texts: folded, each once, in rising order; a text's `order` is its index here.
    """

    kinds: Codes
    order: Floats
    texts: tuple[str, ...]

    def column(self, index: int, n: int) -> Ordered:
        """The values at one index, in n trials: (n, 1)."""
        kinds, order = self.kinds[:, index : index + 1], self.order[:, index : index + 1]
        return Ordered(np.broadcast_to(kinds, (n, 1)), np.broadcast_to(order, (n, 1)), self.texts)

    def flat(self) -> Ordered:
        """All values as trials of their own: (n·k, 1)."""
        return Ordered(self.kinds.reshape(-1, 1), self.order.reshape(-1, 1), self.texts)


def ordered(*values: Value) -> list[Ordered]:
    """Values that compare among each other, each flattened to (n, k)."""
    arrays = [value.texts for value in values if value.texts is not None]
    written = dict.fromkeys(text for array in arrays for text in array.ravel().tolist())
    texts = tuple(sorted({text.casefold() for text in written}, key=order_key))
    indices = {text: float(index) for index, text in enumerate(texts)}
    ranks = {text: indices[text.casefold()] for text in written}
    return [_ordered(value, ranks, texts) for value in values]


def searched(keys: Value, vector: Value, find: Callable[[Ordered, Ordered], Indices]) -> Indices:
    """Where each key stands in the vector of its trial.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        find: takes keys (m, 1) and values, either (m, k) or (1, k) for all keys; gives positions (m,).

    Returns:
        The shape of `keys`, with the trials of both.
    """
    wanted, found = ordered(keys, vector)
    n = max(keys.shape[0], vector.shape[0])
    if vector.shape[0] == 1:
        return find(wanted.flat(), found).reshape(keys.shape)
    columns = [find(wanted.column(j, n), found) for j in range(wanted.order.shape[1])]
    return np.stack(columns, axis=1).reshape(n, *keys.shape[1:])


def _ordered(value: Value, ranks: dict[str, float], texts: tuple[str, ...]) -> Ordered:
    order = np.where(value.kinds >= ERROR, 0.0, value.numbers)
    if value.texts is not None:
        order = np.where(value.kinds == TEXT, _looked_up(value.texts, ranks), order)
    return Ordered(flattened(value.kinds, value), flattened(order, value), texts)


def _looked_up(texts: Objects, ranks: dict[str, float]) -> Floats:
    return np.array([ranks[text] for text in texts.ravel().tolist()], np.float64).reshape(texts.shape)


_SYMBOLS: Final = '\t\n\r !"#$%&()*,./:;?@[\\]^_`{|}~+<=>'
_WEIGHTS: Final[dict[int, str | None]] = {
    **{ord(symbol): chr(index + 1) for index, symbol in enumerate(_SYMBOLS)},
    ord("-"): None,
    ord("'"): None,
}
"""All symbols weigh less than the digit 0."""


def order_key(text: str) -> tuple[str, str]:
    """What to sort a text by; two texts have one key where they differ in case at most."""
    folded = text.casefold()
    bare = folded if folded.isascii() else _without_accents(folded)
    return bare.translate(_WEIGHTS), folded


def _without_accents(text: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
