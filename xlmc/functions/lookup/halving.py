"""The search by halves of `MATCH`, `LOOKUP`, `VLOOKUP` and `HLOOKUP`, which trust the values to be in order.

What it finds among values that are in no order is Excel's too, for sheets rely on it: `LOOKUP(2, 1/(A1:A9=x), B1:B9)`
is the last row of x. Cells of another kind than the key's are stepped over, and among equal neighbours the last is
taken. After Apache POI's account of Excel's behaviour (`LookupUtils`).

Letters: m keys, k values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from xlmc.functions.lookup.picking import Places
from xlmc.functions.ordering import Ordered, searched
from xlmc.functions.values import LOGICAL, NUMBER, TEXT, Bools, Floats, Value

__all__ = ["last_not_beyond"]


def last_not_beyond(keys: Value, vector: Value, *, falling: bool = False) -> Places:
    """Where each key, or else what comes before it, stands in a vector in order; -1 for nowhere.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).
        falling: the vector is in falling order.

    Returns:
        The shape of `keys`, with the trials of both, counted from 0.
    """
    sign = -1.0 if falling else 1.0

    def find(keys: Ordered, vector: Ordered) -> Places:
        result = np.full(len(keys.order), -1)
        for kind in (NUMBER, TEXT, LOGICAL):
            mine = np.flatnonzero(keys.kinds[:, 0] == kind)
            rows = mine if len(vector.order) > 1 else np.zeros(1, np.intp)
            if mine.size:
                result[mine] = _halved(
                    sign * keys.order[mine, 0], vector.kinds[rows] == kind, sign * vector.order[rows]
                )
        return result

    return searched(keys, vector, find)


def _halved(keys: Floats, comparable: Bools, order: Floats) -> Places:
    """The places of keys (m,) in values of (m, k) or, for all keys, (1, k)."""
    if len(order) == 1 and comparable.all() and (order[0, :-1] <= order[0, 1:]).all():
        return np.searchsorted(order[0], keys, side="right") - 1  # what halving comes to where all is in order
    return _Values.of(comparable, order).halved(keys)


@dataclass(frozen=True, slots=True)
class _Values:
    """Values in rising order, if they are in order: (m, k), or (1, k) for all keys.

    Attributes:
        order: what to compare with the keys.
        ahead: the first place, from here on, of a value of the keys' kind; k where there is none.
        run_end: the last place of the equal values side by side that begin here.
    """

    order: Floats
    ahead: Places
    run_end: Places

    @classmethod
    def of(cls, comparable: Bools, order: Floats) -> _Values:
        both = comparable[:, :-1] & comparable[:, 1:]
        goes_on = np.zeros(order.shape, bool)
        goes_on[:, :-1] = both & (order[:, :-1] == order[:, 1:])
        return cls(order, _next(comparable), _next(~goes_on))

    def halved(self, keys: Floats) -> Places:
        """The place of each key, (m,). Between `low`, not beyond the key, and `high`, beyond it, all is open."""
        k = self.order.shape[1]
        rows = np.arange(len(keys)) if len(self.order) > 1 else np.zeros(1, np.intp)
        low, high = np.full(keys.shape, -1), np.full(keys.shape, k)
        while (open_ := high - low > 1).any():
            middle = np.where(open_, (low + high) // 2, 0)
            place = self.ahead[rows, middle]
            inside = open_ & (place < high)
            value = self.order[rows, np.where(inside, place, 0)]
            equal, below = inside & (value == keys), inside & (value < keys)
            above = open_ & ~equal & ~below
            stepped = np.where(inside & (place < high - 1), place, middle)
            run_end = np.minimum(self.run_end[rows, np.where(inside, place, 0)], high - 1)
            low = np.where(equal, run_end, np.where(below, place, low))
            high = np.where(equal, low + 1, np.where(above, stepped, high))
        return low


def _next(wanted: Bools) -> Places:
    """The first wanted place of each row from every place on; the row's length where there is none."""
    k = wanted.shape[1]
    places = np.where(wanted, np.arange(k), k)
    return np.asarray(np.minimum.accumulate(places[:, ::-1], axis=1)[:, ::-1])
