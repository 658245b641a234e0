"""The figure of a study of methods, drawn with matplotlib: speed against accuracy, and a panel for each number."""

from __future__ import annotations

import io
import math
import textwrap
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from xlmc.analysis.studies.methods import STATISTICS, Curve, Runs, Study
from xlmc.analysis.studies.methods.curve import Rms
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, Line, Picture, Work, column_of, guides_of, picture_of, spread

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["OTHER", "STYLES", "Style", "draw", "png", "svg"]


class Style(NamedTuple):
    """How a method looks; markers and dashes tell methods apart without colour, and the colours differ in grey."""

    colour: str
    marker: str
    dashes: tuple[float, ...] = ()


STYLES: Final[Mapping[str, Style]] = {
    "mc": Style("#0B3C6F", "o"),
    "lhs": Style("#C96A00", "s", (6, 2)),
    "sobol": Style("#00805E", "^", (2, 1.5)),
    "grid": Style("#A3123A", "D", (8, 2, 2, 2)),
    "surrogate": Style("#8A5AA8", "P", (4, 1.5, 1, 1.5)),
    "mc/jit": Style("#4C9BD6", "v"),
    "mc/formulas": Style("#999999", "X"),
    "taylor-1": Style("#222222", "X"),
    "taylor-2": Style("#222222", "*"),
}
"""Okabe and Ito's palette, darker."""
OTHER: Final = Style("#444444", ".")

_INK: Final = "#1F3044"
_GREY: Final = "#6B7785"
_LINES: Final = "#DDE2E9"
_ASKED: Final = "#B00020"
_SIZE: Final = (12.4, 10.2)
_LETTERS: Final = 9.2
_APART: Final = 0.047
"""The distance from label to label, as a share of the panel's height."""


