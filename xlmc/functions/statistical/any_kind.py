"""Statistics that count everything in a range but blanks: TRUE as 1, FALSE and texts as 0.

Letters: n trials, k values of a trial.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.functions.arguments import earliest, first_errors
from xlmc.functions.facts import EmptyCells, Facts, Repeats
from xlmc.functions.lookup.picking import flattened
from xlmc.functions.registry import Cells, excel
from xlmc.functions.samples import mean_of, spread_of
from xlmc.functions.values import BLANK, DIV0, Bools, Codes, Floats, Value

__all__: list[str] = []


def _columns(value: Value) -> tuple[Floats, Bools, Codes]:
    """Numbers, which of them count, and errors of one argument: (n, k) each."""
    in_range = value.numbers.ndim == 3
    x, errors = (value.numbers, value.errors) if in_range else value.to_numbers()
    counts = (value.kinds != BLANK) | (not in_range)
    x, counts, errors = (flattened(array, value) for array in (x, counts & (errors == 0), errors))
    return x, counts, errors


def _over_all(
    name: str, meaning: str, body: Callable[[Floats, Bools], Floats], repeats: Repeats = Repeats.REFUSED
) -> None:
    """Register a function of all values, (n, k) and which of them count -> (n,)."""

    def apply(*values: Value) -> Value:
        parts = [_columns(value) for value in values]
        n = max(x.shape[0] for x, _, _ in parts)
        x, counts = (
            np.concatenate([np.broadcast_to(part[i], (n, part[i].shape[1])) for part in parts], axis=1) for i in (0, 1)
        )
        return Value.of_numbers(body(x, counts), earliest(*(first_errors(codes) for _, _, codes in parts)))

    apply.__doc__ = meaning
    facts = Facts(empty_cells=EmptyCells.IGNORED, repeats=repeats, ends_tell=repeats is Repeats.ONCE)
    excel(name, Cells(repeat=True), facts=facts)(apply)


def _average(x: Floats, counts: Bools) -> Floats:
    mean, _, k = mean_of(x, counts)
    return np.where(k > 0, mean, DIV0)


def _largest(x: Floats, counts: Bools) -> Floats:
    return np.where(counts.any(axis=1), np.where(counts, x, -np.inf).max(axis=1), 0.0)


def _smallest(x: Floats, counts: Bools) -> Floats:
    return np.where(counts.any(axis=1), np.where(counts, x, np.inf).min(axis=1), 0.0)


def _variance(x: Floats, counts: Bools) -> Floats:
    total, k = spread_of(x, counts)
    return np.where(k > 1, total / np.maximum(k - 1, 1.0), DIV0)


def _population_variance(x: Floats, counts: Bools) -> Floats:
    total, k = spread_of(x, counts)
    return np.where(k > 0, total / np.maximum(k, 1.0), DIV0)


def _root(variance: Callable[[Floats, Bools], Floats]) -> Callable[[Floats, Bools], Floats]:
    def deviation(x: Floats, counts: Bools) -> Floats:
        found = variance(x, counts)
        return np.where(found >= 0, np.sqrt(np.where(found >= 0, found, 0.0)), DIV0)

    return deviation


_over_all("AVERAGEA", "Mean; `#DIV/0!` of nothing.", _average)
_over_all("MAXA", "Largest; 0 of nothing.", _largest, Repeats.ONCE)
_over_all("MINA", "Smallest; 0 of nothing.", _smallest, Repeats.ONCE)
_over_all("VARA", "Variance, estimated from a sample; `#DIV/0!` of fewer than two.", _variance)
_over_all("VARPA", "Variance of the values themselves; `#DIV/0!` of nothing.", _population_variance)
_over_all("STDEVA", "Standard deviation, from a sample; `#DIV/0!` of fewer than two.", _root(_variance))
_over_all("STDEVPA", "Standard deviation of the values themselves; `#DIV/0!` of nothing.", _root(_population_variance))
