"""Questions that one run does not answer, and distributions for measurements."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING, Any, Unpack

from numpy.typing import ArrayLike

from xlmc.api.models import Model, Simulation
from xlmc.errors import SimulationError

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison import CompareArguments, Comparison
    from xlmc.analysis.studies.decisions import DecideArguments, Decided
    from xlmc.analysis.studies.fitting import Fitting
    from xlmc.analysis.studies.methods import Study
    from xlmc.analysis.studies.optimising import OptimiseArguments, Optimised
    from xlmc.analysis.studies.screening import ScreenArguments, Screening
    from xlmc.analysis.studies.sensitivity import Sensitivities
    from xlmc.analysis.studies.stability import Stability
    from xlmc.analysis.studies.stress import StressArguments, Stressed
    from xlmc.analysis.studies.uncertainty import TwoLoops, UncertaintyArguments

__all__ = [
    "compare",
    "decide",
    "fit",
    "methods",
    "optimise",
    "screen",
    "sensitivities",
    "stability",
    "stress",
    "uncertainty",
]


def sensitivities(
    run: Simulation, *, assumptions: Collection[str] = (), forecasts: Collection[str] = ()
) -> Sensitivities:
    """Compute what the answers of a finished run depend on. Nothing random is in it but the run's own draws.

    Args:
        run: with one forecast or more.
        assumptions: names of those that are measured for every forecast. Where there are more than 20, the others are
            measured for a forecast only if they are among the 20 that matter most for it.
        forecasts: names of those to tell of; by default the first 20, or as many as `simulate(detailed=…)` says.

    Raises:
        SimulationError: no assumption that is drawn or no forecast has one of these names, or evidence weights the
            trials.
    """
    from xlmc.analysis.studies.sensitivity import sensitivities
    from xlmc.montecarlo.model.keywords import forecast_named

    if run.weights is not None:
        raise SimulationError(
            "Evidence weights the trials of this run, and sensitivities count them alike",
            hint='Run it with evidence="rejection"',
        )
    names = [forecast_named(run._run.model, name) for name in forecasts]
    return sensitivities(run._run, names or None, assumptions=assumptions)


def compare(
    first: Model,
    second: Model,
    tolerance: Iterable[str] | str = (),
    *,
    told: Callable[[str], None] | None = None,
    **options: Unpack[CompareArguments],
) -> Comparison:
    """Run two books of one scene over the same trials, and judge whether their answers agree.

    An assumption of the same name takes the same random numbers in both. Forecasts are paired by name. The trials are
    plain Monte Carlo, whatever the books' settings say.

    Args:
        first: a book; numbers are given in its units.
        second: the other; either may be the simpler.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD in the first book), `Name=0.5 mph`; a tenth of the SD
            where none is stated. It holds for mean, SD and both ends of the central range.
        told: the former name of `tell`.
        options: `pairs`, `feeds`, `trials`, `seed`, `engine`, `jobs`, `chance`, `causes` and `tell`, which
            `xlmc.analysis.studies.comparison.compare` describes.

    Raises:
        SimulationError: no forecast has a counterpart, a pair has units of two kinds, or an argument is out of its
            range.
    """
    from xlmc.analysis.studies.comparison import compare

    options.setdefault("tell", told)
    return compare(first._compiled, second._compiled, tolerance, **options)


def screen(
    model: Model,
    tolerance: Iterable[str] | str = (),
    *,
    told: Callable[[str], None] | None = None,
    **options: Unpack[ScreenArguments],
) -> Screening:
    """Find which assumptions may be frozen, and which filters left out, without moving an answer beyond the tolerance.

    The model and its workbook stay as they are. The trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: to screen.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD), `Name=0.5 mph`; a tenth of the SD where none is
            stated. It holds for mean, SD and both ends of the central range.
        told: the former name of `tell`.
        options: `chance`, `acceptance_tolerance`, `sets`, `judged_by`, `ends`, `trials`, `seed`, `engine`, `jobs` and
            `tell`, which `xlmc.analysis.studies.screening.screen` describes.

    Raises:
        SimulationError: an argument is out of its range, no name fits a set, or fewer than two trials are accepted, or
            give a number for any forecast.
    """
    from xlmc.analysis.studies.screening import screen

    options.setdefault("tell", told)
    return screen(model._compiled, tolerance, **options)


def methods(
    model: Model,
    *,
    accuracy: str = "1%",
    trials: int | None = None,
    replicates: int | None = None,
    reference_trials: int | None = None,
    time_limit: str | float | None = None,
    seed: int | None = None,
    quick: bool = False,
) -> Study:
    """Measure what each method of uncertainty analysis costs on a model, and what it misses.

    Args:
        model: to measure them on.
        accuracy: wanted of mean, SD and both ends of the central range in 95 of 100 runs: `1%` of the range from 5 to
            95 %, or a number in the forecasts' units.
        trials: of the longest runs.
        replicates: runs of each length.
        reference_trials: of the long run that errors are measured against.
        time_limit: of all, about: `60s`, `5m`, or seconds; what takes too much of it is left out, and named. By default
            a minute with more than 20 assumptions, if no number of trials or runs is given.
        seed: of the reference.
        quick: few and short runs, in about half a minute.

    Raises:
        SimulationError: an argument is out of its range, or the reference accepts too few trials.
    """
    from xlmc.analysis.studies.methods import quick_settings, study

    asked = {
        "trials": trials,
        "replicates": replicates,
        "reference_trials": reference_trials,
        "time_limit": time_limit,
    }
    given: dict[str, Any] = {name: value for name, value in asked.items() if value is not None}
    if quick:
        given = quick_settings(model._compiled, given)
    return study(model._compiled, accuracy=accuracy, seed=seed, **given)


def stability(model: Model, *, trials: int | None = None, seed: int | None = None, jobs: int = 1) -> Stability:
    """Find where a model loses digits, or its numbers are not what they seem, within the ranges of its assumptions.

    Args:
        model: of a workbook.
        trials: of the run that is looked at; by default the book's own.
        seed: of it.
        jobs: threads or processes.

    Raises:
        SimulationError: an argument is out of its range, or a function of Python computes the model.
    """
    from xlmc.analysis.studies.stability import stability

    return stability(model._compiled, trials=trials, seed=seed, jobs=jobs)


def decide(model: Model, names: Iterable[str] = (), **options: Unpack[DecideArguments]) -> Decided:
    """Run every combination of the values of one to three decisions, over the same random numbers.

    Args:
        model: of a workbook with a table `xlmc_decisions`; it stays as it is.
        names: of decisions, joined by commas, `*` for any letters; all where there are none.
        options: `trials`, `seed`, `sampling`, `engine`, `jobs` and `tell`, which
            `xlmc.analysis.studies.decisions.decide` describes.

    Raises:
        DefinitionError: the workbook has no decisions.
        SimulationError: there is no decision of a name, or there are too many decisions or combinations.
    """
    from xlmc.analysis.studies.decisions import decide

    return decide(model._compiled, names, **options)


def optimise(model: Model, **options: Unpack[OptimiseArguments]) -> Optimised:
    """Find the decisions with which a statistic of a forecast is largest, or smallest, and how sure that is.

    Args:
        model: of a workbook with a table `xlmc_decisions`; it stays as it is.
        options: `maximise` or `minimise`, `subject_to`, `decisions`, `indifference`, `allow_lost`, `runs`, `trials`,
            `seed`, `engine`, `jobs` and `tell`, which `xlmc.analysis.studies.optimising.optimise.optimise` describes.

    Raises:
        DefinitionError: the workbook has no decisions.
        SimulationError: what is asked for is not understood, or no combination meets what is required of decisions.
    """
    from xlmc.analysis.studies.optimising import optimise

    return optimise(model._compiled, **options)


def stress(model: Model, **options: Unpack[StressArguments]) -> Stressed:
    """Find the answers where each assumption in turn lies in its tails, and the inputs that distinguish some answers.

    The model and its workbook stay as they are. The trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: of a workbook.
        options: `share`, `assumptions`, `forecasts`, `scenarios`, `trials`, `seed`, `engine`, `jobs` and `tell`, which
            `xlmc.analysis.studies.stress.stress` describes.

    Raises:
        SimulationError: an argument is out of its range, no name fits, nothing is drawn, or few trials are accepted.
    """
    from xlmc.analysis.studies.stress import stress

    return stress(model._compiled, **options)


def uncertainty(model: Model, **options: Unpack[UncertaintyArguments]) -> TwoLoops:
    """Draw what is uncertain in an outer loop and what varies in an inner one, and find the bands of each answer.

    The model and its workbook stay as they are. The inner trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: with assumptions that are `Uncertain` under `Kind of uncertainty`, or that `uncertain` names.
        options: `outer`, `inner`, `confidence`, `percents`, `uncertain`, `judged`, `seed`, `engine`, `jobs`,
            `keep_trials` and `tell`, which `xlmc.analysis.studies.uncertainty.uncertainty` describes.

    Raises:
        SimulationError: an argument is out of its range, or no trial is accepted.
        DefinitionError: no assumption is uncertain, or an uncertain one depends on one that varies.
    """
    from xlmc.analysis.studies.uncertainty import uncertainty

    return uncertainty(model._compiled, **options)


def fit(values: ArrayLike, *, kind: str | None = None, by: str = "aic") -> Fitting:
    """Rank the distributions that describe measurements.

    Args:
        values: `(n,)`, two or more, not all equal.
        kind: `continuous` or `counts`; None: counts where every value is a whole number from 0 up.
        by: `aic`, `bic`, `ad` or `ks`.

    Raises:
        SimulationError: the values cannot be fitted, or there is no such kind or criterion.
    """
    from xlmc.analysis.studies.fitting import CRITERIA, KINDS, fit

    for given, known in ((kind, KINDS), (by, CRITERIA)):
        if given is not None and given not in known:
            raise SimulationError(f"{given!r} is unknown here", hint=f"Choose one of {', '.join(known)}")
    return fit(values, kind=kind, by=by)
