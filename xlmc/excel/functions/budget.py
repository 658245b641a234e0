"""How much memory and work one value may take. A function asks for it before it takes it.

Excel's own limits give Excel's own errors (a text of more than 32,767 characters is `#VALUE!`). The limits here are
xlmc's: a workbook is untrusted, and no formula of it may fill the memory. They count cells × trials, so that a block of
trials that is too large is evaluated in smaller portions; a formula is refused only if one trial alone is too large.

`work_arrays` gives arrays for intermediate results. Each thread keeps its own from call to call, because pages of fresh
memory cost much time.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import FormulaError

__all__ = [
    "MOST_CALLS",
    "MOST_CALLS_TOGETHER",
    "MOST_CELLS",
    "MOST_CHARACTERS",
    "MOST_KEPT",
    "MOST_LIVE",
    "MOST_READ",
    "MOST_STEPS",
    "MOST_TEXTS",
    "MOST_WORK",
    "CallCount",
    "TooLargeError",
    "ask_for_cells",
    "ask_for_characters",
    "ask_for_live",
    "ask_for_reading",
    "ask_for_texts",
    "ask_for_work",
    "bytes_of",
    "count_characters",
    "work_arrays",
]

MOST_CELLS: Final = 1 << 23
"""Cells × trials of one array: 8 bytes each, and a function needs several arrays of the size at a time."""

MOST_TEXTS: Final = 1 << 21
"""Cells × trials that are computed one by one, as texts are: each takes a microsecond and a hundred bytes."""

MOST_CHARACTERS: Final = 1 << 26
"""Characters of all texts of one array."""

MOST_CALLS: Final = 100_000
"""Calls of LAMBDAs in one formula: each is written out as nodes of its own, 2 kB and 50 microseconds."""

MOST_CALLS_TOGETHER: Final = 500_000
"""Calls of LAMBDAs in all formulas of a workbook."""

MOST_STEPS: Final = 100_000
"""Steps of all calls that a LAMBDA makes of itself and that are not written out: 50 microseconds each."""

MOST_READ: Final = 1 << 21
"""Cells of one area of a sheet; whole columns and rows are counted up to the last filled cell."""

MOST_KEPT: Final = 1 << 28
"""Bytes of all constant arrays that are in memory at a time, each counted once."""

MOST_LIVE: Final = 1 << 28
"""Bytes of all values that are needed at a time while a portion of trials is evaluated."""

MOST_WORK: Final = 1 << 31
"""Multiplications, or other steps as simple, of one function."""


class TooLargeError(FormulaError):
    """A formula asks for more than xlmc takes. With fewer trials at a time it may ask for less.

    Attributes:
        node: the node of the graph that asked for it; None if that is not known.
    """

    node: int | None = None


def ask_for_cells(trials: int, rows: int, columns: int = 1) -> None:
    """Ask for an array of cells.

    Raises:
        TooLargeError: it is too large.
    """
    if trials * rows * columns > MOST_CELLS:
        size = f"{rows:,} rows and {columns:,} columns" if columns > 1 else f"{rows:,} cells"
        raise TooLargeError(
            f"an array of {size} is too large: an array of xlmc holds up to {MOST_CELLS:,} cells",
            hint="make the array smaller, or split the calculation over several cells",
        )


def ask_for_texts(count: int) -> None:
    """Ask to compute so many values one by one.

    Raises:
        TooLargeError: they are too many.
    """
    if count > MOST_TEXTS:
        raise TooLargeError(
            f"{count:,} texts in one array are too many: xlmc takes up to {MOST_TEXTS:,}",
            hint="make the array smaller, or split the calculation over several cells",
        )


def ask_for_characters(count: int) -> None:
    """Ask for so many characters in all texts of one array.

    Raises:
        TooLargeError: they are too many.
    """
    if count > MOST_CHARACTERS:
        raise TooLargeError(
            f"the texts of one array have {count:,} characters together: xlmc takes up to {MOST_CHARACTERS:,}",
            hint="make the texts shorter, or fewer",
        )


def count_characters(items: Iterable[object]) -> Iterator[object]:
    """Pass the items on and count the characters of the texts among them.

    Raises:
        TooLargeError: there are too many characters.
    """
    total = 0
    for item in items:
        if isinstance(item, str):
            total += len(item)
            if total > MOST_CHARACTERS:
                ask_for_characters(total)
        yield item


def ask_for_work(steps: int) -> None:
    """Ask for so many multiplications, or other steps as simple, in one function.

    Raises:
        TooLargeError: they are too many.
    """
    if steps > MOST_WORK:
        raise TooLargeError(
            f"a function of arrays takes {steps:,} steps: xlmc takes up to {MOST_WORK:,}",
            hint="make the arrays smaller",
        )


def ask_for_reading(rows: int, columns: int) -> None:
    """Ask to read an area of a sheet cell by cell.

    Raises:
        TooLargeError: it has too many cells.
    """
    if rows * columns > MOST_READ:
        raise TooLargeError(
            f"a range of {rows:,} rows and {columns:,} columns is too large: xlmc reads ranges of up to "
            f"{MOST_READ:,} cells",
            hint="name only the rows and columns that hold something",
        )


class CallCount:
    """Counts the calls of LAMBDAs, in one formula and in all of a workbook."""

    def __init__(self) -> None:
        self._in_formula = self._together = 0

    def next_formula(self) -> None:
        """Begin to count the calls of another formula."""
        self._in_formula = 0

    def add(self) -> None:
        """Count a call.

        Raises:
            TooLargeError: there are too many.
        """
        self.ask_for(1)
        self._in_formula += 1
        self._together += 1

    def ask_for(self, calls: int) -> None:
        """Ask for so many more calls, before the first of them.

        Raises:
            TooLargeError: they are too many.
        """
        if self._in_formula + calls > MOST_CALLS:
            raise TooLargeError(
                f"the formula calls LAMBDAs more than {MOST_CALLS:,} times",
                hint="make its arrays smaller, or use arithmetic on whole arrays, as in SEQUENCE(9)*2",
            )
        if self._together + calls > MOST_CALLS_TOGETHER:
            raise TooLargeError(
                f"the formulas of the workbook call LAMBDAs more than {MOST_CALLS_TOGETHER:,} times up to here",
                hint="make the arrays smaller, or use arithmetic on whole arrays, as in SEQUENCE(9)*2",
            )


def ask_for_live(bytes_: int) -> None:
    """Ask for the memory of all values that are needed at a time.

    Raises:
        TooLargeError: it is too much.
    """
    if bytes_ > MOST_LIVE:
        raise TooLargeError(
            f"the arrays that are needed at a time take {bytes_ >> 20:,} MB: xlmc takes up to {MOST_LIVE >> 20:,}",
            hint="make the arrays smaller, or fewer",
        )


def bytes_of(arrays: tuple[np.ndarray[Any, Any] | None, ...]) -> int:
    """Return the memory of numbers, kinds and texts. An array that only repeats one element counts as that element."""
    numbers, kinds, texts = arrays
    size = _own_bytes(numbers) + _own_bytes(kinds)
    if texts is not None:
        size += 64 * texts.size + sum(map(len, texts.ravel().tolist()))
    return size


def _own_bytes(array: np.ndarray[Any, Any] | None) -> int:
    if array is None:
        return 0
    return array.nbytes if 0 not in array.strides or array.size < 2 else array.itemsize


_KEPT: Final = 2

_MEMORY = threading.local()


def work_arrays(n: int, arrays: int) -> list[NDArray[np.float64]]:
    """Return one or two arrays `(n,)` that this thread may write to until it calls this again."""
    arrays_here: list[NDArray[np.float64]] = getattr(_MEMORY, "arrays", [])
    if len(arrays_here) < arrays or arrays_here[0].size < n:
        _MEMORY.arrays = arrays_here = [np.empty(n) for _ in range(_KEPT)]
    return [array[:n] for array in arrays_here[:arrays]]
