"""One number from many. Letters: n trials, k numbers of a trial.

Sums and products run from left to right, each trial by itself: the same bits for any number of trials at once, and the
same as the fold of the row's `ufunc`. A cell given as an argument comes as a range of one, so that a text, logical or
blank in it does not count; given directly it does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import errors_unless_range, first_error, first_error_in_row, with_errors
from xlmc.excel.functions.denormals import TINIEST, tiny_to_zero
from xlmc.excel.functions.facts import EmptyCells, Facts, Repeats
from xlmc.excel.functions.lookup.picked_cells import Indices, flatten_cells
from xlmc.excel.functions.registry import REGISTRY, Arrays, Cells, Function, Kind, Number, Numbers, excel, side_by_side
from xlmc.excel.functions.samples import row_sums, sample_of
from xlmc.excel.functions.values import BLANK, DIV0, ERROR, NUM, NUMBER, TEXT, Bools, Floats, Value, constant

__all__ = ["RUNNING", "SO_FAR"]


@excel(
    "SUM",
    Numbers,
    ufunc=np.add,
    facts=Facts(
        never_errs=True,
        empty_cells=EmptyCells.IGNORED,
        repeats=Repeats.ADD_UP,
        ends_suffice=True,
        adds=True,
        measures=True,
    ),
)
def sum_(x: Floats, counts: Bools) -> Floats:
    """Sum."""
    return row_sums(np.where(counts, x, 0.0))


@excel(
    "PRODUCT",
    Numbers,
    ufunc=np.multiply,
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True),
)
def product(x: Floats, counts: Bools) -> Floats:
    """Product; 0 of nothing, and 0 from the first partial product on that is too small a number for Excel."""
    so_far = np.multiply.accumulate(np.where(counts, x, 1.0), axis=1)
    vanished = (np.abs(so_far) < TINIEST).any(axis=1)
    return np.where(counts.any(axis=1) & ~vanished, so_far[:, -1], 0.0)


@excel(
    "MIN",
    Numbers,
    ufunc=np.minimum,
    facts=Facts(
        never_errs=True, empty_cells=EmptyCells.IGNORED, repeats=Repeats.ONCE, ends_suffice=True, unrounded=True
    ),
)
def minimum(x: Floats, counts: Bools) -> Floats:
    """Smallest; 0 of nothing."""
    return np.where(counts.any(axis=1), np.where(counts, x, np.inf).min(axis=1), 0.0)


@excel(
    "MAX",
    Numbers,
    ufunc=np.maximum,
    facts=Facts(
        never_errs=True, empty_cells=EmptyCells.IGNORED, repeats=Repeats.ONCE, ends_suffice=True, unrounded=True
    ),
)
def maximum(x: Floats, counts: Bools) -> Floats:
    """Largest; 0 of nothing."""
    return np.where(counts.any(axis=1), np.where(counts, x, -np.inf).max(axis=1), 0.0)


@excel("AVERAGE", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True))
def average(x: Floats, counts: Bools) -> Floats:
    """Mean; `#DIV/0!` of nothing."""
    k = counts.sum(axis=1)
    return np.where(k > 0, sum_(x, counts) / k, DIV0)


@excel("MEDIAN", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def median(x: Floats, counts: Bools) -> Floats:
    """Middle number, or mean of the two in the middle; `#NUM!` of nothing."""
    ordered, k = _ordered(x, counts)
    low, high = (_picked(ordered, index[:, None])[:, 0] for index in ((k - 1) // 2, k // 2))
    return np.where(k > 0, (low + high) / 2, NUM)


def _ordered(x: Floats, counts: Bools) -> tuple[Floats, Indices]:
    """Return the numbers of each trial in rising order, what does not count behind them, and how many do: (n,
    k), (n,).
    """
    return np.sort(np.where(counts, x, np.inf), axis=1), counts.sum(axis=1)


def _picked(ordered: Floats, indices: Indices) -> Floats:
    """Return the numbers at `indices` (n, m) of each trial; any number where there is none."""
    return np.asarray(np.take_along_axis(ordered, np.clip(indices, 0, ordered.shape[1] - 1), axis=1))


def _variance(x: Floats, counts: Bools, lost: int) -> tuple[Floats, Bools]:
    """Sum of the squared distances from the mean, divided by k - `lost`; and whether k is large enough: (n,), (n,)."""
    k = counts.sum(axis=1)
    distance = np.where(counts, x - (sum_(x, counts) / k)[:, None], 0.0)
    return row_sums(distance * distance) / (k - lost), k > lost


@excel(
    "VAR.S",
    Numbers,
    aliases=("VAR",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True),
)
def sample_variance(x: Floats, counts: Bools) -> Floats:
    """Variance, estimated from a sample; `#DIV/0!` of fewer than two."""
    variance, enough = _variance(x, counts, 1)
    return np.where(enough, variance, DIV0)


@excel(
    "VAR.P",
    Numbers,
    aliases=("VARP",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True),
)
def population_variance(x: Floats, counts: Bools) -> Floats:
    """Variance of the numbers themselves; `#DIV/0!` of nothing."""
    variance, enough = _variance(x, counts, 0)
    return np.where(enough, variance, DIV0)


@excel(
    "STDEV.S",
    Numbers,
    aliases=("STDEV",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True),
)
def sample_deviation(x: Floats, counts: Bools) -> Floats:
    """Return the standard deviation, estimated from a sample; `#DIV/0!` of fewer than two."""
    variance, enough = _variance(x, counts, 1)
    return np.where(enough, np.sqrt(variance), DIV0)


@excel(
    "STDEV.P",
    Numbers,
    aliases=("STDEVP",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True),
)
def population_deviation(x: Floats, counts: Bools) -> Floats:
    """Return the standard deviation of the numbers themselves; `#DIV/0!` of nothing."""
    variance, enough = _variance(x, counts, 0)
    return np.where(enough, np.sqrt(variance), DIV0)


def _how_many(parts: Iterable[Bools]) -> Floats:
    """Return the number of cells that count, in each trial: (n, k), (n, k'), … -> (n,)."""
    total = np.zeros(1)
    for counts in parts:
        total = total + counts.sum(axis=1)
    return total


@excel(
    "COUNT",
    Cells(repeat=True),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.ADD_UP, ends_suffice=True, exact_steps=True),
)
def count(*values: Value) -> Floats:
    """How many are numbers; given directly, also logicals and the texts of numbers. Errors do not count."""
    return _how_many(sample_of(value).counts for value in values)


