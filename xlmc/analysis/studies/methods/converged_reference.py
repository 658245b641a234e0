"""The truth that methods are measured against: one long run, with its own standard errors."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import Answer, Extreme, extremes_of
from xlmc.analysis.studies.methods.quantile_need import QuantileNeed, quantile_need
from xlmc.errors import SimulationError
from xlmc.montecarlo import statistics
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate, Sample
from xlmc.montecarlo.statistics.heavy_tails import heavy_tail

__all__ = ["FIRST", "PROBE", "Probe", "Reference", "fastest_engine", "probe_of", "reference_of", "unfiltered_of"]

_MOST_REFERENCE: Final = 1 << 25
_LEAST: Final = 1 << 14
_MOST_ACCEPTED: Final = 1 << 22
"""Sorting more trials than these costs more than they add."""

_LARGEST: Final = 1e150

_UNFILTERED: Final = 1 << 20

PROBE, FIRST = 65_536, 4_096
"""Trials that the workbook is timed by, and of the run before that, which compiles what must be compiled."""

_ACCEPTED: Final = 100
"""Accepted trials, without which there is no reference."""

_ROUNDING: Final = 1e-12
"""A standard deviation that is smaller beside the mean is none."""

_NORMAL_WIDTH: Final = 3.289707
"""The width from the 5 % to the 95 % quantile of a normal distribution, in standard deviations."""

_MOST_ORDERED: Final = 1 << 20

_WATCHED: Final = 256
"""Accepted trials whose draws are kept: the watch for lost digits looks at so many."""


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """A converged run.

    Attributes:
        trials, accepted: how many it ran, and how many were accepted.
        sampling, engine, seed: Sobol points where no filter rejects anything, or else independent trials.
        seconds: how long it took.
        answers: forecast -> its numbers.
        errors: forecast -> their standard errors.
        single: forecast -> the standard errors that one independent accepted trial would have; over the square root of
            their number, they are what theory says of a run by Monte Carlo.
        widths: forecast -> from its 5 % to its 95 % quantile: what accuracies are relative to. Where these are one
            number, the same of a normal distribution with its standard deviation.
        acceptance: the share of accepted trials.
        heavy: forecast -> attributes of `Answer` that do not converge, because its tail is too heavy.
        warnings: why its answers must not be used as they are.
        extremes: its lowest and highest accepted trials.
        ordered: forecast -> its accepted values in ascending order, evenly thinned to 1,048,576.
        forms: forecast -> how its numbers are written.
    """

    trials: int
    accepted: int
    sampling: str
    engine: str
    seed: int
    seconds: float
    answers: Mapping[str, Answer]
    errors: Mapping[str, Answer]
    single: Mapping[str, Answer]
    widths: Mapping[str, float]
    acceptance: Estimate
    warnings: tuple[str, ...] = ()
    heavy: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    extremes: tuple[Extreme, ...] = ()
    ordered: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    forms: Mapping[str, Form] = field(default_factory=dict)

    def form(self, forecast: str) -> Form:
        """How a forecast's numbers are written."""
        return self.forms.get(forecast, PLAIN)

    def asks(self, forecast: str, statistic: str) -> bool:
        """Whether a statistic is asked for: it converges, and of a yes/no answer it is its share."""
        counted = self.form(forecast).kind is Kind.YES_NO
        return statistic not in self.heavy.get(forecast, ()) and not (counted and statistic != "mean")

    def quantile_need(self, forecast: Forecast, statistic: str, tolerance: float) -> QuantileNeed | None:
        """Return what an end of a forecast's central range needs, as far as the reference knows; else None."""
        own, single = (getattr(each[forecast.name], statistic) for each in (self.errors, self.single))
        ordered = self.ordered.get(forecast.name)
        if ordered is None or ordered.size < 2 or not (own > 0.0 and single > 0.0 and tolerance > 0.0):
            return None
        tail = (1.0 - forecast.central) / 2.0
        p = tail if statistic == "low" else 1.0 - tail
        return quantile_need(ordered, p, tolerance, self.accepted, own * self.accepted**0.5 / single)

    def theory(self, forecast: str, statistic: str, trials: int) -> float:
        """Return the standard error of one number of a forecast in a run of so many independent trials."""
        return float(getattr(self.single[forecast], statistic)) / float(np.sqrt(trials * self.acceptance.value))


def fastest_engine(model: CompiledModel) -> str:
    """`jit` where it is installed and knows the model, or else `numpy`."""
    try:
        model.program("jit")
    except SimulationError:
        return "numpy"
    return "jit"


@dataclass(frozen=True, slots=True)
class Probe:
    """A short run, which says how long longer ones take.

    Attributes:
        trials, accepted: how many it ran, and how many were accepted.
        seconds: how long it took, with its statistics.
        reference: what it says itself, for want of a longer run; None if too few trials are accepted.
    """

    trials: int
    accepted: int
    seconds: float
    reference: Reference | None

    @property
    def sampling(self) -> str:
        """That of the reference: Sobol points where no filter rejects anything."""
        return "sobol" if self.accepted == self.trials else "mc"

    def trials_in(self, seconds: float) -> int:
        """How many trials of the reference take about so many seconds, a power of two."""
        rate = self.trials / self.seconds
        most = min(_MOST_REFERENCE, int(rate * seconds), int(_MOST_ACCEPTED * self.trials / max(self.accepted, 1)))
        return 1 << (max(most, _LEAST).bit_length() - 1)


