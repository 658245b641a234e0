"""Crystal Ball's custom data: rows of one to five columns, as the pieces of a distribution.

| columns | meaning |
|---|---|
| 1, or 6 and more | values, equally weighted; a value that comes twice counts twice |
| 2 | value, weight |
| 3 | low, high, weight: a flat range; without a high, a single value |
| 4 | low, high, weight, step: low, low + step, …, up to high share the weight; without a step, a flat range |
| 5 | low, high, weight, height at low, height at high: a range whose density slopes; without heights, a flat one |

A blank weight is 1. A range without a low begins where the row before it ends. Weights may be cumulative, but not in
five columns. A weight of 0 takes the row out.

Source: Oracle Crystal Ball User's Guide, "Entering Tables of Data into Custom Distributions".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from xlmc.montecarlo.distributions.base import LARGEST, Array
from xlmc.montecarlo.distributions.parameters import DataError, show
from xlmc.montecarlo.distributions.pieces import Piece

__all__ = ["MOST_VALUES", "custom_pieces", "rows_of", "value_pieces", "weighted_pieces"]

MOST_VALUES = 100_000
"""A distribution may have no more single values than this."""

_TOLERANCE = 1e-9
"""A range may fall short of a whole number of steps by this share of a step: decimals are not exact."""

Row = Sequence[float | None]
"""The numbers of a row; None if the cell is blank."""

Position = tuple[int, int]
"""Row and column within the data, counted from 0."""


@dataclass(frozen=True, slots=True)
class _Read:
    """What a row gives: a single value, a range, or the values of a stepped range; and the row's number."""

    pieces: tuple[Piece, ...]
    row: int

    @property
    def low(self) -> float:
        return self.pieces[0].low

    @property
    def high(self) -> float:
        return self.pieces[-1].high

    def clashes_with(self, left: _Read) -> bool:
        """Whether they overlap, where `left` begins first. One value may come twice, and ranges may touch."""
        if self.low != left.high:
            return self.low < left.high
        stepped = len(self.pieces) > 1 or len(left.pieces) > 1
        return stepped and self.pieces[0].low == self.pieces[0].high and left.pieces[-1].low == left.high


def rows_of(data: Array) -> list[Row]:
    """`(rows, columns)` with NaN for blanks, as rows."""
    return [[None if value != value else float(value) for value in row] for row in data]


def value_pieces(rows: Sequence[Row]) -> list[Piece]:
    """Equally weighted values from any number of columns; blank cells are left out.

    Raises:
        DataError: there is no value.
    """
    _refuse_extreme(rows)
    values = [(value, 1.0) for row in rows for value in row if value is not None]
    if not values:
        raise DataError("The data are blank", "Fill in at least one value", 0, 0)
    return _merged(values)


def weighted_pieces(rows: Sequence[Row], *, cumulative: bool = False) -> list[Piece]:
    """Values with weights, from two columns.

    Raises:
        DataError: a value is missing, a weight is below 0 or does not rise, or nothing has a weight.
    """
    weights = _weights(rows, 1, cumulative)
    values: list[tuple[float, float]] = []
    for (number, row), weight in zip(_filled(rows), weights, strict=True):
        if row[0] is None:
            raise DataError("The value is blank", "Type the value that this weight belongs to", number, 0)
        values.append((row[0], weight))
    return _merged(values)


def custom_pieces(rows: Sequence[Row], *, cumulative: bool = False) -> list[Piece]:
    """Return the pieces of a custom distribution, from left to right.

    Args:
        rows: of equal length; rows of blanks are left out.
        cumulative: each weight is the sum of all up to its row.

    Raises:
        DataError: the data are not a distribution.
    """
    columns = len(rows[0])
    if cumulative and columns not in (2, 3, 4):
        what = "heights of a slope" if columns == 5 else "no weights"
        hint = "Clear Cumulative, or use two, three or four columns with cumulative weights"
        raise DataError(f"Weights cannot be cumulative in data with {what}", hint, 0, 0)
    if columns == 1 or columns > 5:
        return value_pieces(rows)
    if columns == 2:
        return weighted_pieces(rows, cumulative=cumulative)
    weights = _weights(rows, 2, cumulative)
    reads: list[_Read] = []
    before: float | None = None  # the end of the row before
    for (number, row), weight in zip(_filled(rows), weights, strict=True):
        reads.append(_Read(_pieces_of(row, number, weight, before), number))
        before = row[0] if row[1] is None else row[1]
    weighted = [read for read, weight in zip(reads, weights, strict=True) if weight > 0]
    _refuse_many(sum(len(read.pieces) for read in weighted))
    _refuse_overlaps(weighted)
    return [piece for read in sorted(weighted, key=lambda read: (read.low, read.high)) for piece in read.pieces]


def _refuse_extreme(rows: Sequence[Row]) -> None:
    for number, row in enumerate(rows):
        for column, value in enumerate(row):
            if value is not None and not abs(value) <= LARGEST:
                message = f"The number ({show(value)}) must be between -1E150 and 1E150"
                raise DataError(message, "Correct the number", number, column)