@excel(
    "COUNTA",
    Cells(repeat=True),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.ADD_UP, ends_suffice=True, exact_steps=True),
)
def count_anything(*values: Value) -> Floats:
    """How many are not blank; an argument left out between commas counts, as in Excel."""
    return _how_many(flatten_cells((value.kinds != BLANK) | (value.numbers.ndim < 3), value) for value in values)


@excel("COUNTBLANK", Cells)
def count_blank(cells: Value) -> Value:
    """How many are blank or hold an empty text."""
    empty = np.asarray(cells.kinds == BLANK)
    if cells.texts is not None:
        empty = empty | ((cells.kinds == TEXT) & (cells.texts == ""))
    return Value.of_numbers(_how_many([flatten_cells(empty, cells)]), errors_unless_range(cells))


@excel(
    "SUMPRODUCT",
    Arrays(repeat=True),
    facts=Facts(empty_cells=EmptyCells.PAIRED, repeats=Repeats.ADD_UP, ends_suffice=True, measures=True),
)
def sum_product(*values: Value) -> Value:
    """Sum of the products of the cells in one position; what is not a number is 0; `#VALUE!` for unequal shapes.

    Where the ranges are of one cell each, a text is `#VALUE!`, as Excel has it.
    """
    ranges = [value.as_range() for value in values]
    shapes = {cells.shape[1:] for cells in ranges}
    if len(shapes) > 1:
        return with_errors(constant(ErrorCode.VALUE), first_error(*(errors_unless_range(value) for value in values)))
    products = np.ones(1)
    errors = []
    for cells in ranges:
        products = tiny_to_zero(products * np.where(cells.kinds == NUMBER, cells.numbers, 0.0))
        refused = (cells.kinds == TEXT) & (shapes == {(1, 1)})
        errors.append(
            first_error_in_row(flatten_cells(np.where(refused, np.uint8(ErrorCode.VALUE), cells.errors), cells))
        )
    return Value.of_numbers(row_sums(products.reshape(products.shape[0], -1)), first_error(*errors))


