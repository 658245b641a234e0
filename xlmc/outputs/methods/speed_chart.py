"""What the chart of speed against accuracy shows; matplotlib draws it on the page, Excel in the workbook.

Across: the work of a run, seconds or evaluations. Upwards: what 95 of 100 runs keep within, in the number that a method
has most trouble with; in % of the forecast's 5–95 % range, or as a multiple of the accuracy where that was given in
units. At the right, words at the ends of the lines stand in a column, apart from each other, in the lines' order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from xlmc.analysis.studies.methods import Curve, Study
from xlmc.analysis.studies.methods.answer import seconds_text, trials_text
from xlmc.analysis.studies.methods.law import law
from xlmc.analysis.studies.methods.need import Choice, Need, choice, reach_of, seconds_of, worst_error
from xlmc.montecarlo.number_text import number_text
from xlmc.outputs.methods.methods_tables import near_text

__all__ = [
    "HOW_TO_READ",
    "Label",
    "Line",
    "Mark",
    "Picture",
    "Point",
    "Work",
    "column_of",
    "guides_of",
    "picture_of",
    "spread",
]


Work = Literal["seconds", "evaluations"]

HOW_TO_READ: Final = (
    "Each line is one method: to the right its runs take longer, and further down its answer is nearer to the truth, "
    "so the best method at an accuracy is the one whose line meets that accuracy's level line farthest to the left.",
    "The texts at the line ends say what each method needs for both marked accuracies; a method that says “never” "
    "stays above them however long it runs.",
)

FINER: Final = 10.0
"""The second accuracy that is marked, over the one asked for."""

_WORDS: Final = 0.033
"""The height of a line of words, as a share of the panel's."""

_NAMED: Final = 3
"""Methods that tie, by name; the others are counted."""

_AHEAD: Final = 6
"""Points of the dashed part of a line."""


@dataclass(frozen=True, slots=True)
class Point:
    """One run length: its work, what 95 of 100 runs keep within, and where that lies with 95 % confidence."""

    x: float
    y: float
    low: float
    high: float


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A method.

    Attributes:
        curve: whose.
        points: measured.
        ahead: where the line goes on, by the law that was fitted, to the finer accuracy; empty where it does not.
        needs: what it needs, in words.
        brief: the same as briefly as a heading of the column allows, `0.35 s, 35 s`.
        once: whether it is a single answer.
    """

    curve: Curve
    points: tuple[Point, ...]
    ahead: tuple[tuple[float, float], ...]
    needs: str
    brief: str
    once: bool

    @property
    def name(self) -> str:
        return self.curve.method.name


@dataclass(frozen=True, slots=True)
class Mark:
    """A height with lines of words: an accuracy, and what is cheapest there."""

    y: float
    words: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """The chart.

    Attributes:
        across, upwards: what the axes show.
        lines: the methods that have a number to show.
        marks: the accuracy asked for, and a finer one.
        chosen: where the recommended method has the accuracy asked for, and its words; None without one.
        frame: left, right, bottom, top.
        absent: what is not drawn, in words.
        brief: what the brief needs are the needs for.
    """

    across: str
    upwards: str
    lines: tuple[Line, ...]
    marks: tuple[Mark, ...]
    chosen: tuple[float, float, str] | None
    frame: tuple[float, float, float, float]
    absent: tuple[str, ...]
    brief: str


@dataclass(frozen=True, slots=True, eq=False)
class Label:
    """Words for the column at the right, and where on the chart they belong to; the recommended run has no `line`."""

    text: str
    brief: str
    x: float
    y: float
    line: Line | None


def column_of(picture: Picture) -> list[Label]:
    """Order the labels from the top: those of one height from the left, so that what leads to them does not cross."""
    labels = [
        Label(f"{line.name}: {line.needs}", f"{line.name}: {line.brief}", *_end(line, picture.frame[1]), line)
        for line in picture.lines
    ]
    if picture.chosen is not None:
        x, y, text = picture.chosen
        labels.append(Label(text, text, x, y, None))
    return sorted(labels, key=lambda each: (-round(math.log10(each.y), 3), each.x))


def _end(line: Line, right: float) -> tuple[float, float]:
    """Return the point that a line's label belongs to: the end of its dotted part, or else its last measured point."""
    if line.once:
        return right, line.points[-1].y
    return line.ahead[-1] if line.ahead else (line.points[-1].x, line.points[-1].y)


def guides_of(picture: Picture, bottom: float) -> tuple[float, float]:
    """Return the start of the lines of slope −1/2 and −1, and the decades over which they fall, in the larger gap
    between words.

    Args:
        picture: the chart.
        bottom: of the frame as it is drawn.
    """
    left, right, _, top = picture.frame
    asked, finer = picture.marks
    high = math.log10(top / bottom)
    above = math.log10(top / asked.y) - _WORDS * high * (len(asked.words) + 1)
    below = math.log10(finer.y / bottom)
    start = top if above > below else finer.y
    fall = min(0.8 * max(above, below) - 0.07 * high, 0.15 * math.log10(right / left))
    return start / 10.0 ** (0.07 * high), max(fall, 0.05 * high)


