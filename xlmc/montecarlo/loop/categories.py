"""Answers that are texts: each trial's text as a number, and the texts that these numbers stand for.

A block numbers its texts as they come; `Labels` numbers those of a whole run in the order of their first trials, so
that the numbers depend neither on blocks nor on threads.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import TEXT_RESULT, Column

__all__ = ["Labels", "labelled"]

Floats = NDArray[np.float64]


def labelled(column: Column) -> tuple[Column, tuple[str, ...]]:
    """Return the column with numbers of texts, from 0, and the texts; a number counts as its own text."""
    codes = np.zeros(column.values.size, np.uint8) if column.codes is None else np.array(column.codes)
    numbers: dict[str, int] = {}
    values = np.zeros(column.values.size)
    for trial in np.flatnonzero((codes == 0) | (codes == TEXT_RESULT)).tolist():
        is_text = codes[trial] == TEXT_RESULT
        text = column.texts[trial] if is_text and column.texts is not None else _number_text(column.values[trial])
        values[trial] = numbers.setdefault(str(text), len(numbers))
    codes[codes == TEXT_RESULT] = 0
    return Column(values, codes if codes.any() else None), tuple(numbers)


def _number_text(number: float) -> str:
    from xlmc.montecarlo.definitions.number_styles import as_programs_read
    from xlmc.montecarlo.number_text import number_text

    with as_programs_read():  # results are named by it
        return number_text(float(number), 12)


class Labels:
    """The texts of one forecast, in the order of their first trials."""

    def __init__(self, known: Iterable[str] = ()) -> None:
        self._numbers = {text: number for number, text in enumerate(known)}

    def renumbered(self, values: Floats, labels: Sequence[str]) -> Floats:
        """Return `(m,)` numbers of a block's texts as those of the run; NaN, a trial without one, stays."""
        known = ~np.isnan(values)
        result, first = np.unique(values[known].astype(np.intp), return_index=True)
        own = np.zeros(len(labels) + 1)
        for number in result[np.argsort(first)].tolist():
            own[number] = self._numbers.setdefault(labels[number], len(self._numbers))
        renumbered = np.full(values.size, np.nan)
        renumbered[known] = own[values[known].astype(np.intp)]
        return renumbered

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts, each at its number."""
        return tuple(self._numbers)