def _filled(rows: Sequence[Row]) -> list[tuple[int, Row]]:
    return [(number, row) for number, row in enumerate(rows) if any(value is not None for value in row)]


def _weights(rows: Sequence[Row], column: int, cumulative: bool) -> list[float]:
    """Return the weight of each row that is not blank."""
    _refuse_extreme(rows)
    filled = _filled(rows)
    if not filled:
        raise DataError("The data are blank", "Fill in at least one row", 0, 0)
    weights: list[float] = []
    reached, last = 0.0, (filled[0][0], column)
    for number, row in filled:
        given, position = row[column], (number, column)
        if cumulative:
            _refuse_fall(given, reached, position, last)
        weight = 1.0 if given is None else given
        if weight < 0:
            raise DataError(f"The weight ({show(weight)}) is below 0", "Type 0 or more", *position)
        weights.append(weight - reached if cumulative else weight)
        reached, last = weight, position
    if not sum(weights) > 0:
        raise DataError("Every weight is 0", "Give at least one row a weight above 0", filled[0][0], column)
    return weights


def _refuse_fall(given: float | None, reached: float, position: Position, last: Position) -> None:
    """Check that a cumulative weight is there, and no less than the one before it."""
    if given is None:
        raise DataError("A cumulative weight is blank", "Type the sum of the weights up to this row", *position)
    if given < reached:
        message = f"The cumulative weight ({show(given)}) falls: before it, in {{also}}, it is {show(reached)}"
        raise DataError(message, "Sort the rows, or clear Cumulative where weights are not sums", *position, also=last)


def _pieces_of(row: Row, number: int, weight: float, before: float | None) -> tuple[Piece, ...]:
    low, high = before if row[0] is None else row[0], row[1]
    if low is None:
        hint = "Type it; only a range that follows another may leave it out"
        raise DataError("The low end is blank", hint, number, 0)
    if high is None:
        if row[0] is None:
            raise DataError("Both ends are blank", "Type a value, or the two ends of a range", number, 0)
        high = low
    if high < low:
        message = f"The low end ({show(low)}) is above the high end ({show(high)})"
        raise DataError(message, "Exchange the two, or correct the wrong one", number, 0)
    step = row[3] if len(row) == 4 else None
    if step is not None and step < 0:
        raise DataError(f"The step ({show(step)}) is below 0", "Type a step above 0, or clear it", number, 3)
    if step and high > low:
        return _stepped(low, high, weight, step, number)
    left, right = _heights(row, number) if len(row) == 5 else (1.0, 1.0)
    return (Piece(low, high, weight, left, right),)


def _stepped(low: float, high: float, weight: float, step: float, number: int) -> tuple[Piece, ...]:
    steps = (high - low) / step
    if not steps < MOST_VALUES:
        _refuse_many(math.inf, (number, 3))
    count = math.floor(steps + _TOLERANCE) + 1
    values = (min(low + step * i, high) for i in range(count))
    return tuple(Piece(value, value, weight / count) for value in values)


def _heights(row: Row, number: int) -> tuple[float, float]:
    if row[3] is None and row[4] is None:
        return 1.0, 1.0
    left, right = (_height(row[column], (number, column)) for column in (3, 4))
    larger = max(left, right)
    if not larger > 0:
        raise DataError("Both heights are 0", "Type a height above 0 for one end, or a weight of 0", number, 3)
    return left / larger, right / larger


def _height(height: float | None, position: Position) -> float:
    if height is None:
        raise DataError("One of the two heights is blank", "Type both, or neither for a flat range", *position)
    if height < 0:
        raise DataError(f"The height ({show(height)}) is below 0", "Type 0 or more", *position)
    return height


def _refuse_many(count: float, position: Position = (0, 0)) -> None:
    if count > MOST_VALUES:
        message = f"The data give more than {MOST_VALUES:,} single values"
        raise DataError(message, "Take a larger step, or a range without steps", *position)


def _refuse_overlaps(reads: Iterable[_Read]) -> None:
    for first, second in pairwise(sorted(reads, key=lambda read: (read.low, read.high))):
        if second.clashes_with(first):
            ends = [f"{show(read.low)} to {show(read.high)}" for read in (second, first)]
            message = f"This row ({ends[0]}) overlaps the row of {{also}} ({ends[1]})"
            hint = "Let each range end where the next begins, or before"
            raise DataError(message, hint, second.row, 0, also=(first.row, 0))


def _merged(values: Iterable[tuple[float, float]]) -> list[Piece]:
    """Single values from left to right; the weights of equal ones are added."""
    weights: dict[float, float] = {}
    for value, weight in values:
        weights[value + 0.0] = weights.get(value + 0.0, 0.0) + weight
    return [Piece(value, value, weights[value]) for value in sorted(weights)]
