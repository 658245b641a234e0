"""Quantiles and ranks. Letters: n trials, m ranks that are asked for.

The numbers of a sample in rising order stand at whole ranks; between them Excel interpolates linearly.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.excel.functions.facts import EmptyCells, Facts, Repeats
from xlmc.excel.functions.math.rounding import TENS, int_
from xlmc.excel.functions.registry import Cells, Number, excel
from xlmc.excel.functions.samples import Sample, at_each
from xlmc.excel.functions.values import NA, NUM, Bools, Floats

__all__: list[str] = []

_THREE: Final = np.full((1, 1), 3.0)
_FALLING: Final = np.zeros((1, 1))


def _interpolate(sample: Sample, ranks: Floats) -> Floats:
    """Return the numbers at ranks (n, m), counted from 0, interpolated; any number where they lie outside."""
    last = np.maximum(sample.size - 1, 0.0)
    low = np.floor(np.clip(ranks, 0.0, last))
    ordered = np.where(np.isinf(ordered := sample.ordered()), 0.0, ordered)
    start, end = (_take(ordered, np.minimum(rank, last)) for rank in (low, low + 1))
    return start + (np.clip(ranks, 0.0, last) - low) * (end - start)


def _take(ordered: Floats, ranks: Floats) -> Floats:
    return np.asarray(np.take_along_axis(ordered, ranks.astype(np.intp), axis=1))


def _inclusive(sample: Sample, share: Floats) -> Floats:
    inside = (share >= 0) & (share <= 1) & (sample.size > 0)
    return np.where(inside, _interpolate(sample, np.where(inside, share, 0.0) * (sample.size - 1)), NUM)


def _exclusive(sample: Sample, share: Floats) -> Floats:
    """Quantiles, ends excluded: the shares 0 and 1 stand at the ranks 0 and n + 1 of n numbers, counted from 1."""
    rank = share * (sample.size + 1)
    inside = (rank >= 1) & (rank <= sample.size)
    return np.where(inside, _interpolate(sample, np.where(inside, rank, 1.0) - 1), NUM)


@excel(
    "PERCENTILE.INC",
    Cells,
    Number,
    aliases=("PERCENTILE",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT),
)
@at_each()
def percentile(sample: Sample, share: Floats) -> Floats:
    """Return the number below which a share, 0 to 1, of the sample lies."""
    return _inclusive(sample, share)


@excel("PERCENTILE.EXC", Cells, Number, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
@at_each()
def percentile_exclusive(sample: Sample, share: Floats) -> Floats:
    """Return the number below which a share lies, ends excluded: `#NUM!` for shares nearer to 0 or 1 than 1/(n + 1)."""
    return _exclusive(sample, share)


@excel(
    "QUARTILE.INC",
    Cells,
    Number,
    aliases=("QUARTILE",),
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT),
)
@at_each()
def quartile(sample: Sample, quarters: Floats) -> Floats:
    """Return the number below which so many quarters, 0 to 4, of the sample lie."""
    return _inclusive(sample, np.floor(quarters) / 4)


@excel("QUARTILE.EXC", Cells, Number, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
@at_each()
def quartile_exclusive(sample: Sample, quarters: Floats) -> Floats:
    """Return the number below which so many quarters, 1 to 3, of the sample lie, ends excluded."""
    return _exclusive(sample, np.floor(quarters) / 4)


def _rank_of(sample: Sample, x: Floats) -> tuple[Floats, Bools]:
    """Return the rank of numbers (n, m) in the sample, counted from 0, and whether they lie inside it."""
    below, equal = sample.count_where(np.less, x), sample.count_where(np.equal, x)
    inside = (equal > 0) | ((below > 0) & (below < sample.size))
    ordered = np.where(np.isinf(ordered := sample.ordered()), 0.0, ordered)
    after = np.clip(below, 0.0, np.maximum(sample.size - 1, 0.0))
    start, end = _take(ordered, np.maximum(after - 1, 0.0)), _take(ordered, after)
    passed = (x - start) / np.where(end > start, end - start, 1.0)
    return np.where(equal > 0, below, below - 1 + passed), inside


def _cut(share: Floats, digits: Floats) -> Floats:
    """Cut a share to so many digits."""
    tens = TENS[np.clip(np.floor(digits), 0, 15).astype(np.intp)]
    return np.asarray(int_(share * tens) / tens)


def _cut_or_error(sample: Sample, inside: Bools, digits: Floats, share: Floats) -> Floats:
    share = np.where(inside, _cut(share, digits), NA)
    return np.where((sample.size > 0) & (digits >= 1), share, NUM)


@excel(
    "PERCENTRANK.INC",
    Cells,
    Number,
    Number(default=3.0),
    aliases=("PERCENTRANK",),
    facts=Facts(empty_cells=EmptyCells.IGNORED),
)
@at_each()
def percent_rank(sample: Sample, x: Floats, digits: Floats = _THREE) -> Floats:
    """Return the share of the sample below a number, 0 to 1, cut to so many digits; `#N/A` outside the sample."""
    rank, inside = _rank_of(sample, x)
    share = np.where(sample.size > 1, rank / np.maximum(sample.size - 1, 1.0), 1.0)
    return _cut_or_error(sample, inside, digits, np.where(inside, share, 0.0))


@excel("PERCENTRANK.EXC", Cells, Number, Number(default=3.0), facts=Facts(empty_cells=EmptyCells.IGNORED))
@at_each()
def percent_rank_exclusive(sample: Sample, x: Floats, digits: Floats = _THREE) -> Floats:
    """Return the share of the sample below a number, ends excluded, cut to so many digits; `#N/A` outside the
    sample.
    """
    rank, inside = _rank_of(sample, x)
    return _cut_or_error(sample, inside, digits, np.where(inside, (rank + 1) / (sample.size + 1), 0.0))


def _rank(x: Floats, sample: Sample, rising: Floats) -> tuple[Floats, Floats]:
    """Return the rank of each number, and how many equal it; with `rising` 0 the largest has rank 1."""
    ahead = np.where(rising == 0, sample.count_where(np.greater, x), sample.count_where(np.less, x))
    return ahead + 1, sample.count_where(np.equal, x)


@excel("RANK.EQ", Number, Cells, Number(default=0.0), aliases=("RANK",), facts=Facts(empty_cells=EmptyCells.IGNORED))
@at_each(1)
def rank(sample: Sample, x: Floats, rising: Floats = _FALLING) -> Floats:
    """Rank of a number in a sample; equal numbers all have their best rank. `#N/A` if it is not there."""
    first, equal = _rank(x, sample, rising)
    return np.where(equal > 0, first, NA)


@excel("RANK.AVG", Number, Cells, Number(default=0.0), facts=Facts(empty_cells=EmptyCells.IGNORED))
@at_each(1)
def average_rank(sample: Sample, x: Floats, rising: Floats = _FALLING) -> Floats:
    """Rank of a number in a sample; equal numbers all have their mean rank. `#N/A` if it is not there."""
    first, equal = _rank(x, sample, rising)
    return np.where(equal > 0, first + (equal - 1) / 2, NA)
