"""Positions of keys in vectors: the equal value, or else the next smaller or larger one, wherever it stands.

A key finds values of its own kind only, texts whatever their case. Letters: m keys, k values.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.lookup.picking import Places
from xlmc.functions.ordering import Ordered, searched
from xlmc.functions.text.patterns import is_pattern, pattern_of
from xlmc.functions.values import ERROR, TEXT, Bools, Floats, Value

__all__ = ["EXACT", "LARGER", "SMALLER", "nearest"]

SMALLER: Final = -1
EXACT: Final = 0
LARGER: Final = 1


def nearest(keys: Value, vector: Value, side: int = EXACT, *, last: bool = False, wildcards: bool = False) -> Places:
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

    def find(keys: Ordered, vector: Ordered) -> Places:
        result = _in_one(keys, vector, side, last) if len(vector.order) == 1 else _in_many(keys, vector, side, last)
        return _patterns_over(result, keys, vector, last) if wildcards else result

    return searched(keys, vector, find)


def _in_one(keys: Ordered, vector: Ordered, side: int, last: bool) -> Places:
    """(m, 1) keys in (1, k) values -> (m,): by bisection of the values in order."""
    result = np.full(keys.order.shape[0], -1)
    kinds, order = vector.kinds[0], vector.order[0]
    for kind in np.unique(kinds[kinds < ERROR]):
        places = np.flatnonzero(kinds == kind)
        places = places[np.argsort(order[places], kind="stable")]
        mine = keys.kinds[:, 0] == kind
        result[mine] = _bisected(order[places], places, keys.order[mine, 0], side, last)
    return result


def _bisected(rising: Floats, places: Places, keys: Floats, side: int, last: bool) -> Places:
    """The places of the values that the keys find among `rising` ones."""
    at = np.searchsorted(rising, keys, "right") - 1 if side == SMALLER else np.searchsorted(rising, keys, "left")
    inside = (at >= 0) & (at < rising.size)
    value = rising[np.where(inside, at, 0)]
    if side == EXACT:
        inside &= value == keys
    chosen = np.searchsorted(rising, value, "right") - 1 if last else np.searchsorted(rising, value, "left")
    return np.where(inside, places[chosen], -1)


def _in_many(keys: Ordered, vector: Ordered, side: int, last: bool) -> Places:
    """(m, 1) keys, each in its own row of (m, k) values -> (m,)."""
    same_kind = (vector.kinds == keys.kinds) & (vector.kinds < ERROR)
    if side == EXACT:
        return _place_of(same_kind & (vector.order == keys.order), last)
    allowed = same_kind & (vector.order <= keys.order if side == SMALLER else vector.order >= keys.order)
    worst = -np.inf if side == SMALLER else np.inf
    within = np.where(allowed, vector.order, worst)
    best = within.max(axis=1, keepdims=True) if side == SMALLER else within.min(axis=1, keepdims=True)
    return _place_of(allowed & (vector.order == best), last)


def _place_of(hits: Bools, last: bool) -> Places:
    """The first hit of each row, or the last; -1 where there is none."""
    place = hits.shape[1] - 1 - hits[:, ::-1].argmax(axis=1) if last else hits.argmax(axis=1)
    return np.where(hits.any(axis=1), place, -1)


def _patterns_over(result: Places, keys: Ordered, vector: Ordered, last: bool) -> Places:
    """What keys with wildcards find, over what they found as plain texts: (m,)."""
    is_text, order = keys.kinds[:, 0] == TEXT, keys.order[:, 0]
    for rank in np.unique(order[is_text]).astype(np.intp):
        if is_pattern(keys.texts[rank]):
            found = _place_of(_fitting(vector, keys.texts[rank]), last)
            result = np.where(is_text & (order == rank), found, result)
    return result


def _fitting(vector: Ordered, pattern: str) -> Bools:
    is_text = vector.kinds == TEXT
    fits = pattern_of(pattern).fits
    fitting = [rank for rank in np.unique(vector.order[is_text]).tolist() if fits(vector.texts[int(rank)])]
    return np.asarray(is_text & np.isin(vector.order, fitting))
