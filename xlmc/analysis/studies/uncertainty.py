"""Two loops: what an answer's distribution would be, if what nobody knows were known, and how far that is uncertain.

The outer loop draws the assumptions that vary from lack of knowledge, by a Latin hypercube; for each of its draws the
inner loop draws all others, trial by trial. Both are one run: its trials take the outer draws in turn, so that it costs
what any run of as many trials costs. Filters act on trials: an outer draw counts by the trials that they accept, since
what they know of the crash, or of whatever happened, says how likely the draw is, too.

Of each outer draw the accepted trials are one distribution of a forecast. A number of it, such as its 95th percentile,
has one value for each; the band of the number is the central part of these values, and holds the truth with the
confidence asked for, if the outer distributions describe what is known. The scatter of the few inner trials makes a
band somewhat too wide. By how much, the two halves of each inner loop say: half of the variance of their difference is
the variance of a half.

Source: Burmaster and Wilson 1996, "An introduction to second-order random variables in human health risk assessments".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.variations import names_of_rows, with_plain_sampling
from xlmc.analysis.studies.shown import Shown
from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.tables.assumptions import UNCERTAINTY
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import upstream
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.sampling.sampling_plan import MOST_OUTER, SamplingPlan
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate, Sample, percentiles, rank_correlation

__all__ = [
    "CONFIDENCE",
    "DEVIATION",
    "INNER",
    "LEAST_OUTER",
    "OUTER",
    "PERCENTS",
    "Band",
    "ForecastBands",
    "TwoLoops",
    "UncertaintyArguments",
    "uncertainty",
]

OUTER: Final = 250
INNER: Final = 1_000
CONFIDENCE: Final = 90.0
PERCENTS: Final = (5.0, 50.0, 95.0)

LEAST_OUTER: Final = 20
"""Outer draws: of fewer no 90 % band has a draw on either side of it."""

DEVIATION: Final = "SD"
"""The name of the standard deviation among the numbers of a forecast."""

IN_PERCENT: Final = Form(Kind.PERCENT)
"""The form of probabilities."""

_CURVE: Final = np.array([0.5, 1, 2, *range(5, 100, 5), 98, 99, 99.5]) / 100.0
"""The shares at which the bands of the cumulative curve are computed."""

_LEAST_INNER: Final = 2

_NOTABLE: Final = 0.05
"""The part of a band's width from which on a sentence says that the scatter of the inner trials causes it."""

Floats = NDArray[np.float64]
Tell = Callable[[str], None]


class UncertaintyArguments(TypedDict, total=False):
    """The arguments of `uncertainty` beside the model."""

    outer: int
    inner: int
    confidence: float
    percents: Sequence[float]
    uncertain: Iterable[str]
    judged: Iterable[str]
    seed: int | None
    engine: str | None
    jobs: int
    keep_trials: bool
    tell: Tell | None


@dataclass(frozen=True, slots=True)
class Band:
    """A number of a forecast, and between which values it lies.

    Attributes:
        number: `mean`, `SD`, `95th percentile`, `P(> 60)`, `probability of yes`.
        pooled: of all trials together, both kinds of uncertainty at once.
        low: the lower end of the band, with its Monte Carlo error.
        high: the upper end.
        form: how it is written.
        excess: the part of the band's width that the scatter of the inner trials causes, about.
    """

    number: str
    pooled: Estimate
    low: Estimate
    high: Estimate
    form: Form
    excess: float

    @property
    def is_share(self) -> bool:
        """Whether it is a probability."""
        return self.form is IN_PERCENT


