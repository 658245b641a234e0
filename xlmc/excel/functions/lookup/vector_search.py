"""Three ways to find the positions of keys in vectors. Letters: m keys, k values.

`nearest` finds the equal value, or else the next smaller or larger one, anywhere in the vector. A key finds only values
of its own kind, and texts in upper or lower case.

`before_first_smaller` goes down a vector in falling order from its first value, as `MATCH` does with -1, and stops at
the first equal or smaller one: what follows does not count (measured in Excel by the authors of ClosedXML).

`last_not_beyond` halves the vector again and again, as `MATCH`, `LOOKUP`, `VLOOKUP` and `HLOOKUP` do, which expect the
values to be in order. If they are not, it still finds what Excel finds, because sheets rely on it:
`LOOKUP(2, 1/(A1:A9=x), B1:B9)` is the last row of x. It steps over cells of another kind than the key's, and takes the
last of equal neighbours. Apache POI describes this behaviour of Excel (`LookupUtils`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.excel.functions.criteria import is_pattern, pattern_of
from xlmc.excel.functions.lookup.picked_cells import Indices
from xlmc.excel.functions.ordering import Ordered, search_each_trial
from xlmc.excel.functions.values import ERROR, LOGICAL, NUMBER, TEXT, Bools, Floats, Value

__all__ = ["EXACT", "LARGER", "SMALLER", "before_first_smaller", "last_not_beyond", "nearest"]

SMALLER: Final = -1
EXACT: Final = 0
LARGER: Final = 1


def nearest(keys: Value, vector: Value, side: int = EXACT, *, last: bool = False, wildcards: bool = False) -> Indices:
    """Find each key in the vector: its index, counted from 0, or -1.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        side: what a key without an equal value finds: the next value that is `SMALLER` or `LARGER`; none if `EXACT`.
        last: find the last of equal values instead of the first.
        wildcards: a key with wildcards finds the texts that match it.

    Returns:
        The shape of `keys`, with the trials of both arguments.
    """

    def find(keys: Ordered, vector: Ordered) -> Indices:
        result = (
            _find_in_one(keys, vector, side, last)
            if len(vector.order) == 1
            else _find_in_many(keys, vector, side, last)
        )
        return _find_patterns(result, keys, vector, last) if wildcards else result

    return search_each_trial(keys, vector, find)


def _find_in_one(keys: Ordered, vector: Ordered, side: int, last: bool) -> Indices:
    """Find (m, 1) keys in (1, k) values -> (m,): sort the values and bisect."""
    result = np.full(keys.order.shape[0], -1)
    for kind, (indices, rising) in vector.rising.items():
        mine = keys.kinds[:, 0] == kind
        result[mine] = _bisect(rising, indices, keys.order[mine, 0], side, last)
    return result


def _bisect(rising: Floats, indices: Indices, keys: Floats, side: int, last: bool) -> Indices:
    """Return the indices of the values that the keys find among `rising` ones."""
    at = np.searchsorted(rising, keys, "right") - 1 if side == SMALLER else np.searchsorted(rising, keys, "left")
    inside = (at >= 0) & (at < rising.size)
    value = rising[np.where(inside, at, 0)]
    if side == EXACT:
        inside &= value == keys
    chosen = np.searchsorted(rising, value, "right") - 1 if last else np.searchsorted(rising, value, "left")
    return np.where(inside, indices[chosen], -1)


def _find_in_many(keys: Ordered, vector: Ordered, side: int, last: bool) -> Indices:
    """Find (m, 1) keys, each in its own row of (m, k) values -> (m,)."""
    same_kind = (vector.kinds == keys.kinds) & (vector.kinds < ERROR)
    if side == EXACT:
        return _hit_of_each_row(same_kind & (vector.order == keys.order), last)
    allowed = same_kind & (vector.order <= keys.order if side == SMALLER else vector.order >= keys.order)
    worst = -np.inf if side == SMALLER else np.inf
    within = np.where(allowed, vector.order, worst)
    best = within.max(axis=1, keepdims=True) if side == SMALLER else within.min(axis=1, keepdims=True)
    return _hit_of_each_row(allowed & (vector.order == best), last)


def _hit_of_each_row(hits: Bools, last: bool) -> Indices:
    """Return the index of the first or the last hit of each row; otherwise -1."""
    index = hits.shape[1] - 1 - hits[:, ::-1].argmax(axis=1) if last else hits.argmax(axis=1)
    return np.where(hits.any(axis=1), index, -1)


def _find_patterns(result: Indices, keys: Ordered, vector: Ordered, last: bool) -> Indices:
    """Replace the result of each key with wildcards by what its pattern finds: (m,)."""
    is_text, order = keys.kinds[:, 0] == TEXT, keys.order[:, 0]
    for rank in np.unique(order[is_text]).tolist():
        if is_pattern(text := keys.text(rank)):
            values = _hit_of_each_row(_match_pattern(vector, text), last)
            result = np.where(is_text & (order == rank), values, result)
    return result


def _match_pattern(vector: Ordered, pattern: str) -> Bools:
    is_text = vector.kinds == TEXT
    fits = pattern_of(pattern).fits
    fitting = [rank for rank in np.unique(vector.order[is_text]).tolist() if fits(vector.texts[int(rank)])]
    return np.asarray(is_text & np.isin(vector.order, fitting))


def before_first_smaller(keys: Value, vector: Value) -> Indices:
    """Find each key in a vector in falling order: its first equal value, else the one before the first smaller value.

    Values of another kind than the key's are passed over. Where the first of its kind is smaller, there is none.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).

    Returns:
        The shape of `keys`, with the trials of both, counted from 0; otherwise -1.
    """
    return _search_each_kind(keys, vector, _go_down)


def _search_each_kind(keys: Value, vector: Value, search: Callable[[Floats, Bools, Floats], Indices]) -> Indices:
    """Find numbers among numbers, texts among texts, logicals among logicals: -1 where there is none.

    `search` finds keys (m,), given which values they can be compared with, and the values, (m, k) or (1, k).
    """

    def find(keys: Ordered, vector: Ordered) -> Indices:
        result = np.full(len(keys.order), -1)
        for kind in (NUMBER, TEXT, LOGICAL):
            mine = np.flatnonzero(keys.kinds[:, 0] == kind)
            rows = mine if len(vector.order) > 1 else np.zeros(1, np.intp)
            if mine.size:
                result[mine] = search(keys.order[mine, 0], vector.kinds[rows] == kind, vector.order[rows])
        return result

    return search_each_trial(keys, vector, find)


def _go_down(keys: Floats, comparable: Bools, order: Floats) -> Indices:
    """Find keys (m,) in values (m, k), or (1, k) for all keys: the last one that is reached and not smaller."""
    least = np.minimum.accumulate(np.where(comparable, order, np.inf), axis=1)
    k = order.shape[1]
    stop = np.searchsorted(-least[0], -keys) if len(least) == 1 else (least > keys[:, None]).sum(axis=1)
    before = np.maximum.accumulate(np.where(comparable, np.arange(k), -1), axis=1)
    rows = np.arange(len(keys)) if len(least) > 1 else np.zeros(1, np.intp)
    equal = (stop < k) & (least[rows, np.minimum(stop, k - 1)] == keys)
    return np.where(equal, stop, np.where(stop > 0, before[rows, np.maximum(stop - 1, 0)], -1))


def last_not_beyond(keys: Value, vector: Value, *, falling: bool = False) -> Indices:
    """Find each key, or the last value before it, in a vector in order: its index, or -1.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        falling: the vector is in falling order.

    Returns:
        The shape of `keys`, with the trials of both, counted from 0.
    """
    sign = -1.0 if falling else 1.0
    return _search_each_kind(
        keys, vector, lambda keys, comparable, order: _halve(sign * keys, comparable, sign * order)
    )


def _halve(keys: Floats, comparable: Bools, order: Floats) -> Indices:
    """Find keys (m,) in values (m, k), or (1, k) for all keys, by halving."""
    if len(order) == 1 and comparable.all() and (order[0, :-1] <= order[0, 1:]).all():
        return np.searchsorted(order[0], keys, side="right") - 1  # halving gives the same if all values are in order
    return _Values.of(comparable, order).halve(keys)


@dataclass(frozen=True, slots=True)
class _Values:
    """Values that should be in rising order: (m, k), or (1, k) for all keys.

    Attributes:
        order: the floats to compare with the keys.
        ahead: for each index, the first one from there on with a value of the keys' kind; k where there is none.
        run_end: for each index, the last one of the equal neighbours that begin there.
    """

    order: Floats
    ahead: Indices
    run_end: Indices

    @classmethod
    def of(cls, comparable: Bools, order: Floats) -> _Values:
        both = comparable[:, :-1] & comparable[:, 1:]
        goes_on = np.zeros(order.shape, bool)
        goes_on[:, :-1] = both & (order[:, :-1] == order[:, 1:])
        return cls(order, _next_index(comparable), _next_index(~goes_on))

    def halve(self, keys: Floats) -> Indices:
        """Find the index of each key, (m,). `low` is not beyond the key, `high` is; between them all is open."""
        k = self.order.shape[1]
        rows = np.arange(len(keys)) if len(self.order) > 1 else np.zeros(1, np.intp)
        low, high = np.full(keys.shape, -1), np.full(keys.shape, k)
        while (open_ := high - low > 1).any():
            middle = np.where(open_, (low + high) // 2, 0)
            index = self.ahead[rows, middle]
            inside = open_ & (index < high)
            value = self.order[rows, np.where(inside, index, 0)]
            equal, below = inside & (value == keys), inside & (value < keys)
            above = open_ & ~equal & ~below
            stepped = np.where(inside & (index < high - 1), index, middle)
            run_end = np.minimum(self.run_end[rows, np.where(inside, index, 0)], high - 1)
            low = np.where(equal, run_end, np.where(below, index, low))
            high = np.where(equal, low + 1, np.where(above, stepped, high))
        return low


def _next_index(wanted: Bools) -> Indices:
    """Return, for every index of each row, the first wanted one from there on; the row's length where there is none."""
    k = wanted.shape[1]
    indices = np.where(wanted, np.arange(k), k)
    return np.asarray(np.minimum.accumulate(indices[:, ::-1], axis=1)[:, ::-1])
