"""Every chart as SVG, for pages, PDF and Word: it needs no font but the one that Typst brings along."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from html import escape

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.workbook.printable import printable
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.number_text import fixed_text, number_text, percent, two_digit_exponent
from xlmc.outputs.document.colours import COLOURS, DARK, GRID, INK, LIGHT
from xlmc.outputs.document.parts import HALF, Bar, Bars, Chart, Drawing, Line, Lines, Shape
from xlmc.outputs.histogram import Figure, Histogram, short_name

__all__ = [
    "FONT",
    "Scale",
    "drawing",
    "drawn",
    "forecast_drawing",
    "line_to",
    "path_of",
    "scale_of",
    "text_at",
]

FONT = "Libertinus Serif"
_THRESHOLD = "#9C0006"
_POINTS = 401
_LONGEST, _BESIDE = 40, 20
"""Characters of a name at the left of a bar, and beside the lines."""
_FILLS = {"dark": DARK, "light": LIGHT}
_ROUND_STEPS = (1.0, 2.0, 5.0, 10.0)
_ROOM = 0.03
_DASHES = ' stroke-dasharray="4 3"'

Floats = NDArray[np.float64]


def forecast_drawing(figure: Figure, result: ForecastResult, width: float) -> Drawing:
    """Draw the frequency of a forecast's accepted trials, and below it their cumulative share, over one axis.

    Args:
        figure: the forecast.
        result: its trials.
        width: in millimetres; a narrow one has fewer details, so that its letters are hardly smaller.
    """
    half = width <= HALF
    left, top, whole = 62.0, 14.0, 420.0 if half else 570.0
    right = whole - 14.0
    middle, bottom = (106.0, 186.0) if half else (176.0, 306.0)
    bins, answer = figure.bins, figure.answer
    first, last = float(bins.edges[0]), float(bins.upper_edges[-1])
    across = Scale(first, last, left, right, bins.width * bins.step)
    most = float((bins.inside + bins.outside).max())
    up = scale_of([0.0, 1.05 * max(most, 1.0)], middle, top, most=5)
    up = Scale(0.0, up.high, middle, top, up.step)
    results = [*_grid(up, left, right, "")]
    for edge, upper, inside, outside in zip(bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True):
        x, wide = across(float(edge)), across(float(upper)) - across(float(edge))
        total, central = float(inside + outside), float(inside)
        results += [_rect(x, up(total), wide, middle - up(total), LIGHT)] if total else []
        results += [_rect(x, up(central), wide, middle - up(central), DARK)] if central else []
    results += [line_to(left, middle, right, middle, INK), text_at(16, (top + middle) / 2, "Trials", turned=True)]
    share = Scale(0.0, 100.0, bottom, middle + 16, 25.0)
    results += _grid(share, left, right, " %")
    low, high = (across(_near(end.value, first, last)) for end in (answer.low, answer.high))
    results.append(_rect(low, share(100.0), high - low, bottom - share(100.0), LIGHT, opacity=0.5))
    levels = np.linspace(0.0, 1.0, _POINTS)
    values = result.sample.quantile(levels)
    points = [
        (across(_near(float(v), first, last)), share(100.0 * float(q))) for v, q in zip(values, levels, strict=True)
    ]
    results.append(path_of(points, DARK, 1.6))
    results.append(text_at(16, (share(100.0) + bottom) / 2, "Not above", turned=True))
    if answer.threshold is not None and first <= answer.threshold <= last:
        x = across(answer.threshold)
        results += [line_to(x, top, x, bottom, _THRESHOLD, 1.0, dashed=True)]
        limit = f"threshold {answer.form.number(answer.threshold)}"
        results.append(text_at(x + 3, top + 8, limit, anchor="start", fill=_THRESHOLD))
    mean = across(_near(answer.mean.value, first, last))
    results += [line_to(mean, top, mean, bottom, INK, 1.0)]
    results += [line_to(left, bottom, right, bottom, INK)]
    middles = 0.0 if bins.names is None else bins.width / 2.0
    edges = [(across(float(edge) + middles), label) for edge, label in _labelled(bins)]
    for x, label in _apart(edges):
        results += [line_to(x, bottom, x, bottom + 4, INK), text_at(x, bottom + 15, label)]
    results.append(text_at((left + right) / 2, bottom + 32, answer.units or "value"))
    message = (
        f"{answer.name}: above, how many accepted trials lie in each interval; below, the share of them that is not "
        f"above each value. Dark: the central {percent(answer.share)}. The vertical line is the mean."
    )
    return drawing(results, whole, bottom + 40, message, width)


def _labelled(bins: Histogram) -> list[tuple[float, str]]:
    """Return the edges of bins that have a label, each with its label."""
    edges, labels = [*bins.edges, bins.upper_edges[-1]], [*bins.labels, bins.last_label]
    return [(float(edge), label) for edge, label in zip(edges, labels, strict=True) if label]


def _apart(marks: list[tuple[float, str]]) -> list[tuple[float, str]]:
    """Return as many marks, equally far from each other, as leave their texts room beside each other."""
    if len(marks) < 2:
        return marks
    wide = _CHARACTER * (max(len(text) for _, text in marks) + 1)
    return marks[:: max(math.ceil(wide / (marks[1][0] - marks[0][0])), 1)]


def drawn(chart: Chart) -> Drawing:
    """Draw a chart as SVG."""
    match chart.data:
        case Bars():
            return _bars(chart, chart.data)
        case Lines():
            return _lines(chart, chart.data)
        case Shape():
            return _shape(chart, chart.data)


def _bars(chart: Chart, shown: Bars) -> Drawing:
    """Bars with their names at the left, over grid lines; a line at 0."""
    left, right, row = 220.0, 548.0, 17.0
    top = 26.0 if chart.title else 6.0
    bottom = top + row * len(shown.bars)
    ends = [0.0, *shown.ends]
    across = scale_of(ends, left, right, form=shown.form)
    if min(ends) == 0.0:
        across = replace(across, low=0.0)
    result = _title(chart)
    result += [line_to(across(tick), top, across(tick), bottom, GRID) for tick in across.ticks]
    result += [text_at(across(tick), bottom + 13, text) for tick, text in across.apart]
    for index, bar in enumerate(shown.bars):
        result += _bar(bar, top + row * index, row, left, across)
    result.append(line_to(across(0.0), top, across(0.0), bottom, INK))
    result.append(text_at((left + right) / 2, bottom + 28, chart.across_and_looks))
    return drawing(result, 570.0, bottom + 34, chart.description, chart.width)


def _bar(bar: Bar, top: float, row: float, left: float, across: Scale) -> list[str]:
    result = [text_at(left - 6, top + 12, short_name(bar.name, _LONGEST), anchor="end")]
    for first, last, look in bar.pieces:
        if math.isfinite(first) and math.isfinite(last):
            start, stop = sorted((across(first), across(last)))
            result.append(_rect(start, top + 3, stop - start, row - 6, _FILLS[look]))
    if bar.whisker is not None and all(map(math.isfinite, bar.whisker)):
        start, stop = map(across, bar.whisker)
        middle = top + row / 2
        result.append(line_to(start, middle, stop, middle, INK))
        result += [line_to(end, middle - 3, end, middle + 3, INK) for end in (start, stop)]
    return result


def _lines(chart: Chart, shown: Lines) -> Drawing:
    """Lines over grid lines, with their names beside them."""
    right, top, bottom = 420.0, 26.0 if chart.title else 10.0, 250.0
    points = [point for line in shown.all for point in _finite(line)]
    known = [shown.now] if shown.now is not None else []
    if shown.share:
        y = scale_of([0.0, 1.0], bottom, top, form=Form(Kind.PERCENT))
    else:
        y = scale_of(shown.heights, bottom, top, form=shown.form_upwards)
    left = max(60.0, 34.0 + _CHARACTER * max((len(text) for _, text in y.marks), default=0))
    x = scale_of([*known, *(point[0] for point in points)], left, right, form=shown.form_across)
    result = _title(chart)
    for tick, text in y.marks:
        result += [line_to(left, y(tick), right, y(tick), GRID), text_at(left - 6, y(tick) + 4, text, anchor="end")]
    result += [text_at(x(tick), bottom + 15, text) for tick, text in x.apart]
    result.append(line_to(left, bottom, right, bottom, INK))
    if shown.now is not None:
        result.append(line_to(x(shown.now), top, x(shown.now), bottom, INK, dashed=True))
    if shown.cloud is not None:
        result += [_dot(x(a), y(b)) for a, b, _ in _finite(shown.cloud)]
        at = top + 14 + 18 * len(shown.lines)
        result += [
            _dot(right + 23, at),
            text_at(right + 40, at + 4, short_name(shown.cloud.name, _BESIDE), anchor="start"),
        ]
    for index, line in enumerate(shown.lines):
        colour, at = COLOURS[index % len(COLOURS)], top + 14 + 18 * index
        width = 1.4 if index else 2.2
        ends = _finite(line)
        result.append(path_of([(x(a), y(b)) for a, b, _ in ends], colour, width) if ends else "")
        for a, b, error in ends if shown.dots else ():
            result += [line_to(x(a), y(b - error), x(a), y(b + error), INK)] if error else []
            result.append(f'<circle cx="{x(a):.2f}" cy="{y(b):.2f}" r="2.5" fill="{colour}"/>')
        result += [
            line_to(right + 12, at, right + 34, at, colour, width),
            text_at(right + 40, at + 4, short_name(line.name, _BESIDE), anchor="start"),
        ]
    result.append(text_at((left + right) / 2, bottom + 34, chart.across))
    result.append(text_at(14, (top + bottom) / 2, shown.upwards, turned=True))
    names = max((len(short_name(line.name, _BESIDE)) for line in shown.all), default=0)
    return drawing(result, max(570.0, right + 44.0 + _CHARACTER * names), bottom + 42, chart.description, chart.width)


def _dot(x: float, y: float) -> str:
    """Draw a point of a cloud."""
    return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="1.3" fill="{INK}" fill-opacity="0.35"/>'


def _finite(line: Line) -> list[tuple[float, float, float | None]]:
    """Return the points with a finite height as (x, y, error); the error is None where there is none."""
    return [(p[0], p[1], p[2] if len(p) > 2 else None) for p in line.points if math.isfinite(p[1])]


def _title(chart: Chart) -> list[str]:
    return [text_at(0, 14, chart.title, anchor="start", size=13)] if chart.title else []


def _shape(chart: Chart, shown: Shape) -> Drawing:
    """How often an assumption has each value before filtering (pale), and in accepted trials (the line)."""
    low, high = shown.edges[0], shown.edges[-1]
    most = max(*shown.before, *shown.accepted)
    width, height, bottom = 150.0, 48.0, 34.0
    across = Scale(low, high, 1.0, width - 1.0, 1.0)
    up = Scale(0.0, most or 1.0, bottom, 2.0, 1.0)
    result = []
    outline: list[tuple[float, float]] = []
    for index, (before, accepted) in enumerate(zip(shown.before, shown.accepted, strict=True)):
        x, upper = across(shown.edges[index]), across(shown.edges[index + 1])
        result.append(_rect(x, up(before), upper - x, bottom - up(before), LIGHT))
        outline += [(x, up(accepted)), (upper, up(accepted))]
    result += [
        path_of([(1.0, bottom), *outline, (width - 1.0, bottom)], DARK, 1.3),
        line_to(1, bottom, width - 1, bottom, INK),
    ]
    plain = shown.form == PLAIN
    first, last = (end_text(end, high - low) if plain else shown.form.number(end) for end in (low, high))
    result.append(text_at(1.0, height - 2, first, anchor="start", size=13))
    result.append(text_at(width - 1.0, height - 2, last, anchor="end", size=13))
    return drawing(result, width, height, f"{chart.description}, from {first} to {last}", chart.width)


def end_text(end: float, span: float) -> str:
    """Return an end of the draws as text, rounded to some thousandths of their span, which is 0 or more.

    >>> end_text(0.0002339, 10.0), end_text(0.60003, 0.35)
    ('0', '0.6')
    """
    digits = 2 - math.floor(math.log10(span)) if span > 0 else 6
    return number_text(round(end, digits) + 0.0, 10)


def _near(value: float, low: float, high: float) -> float:
    return min(max(value, low), high) if math.isfinite(value) else low


def _grid(scale: Scale, left: float, right: float, unit: str) -> list[str]:
    result = []
    for tick in scale.ticks:
        result.append(line_to(left, scale(tick), right, scale(tick), GRID))
        result.append(text_at(left - 6, scale(tick) + 4, f"{fixed_text(tick, 0)}{unit}", anchor="end"))
    return result


def drawing(result: Iterable[str], width: float, height: float, message: str, printed: float) -> Drawing:
    """Return SVG elements as one drawing.

    Args:
        result: the elements.
        width: of the drawing area, in its own units.
        height: of the drawing area, in its own units.
        message: what it shows, for readers who cannot see it.
        printed: its width on paper, in millimetres.
    """
    size = f'width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    return Drawing(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{"".join(result)}</svg>', message, printed)


def _rect(x: float, y: float, width: float, height: float, fill: str, *, opacity: float = 1.0) -> str:
    box = f'x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}"'
    return f'<rect {box} fill="{fill}" fill-opacity="{opacity:g}"/>'


def line_to(
    x1: float, y1: float, x2: float, y2: float, stroke: str, width: float = 0.7, *, dashed: bool = False
) -> str:
    """Draw a straight line."""
    ends = f'x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"'
    return f'<line {ends} stroke="{stroke}" stroke-width="{width:g}"{_DASHES * dashed}/>'


def path_of(points: Sequence[tuple[float, float]], stroke: str, width: float, *, dashed: bool = False) -> str:
    """Draw a line through points."""
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
    """Write a text at a point; markup in it is escaped."""
    look = f'font-family="{FONT}" font-size="{size:g}" fill="{fill}" text-anchor="{anchor}"'
    turn = f' transform="rotate(-90 {x:.2f} {y:.2f})"' if turned else ""
    return f'<text x="{x:.2f}" y="{y:.2f}" {look}{turn}>{escape(printable(value), quote=False)}</text>'


@dataclass(frozen=True, slots=True)
class Scale:
    """A straight axis from `low` at `start` to `high` at `stop`, with round ticks `step` apart, written in a form."""

    low: float
    high: float
    start: float
    stop: float
    step: float
    form: Form = PLAIN

    def __call__(self, value: float) -> float:
        """Return the coordinate of a number."""
        return self.start + (self.stop - self.start) * (value - self.low) / (self.high - self.low)

    @property
    def ticks(self) -> list[float]:
        """The multiples of the step within the scale."""
        first, last = math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9)
        return [float(f"{index * self.step:.12g}") for index in range(first, last + 1)]

    @property
    def marks(self) -> list[tuple[float, str]]:
        """The ticks with their texts, which have a true minus sign where they are numbers."""
        decimals = max(-two_digit_exponent(self.step), 0)
        result = [(tick, self.form.tick(tick, decimals)) for tick in self.ticks]
        return result if self.form.kind is Kind.DATE else [(tick, text.replace("-", "−")) for tick, text in result]

    @property
    def apart(self) -> list[tuple[float, str]]:
        """As many of the ticks as leave their texts room beside each other."""
        result = self.marks
        wide = _CHARACTER * max((len(text) for _, text in result), default=0) + _CHARACTER
        room = abs(self.stop - self.start) * (self.step / (self.high - self.low))
        return result[:: max(math.ceil(wide / room), 1)]


_CHARACTER = 7.0
"""The width of a digit in a text of the usual size, in the widest of the letters that a page may have."""


def scale_of(values: list[float], start: float, stop: float, *, most: int = 6, form: Form = PLAIN) -> Scale:
    """Return a scale from `start` to `stop` over all finite values, with a small margin and at most `most` ticks.

    The ticks of dates and times are round ones.

    >>> scale_of([0.0, 0.93], 0.0, 100.0).ticks
    [0.0, 0.2, 0.4, 0.6, 0.8]
    """
    known = [value for value in values if math.isfinite(value)] or [0.0]
    low, high = min(known), max(known)
    if high - low <= 1e-12 * max(abs(low), abs(high), 1e-300):
        margin = 0.5 * abs(low) or 0.5
        low, high = low - margin, high + margin
    else:
        low, high = low - _ROOM * (high - low), high + _ROOM * (high - low)
    step = _round_above((high - low) / most)
    return Scale(low, high, start, stop, form.rounded_width(step), form)


def _round_above(width: float) -> float:
    power = 10.0 ** math.floor(math.log10(width))
    return power * next(factor for factor in _ROUND_STEPS if factor * power >= width * (1.0 - 1e-9))
