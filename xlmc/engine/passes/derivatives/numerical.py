"""Derivatives of a function without a rule, from differences of its own values, with an estimate of their error.

Central differences, each at half the step of the one before, are extrapolated to a step of 0 (Richardson; the choice
among all orders is that of Ridders, 1982): the value is taken that differs least from its neighbours, and this
difference estimates its error. Steps start at a share of the arguments' size, or of 1 where that gives a smaller
estimate, and at a smaller share where the function turns or jumps within these steps: a very small step must agree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from xlmc.engine.passes.derivatives.jet import Jet, align, chain
from xlmc.engine.passes.derivatives.rules import Operand, Outcome
from xlmc.excel.functions import Function
from xlmc.excel.functions.values import ERROR, TEXT, Bools, Floats, Value

__all__ = ["by_differences"]

_FIRST_STEP: Final = 1 / 16
_STEPS: Final = 7

_FINER: Final = 2.0**-12
_CLOSE: Final = 2.0**-20
"""The share of the usual steps where a function turns nearby; and the very small step."""

_SMALLEST: Final = 1e-100

_TOLERANCE: Final = 1e-4
"""A share of a derivative: if the estimate of its error is larger, there is no derivative, as at a jump."""

Moved = Callable[[Sequence[Floats | None]], Floats]
"""Takes what is added to each operand's numbers, and gives the function's values."""


def by_differences(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Compute the derivatives of any function of numbers; none where it depends on texts that change."""
    jets = [operand.jet for operand in operands]
    live = [index for index, jet in enumerate(jets) if jet.active]
    if any((value.kinds == TEXT).any() for value in (result, *(operands[index].value for index in live))):
        return Outcome(_through_text(result, [jets[index] for index in live]))

    def moved(steps: Sequence[Floats | None]) -> Floats:
        values = [_moved(operand, step) for operand, step in zip(operands, steps, strict=True)]
        results = function(values)
        if results.numbers.shape[1:] != result.numbers.shape[1:]:
            return np.full(result.shape, np.nan)
        return np.where(results.kinds >= ERROR, np.nan, results.numbers)

    single = [index for index in live if operands[index].value.numbers.ndim == 1]
    active = {number for index in live for number in jets[index].active}
    if single == live and result.numbers.ndim == 1 and len(live) <= len(active):
        return Outcome(_by_arguments(moved, result, jets, live), numerical=True)
    return Outcome(_by_assumptions(moved, result, operands), numerical=True)


def _moved(operand: Operand, step: Floats | None) -> Value:
    if step is None:
        return operand.value
    numbers, _ = operand.value.to_numbers()
    kinds = np.where(operand.value.kinds >= ERROR, operand.value.kinds, np.uint8(0))
    return Value(np.asarray(numbers + step), kinds.astype(np.uint8))


def _through_text(result: Value, jets: Sequence[Jet]) -> Jet:
    """Return derivatives of 0 where no assumption changes a text; none where one does, for a text has rounded
    digits.
    """
    total = Jet.still(np.zeros(1))
    for jet in jets:
        cells = jet.spread().each(lambda part, axes: np.abs(part).reshape(*part.shape[: axes + 1], -1).sum(axis=-1))
        total = total + cells
    if result.numbers.ndim == 3:
        total = total.as_range()

    def change(part: Any, axes: int) -> Any:
        return np.where(part == 0, 0.0, np.nan) if axes else part

    return total.each(change, result.numbers)


@dataclass(frozen=True, slots=True)
class _Path:
    """A way to move the operands: by `t·first + t²/2·second` each; their shapes are those of the operands."""

    first: tuple[Floats | None, ...]
    second: tuple[Floats | None, ...]

    def at(self, t: Floats) -> list[Floats | None]:
        steps: list[Floats | None] = []
        for first, second in zip(self.first, self.second, strict=True):
            if first is None:
                steps.append(None)
                continue
            size = t.reshape(-1, *(1,) * (first.ndim - 1))
            steps.append(size * first if second is None else size * first + 0.5 * size * size * second)
        return steps


