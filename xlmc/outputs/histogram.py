"""Trials counted in bins of a round width, for a chart with readable numbers.

**Width.** Freedman and Diaconis, 2·IQR·n^(−1/3), made round (1, 2, 2.5 or 5 times a power of ten) downwards, but no
more than 60 bins over the range shown and about 10 at least; 1 where all trials are whole numbers that allow it. Bins
begin at multiples of their width, so that a limit such as 0 or 0.25 falls between two bins, not into one, and hold
their lower end but not their upper.

**Grid.** Trials that lie on a grid, such as days, cents or tenths, would look like a comb if some bins held more points
of the grid than others: bins are some steps of it wide. Working days, of which a week lacks some, have whole weeks.

**Range shown.** All trials, unless some lie more than five interquartile ranges outside the quartiles; those are not
drawn, for they would leave the rest in one bar, but counted as below and above.

**Central range.** Its ends fall where they fall. Each bin's trials are counted inside and outside it apart, so a bin
that straddles an end is shown as both, and the inside parts add up to exactly the trials of the range.

**One bar each.** Yes and no, texts, and whole numbers that lie close enough have a bar each, centred on its value.

A `Figure` is the histogram of a forecast with its title and caption, as sheet, page and picture draw it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.columns import parts, release
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, counted_text, fraction, number_text, percent, percent_format
from xlmc.montecarlo.statistics.sample import Sample, Values
from xlmc.outputs.summary import (
    SummaryRow,
    answer_text,
    central_text,
    frequent_texts,
    share_text,
    summarise,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Figure", "Histogram", "bars_of", "figures_of", "histogram", "multiples", "not_drawn", "varying"]

Floats = NDArray[np.float64]

_FEWEST, _MOST = 10, 60
_ROUND = (1.0, 2.0, 2.5, 5.0)
_ROUND_LABELS = (1.0, 2.0, 5.0)
_STEPS = (1, 2, 4, 5, 10, 20)
_MOST_LABELS, _FEWEST_LABELS = 12, 4
_LINE, _POWER = 84, 7
"""Characters that an axis has room for, and of a label with a power of ten."""

_LONGEST_LABEL = 24
"""Characters of a text below its bar."""

_FENCE, _VAST = 5.0, 1e300
_MOST_DECIMALS, _LONGEST = 6, 1e15
"""A label with more decimals, or of a larger number, has a power of ten."""

_LEAST_ON_GRID, _ON_A_POINT, _ON_GRID = 200, 4, 1e-6
"""Values that show a grid, values on each of its points, and how far they may lie beside it, in its steps."""

_WEEK = 7

_FINEST = 1e-9
"""The narrowest bin, as a share of the largest value: a finer one would show rounding."""


@dataclass(frozen=True)
class Histogram:
    """Counts of trials in `b` bins of equal width.

    Attributes:
        edges: `(b,)` lower ends.
        inside, outside: `(b,)` trials inside and outside the central range.
        below, above: trials that are not drawn.
        step: bins from one label to the next; the first bin has one.
        decimals: of the width.
        names: `(b,)` what each bar is of, where it has one value alone, on which it is centred; None elsewhere.
        form: how the edges are written.
        grid: the step between the values that trials lie on; None where they lie anywhere.
    """

    edges: Floats
    width: float
    inside: NDArray[np.int64]
    outside: NDArray[np.int64]
    below: int
    above: int
    step: int
    decimals: int
    names: tuple[str, ...] | None = None
    form: Form = PLAIN
    grid: float | None = None

    @property
    def counted(self) -> int:
        """All trials, those that are not drawn among them; of weighted ones, as many as carry as much."""
        return int(self.inside.sum() + self.outside.sum()) + self.below + self.above

    @cached_property
    def upper_edges(self) -> Floats:
        """`(b,)` upper ends; every label and format asks for them."""
        if self.names is not None:
            return np.asarray(self.edges + self.width)
        return multiples(self.width, round(float(self.edges[0] / self.width)) + 1, self.edges.size)

    def in_parts(self, sample: Sample, most: int) -> NDArray[np.int64]:
        """Count the trials in equal parts of each bin, `(b, p)`, p of them at most `most`: whole steps of a grid.

        Args:
            sample: what the bins were counted of.
            most: parts of a bin.
        """
        x = sample.even
        p = self._parts(sample, most)
        if p == 1:
            return (self.inside + self.outside)[:, np.newaxis]
        starts = self.edges[:, np.newaxis] + np.arange(p) * (self.width / p)
        edges = np.append(starts.ravel(), self.upper_edges[-1])
        values = np.diff(np.searchsorted(x, edges - (0.0 if self.grid is None else _ON_GRID * self.grid), side="left"))
        release(x)
        return values.reshape(-1, p)

    def _parts(self, sample: Sample, most: int) -> int:
        """Return in how many parts a bin can be divided so that all are alike."""
        if self.names is not None or self.width / most <= _FINEST * float(np.max(np.abs(self.upper_edges))):
            return 1
        step = 1.0 if self.grid is None and sample.whole else self.grid
        steps = 0 if step is None else round(self.width / step)
        return most if step is None else max(p for p in range(1, most + 1) if steps % p == 0 and (steps or p == 1))

    @property
    def labels(self) -> list[str]:
        """The lower end, or the value of a bar, in text for every `step`-th bin, nothing for the others."""
        if self.names is not None:
            return [short_name(name) if i % self.step == 0 else "" for i, name in enumerate(self.names)]
        decimals = _decimals(self.width * self.step)
        return ["" if i % self.step else self._text(edge, decimals) for i, edge in enumerate(self.edges)]

    @property
    def last_label(self) -> str:
        """The upper end of the last bin in text; bins fill whole steps, so that it is due a label."""
        if self.names is not None:
            return ""
        return self._text(float(self.upper_edges[-1]), _decimals(self.width * self.step))

    @property
    def edge_format(self) -> str:
        """The Excel number format that writes edges in full, if there is room."""
        if not self._short:
            return "General"
        if self.form.kind is Kind.DATE:
            return self.form.moment_code
        if self.form.kind is Kind.PERCENT:
            return percent_format(self.decimals - 2)
        return f"0{fraction(self.decimals)}"

    def _text(self, edge: float, decimals: int) -> str:
        return self.form.tick(edge, decimals) if self._short else number_text(edge, 4)

    @property
    def _short(self) -> bool:
        return self.decimals <= _MOST_DECIMALS and bool(np.max(np.abs(self.upper_edges)) < _LONGEST)


def histogram(values: Values, low: float, high: float, form: Form = PLAIN) -> Histogram | None:
    """Count finite values `(n,)`, or a `Sample` of them, apart for those in [low, high]; otherwise None.

    Of weighted trials as many are counted as carry as much.
    """
    x = Sample.of(values).even
    if x.size == 0:
        return None
    first, last = _shown(x)
    width = form.rounded_width(_width(x, first, last))
    grid = _grid_of(x)
    if grid is not None:
        width = _on_grid(width, grid, is_date=form.kind is Kind.DATE)
    start, stop = math.floor(first / width), math.floor(last / width) + 1
    step = _step(width, start, stop, form)
    start, stop = step * math.floor(start / step), step * math.ceil(stop / step)
    edges = multiples(width, start, stop - start + 1)
    rounding = 0.0 if grid is None else _ON_GRID * grid.step
    reached = np.searchsorted(x, edges - rounding, side="left")
    central = reached.clip(np.searchsorted(x, low, side="left"), np.searchsorted(x, high, side="right"))
    release(x)
    inside = np.diff(central)
    return Histogram(
        edges=edges[:-1],
        width=width,
        inside=inside,
        outside=np.diff(reached) - inside,
        below=int(reached[0]),
        above=int(x.size - reached[-1]),
        step=step,
        decimals=_decimals(width),
        form=form,
        grid=None if grid is None else grid.step,
    )


def bars_of(row: SummaryRow, sample: Sample) -> Histogram | None:
    """Return the bars of a forecast: one for each text, for no and yes, for each whole number; bins of the others."""
    if row.categories:
        texts = [*frequent_texts(row.categories)[0]]
        return _named_bars(sample, row.numbers[: len(texts)], texts, row.form)
    if row.yes is not None and sample.yes_no_at_most:
        return _named_bars(sample, [0.0, 1.0], ["no", "yes"], row.form)
    low, high = row.low.value, row.high.value
    if math.isnan(low) or math.isnan(high):
        return None  # too few effective trials to draw
    if row.kind is Kind.WHOLE and sample.whole and 0.0 < float(sample.x[-1]) - float(sample.x[0]) < _MOST:
        values = np.arange(sample.x[0], sample.x[-1] + 1.0)
        return _named_bars(sample, values.tolist(), [row.form.number(value) for value in values], row.form, low, high)
    return histogram(sample, low, high, row.form)


def _named_bars(
    sample: Sample,
    values: Sequence[float],
    names: Sequence[str],
    form: Form,
    low: float = -math.inf,
    high: float = math.inf,
) -> Histogram:
    """Return a bar for each of these values; those beyond the most that a chart has room for are counted as above."""
    x = sample.even
    order = np.asarray(values[:_MOST])
    counts = np.searchsorted(x, order, side="right") - np.searchsorted(x, order, side="left")
    centres = order if form.kind is Kind.WHOLE else np.arange(order.size, dtype=np.float64)
    central = (order >= low) & (order <= high)
    release(x)
    longest = max(len(short_name(name)) for name in names[:_MOST])
    step = (
        1
        if form.kind is not Kind.WHOLE
        else next(
            each for each in (*_STEPS, _MOST) if order.size / each * (longest + 2) <= _LINE and order.size / each <= 30
        )
    )
    return Histogram(
        edges=centres - 0.5,
        width=1.0,
        inside=np.where(central, counts, 0),
        outside=np.where(central, 0, counts),
        below=0,
        above=int(x.size - counts.sum()),
        step=step,
        decimals=0,
        names=tuple(names[:_MOST]),
        form=form,
    )


def short_name(name: str, longest: int = _LONGEST_LABEL) -> str:
    """Return a name, or the text of a category, as long as there is room for."""
    name = name or "(empty)"
    return name if len(name) <= longest else f"{name[: longest - 1]}…"


def _shown(x: Floats) -> tuple[float, float]:
    """Return the smallest and largest of ascending values inside the fences."""
    lower, upper = _quartiles(x)
    reach = _FENCE * (upper - lower)
    if reach == 0.0:
        return _sane(x[0]), _sane(x[-1])
    first = np.searchsorted(x, lower - reach, side="left")
    last = np.searchsorted(x, upper + reach, side="right") - 1
    if last < first:  # all of them vast
        return _sane(x[0]), _sane(x[-1])
    return _sane(x[first]), _sane(x[last])


@dataclass(frozen=True, slots=True)
class _Grid:
    """The step between neighbouring points of a grid, and the points that occur, `(d,)`."""

    step: float
    points: Floats


def _grid_of(x: Floats) -> _Grid | None:
    """Return the grid that ascending values lie on, where each of its points has several of them; otherwise None."""
    if x.size < _LEAST_ON_GRID:
        return None
    few = np.unique(x[:: x.size // _LEAST_ON_GRID])
    if few.size < 3 or few.size > _LEAST_ON_GRID // 2:
        return None  # too many different values, which a few of them show
    points = np.unique(x)
    if x.size < _ON_A_POINT * points.size:
        return None
    gaps = np.diff(points)
    step = float(gaps.min())
    steps = gaps / step
    if step <= _FINEST * max(abs(points[0]), abs(points[-1])) or np.any(np.abs(steps - np.round(steps)) > _ON_GRID):
        return None
    return _Grid(step, points)


def _on_grid(width: float, grid: _Grid, *, is_date: bool) -> float:
    """Return the width of bins, near another one, that hold equally many points of the grid."""
    days = np.unique(np.round(grid.points) % _WEEK)
    if is_date and grid.step == 1.0 and days.size < _WEEK and grid.points[-1] - grid.points[0] > 2 * _WEEK:
        return _WEEK * max(round(width / _WEEK), 1) if width > 1.0 else width
    count = width / grid.step
    if count >= 1.0 - _ON_GRID and abs(count - round(count)) <= _ON_GRID * count:
        return width
    near = range(max(math.floor(count), 1), 2 * math.ceil(count) + 1)
    widths = [float(f"{steps * grid.step:.9g}") for steps in near]
    return next((each for each in widths if _mantissa(each) in _ROUND), widths[-1 if len(widths) == 1 else 0])


def _sane(value: float) -> float:
    return float(min(max(value, -_VAST), _VAST))


def _quartiles(x: Floats) -> tuple[float, float]:
    """Return the quartiles of ascending values, by straight lines between them."""
    lower, upper = Sample(x).quantile(np.array([0.25, 0.75]))
    return _sane(lower), _sane(upper)


def _width(x: Floats, first: float, last: float) -> float:
    span, largest = last - first, max(abs(first), abs(last))
    if span <= max(_FINEST * largest, 1.0 / _VAST):
        return _round_below(0.01 * largest) if largest > 1.0 / _VAST else 1.0
    if span <= _MOST and all(bool(np.all(part == np.floor(part))) for part in parts(x)):
        return 1.0
    lower, upper = _quartiles(x)
    wanted = min(2.0 * (upper - lower) * x.size ** (-1.0 / 3.0), span / _FEWEST)
    width = _round_below(max(wanted, span / _MOST))
    return width if span <= _MOST * width else _round_above(width)


def _round_below(width: float) -> float:
    """Return the largest round number that is no larger."""
    return _scale(max(factor for factor in _ROUND if factor <= _mantissa(width)), width)


def _round_above(width: float) -> float:
    """Return the smallest round number that is larger."""
    return _scale(min(factor for factor in (*_ROUND, 10.0) if factor > _mantissa(width)), width)


def _mantissa(number: float) -> float:
    return float(f"{number:.6e}".partition("e")[0])


def _scale(factor: float, like: float) -> float:
    return float(f"{factor}e{f'{like:.6e}'.partition('e')[2]}")  # 0.1, not 0.1 and a rounding error


def _step(width: float, first: int, last: int, form: Form = PLAIN) -> int:
    """Return the fewest bins from one label to the next that keep labels round and apart; bins are these multiples."""
    for step in _STEPS:
        most = min(_MOST_LABELS, max(_FEWEST_LABELS, _LINE // (_longest_label(width, step, first, last, form) + 2)))
        if last - first <= step * most and (form.kind is Kind.DATE or _mantissa(width * step) in _ROUND_LABELS):
            return step
    return _STEPS[-1]


def _longest_label(width: float, step: int, first: int, last: int, form: Form) -> int:
    """Characters of the longest edge, or as many as a power of ten takes."""
    largest = max(abs(first), abs(last)) * width
    if _decimals(width) > _MOST_DECIMALS or largest >= _LONGEST:
        return _POWER
    return len(form.tick(-largest if first < 0 else largest, _decimals(width * step)))


def multiples(width: float, first: int, count: int) -> Floats:
    """(count,) multiples of a round width, as people write them: 0.3, not 0.30000000000000004."""
    return np.array([float(f"{multiple * width:.13g}") for multiple in range(first, first + count)])


def _decimals(width: float) -> int:
    """Decimals that write a round width in full: 0.25 -> 2, 10 -> 0."""
    mantissa, _, exponent = f"{width:.2e}".partition("e")
    return max(len(mantissa.rstrip("0").partition(".")[2]) - int(exponent), 0)


_LONGEST_NAME = 90
_MOST_TEXTS = 5
"""Texts whose shares a caption gives."""


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
        if self.bins.names is not None:
            return self.answer.units or ("Value" if self.answer.kind is Kind.WHOLE else "Answer")
        bars = f"bars {self.bins.form.width(self.bins.width)} wide, each labelled at its lower end"
        return f"{self.answer.units} ({bars})" if self.answer.units else f"B{bars[1:]}"

    @property
    def description(self) -> str:
        """The answer in words."""
        row = self.answer
        units = f" {row.units}" if row.units else ""
        message = (
            f"mean {answer_text(row)}{units}; the central {percent(row.share)} of "
            f"{counted_text(row.trials, 'accepted trial')} lie from {central_text(row)}{units}"
        )
        if row.yes is not None:
            message = f"yes in {answer_text(row)} of {counted_text(row.trials, 'accepted trial')}, else no"
        if row.categories:
            shares = [f"{text or '(empty)'} {share_text(share)}" for text, share in row.categories.items()]
            more = f"; {count_text(len(shares) - _MOST_TEXTS)} more texts" if len(shares) > _MOST_TEXTS else ""
            message = f"{'; '.join(shares[:_MOST_TEXTS])}{more}; of {counted_text(row.trials, 'accepted trial')}"
        return message

    @property
    def caption(self) -> str:
        """What the figure shows, in words."""
        row, bins = self.answer, self.bins
        text = f"Figure {self.number}. {self.name}: {self.description}."
        if bins.counted < row.trials:
            text += (
                f" Trials are weighted: the chart shows {counted_text(bins.counted, 'trial')} of equal weight instead."
            )
        if bins.below or bins.above:
            text += not_drawn(bins)
        return text


def not_drawn(bins: Histogram) -> str:
    """How many trials a chart leaves out, as a sentence."""
    if bins.names is not None:
        return f" Not drawn: {counted_text(bins.above, 'trial')} of rarer texts."
    return f" Not drawn: {counted_text(bins.below, 'trial')} below and {count_text(bins.above)} above."


def figures_of(simulation: RunResult, names: Collection[str] | None = None) -> list[Figure]:
    """Every forecast that has a number in an accepted trial.

    Args:
        simulation: the finished run.
        names: of the forecasts; by default all.
    """
    figures: list[Figure] = []
    for row in summarise(simulation, names):
        sample = simulation.results[row.name].sample
        bins = bars_of(row, sample) if sample.n else None
        if bins is not None:
            figures.append(Figure(len(figures) + 1, row, bins))
    return figures


def varying(figures: Sequence[Figure]) -> list[Figure]:
    """Return the figures, without forecasts that are the same in all trials: their curve would be a step."""
    return [each for each in figures if each.answer.yes is None and each.answer.standard_deviation.value > 0.0]
