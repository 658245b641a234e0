"""What a run was asked, in words: the first sentences of the page and of the report."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.report.summary import share_text
from xlmc.results.record.in_words import limits_text
from xlmc.run.rare.account import probability_text

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["Name", "question"]


class Name(str):
    """A name from the workbook: it may be written from right to left, or be long."""

    __slots__ = ()


def question(simulation: Simulation) -> Iterator[str]:
    """The sentences, in pieces that follow each other; those that are a `Name` come from the workbook."""
    model = simulation.model
    yield (
        f"The workbook computes {_count_text(len(model.forecasts), 'answer (forecast)', 'answers (forecasts)')} from "
        f"{_count_text(len(model.live), 'quantity', 'quantities')} known only within ranges (assumptions). "
        f"{simulation.evaluated:,} combinations of values from these ranges were tried. "
    )
    if not model.filters:
        yield "The workbook has no filters: every trial is accepted."
        return
    if simulation.rare is None:
        yield f"{simulation.accepted:,} of them ({share_text(simulation.acceptance)}) agree with the evidence, which "
    else:
        yield f"{simulation.accepted:,} that agree with the evidence were kept; one as they come agrees with "
        yield f"probability {probability_text(simulation.rare)}. The evidence "
    yield "asks: "
    for index, filter_ in enumerate(model.filters):
        yield "; " if index else ""
        yield Name(filter_.name)
        yield f" {limits_text(filter_)}"
    yield ". The answers are those of these accepted trials."


def _count_text(count: int, one: str, several: str) -> str:
    return f"{count} {one if count == 1 else several}"
