"""Whether formulas put right what the arctangent of a quotient loses: half a turn wherever the divisor is negative.

It is tried out. In the trials with a negative divisor the angle is turned by half a turn, and then also every
comparison that tells the sign of the divisor. What follows from the angle is guarded where the one undoes the other, up
to whole turns: in `IF(x<0,PI(),0)+ATAN(y/x)` it does, in `IF(x<0,1,2)+ATAN(y/x)` it does not. What does not change with
the angle needs no guard.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.node_values import Ragged
from xlmc.evaluation.graph.nodes import Apply, uses
from xlmc.evaluation.passes.random_rounding import follow, formula_of
from xlmc.functions.values import TEXT, Value
from xlmc.studies.stability.case import RELATIONS, Bools, Case, Floats

__all__ = ["Guards", "guards"]

_SLIGHT: Final = 1e-4
"""Radians: a small turn of the angle, which tells how a cell follows it."""

_ALIKE: Final = 1e-9
"""Of a number or of a turn: what differs by less is the same."""

_MOST: Final = 256
"""Trials in which it is tried out."""

_MOST_COMPARISONS: Final = 2000
"""That are looked through for those that tell the divisor's sign without naming it, as `x2<x1` for `x2-x1`. A book with
more has a column of them; there only those that name the divisor count."""


@dataclass(frozen=True, slots=True)
class Guards:
    """What becomes of one arctangent.

    Attributes:
        lost: the nodes that take the angle with its quadrant lost; none where no forecast and no filter is among them.
        holding: the nodes that put the angle right.
    """

    lost: frozenset[int]
    holding: frozenset[int]


def guards(case: Case, angle: int, divisor: int) -> Guards:
    """What the formulas make of `ATAN(y/divisor)`.

    Args:
        case: the evidence.
        angle: the node of the arctangent.
        divisor: that of x, which is negative in some trial.
    """
    negative = np.asarray(case.number(divisor) < 0)
    rows = np.flatnonzero(negative)
    rows = rows[np.linspace(0, rows.size - 1, min(rows.size, _MOST)).astype(int)]
    trial = _Trial(case, angle, rows)
    return trial.of(dict(_signs(case, divisor, trial.values, negative)))


def _signs(case: Case, divisor: int, values: Mapping[int, Value], negative: Bools) -> Iterator[tuple[int, Value]]:
    """The comparisons that tell the sign of the divisor, with what they would give for the other sign."""
    turned = Value(-values[divisor].numbers, values[divisor].kinds)
    for place in case.users.get(divisor, ()):
        node = formula_of(case.dag, place)
        if isinstance(node, Apply) and node.function.name in (*RELATIONS, "SIGN"):
            yield place, follow(case.dag, [place], values, {divisor: turned})[place]
    compared = [place for place in case.comparisons if divisor not in uses(formula_of(case.dag, place))]
    for place in compared if len(compared) <= _MOST_COMPARISONS else ():
        if _tells(case, place, negative):
            yield place, Value(1.0 - values[place].numbers, values[place].kinds)


def _tells(case: Case, place: int, negative: Bools) -> bool:
    """Whether a comparison is true where the divisor is negative, or where it is not, in all trials."""
    value = case.values[place]
    if isinstance(value, Ragged) or value.numbers.ndim != 1 or value.has_errors:
        return False
    found = np.broadcast_to(value.numbers, negative.shape) != 0
    return bool((found == negative).all() or (found != negative).all())


class _Trial:
    """The trials in which it is tried out: `values` of all nodes in them."""

    def __init__(self, case: Case, angle: int, rows: NDArray[np.intp]) -> None:
        self._case, self._angle = case, angle
        self._after = case.after(angle)
        self.values = _Taken(case.values, rows)

    def of(self, signs: Mapping[int, Value]) -> Guards:
        """Which nodes the angle reaches with its quadrant lost."""
        turned, both = self._with(np.pi), self._with(np.pi, signs)
        slight = self._with(_SLIGHT)
        lost, holding = {self._angle}, set()
        for place in self._after:
            if not any(part in lost for part in uses(formula_of(self._case.dag, place))):
                continue
            plain = self.values[place]
            if place not in turned or _same(plain, turned[place], 0.0):
                continue
            if place in both and _same(plain, both[place], _turn(plain, slight[place])):
                holding.add(place)
            else:
                lost.add(place)
        targets = {*(self._case.node[row.cell] for row in self._case.model.forecasts), *self._case.conditions}
        return Guards(frozenset(lost if targets & lost else ()), frozenset(holding))

    def _with(self, turn: float, signs: Mapping[int, Value] | None = None) -> dict[int, Value]:
        angle = self.values[self._angle]
        given = {self._angle: Value(angle.numbers + turn, angle.kinds), **(signs or {})}
        return follow(self._case.dag, self._case.after(*given), self.values, given)


class _Taken(Mapping[int, Value]):
    """Node -> its values in some trials, taken when they are asked for."""

    def __init__(self, values: Mapping[int, Value], rows: NDArray[np.intp]) -> None:
        self._values, self._rows = values, rows
        self._taken: dict[int, Value] = {}

    def __getitem__(self, place: int) -> Value:
        if place not in self._taken:
            self._taken[place] = self._values[place].take(self._rows)
        return self._taken[place]

    def __iter__(self) -> Iterator[int]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


def _turn(plain: Value, slight: Value) -> float:
    """A whole turn in the units of a node that follows the angle evenly; 0 where it does not."""
    slopes: Floats = np.abs(slight.numbers - plain.numbers).ravel() / _SLIGHT
    if isinstance(plain, Ragged) or not slopes.size or np.ptp(slopes) > 1e-6 * slopes.max():
        return 0.0
    return float(2 * np.pi * np.median(slopes))


def _same(one: Value, other: Value, turn: float) -> bool:
    """Whether two values are the same in all trials, up to whole turns."""
    if isinstance(one, Ragged) or isinstance(other, Ragged) or one.numbers.shape[1:] != other.numbers.shape[1:]:
        return False
    if (one.kinds != other.kinds).any():
        return False
    if (one.kinds == TEXT).any():
        return bool(np.array_equal(one.objects(), other.objects()))
    off = other.numbers - one.numbers
    if turn:
        off = off - turn * np.rint(off / turn)
    size = np.maximum(np.maximum(np.abs(one.numbers), turn), _usual(one.numbers))
    return bool((np.abs(off) <= _ALIKE * size).all())


def _usual(found: Floats) -> float:
    """The size of most of a node's numbers: beside it, what is left of a 0 by rounding is nothing."""
    sizes = np.abs(found[np.isfinite(found)])
    return float(np.median(sizes)) if sizes.size else 0.0
