"""Tell what a model shares with the one that it was changed from: nodes, and programs compiled for certain draws."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from xlmc.engine.passes.bounds import Bounds
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions, Forecast
from xlmc.montecarlo.model.needed import targets_of

__all__ = ["asks_for_the_same", "hull"]


def hull(first: Mapping[str, Bounds], second: Mapping[str, Bounds]) -> dict[str, Bounds]:
    """Return the ends that hold the draws of two models, and more where a range was moved; none where either
    has none.
    """
    return {name: _wider(ends, second[name]) for name, ends in first.items() if name in second}


def _wider(first: Bounds, second: Bounds) -> Bounds:
    """Bounds that hold both; those of a range that was moved twice as wide, as it will be moved again.

    They stay on their side of 0, which roots and divisors depend on.
    """
    low, high = min(first[0], second[0]), max(first[1], second[1])
    if (low, high) == first:
        return first
    lowest, highest = low - (high - low), high + (high - low)
    return max(lowest, 0.0) if low >= 0.0 else lowest, min(highest, 0.0) if high <= 0.0 else highest


def asks_for_the_same(old: Definitions, new: Definitions, live: Collection[str]) -> bool:
    """Whether two definitions ask for the same cells, so that only numbers can be others.

    Args:
        old: of a workbook.
        new: of the same one, changed.
        live: names of the assumptions that the old ones draw.
    """
    if (old.checks, old.forecast_filters) != (new.checks, new.forecast_filters):
        return False
    if [_asked_of(each) for each in old.forecasts] != [_asked_of(each) for each in new.forecasts]:
        return False
    if old.rewritten is not new.rewritten:
        return False
    if len(old.assumptions) != len(new.assumptions) or len(old.filters) != len(new.filters):
        return False
    pairs = zip(old.assumptions, new.assumptions, strict=True)
    if any(a is not b and _cells_of(a, live) != _cells_of(b, live) for a, b in pairs):
        return False
    return all(targets_of((), (a,)) == targets_of((), (b,)) for a, b in zip(old.filters, new.filters, strict=True))


def _asked_of(forecast: Forecast) -> Forecast:
    """Return what is computed of a forecast, without how it is stated."""
    return replace(forecast, threshold=None, central=0.5)


def _cells_of(assumption: Assumption, live: Collection[str]) -> tuple[object, ...]:
    """Return what the nodes depend on of an assumption; the base value of a drawn assumption is not among it."""
    frozen = None if assumption.name in live else assumption.base
    return assumption.name, assumption.cell, assumption.frozen, assumption.formulas, assumption.data, frozen