@dataclass(frozen=True, slots=True)
class ForecastBands:
    """The bands of one forecast.

    Attributes:
        definition: of the forecast.
        form: how its numbers are written.
        bands: of its numbers.
        shares: `(q,)` of its cumulative curve.
        curve: `(q,)` the values of all trials together at these shares.
        low: `(q,)` the lower ends of the band at these shares.
        high: `(q,)` the upper ends.
        draws: outer draws with a trial in which it is a number.
        effective: as how many draws of equal weight these say, which count by their trials.
        causes: uncertain assumption -> rank correlation of its draws with the means of the forecast.
    """

    definition: Forecast
    form: Form
    bands: tuple[Band, ...]
    shares: Floats
    curve: Floats
    low: Floats
    high: Floats
    draws: int
    effective: float
    causes: Mapping[str, Estimate]

    @property
    def stated(self) -> list[Band]:
        """The bands that sentences give: all probabilities, and of other numbers the first and the last."""
        numbers = [band for band in self.bands if not band.is_share]
        return [*dict.fromkeys((*numbers[:1], *numbers[-1:])), *(band for band in self.bands if band.is_share)]


@dataclass(frozen=True, slots=True, repr=False)
class TwoLoops(Shown):
    """What two loops found.

    Attributes:
        run: all trials; those of an outer draw stand together.
        outer: draws of the outer loop.
        inner: trials for each of them.
        confidence: of the bands, in percent.
        uncertain: names of the assumptions that the outer loop drew.
        variable: names of those that the inner loop drew.
        forecasts: their bands, in the order of the workbook.
        texts: names of the forecasts whose answers are texts, which have none.
        valueless: names of those that are no number in any accepted trial.
        empty: outer draws of which no trial was accepted.
    """

    run: RunResult
    outer: int
    inner: int
    confidence: float
    uncertain: tuple[str, ...]
    variable: tuple[str, ...]
    forecasts: tuple[ForecastBands, ...]
    texts: tuple[str, ...]
    valueless: tuple[str, ...]
    empty: int

    @property
    def wide(self) -> list[tuple[ForecastBands, Band]]:
        """The bands told in sentences that more inner trials would make notably narrower."""
        return [(each, band) for each in self.forecasts for band in each.stated if band.excess > _NOTABLE]

    def __getitem__(self, name: str) -> ForecastBands:
        """Return the bands of a forecast.

        Raises:
            KeyError: it has none.
        """
        for each in self.forecasts:
            if each.definition.name == name:
                return each
        raise KeyError(f"no forecast {name!r} has bands")