def _ranked(values: Value, rank: Value, index_of: Callable[[Floats, Indices], Floats]) -> Value:
    """Return the numbers at `index_of(rank, k)` in rising order, in the shape of `rank`; `#NUM!` where there
    is none.
    """
    sample = sample_of(values)
    ordered, k = _ordered(sample.x, sample.counts)
    ranks, errors = (flatten_cells(array, rank) for array in rank.to_numbers())
    indices = index_of(ranks, k[:, None])
    inside = (indices >= 0) & (indices < k[:, None])
    result = np.where(inside, _picked(ordered, np.where(inside, indices, 0).astype(np.intp)), NUM)
    errors = np.broadcast_to(first_error(sample.errors[:, None], errors), result.shape)
    shape = (result.shape[0], *rank.shape[1:])
    return Value.of_numbers(result.reshape(shape), errors.reshape(shape))


@excel(
    "LARGE", Cells, Number, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, unrounded=True)
)
def large(values: Value, rank: Value) -> Value:
    """Return the number of a rank, the largest being 1; a fraction of a rank rounds up."""
    return _ranked(values, rank, lambda ranks, k: -np.ceil(ranks) + k)


@excel(
    "SMALL", Cells, Number, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, unrounded=True)
)
def small(values: Value, rank: Value) -> Value:
    """Return the number of a rank, the smallest being 1; a fraction of a rank rounds down."""
    return _ranked(values, rank, lambda ranks, k: np.floor(ranks) - 1)


class _Overflowed(Value):
    """A sum or product of numbers of which some overflowed: #NUM! to all who read it, but not yet in a longer range."""

    __slots__ = ("overflows",)

    overflows: Bools

    def __init__(self, value: Value, overflows: Bools) -> None:
        super().__init__(value.numbers, value.kinds)
        object.__setattr__(self, "overflows", overflows)

    def take(self, index: Indices) -> Value:
        """Return the trials of `index`."""
        taken = super().take(index)
        return self if taken is self else _Overflowed(taken, self.overflows[index])

    def opened(self) -> Value:
        """Return the value with infinite numbers for the overflows."""
        return Value(
            np.where(self.overflows, np.inf, self.numbers), np.where(self.overflows, np.uint8(NUMBER), self.kinds)
        )


class _Running(Function):
    """A sum or product whose first or last argument may be that of a shorter range, of cells before or behind.

    In Excel an error in any cell counts before an overflow. So an overflow on the way must not hide a later error.
    """

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        return _running, (self.name,)

    def _of_sets(self, arguments: Sequence[Value]) -> Value:
        opened = [part.opened() if isinstance(part, _Overflowed) else part for part in arguments]
        x, counts, errors = side_by_side(opened, Kind.NUMBER)
        total = self.body(x, counts)
        value = Value.of_numbers(total, errors)
        overflows = ~np.isfinite(total) & (errors == 0)
        return _Overflowed(value, overflows) if overflows.any() else value


def _running(name: str) -> Function:
    return RUNNING[name]


def _so_far(cells: Value, of: str) -> Value:
    """Return what the function gives of a range, (n, r, c) -> (n,); blank where no cell is a number."""
    result = REGISTRY[of]((cells,))
    none = ~(cells.kinds == NUMBER).any(axis=(1, 2)) & (result.kinds < ERROR)
    return Value(np.where(none, 0.0, result.numbers), np.where(none, np.uint8(BLANK), result.kinds))


RUNNING: Final[Mapping[str, Function]] = {
    name: _Running(name, row.parameters, row.body, row.returns, row.ufunc, facts=row.facts)
    for name, row in ((name, REGISTRY[name]) for name in ("SUM", "PRODUCT"))
}
"""Sums and products that go on, by the name of Excel's function."""

SO_FAR: Final[Mapping[str, Function]] = {
    name: Function(
        f"{name} so far",
        (Cells,),
        partial(_so_far, of=name),
        Kind.ANY,
        facts=Facts(unrounded=REGISTRY[name].facts.unrounded),
    )
    for name in ("MAX", "MIN", "PRODUCT")
}
"""Functions of the numbers so far, by the name of Excel's function; they give a blank while there are no numbers.

Excel gives 0 for the largest, the smallest or the product of no numbers at all; 0 would count when more cells follow.
"""
