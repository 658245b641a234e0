"""The drawings of a document, as SVG: a forecast's frequency and certainty, an assumption before and after filters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.report.histogram import Figure
from xlmc.report.page.element import Html, element, join
from xlmc.report.page.svg import Bar, bars, scale_of
from xlmc.report.summary import percent

__all__ = ["bar_picture", "before_and_after", "forecast_picture"]

_FONT = "Libertinus Serif"
_DARK, _PALE, _LINE, _GREY = "#1f5582", "#b9cfe2", "#b3541e", "#5c6670"
_WIDTH, _HEIGHT, _TOP = 640.0, 300.0, 26.0
_LEFT, _RIGHT, _BELOW = 62.0, 58.0, 48.0

_SMALL_WIDTH, _SMALL_HEIGHT, _BINS = 150.0, 34.0, 30

_STYLE = f"""
text {{ font-family: '{_FONT}'; font-size: 13px; fill: #222; }}
.title {{ font-weight: bold; }} .name {{ text-anchor: end; }} .tick {{ text-anchor: middle; }}
.dark {{ fill: {_DARK}; }} .light {{ fill: {_PALE}; }}
.grid {{ stroke: #ddd; stroke-width: 1; }} .axis {{ stroke: #444; stroke-width: 1; }}
.whisker {{ stroke: #444; stroke-width: 1.2; }}
"""

Floats = NDArray[np.float64]


def forecast_picture(figure: Figure) -> str:
    """How many accepted trials lie in each bin, dark in the central range, and the share of those below as a line."""
    bins, answer = figure.bins, figure.answer
    edges, counts = np.append(bins.edges, bins.upper_edges[-1]), bins.inside + bins.outside
    right, bottom = _WIDTH - _RIGHT, _HEIGHT - _BELOW
    low, high = float(edges[0]), float(edges[-1])
    y = scale_of([0.0, float(counts.max())], bottom, _TOP)
    ground = y(0.0)

    def x(value: float) -> float:
        return _LEFT + (right - _LEFT) * (value - low) / (high - low)

    def share(value: float) -> float:
        return ground - (ground - _TOP) * value

    found = [_line(_LEFT, y(tick), right, y(tick), "#dddddd") for tick in y.ticks if tick > 0]
    for at in range(bins.edges.size):
        left, width = x(float(edges[at])), x(float(edges[at + 1])) - x(float(edges[at]))
        inside, outside = float(bins.inside[at]), float(bins.outside[at])
        found.append(_box(left, y(inside), width, ground - y(inside), _DARK))
        found.append(_box(left, y(inside + outside), width, y(inside) - y(inside + outside), _PALE))
    below = (bins.below + np.append(0, np.cumsum(counts))) / max(1, answer.trials)
    path = " ".join(
        f"{'L' if at else 'M'}{x(float(edge)):.1f} {share(float(below[at])):.1f}" for at, edge in enumerate(edges)
    )
    found.append(element("path", d=path, fill="none", stroke=_LINE, stroke_width="1.8"))
    found.append(_line(_LEFT, ground, right, ground, "#444444"))
    for label, edge in zip([*bins.labels, bins.last_label], edges, strict=True):
        if label:
            found.append(_line(x(float(edge)), ground, x(float(edge)), ground + 4, "#444444"))
            found.append(_text(x(float(edge)), ground + 18, label, "middle"))
    found += [_text(_LEFT - 6, y(tick) + 4, f"{tick:,.0f}", "end") for tick in y.ticks if tick >= 0]
    found += [_text(right + 6, share(tick / 100) + 4, f"{tick} %", "start", _LINE) for tick in (0, 25, 50, 75, 100)]
    units = f", {answer.units}" if answer.units else ""
    found.append(_text((_LEFT + right) / 2, _HEIGHT - 8, f"{figure.name}{units}", "middle"))
    found.append(_text(_LEFT - 40, 14, "Accepted trials", "start"))
    found.append(_text(_WIDTH, 14, "Share of trials below", "end", _LINE))
    found.append(_text((_LEFT + right) / 2, 14, f"dark: the central {percent(answer.share)}", "middle", _DARK))
    return _drawing(found, _WIDTH, _HEIGHT)


def before_and_after(before: Floats, after: Floats) -> str:
    """An assumption's draws before filtering, as an outline, and the accepted ones, filled; both of one area."""
    before, after = before[np.isfinite(before)], after[np.isfinite(after)]
    low, high = (float(f(before)) for f in (np.min, np.max)) if before.size else (0.0, 1.0)
    if not high > low:
        return _drawing(
            [_line(0, _SMALL_HEIGHT - 4, _SMALL_WIDTH, _SMALL_HEIGHT - 4, _GREY)], _SMALL_WIDTH, _SMALL_HEIGHT
        )
    shares = [np.histogram(x, _BINS, (low, high))[0] / max(1, x.size) for x in (before, after)]
    top = max(float(np.max(each)) for each in shares)
    wide, ground = _SMALL_WIDTH / _BINS, _SMALL_HEIGHT - 4

    def height(value: float) -> float:
        return (ground - 3) * value / top

    found = [
        _box(at * wide, ground - height(float(value)), wide, height(float(value)), _DARK)
        for at, value in enumerate(shares[1])
        if value
    ]
    steps = " ".join(
        f"{'L' if at else 'M'}{at * wide:.1f} {ground - height(float(value)):.1f} L{(at + 1) * wide:.1f} "
        f"{ground - height(float(value)):.1f}"
        for at, value in enumerate(shares[0])
    )
    found.append(element("path", d=steps, fill="none", stroke=_LINE, stroke_width="1.3"))
    found.append(_line(0, ground, _SMALL_WIDTH, ground, _GREY))
    return _drawing(found, _SMALL_WIDTH, _SMALL_HEIGHT)


def bar_picture(drawn: Sequence[Bar], title: str, axis: str) -> str:
    """Bars from left to right, the first on top."""
    source = bars(drawn, title, axis).source
    return source.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1).replace(
        ">", f"><style>{_STYLE}</style>", 1
    )


def _drawing(found: Sequence[Html], width: float, height: float) -> str:
    inner = join(list(found)).source
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}">{inner}</svg>'


def _text(x: float, y: float, value: str, anchor: str, colour: str = "#222222") -> Html:
    return element(
        *("text", value),
        x=f"{x:.1f}",
        y=f"{y:.1f}",
        text_anchor=anchor,
        font_family=_FONT,
        font_size="13",
        fill=colour,
    )


def _box(x: float, y: float, width: float, height: float, colour: str) -> Html:
    box = {"x": f"{x:.1f}", "y": f"{y:.1f}", "width": f"{max(0.0, width - 0.6):.1f}", "height": f"{height:.1f}"}
    return element("rect", fill=colour, **box)


def _line(x1: float, y1: float, x2: float, y2: float, colour: str) -> Html:
    ends = {"x1": f"{x1:.1f}", "y1": f"{y1:.1f}", "x2": f"{x2:.1f}", "y2": f"{y2:.1f}"}
    return element("line", stroke=colour, stroke_width="1", **ends)
