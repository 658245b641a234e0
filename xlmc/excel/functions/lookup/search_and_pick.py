"""Lookups in constant numbers, as engines compute them: a search and a pick, of plain numbers alone.

`POSITION` is MATCH in constant numbers that are in order, `CELL_AT` gives the number at the position that it found.
Engines run `Search` and `Pick`, which are called like ufuncs, instead of the bodies of these two functions, which take
values of any kind.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.budget import work_arrays
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.lookup.index_and_address import index
from xlmc.excel.functions.lookup.lookup import match
from xlmc.excel.functions.registry import Anything, Arrays, Cells, Function, Kind, Number
from xlmc.excel.functions.values import NUMBER, Floats, Value

__all__ = ["CELL_AT", "POSITION", "Pick", "Search", "numbers_of"]

POSITION: Final = Function(
    "a lookup", (Anything, Cells, Number), match, Kind.NUMBER, facts=Facts(jumps=True, exact_steps=True)
)
"""A key that is one number, constant numbers, and a constant order: 1, 0 or -1."""

CELL_AT: Final = Function(
    "the cell found", (Arrays, Number), index, Kind.NUMBER, facts=Facts(exact_steps=True, unrounded=True)
)
"""Constant numbers and a position that is surely one of theirs."""


def numbers_of(value: Value) -> Floats | None:
    """Return the numbers of a constant row or column, `(k,)`; None of another value, or where not all are numbers."""
    if value.numbers.ndim != 3 or value.shape[0] != 1 or 1 not in value.shape[1:]:
        return None
    if not (value.kinds == NUMBER).all():
        return None
    return np.ascontiguousarray(np.broadcast_to(value.numbers, value.shape).reshape(-1))


_EVEN: Final = 0.25
"""Numbers that lie no farther than this share of a step from evenly spaced ones are found by a division."""

_LEAST_STEP: Final = 1e-300
"""The inverse of a smaller step may be no number."""


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """Finds the positions of keys in numbers, counted from 1.

    Attributes:
        rising: `(k,)` the numbers in rising order, each times `sign`; infinity follows.
        sign: -1 where they are in falling order.
        positions: `(k,)` where each of them stands, counted from 1, if a key must equal one of them, the first of equal
            ones; None if a key has the position of the last number that is not beyond it.
        step: from one of them to the next, where they are evenly spaced; else 0.
        divides: whether the whole steps from the first number to a key say where it is, whatever the key.
    """

    rising: Floats
    sign: float
    positions: NDArray[np.intp] | None
    step: float
    divides: bool = False
    nin: ClassVar[int] = 1

    @classmethod
    def of(cls, numbers: Floats, order: float) -> Search | None:
        """Return the search that MATCH makes with this order: 1, 0 or -1; None in numbers that are not in it."""
        if order == 0:
            by_size = np.argsort(numbers, kind="stable")
            return cls(np.append(numbers[by_size], np.inf), 1.0, np.append(by_size + 1, 0), 0.0)
        signed = np.copysign(1.0, order) * numbers
        in_order = np.less_equal if order > 0 else np.less  # of equal numbers in falling order MATCH finds the first
        if not in_order(signed[:-1], signed[1:]).all():
            return None
        with np.errstate(all="ignore"):  # of numbers that are too far apart, or too near, the step is none
            step = float(signed[-1] - signed[0]) / max(1, signed.size - 1)
            even = signed[0] + step * np.arange(signed.size)
            is_even = step > _LEAST_STEP and bool((np.abs(signed - even) <= _EVEN * step).all())
            divides = is_even and _divides(signed, step)
        sign = float(np.copysign(1.0, order))
        return cls(np.append(signed, np.inf), sign, None, step if is_even else 0.0, divides)

    def finds(self, keys: Floats) -> bool:
        """Whether every key, none of them infinite, has a position."""
        if self.positions is not None:
            return bool((self.rising.take(np.searchsorted(self.rising, keys)) == keys).all())
        least = np.minimum.reduce(keys) if self.sign > 0 else -np.maximum.reduce(keys)
        return bool(least >= self.rising[0])

    def __call__(self, keys: Floats, out: Floats | None = None) -> Floats:
        """Return the positions, `(n,)`, of keys that all have one."""
        return np.add(self.indices(keys), 1.0, out=out)

    def indices(self, keys: Floats, out: Floats | None = None) -> NDArray[np.int64]:
        """Return the positions counted from 0, as whole numbers for `Pick.at`, `(n,)`, in the memory of `out` where it
        is given.
        """
        values = np.empty(keys.shape, np.int64) if out is None else out.view(np.int64)
        if self.divides:
            np.copyto(values, self._steps(keys), casting="unsafe")
        else:
            np.subtract(self._positions(keys), 1, out=values)
        return values

    def _steps(self, keys: Floats) -> Floats:
        """How many steps lie between the first number and each key, in memory that the next call writes to again."""
        (steps,) = work_arrays(keys.size, 1)
        np.minimum(keys if self.sign > 0 else -keys, self.rising[-2], out=steps)
        if self.rising[0]:
            steps -= self.rising[0]
        steps /= self.step
        return steps

    def _positions(self, keys: Floats) -> NDArray[np.intp]:
        if self.positions is not None:
            positions: NDArray[np.intp] = self.positions.take(np.searchsorted(self.rising, keys))
            return positions
        keys = keys if self.sign > 0 else -keys
        return self._by_division(keys) if self.step else np.searchsorted(self.rising, keys, "right")

    def _by_division(self, keys: Floats) -> NDArray[np.intp]:
        """Guess by the distance from the first number, which misses by one at most, and correct."""
        guess = np.minimum(keys, self.rising[-2])
        guess -= self.rising[0]
        guess *= 1.0 / self.step
        values: NDArray[np.intp] = guess.astype(np.intp)
        values -= keys < self.rising.take(values)
        values += 1
        values += keys >= self.rising.take(values)
        return values


def _divides(rising: Floats, step: float) -> bool:
    """Whether (key - first) / step, rounded down, is the index of the last number that is not above the key.

    It never falls as the key rises, so it needs a look only where the index changes: at each number, and just below it.
    """
    index = np.arange(rising.size)
    below = np.nextafter(rising[1:], -np.inf)
    at, under = (np.floor((keys - rising[0]) / step) for keys in (rising, below))
    return bool((at == index).all() and (under == index[:-1]).all())


@dataclass(frozen=True, slots=True, eq=False)
class Pick:
    """Picks the numbers at positions, counted from 1.

    Attributes:
        numbers: `(k + 1,)`, the first of which is never picked.
    """

    numbers: Floats
    nin: ClassVar[int] = 1

    @classmethod
    def of(cls, numbers: Floats) -> Pick:
        """Return the pick from a row or a column."""
        return cls(np.insert(numbers, 0, np.nan))

    def __call__(self, positions: Floats, out: Floats | None = None) -> Floats:
        """Return the numbers at positions, `(n,)`."""
        (work,) = work_arrays(positions.size, 1)
        indices = work.view(np.int64).reshape(positions.shape)
        np.copyto(indices, positions, casting="unsafe")
        values: Floats = self.numbers.take(indices, out=out, mode="clip")
        return values

    def at(self, indices: NDArray[np.int64], out: Floats | None = None) -> Floats:
        """Return the numbers at `Search.indices`, `(n,)`; `out` must not be the memory of these."""
        values: Floats = self.numbers[1:].take(indices, out=out, mode="clip")
        return values