def uncertainty(
    model: CompiledModel,
    *,
    outer: int = OUTER,
    inner: int = INNER,
    confidence: float = CONFIDENCE,
    percents: Sequence[float] = PERCENTS,
    uncertain: Iterable[str] = (),
    judged: Iterable[str] = (),
    seed: int | None = None,
    engine: str | None = None,
    jobs: int = 1,
    keep_trials: bool = False,
    tell: Tell | None = None,
) -> TwoLoops:
    """Draw what is uncertain in an outer loop and what varies in an inner one, and find the bands of each answer.

    The model and its workbook stay as they are. The inner trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: with assumptions that are `Uncertain` under `Kind of uncertainty`.
        outer: draws of the outer loop, 20 to 16,384.
        inner: trials for each of them, 2 or more.
        confidence: of the bands, in percent.
        percents: the percentiles whose bands are shown, above 0 and below 100.
        uncertain: names of the assumptions that are uncertain, instead of what their rows say: joined by commas, `*`
            for any letters.
        judged: names of the forecasts to show, in the same form; all where there are none.
        seed: of the run; as in `Model.simulate`, like what follows.
        engine: of the run.
        jobs: of the run.
        keep_trials: keep the draws of all trials, so that these can be saved as a table.
        tell: called before the run with what it is for.

    Raises:
        SimulationError: an argument is out of its range, or no trial is accepted.
        DefinitionError: no assumption is uncertain, or an uncertain one depends on one that varies.
    """
    _check(outer, inner, confidence, percents)
    wanted = {name for text in judged for name in names_of_rows(text, model.forecasts, "forecast")}
    names = _uncertain_names(model, uncertain)
    _refuse_dependent(model, names)
    plan = SamplingPlan.nested(names, outer, inner)
    if tell is not None:
        tell(f"{count_text(outer)} outer draws, {count_text(inner)} trials each")
    options = RunOptions.of(
        trials=outer * inner,
        seed=seed,
        engine=engine,
        jobs=jobs,
        evidence="rejection",
        keep_inputs=None if keep_trials else 0,
    )
    run = run_model(with_plain_sampling(model), options, plan=plan)
    if not run.accepted:
        message = f"none of {count_text(run.trials)} trials was accepted, so that there is nothing to tell"
        raise SimulationError(message, hint="Run xlmc simulate, which says what each filter rejects")
    asked = [f for f in model.forecasts if not wanted or f.name in wanted]
    texts = tuple(f.name for f in asked if f.name in run.labels)
    numeric = [f for f in asked if f.name not in texts and run.results[f.name].sample.n]
    drawn = _outer_draws(run, names, outer)
    accepted = np.bincount(run.trial_index // inner, minlength=outer)
    return TwoLoops(
        run=run,
        outer=outer,
        inner=inner,
        confidence=confidence,
        uncertain=names,
        variable=tuple(name for name in model.draws if name not in names),
        forecasts=tuple(_bands(run, run.results[f.name], plan, confidence, percents, drawn) for f in numeric),
        texts=texts,
        valueless=tuple(f.name for f in asked if f.name not in texts and f not in numeric),
        empty=int(np.count_nonzero(accepted == 0)),
    )


def _check(outer: int, inner: int, confidence: float, percents: Sequence[float]) -> None:
    """Refuse arguments that are out of their range.

    Raises:
        SimulationError: one is.
    """
    if not LEAST_OUTER <= outer <= MOST_OUTER:
        message = f"{count_text(outer)} outer draws were asked for"
        raise SimulationError(message, hint=f"Give {LEAST_OUTER} to {count_text(MOST_OUTER)}")
    if inner < _LEAST_INNER:
        raise SimulationError(f"{count_text(inner)} inner trials were asked for", hint=f"Give {_LEAST_INNER} or more")
    if not 0.0 < confidence < 100.0:
        message = f"a confidence of {number_text(confidence)} % was asked for"
        raise SimulationError(message, hint="Give a percentage above 0 and below 100, such as 90")
    for percent in percents:
        if not 0.0 < percent < 100.0:
            raise SimulationError(
                f"{number_text(percent)} is no percentile", hint="Percentiles lie above 0 and below 100"
            )


def _uncertain_names(model: CompiledModel, asked: Iterable[str]) -> tuple[str, ...]:
    """Return the names of the drawn assumptions that are uncertain, by their rows or as asked.

    Raises:
        DefinitionError: none is.
        SimulationError: no assumption that is drawn has an asked name.
    """
    live = [a.name for a in model.live]
    result = {name for text in asked for name in names_of_rows(text, model.live, "assumption that is drawn")}
    result = result or {a.name for a in model.live if a.uncertain}
    if not result:
        message = f"no assumption that a forecast or filter needs is Uncertain under {UNCERTAINTY}"
        hint = "Mark those whose one value nobody knows in that column of xlmc_assumptions, or name them (--uncertain)"
        raise DefinitionError(message, where=model.workbook.name, hint=hint)
    return tuple(name for name in live if name in result)


def _refuse_dependent(model: CompiledModel, names: Sequence[str]) -> None:
    """Refuse an uncertain assumption that is joined with one that varies, or whose parameters depend on one.

    Raises:
        DefinitionError: there is such an assumption.
    """
    rows = {a.name: a for a in model.live}
    varying = {a.cell: a.name for a in model.live if a.name not in names}
    for group in model.groups:
        inside = [name for name in group.names if name in names]
        outside = [name for name in group.names if name not in names]
        if inside and outside:
            message = f"{inside[0]!r} is Uncertain and correlated with {outside[0]!r}, which is Variable"
            hint = f"Give both the same {UNCERTAINTY}, or take the correlation out"
            raise DefinitionError(message, where=rows[inside[0]].row, hint=hint)
    for name in names:
        needs = upstream(model.needed.graph, rows[name].cells, {})
        other = next((varying[cell] for cell in sorted(needs) if cell in varying), None)
        if other is not None:
            message = f"{name!r} is Uncertain, and its distribution depends on {other!r}, which is Variable"
            hint = f"Mark {other!r} Uncertain, too, or {name!r} Variable"
            raise DefinitionError(message, where=rows[name].row, hint=hint)


def _outer_draws(run: RunResult, names: Sequence[str], outer: int) -> dict[str, Floats]:
    """Draw the uncertain assumptions once more, `(outer,)` each: a trial for each outer draw."""
    drawn = run.model.sampler(run.settings.seed, outer, plan=SamplingPlan.nested(names, outer, 1)).draw(0)
    return {name: drawn[name].copy() for name in names}


@dataclass(frozen=True, slots=True)
class _Grouped:
    """Trials of a forecast by outer draw, `o` draws with a trial of `outer`.

    Attributes:
        values: `(m,)` ascending within each draw.
        draws: `(o,)` the numbers of the draws.
        counts: `(o,)` trials of each.
    """

    values: Floats
    draws: NDArray[np.intp]
    counts: NDArray[np.intp]

    @classmethod
    def of(cls, values: Floats, draw: NDArray[np.int64], outer: int) -> _Grouped:
        """Sort values `(m,)` of these outer draws `(m,)`, which ascend."""
        counts = np.bincount(draw, minlength=outer)
        draws, ascending = np.flatnonzero(counts), values.copy()
        for end, count in zip(np.cumsum(counts).tolist(), counts.tolist(), strict=True):
            ascending[end - count : end].sort()
        return cls(ascending, draws, counts[draws])

    @property
    def _starts(self) -> NDArray[np.intp]:
        return np.cumsum(self.counts) - self.counts

    def sums(self, values: Floats) -> Floats:
        """Add up `(m,)` numbers by draw, `(o,)`."""
        return np.add.reduceat(values, self._starts)

    @property
    def means(self) -> Floats:
        """`(o,)`."""
        return self.sums(self.values) / self.counts

    @property
    def deviations(self) -> Floats:
        """`(o,)` standard deviations; 0 of a single trial, and of values that are all the same."""
        apart = self.values - np.repeat(self.means, self.counts)
        values = np.sqrt(self.sums(apart * apart) / np.maximum(self.counts - 1, 1))
        still = self.values[self._starts] == self.values[self._starts + self.counts - 1]
        return np.where(still, 0.0, values)

    def above(self, threshold: float) -> Floats:
        """`(o,)` the share of the trials above a number."""
        return self.sums((self.values > threshold).astype(np.float64)) / self.counts

    def quantiles(self, share: float) -> Floats:
        """`(o,)` the value that a share of the trials do not exceed, as Excel's PERCENTILE.INC."""
        rank = share * (self.counts - 1)
        low = np.floor(rank).astype(np.intp)
        left, right = self._starts + low, self._starts + np.minimum(low + 1, self.counts - 1)
        return np.asarray(self.values[left] + (self.values[right] - self.values[left]) * (rank - low))


_Number = Callable[[_Grouped], Floats]


def _bands(
    run: RunResult,
    result: ForecastResult,
    plan: SamplingPlan,
    confidence: float,
    percents: Sequence[float],
    drawn: Mapping[str, Floats],
) -> ForecastBands:
    """Find the bands of a forecast that is a number in some trials."""
    column = run.forecasts[result.definition.name]
    known = np.flatnonzero(~np.isnan(column))
    values, trials = np.asarray(column[known]), run.trial_index[known]
    whole = _Grouped.of(values, trials // plan.size, plan.replicates)
    first = trials % 2 == 0
    halves = [_Grouped.of(values[half], trials[half] // plan.size, plan.replicates) for half in (first, ~first)]
    ends = [(100.0 - confidence) / 2.0, (100.0 + confidence) / 2.0]

    def band(number: str, pooled: Estimate, of: _Number, form: Form) -> Band:
        results = of(whole)
        low, high = _percentiles(results, whole.counts, ends)
        return Band(number, pooled, low, high, form, _excess(results, whole.counts, of, halves))

    answer = [_share_at(whole, share, ends) for share in _CURVE]
    means = whole.means
    return ForecastBands(
        definition=result.definition,
        form=result.form,
        bands=tuple(band(*each) for each in _asked(result, percents)),
        shares=_CURVE,
        curve=result.sample.quantile(_CURVE),
        low=np.array([low for low, _ in answer]),
        high=np.array([high for _, high in answer]),
        draws=int(whole.draws.size),
        effective=float(whole.counts.sum() ** 2 / (whole.counts.astype(np.float64) ** 2).sum()),
        causes={name: rank_correlation(draws[whole.draws], means) for name, draws in drawn.items()},
    )


def _asked(result: ForecastResult, percents: Sequence[float]) -> Iterator[tuple[str, Estimate, _Number, Form]]:
    """Yield the numbers of a forecast: name, value of all trials, what gives it for each outer draw, and its form."""
    threshold, form = result.definition.threshold, result.form
    if result.kind is Kind.YES_NO:
        yield "probability of yes", result.mean, lambda trials: trials.means, IN_PERCENT
        return
    yield "mean", result.mean, lambda trials: trials.means, form
    yield DEVIATION, result.standard_deviation, lambda trials: trials.deviations, form
    for percent in percents:
        yield _ordinal(percent), result.percentile_at(percent), partial(_Grouped.quantiles, share=percent / 100.0), form
    if threshold is not None:
        above = result.probability_above(threshold)
        yield f"P(> {form.number(threshold)})", above, lambda trials: trials.above(threshold), IN_PERCENT


def _ordinal(percent: float) -> str:
    """Name a percentile.

    >>> [_ordinal(percent) for percent in (2.5, 50, 95, 1, 22, 13)]
    ['2.5th percentile', 'median', '95th percentile', '1st percentile', '22nd percentile', '13th percentile']
    """
    if percent == 50.0:
        return "median"
    whole = int(percent)
    endings = {1: "st", 2: "nd", 3: "rd"} if whole == percent and whole not in (11, 12, 13) else {}
    ending = endings.get(whole % 10, "th")
    return f"{number_text(percent)}{ending} percentile"


def _percentiles(values: Floats, counts: NDArray[np.intp], percents: Sequence[float]) -> list[Estimate]:
    """Return percentiles of a number over the outer draws, which count by their trials."""
    alike = counts.size > 0 and bool(np.all(counts == counts[0]))
    sample = Sample.of(values, None if alike else counts.astype(np.float64), two_valued=False)
    return list(percentiles(sample, percents).values())


def _share_at(whole: _Grouped, share: float, ends: Sequence[float]) -> tuple[float, float]:
    low, high = _percentiles(whole.quantiles(share), whole.counts, ends)
    return low.value, high.value


def _excess(values: Floats, counts: NDArray[np.intp], of: _Number, halves: Sequence[_Grouped]) -> float:
    """Return the part of the spread of a number `(o,)` over the outer draws that comes from few inner trials; 0 to 1.

    The spread is the root of true variance and noise; without noise it would be the root of the first alone.
    """
    both, one, other = np.intersect1d(halves[0].draws, halves[1].draws, assume_unique=True, return_indices=True)
    if both.size < LEAST_OUTER or values.size < LEAST_OUTER:
        return 0.0
    apart = of(halves[0])[one] - of(halves[1])[other]
    weights = (halves[0].counts[one] + halves[1].counts[other]).astype(np.float64)
    noise = float(np.average(apart * apart, weights=weights)) / 4.0
    middle = float(np.average(values, weights=counts))
    spread = float(np.average((values - middle) ** 2, weights=counts))
    if not spread or not math.isfinite(spread):
        return 0.0
    return 1.0 - math.sqrt(max(0.0, 1.0 - noise / spread))
