"""All methods on one workbook: what each costs, and how far it is from a converged reference."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from xlmc.definitions.stopping import as_tolerance
from xlmc.errors import SimulationError
from xlmc.methods.answer import STATISTICS, Answer, Method, MethodResult
from xlmc.methods.corners import Corners
from xlmc.methods.curve import Curve, rung_of
from xlmc.methods.first_order import FirstOrder
from xlmc.methods.importance_grid import ImportanceGrid
from xlmc.methods.optimised import Optimised
from xlmc.methods.reference import Reference, fastest_engine, reference_of, reference_size
from xlmc.methods.sampled import ENGINE_VARIANTS, MONTE_CARLO, SAMPLERS, Sampled
from xlmc.methods.second_order import SecondOrder
from xlmc.methods.surrogate import Surrogate
from xlmc.methods.worst_case import WorstCase
from xlmc.model import Model

__all__ = ["ACCURACY", "REPLICATES", "Study", "ladder_of", "study"]

ACCURACY: Final = "1%"
REPLICATES: Final = 24
"""They know a root mean square error to 15 %."""

MOST_TRIALS: Final = 1 << 18
RUNGS: Final = (16, 4, 1)
"""The trials of the longest runs over those of each rung."""

ONCE: Final[tuple[Method, ...]] = (Corners(), Optimised(), WorstCase(), FirstOrder(), SecondOrder())
DRAWN: Final[tuple[Method, ...]] = (*SAMPLERS, ImportanceGrid(), Surrogate())

_REFERENCE_SECONDS: Final = 8.0
_LONGEST_RUN: Final = 0.25
_APART: Final = 1_000_000
"""Between the seeds of the runs of one length and those of the next: runs of different lengths share no trials."""

SLOW: Final = "formulas"

_ROUNDING: Final = 1e-12

_RUNS_SECONDS, _LEAST_RUNS = 5.0, 6
"""Of one method and length, where nobody says how many there shall be."""

_FEW: Final = 8
"""Trials that the slow reference engine is timed by."""

_PATIENCE: Final = 1.0
"""Seconds of a run that is too long to be repeated."""

Told = Callable[[str], None]


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """What was measured.

    Attributes:
        model: the workbook.
        seed: of the reference; the replicates have others.
        accuracy: what is asked of the answers, as typed, the number, and whether it is a share of each number.
        reference: what the errors are from.
        ladder: trials of the runs of methods that draw.
        replicates: the most runs of each length.
        once: the methods that give one answer, the cheapest idea first.
        curves: the methods that draw.
        engines: the same trials as Monte Carlo's, computed by other engines.
        absent: method -> why it could not be used.
    """

    model: Model
    seed: int
    accuracy: tuple[str, float, bool]
    reference: Reference
    ladder: tuple[int, ...]
    replicates: int
    once: tuple[Curve, ...]
    curves: tuple[Curve, ...]
    engines: tuple[Curve, ...]
    absent: Mapping[str, str]

    @property
    def every(self) -> tuple[Curve, ...]:
        return (*self.once, *self.curves, *self.engines)

    @property
    def varying(self) -> tuple[str, ...]:
        """The forecasts that have any spread; of the others every method knows everything."""
        found = self.reference.answers
        return tuple(name for name, answer in found.items() if answer.sd > _ROUNDING * abs(answer.mean))

    def converges(self, forecast: str, statistic: str) -> bool:
        """Whether there is something to come near to: the forecast varies, and its tail is not too heavy for this."""
        return forecast in self.varying and statistic not in self.reference.heavy.get(forecast, ())

    def tolerance(self, forecast: str, statistic: str) -> float:
        """The error asked for, in the forecast's units."""
        _, value, relative = self.accuracy
        return value * abs(float(getattr(self.reference.answers[forecast], statistic))) if relative else value