def picture_of(study: Study, work: Work) -> Picture | None:
    """Make the chart of a study; None if no forecast varies."""
    if not study.varying:
        return None
    result, finer = choice(study), choice(study, _finer(study))
    scale = _scale(study)
    lines, absent = [], []
    for curve in study.every:
        if not curve.answers:
            continue
        if not all(runs.measured for runs in curve.lengths):
            absent.append(f"{curve.method.name} is not drawn: {_needs(study, curve, result, finer)}.")
            continue
        line = _line(study, curve, work, scale, result, finer)
        if line.points:
            lines.append(line)
    marks = (
        Mark(scale, _mark(study, scale, study.accuracy, result, ", as asked for")),
        Mark(scale / FINER, _mark(study, scale / FINER, _finer(study), finer, "")),
    )
    return Picture(
        across="time of a run, s" if work == "seconds" else "evaluations of the workbook in a run",
        upwards=_upwards(study),
        lines=tuple(lines),
        marks=marks,
        chosen=_recommended_run(study, result, work, scale),
        frame=_frame(lines, scale),
        absent=tuple(absent),
        brief=f"needs for {_accuracy_text(study, scale)}, for {_accuracy_text(study, scale / FINER)}",
    )


def _finer(study: Study) -> tuple[str, float, bool]:
    _, value, relative = study.accuracy
    return _accuracy_text(study, _scale(study) / FINER), value / FINER, relative


def _scale(study: Study) -> float:
    """Return the accuracy asked for, as the chart counts."""
    _, value, relative = study.accuracy
    return 100.0 * value if relative else 1.0


def _accuracy_text(study: Study, height: float) -> str:
    _, value, relative = study.accuracy
    return f"{number_text(height)} %" if relative else number_text(height * value)


def _upwards(study: Study) -> str:
    if study.accuracy[2]:
        return "error of the worst number, % of its 5–95 % range"
    return f"error of the worst number, over the {study.accuracy[0]} asked for"


def _line(study: Study, curve: Curve, work: Work, scale: float, result: Choice, finer: Choice) -> Line:
    once = curve in study.once
    kind = _kind(study, curve, result)
    points = []
    for runs in curve.lengths:
        y, low, high = (scale * each for each in reach_of(study, curve, runs, kind))
        x = float(getattr(runs, work))
        if np.isfinite(y) and y > 0.0 and np.isfinite(x) and x > 0.0:
            points.append(Point(x, y, low, high))
    ahead = () if once or not points else _ahead(study, curve, work, scale, kind, result.needs[curve])
    words = _needs(study, curve, result, finer), _briefly(study, curve, result, finer)
    return Line(curve, tuple(points), ahead, *words, once)


def _kind(study: Study, curve: Curve, result: Choice) -> tuple[str, str]:
    """Return the number that a method has most trouble with."""
    worst = worst_error(study, curve) if curve in study.once else result.needs[curve]
    return worst.forecast, worst.statistic


def _ahead(
    study: Study, curve: Curve, work: Work, scale: float, kind: tuple[str, str], wanted: Need
) -> tuple[tuple[float, float], ...]:
    """Return the dotted part of a line, from the longest runs to the finer accuracy; nothing where the method never
    reaches it.
    """
    tolerance = study.tolerance(kind[0])
    rule = law(study, curve, kind)
    budget = float(curve.lengths[-1].budget)
    most = rule.trials(tolerance / FINER)
    if not wanted.usable or not np.isfinite(most) or most <= budget:
        return ()
    trials = np.geomspace(budget, most, _AHEAD).tolist()
    return tuple((_work_of(curve, work, each), scale * rule.reach(each) / tolerance) for each in trials)


def _work_of(curve: Curve, work: Work, trials: float) -> float:
    if work == "seconds":
        return seconds_of(curve, trials)
    across = np.array([float(runs.budget) for runs in curve.lengths])
    spent = np.array([runs.evaluations for runs in curve.lengths])
    if trials <= across[-1]:
        return float(np.interp(trials, across, spent))
    each = float((spent[-1] - spent[-2]) / (across[-1] - across[-2])) if across.size > 1 else 1.0
    return float(spent[-1]) + each * (trials - float(across[-1]))


