"""The search by halves of `MATCH`, `LOOKUP`, `VLOOKUP` and `HLOOKUP`, which trust the values to be in order.

What they find where the values are not in order is known to users, who rely on it (`LOOKUP(2, 1/(A1:A9=x), B1:B9)` is
the last row of x): so the search itself is Excel's, not only its result on ordered values. Cells of another kind than
the key's are stepped over. After the notes and tests of Apache POI on Excel's behaviour (`LookupUtils`).

Letters: n trials, m keys and k values of a trial.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.ordering import Ordered, ordered
from xlmc.functions.picking import Places
from xlmc.functions.values import LOGICAL, NUMBER, TEXT, Bools, Floats, Value

__all__ = ["last_not_beyond"]


def last_not_beyond(keys: Value, vector: Value, *, falling: bool = False) -> Places:
    """Where each key, or else what comes before it, stands in a vector in rising order, or falling; -1 for nowhere.

    Args:
        keys: (n,) or, in an array formula, (n, r, c).
        vector: (n, k, 1) or (n, 1, k).

    Returns:
        The shape of `keys`, with the trials of both, counted from 0.
    """
    wanted, found = ordered(keys, vector)
    n, m = max(keys.shape[0], vector.shape[0]), wanted.order.shape[1]
    sign = -1.0 if falling else 1.0
    if vector.shape[0] == 1:
        return np.broadcast_to(
            _of_all_kinds(wanted.kinds.ravel(), sign * wanted.order.ravel(), found, sign).reshape(-1, m), (n, m)
        ).reshape(n, *keys.shape[1:])
    columns = [
        _of_all_kinds(*(np.broadcast_to(part[:, j], n) for part in (wanted.kinds, sign * wanted.order)), found, sign)
        for j in range(m)
    ]
    return np.stack(columns, axis=1).reshape(n, *keys.shape[1:])
