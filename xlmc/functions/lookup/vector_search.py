"""Positions of keys in vectors, found in two ways. Letters: m keys, k values.

`nearest` finds the equal value, or else the next smaller or larger one, wherever it stands. A key finds values of its
own kind only, texts whatever their case.

`last_not_beyond` halves the vector again and again, as `MATCH`, `LOOKUP`, `VLOOKUP` and `HLOOKUP` do, which trust the
values to be in order. What it finds among values that are in no order is Excel's too, for sheets rely on it:
`LOOKUP(2, 1/(A1:A9=x), B1:B9)` is the last row of x. Cells of another kind than the key's are stepped over, and among
equal neighbours the last is taken. After Apache POI's account of Excel's behaviour (`LookupUtils`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.functions.criteria import is_pattern, pattern_of
from xlmc.functions.lookup.picked_cells import Indices
from xlmc.functions.ordering import Ordered, search_each_trial
from xlmc.functions.values import ERROR, LOGICAL, NUMBER, TEXT, Bools, Floats, Value

__all__ = ["EXACT", "LARGER", "SMALLER", "last_not_beyond", "nearest"]

SMALLER: Final = -1
EXACT: Final = 0
LARGER: Final = 1


def nearest(keys: Value, vector: Value, side: int = EXACT, *, last: bool = False, wildcards: bool = False) -> Indices:
    """Where each key stands in the vector, counted from 0; -1 where nothing is found.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        side: where nothing is equal, the largest value that is `SMALLER` or the smallest that is `LARGER`; or `EXACT`.
        last: the last of equal values rather than the first.
        wildcards: a text with wildcards finds the texts that fit.

    Returns:
        The shape of `keys`, with the trials of both.
    """

    def find(keys: Ordered, vector: Ordered) -> Indices:
        result = _in_one(keys, vector, side, last) if len(vector.order) == 1 else _in_many(keys, vector, side, last)
        return _patterns_over(result, keys, vector, last) if wildcards else result

    return search_each_trial(keys, vector, find)


def _in_one(keys: Ordered, vector: Ordered, side: int, last: bool) -> Indices:
    """(m, 1) keys in (1, k) values -> (m,): by bisection of the values in order."""
    result = np.full(keys.order.shape[0], -1)
    kinds, order = vector.kinds[0], vector.order[0]
    for kind in np.unique(kinds[kinds < ERROR]):
        indices = np.flatnonzero(kinds == kind)
        indices = indices[np.argsort(order[indices], kind="stable")]
        mine = keys.kinds[:, 0] == kind
        result[mine] = _bisected(order[indices], indices, keys.order[mine, 0], side, last)
    return result


def _bisected(rising: Floats, indices: Indices, keys: Floats, side: int, last: bool) -> Indices:
    """The indices of the values that the keys find among `rising` ones."""
    at = np.searchsorted(rising, keys, "right") - 1 if side == SMALLER else np.searchsorted(rising, keys, "left")
    inside = (at >= 0) & (at < rising.size)
    value = rising[np.where(inside, at, 0)]
    if side == EXACT:
        inside &= value == keys
    chosen = np.searchsorted(rising, value, "right") - 1 if last else np.searchsorted(rising, value, "left")
    return np.where(inside, indices[chosen], -1)


def _in_many(keys: Ordered, vector: Ordered, side: int, last: bool) -> Indices:
    """(m, 1) keys, each in its own row of (m, k) values -> (m,)."""
    same_kind = (vector.kinds == keys.kinds) & (vector.kinds < ERROR)
    if side == EXACT:
        return _index_of(same_kind & (vector.order == keys.order), last)
    allowed = same_kind & (vector.order <= keys.order if side == SMALLER else vector.order >= keys.order)
    worst = -np.inf if side == SMALLER else np.inf
    within = np.where(allowed, vector.order, worst)
    best = within.max(axis=1, keepdims=True) if side == SMALLER else within.min(axis=1, keepdims=True)
    return _index_of(allowed & (vector.order == best), last)


def _index_of(hits: Bools, last: bool) -> Indices:
    """The first hit of each row, or the last; -1 where there is none."""
    index = hits.shape[1] - 1 - hits[:, ::-1].argmax(axis=1) if last else hits.argmax(axis=1)
    return np.where(hits.any(axis=1), index, -1)


def _patterns_over(result: Indices, keys: Ordered, vector: Ordered, last: bool) -> Indices:
    """What keys with wildcards find, over what they found as plain texts: (m,)."""
    is_text, order = keys.kinds[:, 0] == TEXT, keys.order[:, 0]
    for rank in np.unique(order[is_text]).astype(np.intp):
        if is_pattern(keys.texts[rank]):
            found = _index_of(_fitting(vector, keys.texts[rank]), last)
            result = np.where(is_text & (order == rank), found, result)
    return result


def _fitting(vector: Ordered, pattern: str) -> Bools:
    is_text = vector.kinds == TEXT
    fits = pattern_of(pattern).fits
    fitting = [rank for rank in np.unique(vector.order[is_text]).tolist() if fits(vector.texts[int(rank)])]
    return np.asarray(is_text & np.isin(vector.order, fitting))


def last_not_beyond(keys: Value, vector: Value, *, falling: bool = False) -> Indices:
    """Where each key, or else what comes before it, stands in a vector in order; -1 for nowhere.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        falling: the vector is in falling order.

    Returns:
        The shape of `keys`, with the trials of both, counted from 0.
    """
    sign = -1.0 if falling else 1.0

    def find(keys: Ordered, vector: Ordered) -> Indices:
        result = np.full(len(keys.order), -1)
        for kind in (NUMBER, TEXT, LOGICAL):
            mine = np.flatnonzero(keys.kinds[:, 0] == kind)
            rows = mine if len(vector.order) > 1 else np.zeros(1, np.intp)
            if mine.size:
                result[mine] = _halved(
                    sign * keys.order[mine, 0], vector.kinds[rows] == kind, sign * vector.order[rows]
                )
        return result

    return search_each_trial(keys, vector, find)


def _halved(keys: Floats, comparable: Bools, order: Floats) -> Indices:
    """The indices of keys (m,) in values of (m, k) or, for all keys, (1, k)."""
    if len(order) == 1 and comparable.all() and (order[0, :-1] <= order[0, 1:]).all():
        return np.searchsorted(order[0], keys, side="right") - 1  # what halving comes to where all is in order
    return _Values.of(comparable, order).halved(keys)


@dataclass(frozen=True, slots=True)
class _Values:
    """Values in rising order, if they are in order: (m, k), or (1, k) for all keys.

    Attributes:
        order: what to compare with the keys.
        ahead: the first index, from here on, of a value of the keys' kind; k where there is none.
        run_end: the last index of the equal values side by side that begin here.
    """

    order: Floats
    ahead: Indices
    run_end: Indices

    @classmethod
    def of(cls, comparable: Bools, order: Floats) -> _Values:
        both = comparable[:, :-1] & comparable[:, 1:]
        goes_on = np.zeros(order.shape, bool)
        goes_on[:, :-1] = both & (order[:, :-1] == order[:, 1:])
        return cls(order, _next(comparable), _next(~goes_on))

    def halved(self, keys: Floats) -> Indices:
        """The index of each key, (m,). Between `low`, not beyond the key, and `high`, beyond it, all is open."""
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


def _next(wanted: Bools) -> Indices:
    """The first wanted index of each row from every index on; the row's length where there is none."""
    k = wanted.shape[1]
    indices = np.where(wanted, np.arange(k), k)
    return np.asarray(np.minimum.accumulate(indices[:, ::-1], axis=1)[:, ::-1])
