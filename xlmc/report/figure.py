"""A forecast as a figure: its histogram and the words that go with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.report.histogram import Histogram, histogram
from xlmc.report.summary import SummaryRow, estimate_text, percent, summarise

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["Figure", "figures_of", "varying"]

_LONGEST_NAME = 90


@dataclass(frozen=True, slots=True)
class Figure:
    """A forecast to draw; `number` counts from 1."""

    number: int
    answer: SummaryRow
    bins: Histogram

    @property
    def name(self) -> str:
        """The forecast's name, as long as a chart has room for."""
        name = self.answer.name
        return name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"

    @property
    def axis(self) -> str:
        """What stands below the bars: the units, and what a bar covers."""
        bars = f"bars {self.bins.width:g} wide, each labelled at its lower end"
        return f"{self.answer.units} ({bars})" if self.answer.units else f"B{bars[1:]}"

    @property
    def caption(self) -> str:
        """What the figure shows, in words."""
        row, bins = self.answer, self.bins
        units = f" {row.units}" if row.units else ""
        text = (
            f"Figure {self.number}. {self.name}: mean {estimate_text(row.mean)}{units}; the central "
            f"{percent(row.share)} of {row.trials:,} accepted trials lie from {estimate_text(row.low)} to "
            f"{estimate_text(row.high)}{units}."
        )
        if bins.below or bins.above:
            text += f" Not drawn: {bins.below:,} trials below and {bins.above:,} above."
        return text


def figures_of(simulation: Simulation) -> list[Figure]:
    """Every forecast that has a number in an accepted trial."""
    found: list[Figure] = []
    for row in summarise(simulation):
        bins = histogram(simulation.results[row.name].sample, row.low.value, row.high.value)
        if bins is not None:
            found.append(Figure(len(found) + 1, row, bins))
    return found


def varying(figures: Sequence[Figure]) -> list[Figure]:
    """The figures, without forecasts that are the same in all trials: their curve would be a step."""
    return [figure for figure in figures if figure.answer.standard_deviation.value > 0.0]