def _needs(study: Study, curve: Curve, result: Choice, finer: Choice) -> str:
    """`1 % in 0.35 s, 0.1 % in 35 s`, or `never`."""
    texts = [_accuracy_text(study, _scale(study) / part) for part in (1.0, FINER)]
    if curve in study.once:
        near = worst_error(study, curve)
        if near.reaches == "unknown":
            return f"cannot tell at {texts[0]}"
        return "never" if near.reaches == "no" else f"within {texts[0]}" + _also(near.times, texts[1])
    needs = [each.needs[curve] for each in (result, finer)]
    if needs[0].reaches == "no":
        return "never"
    return ", ".join(f"{text} {_when(each)}" for text, each in zip(texts, needs, strict=True))


def _briefly(study: Study, curve: Curve, result: Choice, finer: Choice) -> str:
    """`0.35 s, 35 s`, or `never`."""
    if curve in study.once:
        return near_text(study, curve)
    needs = [each.needs[curve] for each in (result, finer)]
    if needs[0].reaches == "no":
        return "never"
    return ", ".join(seconds_text(each.seconds) if each.reaches == "yes" else _when(each) for each in needs)


def _also(times: float, text: str) -> str:
    return f", {text} too" if times <= 1.0 / FINER else ""


def _when(need: Need) -> str:
    if need.reaches == "yes":
        return f"in {seconds_text(need.seconds)}"
    return "never" if need.reaches == "no" else "cannot tell"


def _mark(study: Study, height: float, accuracy: tuple[str, float, bool], result: Choice, more: str) -> tuple[str, ...]:
    """Return the accuracy, the cheapest method there, and those that tie with it.

    A method that draws nothing states no error. Only the reference shows whether it is near enough: it is named apart.
    """
    text = f"{_accuracy_text(study, height)}{more}"
    asked = replace(study, accuracy=accuracy)
    near = [c.method.name for c in study.once if c.answers and worst_error(asked, c).reaches == "yes"]
    apart = tuple(f"near enough, as the reference shows: {name}" for name in near)
    if not result.cheapest:
        return (text, *apart)
    first, *others = result.cheapest
    first_line = (f"{text}; cheapest:", f"{first.method.name}, {seconds_text(result.needs[first].seconds)}")
    named, rest = [f"tie: {each.method.name}" for each in others[:_NAMED]], len(others) - _NAMED
    return (*first_line, *named, *([f"and {rest} more"] if rest > 0 else []), *apart)


def _recommended_run(study: Study, result: Choice, work: Work, scale: float) -> tuple[float, float, str] | None:
    if result.chosen is None:
        return None
    wanted = result.needs[result.chosen]
    text = (
        f"Recommended: {result.chosen.method.name}, {trials_text(wanted.trials)} trials, {seconds_text(wanted.seconds)}"
    )
    return _work_of(result.chosen, work, wanted.trials), scale, text


def _frame(lines: Sequence[Line], scale: float) -> tuple[float, float, float, float]:
    """Round decades about everything that is drawn."""
    xs = [point.x for line in lines for point in line.points] + [x for line in lines for x, _ in line.ahead]
    ys = [point.y for line in lines for point in line.points] + [scale / FINER]
    left, right = _decade(min(xs, default=1.0), math.floor), _decade(max(xs, default=1.0), math.ceil)
    bottom = min(_decade(min(ys) * 0.999, math.floor), scale / FINER / 3.0)
    return left, max(right, 10.0 * left), max(bottom, min(ys) / 3.0), _decade(max(ys), math.ceil)


def _decade(value: float, rounds: Callable[[float], int]) -> float:
    return 10.0 ** rounds(math.log10(value))


def spread(heights: Sequence[float], apart: float, bottom: float, top: float) -> list[float]:
    """Heights that are at least so far apart, in the same order, each as near to what it was as the others allow.

    Args:
        heights: falling, or in the order in which labels shall stand from the top.
        apart: the least distance; less where there is not room enough.
        bottom: of the column.
        top: of the column.

    >>> spread([5.0, 5.0, 1.0], 1.0, 0.0, 10.0)
    [5.5, 4.5, 1.0]
    """
    if not heights:
        return []
    step = min(apart, (top - bottom) / max(len(heights) - 1, 1))
    groups: list[tuple[float, int]] = []  # the middle of labels that touch each other, and how many there are
    for height in heights:
        middle, count = height, 1
        while groups and groups[-1][0] - groups[-1][1] * step / 2.0 < middle + count * step / 2.0:
            other, more = groups.pop()
            middle, count = (other * more + middle * count) / (more + count), more + count
        groups.append((middle, count))
    result = [middle + (count - 1) * step / 2.0 - index * step for middle, count in groups for index in range(count)]
    return _inside(result, step, bottom, top)


def _inside(heights: list[float], step: float, bottom: float, top: float) -> list[float]:
    """Push the heights back from both ends."""
    result = []
    limit = top
    for height in heights:
        result.append(min(height, limit))
        limit = result[-1] - step
    limit = bottom
    for index in range(len(result) - 1, -1, -1):
        result[index] = max(result[index], limit)
        limit = result[index] + step
    return result
