"""Drawings for the page as SVG: bars, one for each assumption, and lines over the limit of a filter."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from xlmc.outputs.page.element import Html, element, join

__all__ = ["Bar", "Line", "Scale", "bars", "before_after", "lines", "scale_of"]

_WIDTH, _HEIGHT = 520, 260

_NAMES, _ROW, _MARGIN = 244, 20, 12

_BELOW = 44

_LONGEST = 37

_ROUND_STEPS = (1.0, 2.0, 5.0, 10.0)

_ROOM = 0.03


@dataclass(frozen=True, slots=True)
class Bar:
    """A named row of pieces, each from one number to another, in a look (`dark`, `light`), and a whisker."""

    name: str
    pieces: tuple[tuple[float, float, str], ...]
    whisker: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Line:
    """A named line through points (x, y), each with the error of y or None."""

    name: str
    points: tuple[tuple[float, float, float | None], ...]


def bars(drawn: Sequence[Bar], title: str, axis: str) -> Html:
    """Bars from left to right, the first on top, with a line at 0."""
    ends = [end for bar in drawn for piece in bar.pieces for end in piece[:2]]
    ends += [end for bar in drawn for end in bar.whisker or ()]
    bottom = 24 + _ROW * len(drawn)
    scale = scale_of([0.0, *ends], _NAMES, _WIDTH - _MARGIN)
    found = [_text(0, 14, title, "title"), *_across(scale, 24, bottom, axis)]
    for index, bar in enumerate(drawn):
        found += _bar(bar, 24 + _ROW * index, scale)
    found.append(_stroke(scale(0.0), 24, scale(0.0), bottom, "axis"))
    return _drawing(found, bottom + _BELOW, f"{title}: {', '.join(bar.name for bar in drawn)}")


def _bar(bar: Bar, top: float, scale: Scale) -> list[Html]:
    name = bar.name if len(bar.name) <= _LONGEST else f"{bar.name[: _LONGEST - 1]}…"
    found = [_text(_NAMES - 8, top + 14, name, "name")]
    for first, last, look in bar.pieces:
        left, right = sorted((scale(first), scale(last)))
        found.append(_rect(left, top + 3, right - left, _ROW - 6, look))
    if bar.whisker is not None:
        left, right, middle = scale(bar.whisker[0]), scale(bar.whisker[1]), top + _ROW / 2
        found.append(_stroke(left, middle, right, middle, "whisker"))
        found += [_stroke(end, middle - 3, end, middle + 3, "whisker") for end in (left, right)]
    return found


def lines(drawn: Sequence[Line], title: str, across: str, upwards: str, now: float) -> Html:
    """Lines with points, each with its number at the end; a dashed upright line at `now`."""
    left, bottom = 64, _HEIGHT - _BELOW
    points = [point for line in drawn for point in line.points if math.isfinite(point[1])]
    reach = [value for _, y, error in points for value in (y - (error or 0.0), y + (error or 0.0))]
    x = scale_of([now, *(point[0] for point in points)], left, _WIDTH - 3 * _MARGIN)
    y = scale_of([0.0, *reach], bottom, 30)
    found = [_text(0, 14, title, "title"), *_across(x, 30, bottom, across), _stroke(x(now), 30, x(now), bottom, "now")]
    for tick in y.ticks:
        found.append(_stroke(left, y(tick), _WIDTH - 3 * _MARGIN, y(tick), "grid"))
        found.append(_text(left - 6, y(tick) + 4, y.text(tick), "name"))
    found.append(_text(-(30 + bottom) / 2, 12, upwards, "upright"))
    for number, line in enumerate(drawn, 1):
        found += _line(line, number, x, y)
    return _drawing(found, _HEIGHT, f"{title}: {', '.join(line.name for line in drawn)}")


def before_after(before: Sequence[float], accepted: Sequence[float], said: str) -> Html:
    """How often an assumption has each value before filtering, pale, and among accepted draws, as a line.

    Args:
        before: `(n,)` shares of the draws in each bin.
        accepted: the same of the accepted draws.
        said: what it shows.
    """
    width, height = 176.0, 32.0
    step, most = width / len(before), max(*before, *accepted)
    found = [
        _rect(index * step, height * (1.0 - share / most), step, height * share / most, "light")
        for index, share in enumerate(before)
    ]
    tops = [1.0 + (height - 1.0) * (1.0 - share / most) for share in accepted]
    corners = [f"{index * step:.1f} {top:.1f}H{(index + 1) * step:.1f}" for index, top in enumerate(tops)]
    found.append(element("path", d="M" + "L".join(corners), class_="line"))
    box = f"0 0 {width:g} {height:g}"
    return element("svg", join(found), viewBox=box, role="img", aria_label=said, class_="shape")


def _line(line: Line, number: int, x: Scale, y: Scale) -> list[Html]:
    known = [(x(at), y(value), value, error) for at, value, error in line.points if math.isfinite(value)]
    if not known:
        return []
    look = f"line-{(number - 1) % 6 + 1}"
    path = " ".join(f"{'L' if index else 'M'}{at:.1f} {up:.1f}" for index, (at, up, _, _) in enumerate(known))
    found = [element("path", d=path, class_=f"line {look}")]
    for at, up, value, error in known:
        if error:
            found.append(_stroke(at, y(value - error), at, y(value + error), "whisker"))
        found.append(element("circle", cx=f"{at:.1f}", cy=f"{up:.1f}", r="2.5", class_=look))
    found.append(_text(known[-1][0] + 6, known[-1][1] + 4, str(number), "number"))
    return found


def _across(scale: Scale, top: float, bottom: float, axis: str) -> list[Html]:
    found = []
    for tick in scale.ticks:
        found.append(_stroke(scale(tick), top, scale(tick), bottom, "grid"))
        found.append(_text(scale(tick), bottom + 16, scale.text(tick), "tick"))
    return [*found, _text((scale.start + scale.stop) / 2, bottom + 36, axis, "tick")]


def _drawing(found: Sequence[Html], height: float, label: str) -> Html:
    return element(
        "svg", join(list(found)), viewBox=f"0 0 {_WIDTH} {height:g}", role="img", aria_label=label, class_="drawn"
    )


def _text(x: float, y: float, value: str, look: str) -> Html:
    return element("text", value, x=f"{x:.1f}", y=f"{y:.1f}", class_=look)


def _rect(x: float, y: float, width: float, height: float, look: str) -> Html:
    box = {"x": f"{x:.1f}", "y": f"{y:.1f}", "width": f"{width:.1f}", "height": f"{height:.1f}"}
    return element("rect", class_=look, **box)


def _stroke(x1: float, y1: float, x2: float, y2: float, look: str) -> Html:
    return element("line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=look)


@dataclass(frozen=True, slots=True)
class Scale:
    """A straight axis from `low` at `start` to `high` at `stop`, with round ticks `step` apart."""

    low: float
    high: float
    start: float
    stop: float
    step: float

    def __call__(self, value: float) -> float:
        """The coordinate of a number."""
        return self.start + (self.stop - self.start) * (value - self.low) / (self.high - self.low)

    @property
    def ticks(self) -> list[float]:
        """The multiples of the step within the scale."""
        first, last = math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9)
        return [float(f"{index * self.step:.12g}") for index in range(first, last + 1)]

    def text(self, tick: float) -> str:
        """A tick in the digits that the step needs."""
        return f"{tick:g}".replace("-", "−")


def scale_of(values: list[float], start: float, stop: float, *, most: int = 6) -> Scale:
    """A scale that reaches over all finite values, with a little room, and has `most` ticks at most.

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
    return Scale(low, high, start, stop, step)


def _round_above(width: float) -> float:
    power = 10.0 ** math.floor(math.log10(width))
    return power * next(factor for factor in _ROUND_STEPS if factor * power >= width * (1.0 - 1e-9))