def _by_arguments(moved: Moved, result: Value, jets: Sequence[Jet], live: Sequence[int]) -> Jet:
    """Differences by the arguments, then the chain rule."""
    order = jets[live[0]].order

    def path(*indices: int) -> _Path:
        first = tuple(_scale(jet.x) if index in indices else None for index, jet in enumerate(jets))
        return _Path(first, (None,) * len(jets))

    singles = {index: _along(moved, result, path(index)) for index in live}
    sizes = {index: _scale(jets[index].x) for index in live}
    firsts = [singles[index].first / sizes[index] if index in singles else 0.0 for index in range(len(jets))]
    errors = {index: singles[index].first_error / sizes[index] for index in live}

    seconds: dict[tuple[int, int], Floats] = {}
    second_errors: dict[tuple[int, int], Floats] = {}
    if order > 1:
        for i in live:
            seconds[i, i] = singles[i].second / sizes[i] ** 2
            second_errors[i, i] = singles[i].second_error / sizes[i] ** 2
            for j in live:
                if j > i:
                    both = _along(moved, result, path(i, j))
                    seconds[i, j], second_errors[i, j] = _mixed(both, singles[i], singles[j], sizes[i] * sizes[j])
    jet = chain(result.numbers, jets, firsts, lambda: seconds)
    return _with_errors(jet, [jets[index] for index in live], list(errors.values()), live, second_errors)


def _with_errors(
    jet: Jet,
    jets: Sequence[Jet],
    errors: Sequence[Floats],
    live: Sequence[int],
    second_errors: dict[tuple[int, int], Floats],
) -> Jet:
    """Return the jet with the errors of the partial derivatives added to those of its operands."""
    wide = align(jets)
    own = sum((np.abs(part.first) * error for part, error in zip(wide, errors, strict=True)), np.zeros(1))
    second_error = jet.second_error
    if jet.second is not None:
        more = np.zeros(1)
        for part, error in zip(wide, errors, strict=True):
            assert part.second is not None
            more = more + np.abs(part.second) * error
        by_index = dict(zip(live, wide, strict=True))
        for (i, j), error in second_errors.items():
            outer = np.abs(by_index[i].first)[:, None] * np.abs(by_index[j].first)[None, :] * error
            more = more + (outer if i == j else outer + outer.swapaxes(0, 1))
        second_error = more if second_error is None else second_error + more
    error = own if jet.error is None else jet.error + own
    return Jet(jet.x, jet.active, jet.first, jet.second, error, second_error)


def _by_assumptions(moved: Moved, result: Value, operands: Sequence[Operand]) -> Jet:
    """Differences along what each assumption does to all cells of all operands: for ranges, of many cells."""
    indices = [index for index, operand in enumerate(operands) if operand.jet.active]
    wide = dict(zip(indices, align([operands[index].jet for index in indices]), strict=True))
    jets = {index: jet.spread() for index, jet in wide.items()}
    x = [jets[index].x for index in indices]
    active = jets[indices[0]].active
    order = jets[indices[0]].order
    a = range(len(active))

    def path(weights: dict[int, Floats]) -> _Path:
        """Along a sum of assumptions, each by a weight `(n,)`."""
        firsts: list[Floats | None] = [None] * len(operands)
        seconds: list[Floats | None] = [None] * len(operands)
        for index, jet in jets.items():
            level = {i: w.reshape(-1, *(1,) * (jet.x.ndim - 1)) for i, w in weights.items()}
            firsts[index] = sum((w * jet.first[i] for i, w in level.items()), np.zeros(1))
            if jet.second is not None:
                curve = [v * w * jet.second[i, j] for i, v in level.items() for j, w in level.items()]
                seconds[index] = sum(curve, np.zeros(1))
        return _Path(tuple(firsts), tuple(seconds))

    n = result.shape[0]
    weight = [_weight([jets[index].first[i] for index in indices], x, n) for i in a]
    singles = [_along(moved, result, path({i: weight[i]})) for i in a]
    level = [w.reshape(-1, *(1,) * (result.numbers.ndim - 1)) for w in weight]
    first = np.stack([singles[i].first / level[i] for i in a])
    error = np.stack([singles[i].first_error / level[i] for i in a])
    second = second_error = None
    if order > 1:
        second, second_error = (np.zeros((len(active), len(active), *result.shape)) for _ in range(2))
        for i in a:
            second[i, i] = singles[i].second / level[i] ** 2
            second_error[i, i] = singles[i].second_error / level[i] ** 2
            for j in range(i):
                both = _along(moved, result, path({i: weight[i], j: weight[j]}))
                second[i, j], second_error[i, j] = _mixed(both, singles[i], singles[j], level[i] * level[j])
                second[j, i], second_error[j, i] = second[i, j], second_error[i, j]
    error, second_error = _inherit(jets, singles, error, second_error)
    return Jet(result.numbers, active, first, second, error, second_error)