def study(
    model: Model,
    *,
    accuracy: str = ACCURACY,
    reference_trials: int | None = None,
    trials: int | None = None,
    replicates: int | None = None,
    seed: int | None = None,
    told: Told | None = None,
) -> Study:
    """Measure every method on a workbook.

    Args:
        model: the workbook.
        accuracy: of mean, standard deviation and both ends of the central range, that 95 of 100 runs keep: `1%` of
            each number, or a number in the forecasts' units.
        reference_trials: by default a power of two of them, up to 33,554,432, that takes about eight seconds.
        trials: of the longest runs; by default a power of two, up to 262,144, that takes a quarter of a second.
        replicates: runs of each length, 2 or more; by default 24, or as many as take a method five seconds, 6 at least.
        seed: of the reference; by default the workbook's.
        told: called with what is being measured.

    Raises:
        SimulationError: an argument is out of its range, or the reference accepts too few trials.
    """
    wanted = (accuracy.strip(), *as_tolerance(accuracy))
    own = model.definitions.settings.seed if seed is None else seed
    _check(own, replicates, trials, reference_trials, model)
    tell = told or (lambda _: None)
    engine = fastest_engine(model)
    tell("how fast the workbook is")
    size, sampling = reference_size(model, engine, own, _REFERENCE_SECONDS)
    size = reference_trials or size
    tell(f"the reference, {size:,} trials")
    reference = reference_of(model, size, sampling, engine, own)
    ladder = ladder_of(model, trials, own)
    measuring = _Measuring(model, reference, ladder, replicates, own, tell)
    once = measuring.once(ONCE)
    found = measuring.drawn(DRAWN, [each for each in ENGINE_VARIANTS if each.engine != SLOW])
    curves = tuple(curve for curve in found if curve.method in DRAWN)
    engines = tuple(curve for curve in found if curve.method not in DRAWN)
    for variant in ENGINE_VARIANTS:
        if variant.engine == SLOW:
            engines += measuring.slow(variant, next(curve for curve in curves if curve.method is MONTE_CARLO))
    return Study(
        model, own, wanted, reference, ladder, replicates or REPLICATES, once, curves, engines, measuring.absent
    )


