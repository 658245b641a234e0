"""All methods on one workbook: what each costs, and how far it is from a converged reference."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Final

import numpy as np

from xlmc.definitions.stopping import as_tolerance
from xlmc.errors import SimulationError
from xlmc.methods.answer import Method, MethodResult
from xlmc.methods.corners import Corners
from xlmc.methods.curve import Curve, Rung, rung_of
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

MOST_TRIALS: Final = 1 << 17
RUNGS: Final = (16, 4, 1)
"""The trials of the longest runs over those of each rung."""

ONCE: Final[tuple[Method, ...]] = (Corners(), Optimised(), WorstCase(), FirstOrder(), SecondOrder())
DRAWN: Final[tuple[Method, ...]] = (*SAMPLERS, ImportanceGrid(), Surrogate())

_REFERENCE_SECONDS: Final = 6.0
_LONGEST_RUN: Final = 0.25
_TIMED: Final = 5
"""Runs of each length that an engine is timed by; what it answers is known already."""

_RUNS_SECONDS, _LEAST_RUNS = 5.0, 6
"""Of one method and length, where nobody says how many there shall be."""

_FEW: Final = 8
"""Trials that the slow reference engine is timed by, where the shortest runs would take it too long."""

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
        engines: the same trials as the first of these, computed by other engines.
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
        reference_trials: by default a power of two of them, up to 33,554,432, that takes about six seconds.
        trials: of the longest runs; by default a power of two, up to 131,072, that takes a quarter of a second.
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
    curves = measuring.drawn(DRAWN)
    engines = measuring.engines(ENGINE_VARIANTS, next(c for c in curves if c.method is MONTE_CARLO))
    return Study(
        model, own, wanted, reference, ladder, replicates or REPLICATES, once, curves, engines, measuring.absent
    )


def ladder_of(model: Model, most: int | None, seed: int) -> tuple[int, ...]:
    """Trials of the runs, the fewest first; without a wish, as many as take a quarter of a second at the most."""
    if most is None:
        first = MONTE_CARLO.run(model, 1_024, seed)
        rate = 1_024 / first.seconds
        for trials in (8_192, MOST_TRIALS):
            if trials / rate > 4.0 * _LONGEST_RUN:
                break
            rate = trials / MONTE_CARLO.run(model, trials, seed).seconds
        most = 1 << (int(min(MOST_TRIALS, max(rate * _LONGEST_RUN, 1_024))).bit_length() - 1)
    return tuple(dict.fromkeys(max(most // part, 16) for part in RUNGS))


def _check(seed: int, replicates: int | None, trials: int | None, reference: int | None, model: Model) -> None:
    if not model.forecasts:
        raise SimulationError("the workbook has no forecast", hint="add one to the table xlmc_forecasts")
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
        self._first: dict[int, MethodResult] = {}

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

    def drawn(self, methods: Sequence[Method]) -> tuple[Curve, ...]:
        """The methods that draw: in turn, so that what else the machine does is shared among them."""
        firsts = {method.key: self._tried(method, self._ladder[0]) for method in methods}
        able = [method for method in methods if firsts[method.key] is not None]
        rungs: dict[str, list[Rung]] = {method.key: [] for method in able}
        last: dict[str, MethodResult] = {}
        for number, budget in enumerate(self._ladder):
            results: dict[str, list[MethodResult]] = {method.key: [] for method in able}
            for replicate in range(self._replicates):
                self._tell(f"runs of {budget:,} trials, {replicate + 1} of {self._replicates}")
                for method in able:
                    if self._limited and _enough(results[method.key]):
                        continue
                    seed = self._seed + 1 + number * 1_000_000 + replicate
                    results[method.key].append(method.run(self._model, budget, seed))
            for method in able:
                rungs[method.key].append(rung_of(budget, results[method.key], self._reference))
                last[method.key] = results[method.key][-1]
            self._first[budget] = results[MONTE_CARLO.key][0]
        return tuple(
            Curve(
                method,
                tuple(rungs[method.key]),
                max(0.0, _seconds(firsts[method.key]) - rungs[method.key][0].seconds),
                last[method.key].remarks,
                {},
            )
            for method in able
        )

    def engines(self, variants: Sequence[Sampled], numpy: Curve) -> tuple[Curve, ...]:
        """The engines: they compute the trials that `numpy` has computed, so that only their time is measured."""
        found = []
        for variant in variants:
            self._tell(variant.name)
            first = self._tried(variant, _FEW if variant.engine == "formulas" else self._ladder[0])
            if first is None:
                continue
            rungs, remarks = [], list[str]()
            for number, rung in enumerate(numpy.rungs):
                expected = first.seconds * rung.budget / _FEW if variant.engine == "formulas" else 0.0
                if expected > _PATIENCE:
                    rungs.append(replace(rung, seconds=expected, measured=False))
                    continue
                seed = self._seed + 1 + number * 1_000_000
                runs = [variant.run(self._model, rung.budget, seed) for _ in range(_TIMED)]
                rungs.append(replace(rung, seconds=median(run.seconds for run in runs)))
                remarks = [self._agreement(runs[0], self._first[rung.budget])]
            if not all(rung.measured for rung in rungs):
                remarks.append(f"time worked out from {_FEW} trials")
            setup = 0.0 if variant.engine == "formulas" else max(0.0, first.seconds - rungs[0].seconds)
            found.append(Curve(variant, tuple(rungs), setup, tuple(remarks), {}))
        return tuple(found)

    def _tried(self, method: Method, budget: int) -> MethodResult | None:
        """A method's first run; None, and why, where it cannot be used."""
        try:
            return method.run(self._model, budget, self._seed)
        except SimulationError as error:
            self.absent[method.name] = str(error)
            return None

    def _agreement(self, found: MethodResult, numpy: MethodResult) -> str:
        """How far an engine's answers are from those of `numpy` at the same trials, in standard deviations."""
        apart = [
            abs(getattr(answer, statistic) - getattr(numpy.answers[name], statistic)) / self._reference.answers[name].sd
            for name, answer in found.answers.items()
            for statistic in ("mean", "sd", "low", "high")
        ]
        return f"answers at the same trials differ from those of numpy by {np.nanmax(apart):.1g} SD at the most"


def _enough(results: Sequence[MethodResult]) -> bool:
    """Whether runs of one length have taken their time."""
    return len(results) >= _LEAST_RUNS and sum(result.seconds for result in results) > _RUNS_SECONDS


def _seconds(result: MethodResult | None) -> float:
    return 0.0 if result is None else result.seconds
