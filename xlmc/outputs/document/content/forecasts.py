"""The forecasts: a figure of each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.number_text import counted_text, percent
from xlmc.outputs.document.charts import shares_chart
from xlmc.outputs.document.drawings import forecast_drawing
from xlmc.outputs.document.parts import HALF, Block, Figure, Paragraph
from xlmc.outputs.histogram import figures_of, not_drawn
from xlmc.outputs.summary import answer_text, central_text

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


_FEW: Final = 4
"""Forecasts whose figures are large, two a page; those of more stand side by side, eight a page."""
_MOST_FIGURES: Final = 12
"""Forecasts that a report draws."""
_LARGE: Final = 160.0
"""The width of the figures of few forecasts, in millimetres."""
_HOW_TO_READ: Final = (
    "Above in each figure: how many accepted trials lie in each bar; below: the share of them that is not above each "
    "value. Dark: the central range. Upright line: the mean."
)


def section(material: Material) -> Iterator[Block]:
    """Yield a figure of each chosen forecast."""
    simulation = material.simulation
    width = _LARGE if len(material.once) <= _FEW else HALF
    shown = figures_of(simulation, material.once)
    if len(shown) > _MOST_FIGURES:
        yield Paragraph(
            f"Figures of the first {_MOST_FIGURES} of {len(shown)} forecasts. The sheet Charts of the result workbook "
            f"and the page show {_many(simulation)}; --forecasts chooses those of the report."
        )
    if not all(figure.answer.is_share for figure in shown[:_MOST_FIGURES]):
        yield Paragraph(_HOW_TO_READ)
    for figure in shown[:_MOST_FIGURES]:
        row, bins = figure.answer, figure.bins
        units = f" {row.units}" if row.units else ""
        wide = f" Bars: {bins.form.width(bins.width)}{units}." if bins.names is None else ""
        caption = (
            f"{material.called(row.name)}: mean {answer_text(row)}{units}; central {percent(row.share)} from "
            f"{central_text(row)}{units}.{wide}"
        )
        if row.is_share:
            caption = f"{figure.name}: {figure.description}."
        if bins.counted < row.trials:
            caption += f" Trials are weighted: the figure shows {counted_text(bins.counted, 'trial')} of equal weight."
        if bins.below or bins.above:
            caption += not_drawn(bins)
        drawing = (
            shares_chart(figure) if row.is_share else forecast_drawing(figure, simulation.results[row.name], width)
        )
        yield Figure(drawing, caption)


def _many(simulation: RunResult) -> str:
    """Return how many forecasts sheets and page draw, in words."""
    drawn_count = len(simulation.detailed)
    return "all of them" if drawn_count == len(simulation.model.forecasts) else f"the first {drawn_count} (--detailed)"
