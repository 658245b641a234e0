"""How values are put in order: each becomes a float, and floats of one kind compare as the values do.

A number becomes itself, a logical 1 or 0, a text its rank among all texts that are compared. This is Excel's order of
texts when it sorts and in approximate lookups: case does not count; symbols come before digits, digits before letters;
accents, hyphens and apostrophes count only between texts that are otherwise equal.
Letters: n trials, k values of a trial.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.excel.functions.lookup.picked_cells import Indices, flatten_cells
from xlmc.excel.functions.values import ERROR, TEXT, Codes, Floats, Objects, Value

__all__ = ["Ordered", "order_key", "search_each_trial", "to_ordered"]


@dataclass(frozen=True, slots=True)
class Ordered:
    """Values of any kind, side by side, and the floats they compare by.

    Attributes:
        kinds: (n, k).
        order: (n, k); 0 for blanks and errors.
        texts: in lower case, each once, in rising order; a text's `order` is its index here.
    """

    kinds: Codes
    order: Floats
    texts: tuple[str, ...]

    def column(self, index: int, n: int) -> Ordered:
        """Return the values at one index, in n trials: (n, 1)."""
        kinds, order = self.kinds[:, index : index + 1], self.order[:, index : index + 1]
        return Ordered(np.broadcast_to(kinds, (n, 1)), np.broadcast_to(order, (n, 1)), self.texts)

    def flat(self) -> Ordered:
        """Return each value as a trial of its own: (n·k, 1)."""
        return Ordered(self.kinds.reshape(-1, 1), self.order.reshape(-1, 1), self.texts)


def to_ordered(*values: Value) -> list[Ordered]:
    """Flatten values to (n, k) each and give them floats by which all of them compare."""
    arrays = [value.texts for value in values if value.texts is not None]
    written = dict.fromkeys(text for array in arrays for text in array.ravel().tolist())
    texts = tuple(sorted({text.casefold() for text in written}, key=order_key))
    indices = {text: float(index) for index, text in enumerate(texts)}
    ranks = {text: indices[text.casefold()] for text in written}
    return [_to_ordered(value, ranks, texts) for value in values]


def search_each_trial(keys: Value, vector: Value, find: Callable[[Ordered, Ordered], Indices]) -> Indices:
    """Find each key in the vector of its trial.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        find: takes keys (m, 1) and values, either (m, k) or (1, k) for all keys; gives positions (m,).

    Returns:
        The shape of `keys`, with the trials of both.
    """
    wanted, found = to_ordered(keys, vector)
    n = max(keys.shape[0], vector.shape[0])
    if vector.shape[0] == 1:
        return find(wanted.flat(), found).reshape(keys.shape)
    columns = [find(wanted.column(j, n), found) for j in range(wanted.order.shape[1])]
    return np.stack(columns, axis=1).reshape(n, *keys.shape[1:])


def _to_ordered(value: Value, ranks: dict[str, float], texts: tuple[str, ...]) -> Ordered:
    order = np.where(value.kinds >= ERROR, 0.0, value.numbers)
    if value.texts is not None:
        order = np.where(value.kinds == TEXT, _look_up_ranks(value.texts, ranks), order)
    return Ordered(flatten_cells(value.kinds, value), flatten_cells(order, value), texts)


def _look_up_ranks(texts: Objects, ranks: dict[str, float]) -> Floats:
    return np.array([ranks[text] for text in texts.ravel().tolist()], np.float64).reshape(texts.shape)


_SYMBOLS: Final = '\t\n\r !"#$%&()*,./:;?@[\\]^_`{|}~+<=>'
_WEIGHTS: Final[dict[int, str | None]] = {
    **{ord(symbol): chr(index + 1) for index, symbol in enumerate(_SYMBOLS)},
    ord("-"): None,
    ord("'"): None,
}
"""Every symbol has a code below that of the digit 0; hyphen and apostrophe have none."""


def order_key(text: str) -> tuple[str, str]:
    """Return the key to sort a text by; two texts have the same key only if they differ in case alone."""
    folded = text.casefold()
    bare = folded if folded.isascii() else _without_accents(folded)
    return bare.translate(_WEIGHTS), folded


def _without_accents(text: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
