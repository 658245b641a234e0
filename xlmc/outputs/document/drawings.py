"""The pictures of a report, as SVG that needs no font but the one that Typst brings along."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity import ForecastSensitivity
from xlmc.excel.workbook.printable import printable
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.outputs.document.parts import Drawing
from xlmc.outputs.filter_effect import Shapes
from xlmc.outputs.histogram import Figure
from xlmc.outputs.page.svg import Scale, scale_of
from xlmc.outputs.sheets.styles import DARK, GRID, INK, LIGHT
from xlmc.outputs.summary import percent

__all__ = [
    "before_and_after",
    "drawing",
    "forecast_drawing",
    "influence_drawing",
    "line_to",
    "path_of",
    "text_at",
]

FONT = "Libertinus Serif"
_THRESHOLD = "#9C0006"
_POINTS = 401
_LONGEST = 40
_DASHES = ' stroke-dasharray="4 3"'

Floats = NDArray[np.float64]


def forecast_drawing(figure: Figure, result: ForecastResult, width: float) -> Drawing:
    """The frequency of a forecast's accepted trials, and below it their cumulative share, over one axis.

    Args:
        figure: the forecast.
        result: its trials.
        width: in millimetres.
    """
    left, right, top, middle, bottom = 62.0, 556.0, 14.0, 176.0, 306.0
    bins, answer = figure.bins, figure.answer
    first, last = float(bins.edges[0]), float(bins.upper_edges[-1])
    across = Scale(first, last, left, right, bins.width * bins.step)
    most = float((bins.inside + bins.outside).max())
    up = scale_of([0.0, 1.05 * max(most, 1.0)], middle, top, most=5)
    up = Scale(0.0, up.high, middle, top, up.step)
    found = [*_grid(up, left, right, "{:,.0f}")]
    for edge, upper, inside, outside in zip(bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True):
        x, wide = across(float(edge)), across(float(upper)) - across(float(edge))
        total, central = float(inside + outside), float(inside)
        found += [_rect(x, up(total), wide, middle - up(total), LIGHT)] if total else []
        found += [_rect(x, up(central), wide, middle - up(central), DARK)] if central else []
    found += [line_to(left, middle, right, middle, INK), text_at(16, (top + middle) / 2, "Trials", turned=True)]
    share = Scale(0.0, 100.0, bottom, middle + 16, 25.0)
    found += _grid(share, left, right, "{:.0f} %")
    low, high = (across(_near(end.value, first, last)) for end in (answer.low, answer.high))
    found.append(_rect(low, share(100.0), high - low, bottom - share(100.0), LIGHT, opacity=0.5))
    levels = np.linspace(0.0, 1.0, _POINTS)
    values = result.sample.quantile(levels)
    points = [
        (across(_near(float(v), first, last)), share(100.0 * float(q))) for v, q in zip(values, levels, strict=True)
    ]
    found.append(path_of(points, DARK, 1.6))
    found.append(text_at(16, (share(100.0) + bottom) / 2, "Not above", turned=True))
    if answer.threshold is not None and first <= answer.threshold <= last:
        x = across(answer.threshold)
        found += [line_to(x, top, x, bottom, _THRESHOLD, 1.0, dashed=True)]
        found.append(text_at(x + 3, top + 8, f"threshold {show(answer.threshold)}", anchor="start", fill=_THRESHOLD))
    mean = across(_near(answer.mean.value, first, last))
    found += [line_to(mean, top, mean, bottom, INK, 1.0)]
    found += [line_to(left, bottom, right, bottom, INK)]
    for edge, label in zip([*bins.edges, bins.upper_edges[-1]], [*bins.labels, bins.last_label], strict=True):
        if label:
            x = across(float(edge))
            found += [line_to(x, bottom, x, bottom + 4, INK), text_at(x, bottom + 15, label)]
    found.append(text_at((left + right) / 2, bottom + 32, answer.units or "value"))
    said = (
        f"{answer.name}: above, how many accepted trials lie in each interval; below, the share of them that is not "
        f"above each value. Dark: the central {percent(answer.share)}. The vertical line is the mean."
    )
    return drawing(found, 570.0, bottom + 40, said, width)


def before_and_after(name: str, shown: Shapes | None) -> Drawing | None:
    """How often an assumption has each value before filtering (pale), and in accepted trials (the line).

    Args:
        name: of the assumption.
        shown: its shapes; None where there are none to draw.
    """
    if shown is None:
        return None
    edges, pale, dark = shown.edges, shown.before, shown.accepted
    low, high = float(edges[0]), float(edges[-1])
    most = float(max(pale.max(), dark.max()))
    width, height, bottom = 150.0, 48.0, 34.0
    across = Scale(low, high, 1.0, width - 1.0, 1.0)
    up = Scale(0.0, most or 1.0, bottom, 2.0, 1.0)
    found = []
    outline: list[tuple[float, float]] = []
    for index in range(pale.size):
        x, upper = across(float(edges[index])), across(float(edges[index + 1]))
        found.append(_rect(x, up(float(pale[index])), upper - x, bottom - up(float(pale[index])), LIGHT))
        outline += [(x, up(float(dark[index]))), (upper, up(float(dark[index])))]
    found += [
        path_of([(1.0, bottom), *outline, (width - 1.0, bottom)], DARK, 1.3),
        line_to(1, bottom, width - 1, bottom, INK),
    ]
    first, last = (_end_text(end, high - low) for end in (low, high))
    found.append(text_at(1.0, height - 2, first, anchor="start", size=13))
    found.append(text_at(width - 1.0, height - 2, last, anchor="end", size=13))
    said = f"{name}: before filtering pale, accepted as a line, from {first} to {last}"
    return drawing(found, width, height, said, 28.0)


def _end_text(end: float, span: float) -> str:
    """An end of the draws, to some thousandths of what they reach over.

    >>> _end_text(0.0002339, 10.0), _end_text(0.60003, 0.35)
    ('0', '0.6')
    """
    digits = 2 - math.floor(math.log10(span)) if span > 0 else 6
    return f"{round(end, digits) + 0.0:.10g}"


def influence_drawing(found: ForecastSensitivity, most: int) -> Drawing:
    """The variance of a forecast that each assumption explains, as bars with whiskers; the largest on top."""
    shown = found.influences[:most]
    left, right, row = 220.0, 548.0, 17.0
    bottom = 6 + row * len(shown)
    shares = [(each.assumption, 100.0 * each.explained.value, each.explained.error) for each in shown]
    ends = [value + 100.0 * (error or 0.0) for _, value, error in shares if math.isfinite(value)]
    across = scale_of([0.0, *ends], left, right)
    across = Scale(min(0.0, min([*ends, 0.0])), across.high, left, right, across.step)
    drawn = []
    for tick in across.ticks:
        drawn += [
            line_to(across(tick), 6, across(tick), bottom, GRID),
            text_at(across(tick), bottom + 13, across.text(tick)),
        ]
    for index, (name, value, error) in enumerate(shares):
        top = 6 + row * index
        drawn.append(text_at(left - 6, top + 12, _short(name), anchor="end"))
        if not math.isfinite(value):
            continue
        drawn.append(_rect(across(0.0), top + 3, max(across(value) - across(0.0), 0.0), row - 6, DARK))
        if error:
            ends_x = (across(max(value - 100.0 * error, across.low)), across(value + 100.0 * error))
            drawn.append(line_to(ends_x[0], top + row / 2, ends_x[1], top + row / 2, INK))
    drawn += [line_to(across(0.0), 6, across(0.0), bottom, INK)]
    drawn.append(text_at((left + right) / 2, bottom + 28, "Share of the variance explained, %"))
    said = f"{found.forecast}: the variance that each assumption explains, the largest first"
    return drawing(drawn, 570.0, bottom + 34, said, 125.0)


def _near(value: float, low: float, high: float) -> float:
    return min(max(value, low), high) if math.isfinite(value) else low


def _short(name: str) -> str:
    return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"


def _grid(scale: Scale, left: float, right: float, form: str) -> list[str]:
    found = []
    for tick in scale.ticks:
        found.append(line_to(left, scale(tick), right, scale(tick), GRID))
        found.append(text_at(left - 6, scale(tick) + 4, form.format(tick), anchor="end"))
    return found


def drawing(found: Iterable[str], width: float, height: float, said: str, printed: float) -> Drawing:
    """The drawing; `printed` is its width in millimetres, `said` what it shows."""
    size = f'width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    return Drawing(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{"".join(found)}</svg>', said, printed)


def _rect(x: float, y: float, width: float, height: float, fill: str, *, opacity: float = 1.0) -> str:
    box = f'x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}"'
    return f'<rect {box} fill="{fill}" fill-opacity="{opacity:g}"/>'


def line_to(
    x1: float, y1: float, x2: float, y2: float, stroke: str, width: float = 0.7, *, dashed: bool = False
) -> str:
    """A straight line."""
    ends = f'x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"'
    return f'<line {ends} stroke="{stroke}" stroke-width="{width:g}"{_DASHES * dashed}/>'


def path_of(points: Sequence[tuple[float, float]], stroke: str, width: float, *, dashed: bool = False) -> str:
    """A line through points."""
    steps = " ".join(f"{'L' if index else 'M'}{x:.2f} {y:.2f}" for index, (x, y) in enumerate(points))
    return f'<path d="{steps}" fill="none" stroke="{stroke}" stroke-width="{width:g}"{_DASHES * dashed}/>'


def text_at(
    x: float,
    y: float,
    value: str,
    *,
    anchor: str = "middle",
    size: float = 11,
    fill: str = INK,
    turned: bool = False,
) -> str:
    """A text, whatever is in it."""
    look = f'font-family={quoteattr(FONT)} font-size="{size:g}" fill="{fill}" text-anchor="{anchor}"'
    turn = f' transform="rotate(-90 {x:.2f} {y:.2f})"' if turned else ""
    return f'<text x="{x:.2f}" y="{y:.2f}" {look}{turn}>{escape(printable(value))}</text>'
