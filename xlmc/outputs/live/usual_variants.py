"""Variants of a case that show how firm its answer is."""

from __future__ import annotations

from collections.abc import Iterator

from xlmc.analysis.results.statements.in_words import plain_text
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.outputs.live.adjustments import LIMITS, Adjustments, movable_limits

__all__ = ["usual_variants"]


def usual_variants(definitions: Definitions) -> dict[str, Adjustments]:
    """Return variants that show how firm an answer is: all ranges wider and narrower, each limit halved and doubled.

    Ranges are those of the assumptions with numbers `low` and `high`; a limit of 0 stays.
    """
    result: dict[str, Adjustments] = {}
    for label, factor in (("half as wide", 0.5), ("one and a half times as wide", 1.5)):
        made = Adjustments()
        for name, low, high in _ranges(definitions):
            middle, half = 0.5 * (low + high), 0.5 * (high - low) * factor
            for key, end in (("low", middle - half), ("high", middle + half)):
                made = made.having("assumption", name, key, float(f"{end:.12g}"))  # 0.6875, not 0.6874999999999999
        if made:
            result[f"every range {label}"] = made
    for filter_ in definitions.filters:
        for key, limit in movable_limits(filter_).items():
            if isinstance(limit, Cell) or not limit:
                continue
            for label, factor in (("half", 0.5), ("twice", 2.0)):
                name = f"{filter_.name} {LIMITS[key]} {plain_text(limit * factor)} ({label})"
                result[name] = Adjustments().having("filter", filter_.name, key, limit * factor)
    return result


def _ranges(definitions: Definitions) -> Iterator[tuple[str, float, float]]:
    """Return name, low and high of the drawn assumptions that are given by these two numbers."""
    for each in definitions.assumptions:
        low, high = each.parameters.get("low"), each.parameters.get("high")
        if not each.frozen and len(each.parameters) == 2 and isinstance(low, float) and isinstance(high, float):
            yield each.name, low, high
