"""Weeks of work: which of their days are worked, and counting by them.

Letters: n trials, m cells of an argument in an array formula (1 elsewhere). Days of the week are numbered from 0 for
Monday. Days are serials of the 1900 system.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.values import Bools, Codes, Floats, Value

__all__ = ["Weeks", "worked_days"]

_WEEKENDS: Final = {
    **{code: {(code + 4) % 7, (code + 5) % 7} for code in range(1, 8)},
    **{code: {(code - 5) % 7} for code in range(11, 18)},
}
"""Days off by Excel's numbers of weekends: 1 is Saturday and Sunday, 11 Sunday alone, and so on."""

_A_MONDAY: Final = 2
"""A serial, and with it the start of a week: 2 January 1900, as Excel has it."""


def worked_days(weekend: Value) -> tuple[Bools, Codes]:
    """Which days of the week are worked, with 7 behind the shape of the argument; and errors."""
    known: dict[object, tuple[bool, ...] | ErrorCode] = {}
    items = weekend.objects()
    worked, errors = np.ones((*items.shape, 7), bool), np.zeros(items.shape, np.uint8)
    for place in np.ndindex(*items.shape):
        item = items[place]
        key = (type(item), item)
        if key not in known:
            known[key] = _pattern(item)
        found = known[key]
        if isinstance(found, ErrorCode):
            errors[place] = found
        else:
            worked[place] = found
    return worked, errors


def _pattern(item: object) -> tuple[bool, ...] | ErrorCode:
    """Which days of the week are worked: for a number of `_WEEKENDS`, or for a text of seven 0s and 1s (off)."""
    match item:
        case None:
            return _pattern(1.0)
        case ErrorCode():
            return item
        case str():
            is_mask = len(item) == 7 and set(item) <= {"0", "1"}
            return tuple(mark == "0" for mark in item) if is_mask else ErrorCode.VALUE
        case bool():
            return ErrorCode.VALUE
        case float() if np.floor(item) in _WEEKENDS:
            return tuple(day not in _WEEKENDS[int(item)] for day in range(7))
        case _:
            return ErrorCode.NUM


class Weeks:
    """Counts days of work by the week alone.

    Attributes:
        worked: (n, m, 7).
        a_week: how many days of work there are in a week, at least 1 so that it can divide, (n, m).
        none: where there is none, (n, m).
    """

    def __init__(self, worked: Bools) -> None:
        self.worked = worked
        self.none: Bools = np.asarray(~worked.any(axis=-1))
        self.a_week = np.maximum(worked.sum(axis=-1), 1)
        self._before: NDArray[np.intp] = np.cumsum(worked, axis=-1) - worked
        self._order = np.argsort(~worked, axis=-1, kind="stable")

    def before(self, day: Floats) -> Floats:
        """Days of work from `_A_MONDAY` to the day before, negative if that comes first: (n, m) -> (n, m)."""
        weeks, weekday = np.divmod(day - _A_MONDAY, 7)
        return np.asarray(weeks * self.a_week + _picked(self._before, weekday))

    def numbered(self, number: Floats) -> Floats:
        """The day of work that has so many `before` it."""
        weeks, rest = np.divmod(number, self.a_week)
        return np.asarray(_A_MONDAY + weeks * 7 + _picked(self._order, rest))

    def is_worked(self, day: Floats) -> Bools:
        return _picked(self.worked, np.mod(day - _A_MONDAY, 7)).astype(bool)


def _picked(table: NDArray[Any], place: Floats) -> NDArray[Any]:
    """From tables (n, m, 7) the entry at a place (n, m)."""
    shape = np.broadcast_shapes(table.shape[:-1], place.shape)
    spread = np.broadcast_to(table, (*shape, 7))
    return np.take_along_axis(spread, np.broadcast_to(place, shape)[..., None].astype(np.intp), axis=-1)[..., 0]