def _inherit(
    jets: dict[int, Jet], singles: Sequence[_Along], error: Floats, second_error: Floats | None
) -> tuple[Floats, Floats | None]:
    """Return the errors, with the relative errors of the operands' derivatives added."""
    share = 0.0
    for jet in jets.values():
        if jet.error is not None:
            with np.errstate(all="ignore"):
                part = np.where(jet.first == 0, 0.0, np.abs(jet.error / jet.first))
            share = max(share, float(np.nanmax(part, initial=0.0)))
    if share:
        size = np.stack([np.abs(single.first) for single in singles])
        error = error + share * size
    return error, second_error


def _scale(x: Floats) -> Floats:
    """Return the size of an argument; 1 where it is 0 or nearly so."""
    return np.where(np.abs(x) < _SMALLEST, 1.0, np.abs(x))


def _weight(firsts: Sequence[Floats], x: Sequence[Floats], n: int) -> Floats:
    """How far an assumption may be moved so that no cell moves by more than its size, `(n,)`."""
    most = np.zeros(n)
    for first, numbers in zip(firsts, x, strict=True):
        share = np.abs(first) / _scale(numbers)
        most = np.maximum(most, share.reshape(share.shape[0], -1).max(axis=1))
    return np.where(most > 0, 1 / np.where(most > 0, most, 1.0), 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Along:
    """The derivatives along a way, and estimates of their errors: NaN and infinite where there are none.

    `fine` is the error that a second derivative may have and still count as known, even if it is 0.
    """

    first: Floats
    first_error: Floats
    second: Floats
    second_error: Floats
    fine: Floats

    def or_better(self, other: _Along) -> _Along:
        """Return the derivatives of this one or of the other, whichever has the smaller estimate."""
        first = other.first_error < self.first_error
        second = other.second_error < self.second_error
        return _Along(
            np.where(first, other.first, self.first),
            np.where(first, other.first_error, self.first_error),
            np.where(second, other.second, self.second),
            np.where(second, other.second_error, self.second_error),
            np.where(second, other.fine, self.fine),
        )


def _along(moved: Moved, result: Value, path: _Path) -> _Along:
    """Return the better result of steps that suit the arguments' size, and of steps that suit a size of 1."""
    n = result.shape[0]
    most = np.zeros(n)
    for step in path.first:
        if step is not None:
            most = np.maximum(most, np.abs(step).reshape(step.shape[0], -1).max(axis=1))
    along = _extrapolate(moved, result, path, np.ones(n))
    small = (most < 1) & (most >= _SMALLEST)
    if small.any():
        along = along.or_better(_extrapolate(moved, result, path, np.where(small, 1 / most, 1.0)))
    if not np.isfinite(along.first_error).all():
        along = along.or_better(_extrapolate(moved, result, path, np.full(n, _FINER)))
    return along


def _mixed(both: _Along, one: _Along, other: _Along, size: Floats) -> tuple[Floats, Floats]:
    """Return the mixed second derivative along two paths, from those along each and along their sum, and its error."""
    second = both.second - one.second - other.second
    error = both.second_error + one.second_error + other.second_error
    tolerance = np.maximum(10 * _TOLERANCE * np.abs(second), 1e-6 * (np.abs(one.second) + np.abs(other.second)))
    sure = error <= np.maximum(tolerance, np.maximum(1e-6 * np.abs(both.second), both.fine))
    return np.where(sure, second, np.nan) / (2 * size), np.where(sure, error, np.inf) / (2 * size)


def _extrapolate(moved: Moved, result: Value, path: _Path, scale: Floats) -> _Along:
    middle = np.broadcast_to(np.where(result.kinds >= ERROR, np.nan, result.numbers), result.shape)
    level = scale.reshape(-1, *(1,) * (result.numbers.ndim - 1))
    slopes, bends, steps = [], [], []
    largest = np.abs(middle)
    for share in [*(_FIRST_STEP / 2**halving for halving in range(_STEPS)), _CLOSE]:
        t = scale * share
        up, down = moved(path.at(t)), moved(path.at(-t))
        size = level * share
        slopes.append((up - down) / (2 * size))
        bends.append(((up - middle) - (middle - down)) / size**2)
        steps.append(size)
        largest = np.fmax(largest, np.fmax(np.abs(up), np.abs(down)))
    *slopes, close = slopes
    noise = np.finfo(float).eps * (largest + np.abs(slopes[-1]) * np.minimum(level, 1.0))
    first, first_error = _best(slopes, [noise / size for size in steps[:-1]])
    second, second_error = _best(bends[:-1], [4 * noise / size**2 for size in steps[:-1]])
    apart = np.abs(close - first) - 1e-3 * np.fmax(np.abs(first), np.abs(close))
    agrees = (apart <= 8 * noise / steps[-1]) & ~_turns(slopes, bends, steps, 8 * noise / steps[-1])
    reach = largest / steps[-2]
    sure = agrees & (first_error <= np.maximum(_TOLERANCE * np.abs(first), 1e-9 * reach))
    fine = 1e-7 * reach / steps[-2]
    bent = sure & (second_error <= np.maximum(_TOLERANCE * 10 * np.abs(second), fine))
    return _Along(
        np.where(sure, first, np.nan),
        np.where(sure, first_error, np.inf),
        np.where(bent, second, np.nan),
        np.where(bent, second_error, np.inf),
        np.broadcast_to(fine, second.shape),
    )


def _turns(slopes: Sequence[Floats], bends: Sequence[Floats], steps: Sequence[Floats], noise: Floats) -> Bools:
    """Whether the slopes on the two sides of a very small step, the last of them, still differ, as at a turn.

    Central differences alone do not see a turn that is alike on both sides.
    """
    sides = [np.abs(bend) * step for bend, step in zip(bends, steps, strict=True)]
    steepest = np.fmax.reduce([side + np.abs(slope) for side, slope in zip(sides, slopes, strict=False)])
    return np.asarray(sides[-1] > 1e-3 * steepest + noise)


def _best(rows: Sequence[Floats], noise: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Return the entry of the extrapolation table that differs least from those it was made of, and by how much."""
    best = np.full(rows[0].shape, np.nan)
    least = np.full(rows[0].shape, np.inf)
    before: list[Floats] = []
    for row, floor in zip(rows, noise, strict=True):
        now = [row]
        for power, left in enumerate(before, start=1):
            factor = 4.0**power
            now.append((factor * now[-1] - left) / (factor - 1))
            error = np.maximum(np.abs(now[-1] - now[-2]), np.abs(now[-1] - left)) + floor
            better = error < least
            best, least = np.where(better, now[-1], best), np.where(better, error, least)
        before = now
    return best, least
