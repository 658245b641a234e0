"""How values are put in order: each becomes a float, and floats of one kind compare as the values do.

A number becomes itself, a logical 1 or 0, a text its rank among all texts that are compared. This is Excel's order of
texts when it sorts and in approximate lookups: case does not count; symbols come before digits, digits before letters;
accents, hyphens and apostrophes count only between texts that are otherwise equal.

Thousands of lookups may search one table, each for one key. So the texts of a table that does not vary are put in order
once, and texts of keys that it does not have get places between theirs, so that nothing of the table changes.

Letters: n trials, k values of a trial.
"""

from __future__ import annotations

import unicodedata
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from xlmc.excel.functions.lookup.picked_cells import Indices, flatten_cells
from xlmc.excel.functions.values import ERROR, TEXT, Codes, Floats, Objects, Value, kept_with_table

__all__ = ["Ordered", "order_key", "search_each_trial", "to_ordered"]


@dataclass(frozen=True, eq=False)
class Ordered:
    """Values of any kind, side by side, and the floats they compare by.

    Attributes:
        kinds: (n, k).
        order: (n, k); 0 for blanks and errors.
        texts: in lower case, each once, in rising order; a text's `order` is its index here.
        between: order -> text, of texts that stand between these.
    """

    kinds: Codes
    order: Floats
    texts: tuple[str, ...]
    between: Mapping[float, str] = field(default_factory=dict)

    def text(self, order: float) -> str:
        """Return the text of an order, in lower case."""
        result = self.between.get(order)
        return self.texts[int(order)] if result is None else result

    @cached_property
    def rising(self) -> dict[int, tuple[Indices, Floats]]:
        """Kind -> the indices of its values in (1, k), and the values, in rising order; errors are left out."""
        kinds, order = self.kinds[0], self.order[0]
        result = {}
        for kind in np.unique(kinds[kinds < ERROR]).tolist():
            indices = np.flatnonzero(kinds == kind)
            indices = indices[np.argsort(order[indices], kind="stable")]
            result[kind] = indices, order[indices]
        return result

    def column(self, index: int, n: int) -> Ordered:
        """Return the values at one index, in n trials: (n, 1)."""
        kinds, order = self.kinds[:, index : index + 1], self.order[:, index : index + 1]
        return Ordered(np.broadcast_to(kinds, (n, 1)), np.broadcast_to(order, (n, 1)), self.texts, self.between)

    def flat(self) -> Ordered:
        """Return each value as a trial of its own: (n·k, 1)."""
        return Ordered(self.kinds.reshape(-1, 1), self.order.reshape(-1, 1), self.texts, self.between)


class _Texts(NamedTuple):
    """Texts in lower case, each once, in rising order; what they are sorted by; and the rank of each."""

    in_order: tuple[str, ...]
    keys: tuple[tuple[str, str], ...]
    ranks: dict[str, float]

    @classmethod
    def of(cls, written: Iterable[str]) -> _Texts:
        """Put texts in order."""
        pairs = sorted((order_key(text), text) for text in {text.casefold() for text in written})
        texts = tuple(text for _, text in pairs)
        return cls(texts, tuple(key for key, _ in pairs), {text: float(rank) for rank, text in enumerate(texts)})


def to_ordered(*values: Value) -> list[Ordered]:
    """Flatten values to (n, k) each and give them floats by which all of them compare.

    Of the largest of those that do not vary the texts are put in order once for all calls. Where that is the last one,
    the table, the others may have texts `between` its own.
    """
    still = max(filter(_is_kept, values), key=lambda value: value.numbers.size, default=None)
    if still is None:
        texts = _Texts.of(text for value in values for text in _written(value))
        return [_to_ordered(value, texts.ranks, texts.in_order) for value in values]
    kept, alone = _in_order(still)
    others = {text.casefold() for value in values if value is not still for text in _written(value)}
    new = sorted((order_key(text), text) for text in others if text not in kept.ranks)
    if not new:
        return [alone if value is still else _to_ordered(value, kept.ranks, kept.in_order) for value in values]
    before = [bisect_left(kept.keys, key) for key, _ in new]
    if still is values[-1]:
        places = _places_between(before)
        at = dict(zip((text for _, text in new), places, strict=True))
        ranks = at | {text: kept.ranks[text] for text in others - at.keys()}
        between = {place: text for text, place in at.items()}
        return [alone if value is still else _to_ordered(value, ranks, kept.in_order, between) for value in values]
    merged = np.insert(np.array(kept.in_order, object), before, np.array([text for _, text in new], object))
    ranks = {text: float(place + index) for index, (place, (_, text)) in enumerate(zip(before, new, strict=True))}
    ranks |= {text: kept.ranks[text] + bisect_right(before, kept.ranks[text]) for text in others - ranks.keys()}
    moved = alone.order + np.searchsorted(before, alone.order, side="right")
    own = Ordered(alone.kinds, np.where(alone.kinds == TEXT, moved, alone.order), tuple(merged.tolist()))
    return [own if value is still else _to_ordered(value, ranks, own.texts) for value in values]


def _places_between(before: Sequence[int]) -> list[float]:
    """Return different floats, in rising order, for texts that stand before the ones of these indices.

    >>> _places_between([0, 2, 2])
    [-0.5, 1.3333333333333333, 1.6666666666666665]
    """
    share = Counter(before)
    first = {place: index for index, place in reversed([*enumerate(before)])}
    return [place - 1.0 + (index - first[place] + 1.0) / (share[place] + 1.0) for index, place in enumerate(before)]


_LEAST_KEPT: Final = 16
"""Cells; fewer are put in order anew as fast."""


def _is_kept(value: Value) -> bool:
    return value.numbers.ndim == 3 and value.shape[0] == 1 and value.numbers.size >= _LEAST_KEPT


@kept_with_table
def _in_order(value: Value) -> tuple[_Texts, Ordered]:
    """Return the texts of a value in order, and the value."""
    texts = _Texts.of(_written(value))
    return texts, _to_ordered(value, texts.ranks, texts.in_order)


def _written(value: Value) -> Iterable[str]:
    return () if value.texts is None else value.texts.ravel().tolist()


def search_each_trial(keys: Value, vector: Value, find: Callable[[Ordered, Ordered], Indices]) -> Indices:
    """Find each key in the vector of its trial.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        find: takes keys (m, 1) and values, either (m, k) or (1, k) for all keys; gives positions (m,).

    Returns:
        The shape of `keys`, with the trials of both.
    """
    wanted, order = to_ordered(keys, vector)
    n = max(keys.shape[0], vector.shape[0])
    if vector.shape[0] == 1:
        return find(wanted.flat(), order).reshape(keys.shape)
    columns = [find(wanted.column(j, n), order) for j in range(wanted.order.shape[1])]
    return np.stack(columns, axis=1).reshape(n, *keys.shape[1:])


def _to_ordered(
    value: Value, ranks: Mapping[str, float], texts: tuple[str, ...], between: Mapping[float, str] | None = None
) -> Ordered:
    order = np.where(value.kinds >= ERROR, 0.0, value.numbers)
    if value.texts is not None:
        order = np.where(value.kinds == TEXT, _look_up_ranks(value.texts, ranks), order)
    return Ordered(flatten_cells(value.kinds, value), flatten_cells(order, value), texts, between or {})


def _look_up_ranks(texts: Objects, ranks: Mapping[str, float]) -> Floats:
    return np.array([ranks[text.casefold()] for text in texts.ravel().tolist()], np.float64).reshape(texts.shape)


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
