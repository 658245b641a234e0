"""Certainty: the share of the accepted trials below, in and above each range, and of each answer that is no number."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from xlmc.analysis.results.statements.sentences import certainties
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.measured import counted_share
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table
from xlmc.outputs.summary import frequent_texts, shares_of

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.document.material import Material

__all__ = ["certainty_blocks", "section"]


def certainty_blocks(simulation: RunResult, names: Iterable[str]) -> Iterator[Block]:
    """Yield the certainty of the central range and the threshold of the forecasts of these names, and the share of
    each text and of yes and no.
    """
    rows = [(name, *row) for name in names for row in _rows(simulation.results[name])]
    if not rows:
        yield Paragraph("No forecast has an answer in an accepted trial.")
        return
    yield Table("", ("Forecast", "Range or answer", "Trials in it", "Certainty"), tuple(rows))


def _rows(result: ForecastResult) -> Iterator[tuple[Content, ...]]:
    frequent, others, left = frequent_texts(shares_of(result))
    for text, share in frequent.items():
        yield _row(text, share)
    if others:
        yield others, cells.count(round(left * result.statistics.trials)), Shown(left, "0.0%")
    for each in certainties(result):
        yield _row(each.words, each.share)


def _row(words: str, share: Estimate) -> tuple[Content, ...]:
    return words or "(empty)", cells.count(round(share.value * share.n)), counted_share(share)


def section(material: Material) -> Iterator[Block]:
    """Yield the certainty of ranges."""
    yield Paragraph("The share of the accepted trials below, in and above each range, as it is rounded here.")
    yield from certainty_blocks(material.simulation, material.forecasts)