def draw(study: Study, against: Work = "seconds", *, words: bool = True) -> Figure:
    """Draw the figure: against time, or against evaluations of the workbook; with the words that tell how to
    read it.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    figure = Figure(figsize=_SIZE, layout=ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.04))
    upper, lower = np.asarray(figure.subfigures(2, 1, height_ratios=[2.35, 1.0]))
    picture = picture_of(study, against)
    axis = upper.subplots()
    if picture is None:
        _say(axis, "No forecast varies.")
    else:
        _main(axis, picture)
    if words:
        upper.suptitle(_title(study, picture), fontsize=10, ha="left", x=0.008, color=_INK, linespacing=1.45)
    for panel, (name, get) in zip(lower.subplots(1, 5), _numbers(study).items(), strict=True):
        _small(panel, study, name, get, _nothing_text(study, name))
    lower.suptitle(_below(study, picture), fontsize=8.5, ha="left", x=0.008, color=_GREY)
    return figure


def _title(study: Study, picture: Picture | None) -> str:
    name = textwrap.shorten(study.model.workbook.name, 60, placeholder="…")
    words = HOW_TO_READ if picture is not None else ()
    return "\n".join([f"Speed against accuracy: {name}", *("\n".join(textwrap.wrap(each, 150)) for each in words)])


def _below(study: Study, picture: Picture | None) -> str:
    label = (
        f"Each number apart: root mean square error over up to {study.replicates} runs and "
        f"{len(study.model.forecasts)} forecasts, in % of the 5–95 % range, against the trials of a run. "
        f"Reference: {count_text(study.reference.trials)} trials. Bars: 95 % intervals of the errors themselves. "
        "Dotted: not run, but carried on by the law that the runs follow."
    )
    absent = " ".join(picture.absent) if picture is not None else ""
    return "\n".join(textwrap.wrap(f"{label} {absent}", 175))


def _main(axis: Axes, picture: Picture) -> None:
    left, right, bottom, top = picture.frame
    axis.set(xscale="log", yscale="log", ylim=(bottom, top))
    wide = math.log10(right / left)
    axis.set_xlim(left / 10.0 ** (0.36 * wide), right * 10.0 ** (0.62 * wide))
    _guides(axis, picture)
    for mark in picture.marks:
        axis.plot([axis.get_xlim()[0], right], [mark.y, mark.y], color=_ASKED, lw=1.0, zorder=1)
        axis.annotate(
            "\n".join(mark.words), (0.008, mark.y), xycoords=("axes fraction", "data"), xytext=(0, 3),
            textcoords="offset points", color=_ASKED, fontsize=_LETTERS, va="bottom",
        )  # fmt: skip
    for line in picture.lines:
        _line(axis, line, right)
    _labels(axis, picture)
    if picture.chosen is not None:
        axis.plot(picture.chosen[0], picture.chosen[1], "o", ms=15, mfc="none", mec=_INK, mew=1.8, zorder=6)
    axis.set_xlabel(picture.across)
    axis.set_ylabel(picture.upwards)
    _style_axes(axis)
    axis.set_xticks([tick for tick in axis.get_xticks() if left * 0.999 <= tick <= right * 1.001])


def _guides(axis: Axes, picture: Picture) -> None:
    """Slopes of −1/2 and −1, in the empty corner left of the lines."""
    left, right, bottom, _ = picture.frame
    y0, fall = guides_of(picture, bottom)
    x0 = left / 10.0 ** (0.33 * math.log10(right / left))
    for slope, text in ((-0.5, "slope −½: four times the work, half the error"), (-1.0, "slope −1")):
        across = fall / -slope
        axis.plot([x0, x0 * 10.0**across], [y0, y0 / 10.0**fall], color=_GREY, lw=1.0, zorder=1)
        above = slope > -1.0
        at = (x0, y0) if above else (x0 * 10.0**across, y0 / 10.0**fall)
        axis.annotate(
            text, at, xytext=(0, 4) if above else (-4, 2), textcoords="offset points", fontsize=7.5, color=_GREY,
            va="bottom", ha="left" if above else "right",
        )  # fmt: skip


def _line(axis: Axes, line: Line, right: float) -> None:
    style = STYLES.get(line.curve.method.key, OTHER)
    x, y = [each.x for each in line.points], [each.y for each in line.points]
    if line.once:
        axis.plot([x[0], right], [y[0], y[0]], color=style.colour, lw=0.8, ls=":", zorder=2)
    bars = np.array([[max(each.y - each.low, 0.0), each.high - each.y] for each in line.points]).T
    axis.errorbar(
        x, y, yerr=bars, color=style.colour, marker=style.marker, ms=8 if line.once else 5.5, mew=0.8, mec="white",
        lw=1.7, elinewidth=0.8, capsize=1.8, zorder=3, **_dashes(style),
    )  # fmt: skip
    if line.ahead:
        axis.plot([x for x, _ in line.ahead], [y for _, y in line.ahead], color=style.colour, lw=1.1, ls=(0, (1, 2)))


def _dashes(style: Style) -> dict[str, Any]:
    return {"ls": (0, style.dashes)} if style.dashes else {"ls": "-"}


def _labels(axis: Axes, picture: Picture) -> None:
    left, right, bottom, top = picture.frame
    high = math.log10(top / bottom)
    words = column_of(picture)
    at = spread([math.log10(each.y / bottom) / high for each in words], _APART, 0.03, 0.97)
    column = right * 10.0 ** (0.05 * math.log10(right / left))
    for each, height in zip(words, at, strict=True):
        style = Style(_INK, "o") if each.line is None else STYLES.get(each.line.curve.method.key, OTHER)
        level = bottom * 10.0 ** (height * high)
        axis.plot([each.x, right, column], [each.y, level, level], color=style.colour, lw=0.6, alpha=0.75, zorder=2)
        hollow: dict[str, Any] = (
            {"mfc": "none", "mec": _INK, "mew": 1.5} if each.line is None else {"mec": "white", "mew": 0.6}
        )
        axis.plot(column, level, color=style.colour, marker=style.marker, ms=5.5, zorder=4, **hollow)
        axis.annotate(
            each.text, (column, level), xytext=(6, 0), textcoords="offset points", va="center", fontsize=_LETTERS,
            color=style.colour, fontweight="bold" if each.line is None else "normal",
        )  # fmt: skip


_ACCEPTED: Final = "Accepted share, % of it"


def _numbers(study: Study) -> dict[str, Callable[[Runs], tuple[float, float, float]]]:
    """Title -> the error of a run length in % and its interval; of the accepted share in % of it."""

    def of(statistic: str) -> Callable[[Runs], tuple[float, float, float]]:
        return lambda runs: _with_interval(
            100.0 * runs.shares[statistic],
            [runs.errors[name, statistic] for name in study.varying if study.converges(name, statistic)],
        )

    def accepted(runs: Runs) -> tuple[float, float, float]:
        if runs.acceptance is None or _every_trial_is_accepted(study):
            return (math.nan,) * 3
        return _with_interval(100.0 * runs.acceptance.value / study.reference.acceptance.value, [runs.acceptance])

    return {**{name: of(each) for each, name in STATISTICS.items()}, _ACCEPTED: accepted}


def _with_interval(value: float, errors: list[Rms]) -> tuple[float, float, float]:
    """Return the interval that as many replicates give; forecasts of the same runs are no further replicates."""
    known = [each for each in errors if each.value > 0.0]
    if not known or not value > 0.0:
        return value, value, value
    low, high = np.mean([np.array(each.interval) / each.value for each in known], axis=0)
    return value, value * float(low), value * float(high)


def _nothing_text(study: Study, title: str) -> str:
    """Why a panel is empty, if it is."""
    every = title == _ACCEPTED and _every_trial_is_accepted(study)
    return "every trial is accepted" if every else "nothing to show"


def _every_trial_is_accepted(study: Study) -> bool:
    return study.reference.acceptance.value == 1.0


def _small(
    axis: Axes, study: Study, title: str, get: Callable[[Runs], tuple[float, float, float]], nothing: str
) -> None:
    axis.set(xscale="log", yscale="log")
    drawn = False
    for curve in study.every:
        if curve.answers and all(runs.measured for runs in curve.lengths):
            drawn |= _small_line(axis, study, curve, get)
    axis.set_title(title, loc="left", fontsize=9.5, color=_INK)
    axis.set_xlabel("trials", fontsize=8)
    axis.tick_params(labelsize=7.5)
    if drawn:
        _style_axes(axis)
        _half(axis)
    else:
        axis.set_axis_off()
        _say(axis, nothing)


def _small_line(axis: Axes, study: Study, curve: Curve, get: Callable[[Runs], tuple[float, float, float]]) -> bool:
    style = STYLES.get(curve.method.key, OTHER)
    result = [(float(runs.budget), *get(runs)) for runs in curve.lengths]
    known = [each for each in result if np.isfinite(each[1]) and each[1] > 0.0]
    if not known:
        return False
    if curve in study.once:
        axis.axhline(known[0][1], color=style.colour, lw=0.9, ls=":")
        return True
    if curve in study.engines:  # the errors of the same trials: the same line again
        return False
    x, y, low, high = np.array(known).T
    axis.errorbar(
        x, y, yerr=[y - low, high - y], color=style.colour, marker=style.marker, ms=3.2, lw=1.2, elinewidth=0.6,
        mew=0.0, **_dashes(style),
    )  # fmt: skip
    return True


def _half(axis: Axes) -> None:
    """Draw a line of slope −1/2 below the others."""
    left, right = axis.get_xlim()
    bottom, top = axis.get_ylim()
    axis.set_ylim(bottom / 3.0, top)
    across = (right / left) ** 0.7
    start = bottom * 0.5 * across**0.5
    axis.plot([left * 1.5, left * 1.5 * across], [start, start / across**0.5], color=_GREY, lw=0.9, zorder=1)
    axis.annotate("−½", (left * 1.5 * across**0.4, start / across**0.2), xytext=(-2, -9), textcoords="offset points",
                  fontsize=7.5, color=_GREY, ha="right")  # fmt: skip


def _style_axes(axis: Axes) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.grid(which="major", color=_LINES, lw=0.7)
    axis.set_axisbelow(True)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    for ticks in (axis.xaxis, axis.yaxis):
        ticks.set_major_locator(LogLocator(numticks=12))
        ticks.set_major_formatter(FuncFormatter(_tick))
        ticks.set_minor_formatter(NullFormatter())


def _tick(value: float, _: float) -> str:
    """`0.01`, `100`, `10⁴`."""
    if 1e-3 <= value < 1e4:
        return number_text(value, 12)
    power = str(round(math.log10(value))).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"10{power}"


def _say(axis: Axes, text: str) -> None:
    axis.text(0.5, 0.5, text, transform=axis.transAxes, ha="center", color=_GREY)


@lru_cache(maxsize=2)  # drawing takes a second, and page and document show the same
def svg(study: Study, against: Work) -> str:
    """Draw the figure of a study as SVG, its letters as shapes; the same study gives the same bytes."""
    import matplotlib as mpl

    drawn = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "path", "svg.hashsalt": "xlmc"}):
        draw(study, against, words=False).savefig(drawn, format="svg", metadata={"Date": None})
    text = drawn.getvalue()
    return text[text.index("<svg") :]


def png(study: Study) -> bytes:
    """Draw the figure against time as a picture."""
    drawn = io.BytesIO()
    draw(study).savefig(drawn, format="png", dpi=130)
    return drawn.getvalue()