def ladder_of(model: Model, most: int | None, seed: int) -> tuple[int, ...]:
    """Trials of the runs, the fewest first; without a wish, as many as take a quarter of a second at the most."""
    if most is None:
        first = MONTE_CARLO.run(model, 1_024, seed)
        rate = 1_024 / first.seconds
        for trials in (8_192, 65_536, MOST_TRIALS):
            if trials / rate > 4.0 * _LONGEST_RUN:
                break
            rate = trials / MONTE_CARLO.run(model, trials, seed).seconds
        most = 1 << (int(min(MOST_TRIALS, max(rate * _LONGEST_RUN, 1_024))).bit_length() - 1)
    return tuple(dict.fromkeys(max(most // part, 16) for part in RUNGS))


def _check(seed: int, replicates: int | None, trials: int | None, reference: int | None, model: Model) -> None:
    if not model.forecasts:
        raise SimulationError("the workbook has no forecast", hint="add one to the table xlmc_forecasts")
    if not model.live:
        message = "no assumption that the forecasts or filters need is drawn, so that every method gives the same"
        raise SimulationError(message, hint="give the table xlmc_assumptions a range that a forecast depends on")
    if seed < 0:
        raise SimulationError(f"the seed {seed} is negative", hint="give a whole number from 0 up")
    if replicates is not None and replicates < 2:
        raise SimulationError(f"{replicates} replicates were asked for", hint="give 2 or more; 24 are usual")
    for what, given, least in (("trials", trials, 1_024), ("reference trials", reference, 1_024)):
        if given is not None and given < least:
            raise SimulationError(f"{given:,} {what} were asked for", hint=f"give {least:,} or more")


class _Measuring:
    """The runs of one study."""

    def __init__(
        self, model: Model, reference: Reference, ladder: Sequence[int], replicates: int | None, seed: int, tell: Told
    ) -> None:
        self._model, self._reference, self._ladder = model, reference, ladder
        self._replicates, self._limited = replicates or REPLICATES, replicates is None
        self._seed, self._tell = seed, tell
        self.absent: dict[str, str] = {}

    def once(self, methods: Sequence[Method]) -> tuple[Curve, ...]:
        """The methods that need to be run only once; twice, so that the second time says what it costs."""
        found = []
        for method in methods:
            self._tell(method.name)
            first = self._tried(method, self._ladder[-1])
            if first is None:
                continue
            again = method.run(self._model, self._ladder[-1], self._seed) if first.seconds < _PATIENCE else first
            result = replace(again, seconds=min(first.seconds, again.seconds))
            rung = rung_of(result.evaluations, [result], self._reference)
            ranges = {name: (a.least, a.most) for name, a in result.answers.items() if np.isfinite(a.least)}
            setup = max(0.0, first.seconds - again.seconds)
            found.append(Curve(method, (rung,), setup, result.remarks, ranges))
        return tuple(found)

    def drawn(self, methods: Sequence[Method], engines: Sequence[Sampled]) -> tuple[Curve, ...]:
        """The methods that draw, and the engines, which compute the trials that the first of these has computed.

        All in turn, run length after run length, so that whatever else the machine does is shared among them.
        """
        firsts = {method.key: self._tried(method, self._ladder[0]) for method in (*methods, *engines)}
        able = [method for method in (*methods, *engines) if firsts[method.key] is not None]
        results: dict[tuple[str, int], list[MethodResult]] = {(m.key, b): [] for m in able for b in self._ladder}
        for replicate in range(self._replicates):
            self._tell(
                f"runs of {self._ladder[0]:,} to {self._ladder[-1]:,} trials, {replicate + 1} of {self._replicates}"
            )
            for number, budget in enumerate(self._ladder):
                seed = self._seed + 1 + number * _APART + replicate
                for method in able:
                    known = results[method.key, budget]
                    if not (self._limited and _enough(known)):
                        known.append(self._run(method, budget, seed))
        return tuple(self._curve(method, firsts[method.key], results) for method in able)

    def _run(self, method: Method, budget: int, seed: int) -> MethodResult:
        """One run of a method that can be used; one that fails, for want of accepted trials, is counted as such."""
        try:
            return method.run(self._model, budget, seed)
        except SimulationError as error:
            nothing = {forecast.name: Answer() for forecast in self._model.forecasts}
            return MethodResult(np.nan, budget, nothing, remarks=(str(error),))

    def _curve(
        self, method: Method, first: MethodResult | None, results: Mapping[tuple[str, int], list[MethodResult]]
    ) -> Curve:
        rungs = tuple(rung_of(budget, results[method.key, budget], self._reference) for budget in self._ladder)
        remarks = results[method.key, self._ladder[-1]][-1].remarks
        plain = results.get((MONTE_CARLO.key, self._ladder[0]))
        if isinstance(method, Sampled) and method.engine != MONTE_CARLO.engine and plain:
            remarks = (self._agreement(results[method.key, self._ladder[0]], plain),)
        setup = 0.0 if first is None else float(np.nan_to_num(max(0.0, first.seconds - rungs[0].seconds)))
        return Curve(method, rungs, setup, remarks, {})

    def slow(self, engine: Sampled, numpy: Curve) -> tuple[Curve, ...]:
        """An engine that is too slow for runs of any length: its time is worked out from a few trials."""
        self._tell(engine.name)
        first = self._tried(engine, _FEW)
        if first is None:
            return ()
        again = engine.run(self._model, _FEW, self._seed).seconds
        rungs = tuple(replace(r, seconds=again * r.budget / _FEW, measured=False) for r in numpy.rungs)
        said = f"the same trials as {numpy.method.name}; time worked out from {_FEW} of them"
        return (Curve(engine, rungs, max(0.0, first.seconds - again), (said,), {}),)

    def _tried(self, method: Method, budget: int) -> MethodResult | None:
        """A method's first run; None, and why, where it cannot be used."""
        try:
            return method.run(self._model, budget, self._seed)
        except SimulationError as error:
            self.absent[method.name] = str(error)
            return None

    def _agreement(self, found: Sequence[MethodResult], numpy: Sequence[MethodResult]) -> str:
        """How far an engine's answers are from those of `numpy` at the same trials, in standard deviations."""
        apart = [
            abs(getattr(answer, statistic) - getattr(other.answers[name], statistic)) / self._reference.answers[name].sd
            for one, other in zip(found, numpy, strict=False)
            for name, answer in one.answers.items()
            for statistic in STATISTICS
            if self._reference.answers[name].sd > 0.0
        ]
        known = [each for each in apart if np.isfinite(each)]
        return f"answers at the same trials differ from those of numpy by {max(known, default=0.0):.1g} SD at the most"


def _enough(results: Sequence[MethodResult]) -> bool:
    """Whether runs of one length have taken their time."""
    return len(results) >= _LEAST_RUNS and sum(result.seconds for result in results) > _RUNS_SECONDS