def probe_of(model: CompiledModel, engine: str, seed: int, trials: int) -> Probe:
    """Make a short run, of independent trials.

    Raises:
        SimulationError: a forecast is too large for its errors to be squared.
    """
    started = time.perf_counter()
    result = simulate(model, trials=trials, seed=seed, engine=engine, sampling="mc", keep_inputs=_WATCHED)
    reference = _of_run(result, started) if result.accepted >= _ACCEPTED else None
    return Probe(result.trials, result.accepted, time.perf_counter() - started, reference)


def reference_of(model: CompiledModel, trials: int, sampling: str, engine: str, seed: int) -> Reference:
    """Run the reference.

    Raises:
        SimulationError: fewer than 100 trials are accepted, or a forecast is too large for its errors to be squared.
    """
    started = time.perf_counter()
    run = simulate(model, trials=trials, seed=seed, sampling=sampling, engine=engine, keep_inputs=_WATCHED)
    if run.accepted < _ACCEPTED:
        message = (
            f"the filters accept {run.accepted} of {count_text(run.trials)} reference trials, "
            "too few to measure methods with"
        )
        raise SimulationError(
            message, hint="give more reference trials, or see whether the filters contradict the inputs"
        )
    return _of_run(run, started)


def _of_run(run: RunResult, started: float) -> Reference:
    """Return what a run says of itself, which was begun at `started`, a time of the clock.

    Raises:
        SimulationError: a forecast is too large for its errors to be squared.
    """
    model = run.model
    for forecast in model.forecasts:
        if np.max(np.abs(run[forecast.name].sample.x), initial=0.0) > _LARGEST:
            message = f"the forecast {forecast.name!r} is beyond 1E150 in some trials: its errors cannot be squared"
            raise SimulationError(message, where=forecast.cell, hint="give it in larger units")
    numbers = {f.name: _numbers(run, f) for f in model.forecasts}
    return Reference(
        trials=run.trials,
        accepted=run.accepted,
        sampling=run.settings.sampling,
        engine=run.settings.engine,
        seed=run.settings.seed,
        seconds=time.perf_counter() - started,
        answers={name: result[0] for name, result in numbers.items()},
        errors={name: results[1] for name, results in numbers.items()},
        single={name: answer[2] for name, answer in numbers.items()},
        widths={f.name: _width(run[f.name].sample, numbers[f.name][0]) for f in model.forecasts},
        acceptance=run.acceptance,
        warnings=tuple(run.warnings),
        extremes=extremes_of(run.forecasts, run.trial_index, run.settings.seed, run.plan),
        ordered={f.name: _thinned(run[f.name].sample.x) for f in model.forecasts},
        forms={f.name: run.results[f.name].form for f in model.forecasts},
        heavy={f.name: lost for f in model.forecasts if (lost := _lost(run[f.name].sample.x))},
    )


def unfiltered_of(model: CompiledModel, reference: Reference) -> Reference | None:
    """Return the forecasts without the filters, by a run of up to 1,048,576 trials.

    None if no filter rejects anything, or where forecasts are no numbers in trials that the filters reject: then
    there is no such answer.
    """
    if not model.filters or reference.accepted == reference.trials:
        return None
    free = CompiledModel(model.workbook, replace(model.definitions, filters=(), checks=()), model.path)
    trials = min(reference.trials, _UNFILTERED)
    try:
        result = reference_of(free, trials, "mc", reference.engine, reference.seed)
    except SimulationError:
        return None
    return None if result.warnings or result.heavy else result


def _thinned(ordered: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) values of the middles of as many equal parts."""
    if ordered.size <= _MOST_ORDERED:
        return ordered
    return ordered[((np.arange(_MOST_ORDERED) + 0.5) * (ordered.size / _MOST_ORDERED)).astype(np.int64)]


def _width(sample: Sample, answer: Answer) -> float:
    """Return the width from the 5 % to the 95 % quantile; 0 where a forecast does not vary."""
    if sample.n < 2 or not answer.sd > _ROUNDING * abs(answer.mean):
        return 0.0
    low, high = sample.quantile(np.array([0.05, 0.95]))
    return float(high - low) if high > low else _NORMAL_WIDTH * answer.sd


def _lost(x: NDArray[np.float64]) -> tuple[str, ...]:
    """Return the statistics of a forecast that do not converge."""
    pair = heavy_tail(x)
    if pair is None:
        return ()
    index, error = pair
    return ("mean", "sd") if index - 2 * error <= 1.0 else ("sd",)


def _numbers(run: RunResult, forecast: Forecast) -> tuple[Answer, Answer, Answer]:
    sample = run[forecast.name].sample
    if sample.n < 2:
        return Answer(), Answer(), Answer()
    own = _estimates(sample, forecast.central)
    single = own if sample.group is None else _estimates(Sample(sample.x), forecast.central)
    root = float(np.sqrt(sample.n))
    return (
        Answer(*(each.value for each in own)),
        Answer(*(_error(each) for each in own)),
        Answer(*(_error(each) * root for each in single)),
    )


def _estimates(sample: Sample, central: float) -> tuple[Estimate, ...]:
    return (
        statistics.mean(sample),
        statistics.standard_deviation(sample),
        *statistics.central_interval(sample, central),
    )


def _error(estimate: Estimate) -> float:
    return np.nan if estimate.error is None else estimate.error
