"""The whole sensitivity analysis of a run: what its answers depend on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

import numpy as np

from xlmc.analysis.studies.sensitivity.influences import MEASURED, Chosen, choose, influences
from xlmc.analysis.studies.sensitivity.limit_trials import TriedLimit, limit_trials
from xlmc.analysis.studies.sensitivity.measures import FilterLimit, ForecastSensitivity, Influence, Sensitivities
from xlmc.analysis.studies.sensitivity.moved_limit import moved_limit
from xlmc.analysis.studies.sensitivity.one_at_a_time import one_at_a_time
from xlmc.analysis.studies.sensitivity.pick_and_freeze import SobolRun, pick_and_freeze, why_not
from xlmc.montecarlo.model.keywords import assumption_named

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Forecast
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["sensitivities"]

_MOST_LIMITS: Final = 40
_MOST_LIMIT_FORECASTS: Final = 12
"""The most limits; more would make no readable charts, and take long."""

_WORDS: Final = {">=": "at least", "<=": "at most", ">": "above", "<": "below"}
_KNOWN: Final[WeakKeyDictionary[RunResult, dict[tuple[tuple[int, ...], frozenset[str]], Sensitivities]]] = (
    WeakKeyDictionary()
)
"""By the numbers of the forecasts and the assumptions asked for. Sheets, page and JSON of one run want the same."""


def sensitivities(
    simulation: RunResult,
    names: Collection[str] | None = None,
    progress: Callable[[float], None] = lambda share: None,
    *,
    assumptions: Collection[str] = (),
) -> Sensitivities:
    """Say what the answers of a finished run depend on. Nothing random is in it but the run's own draws.

    Args:
        simulation: the run.
        names: of the forecasts that are wanted; None for the run's `detailed` ones. Of fewer, more trials may be
            examined.
        progress: takes the share of the work that is done.
        assumptions: names of those that are measured for every forecast; of more than 20, else only the 20 are that
            matter most for each.

    Raises:
        SimulationError: no assumption that is drawn has one of these names.
    """
    model, known = simulation.model, _KNOWN.setdefault(simulation, {})
    names = simulation.detailed if names is None else names
    result = [i for i, each in enumerate(model.forecasts) if each.name in names]
    wanted = tuple(i for i in result if i not in model.categories)  # texts have no variance to explain
    asked = frozenset(assumption_named(model, name, drawn=True) for name in assumptions)
    if (wanted, asked) not in known:
        known[wanted, asked] = _analyse(simulation, wanted, asked, progress)
    return known[wanted, asked]


def _analyse(
    simulation: RunResult, wanted: Sequence[int], asked: Collection[str], progress: Callable[[float], None]
) -> Sensitivities:
    model = simulation.model
    forecasts = [model.forecasts[index] for index in wanted]
    chosen = choose(simulation, forecasts, asked)
    result = influences(simulation, chosen, forecasts, lambda share: progress(0.5 * share))
    moves = one_at_a_time(model, [a.name for a in model.live], wanted, MEASURED, asked)
    reason = why_not(simulation) if model.live else "Sobol indices are not given: no assumption is drawn"
    progress(0.5)
    sobol = SobolRun(0, {})
    if not reason:
        sobol = pick_and_freeze(
            model,
            _measured_for(chosen, wanted),
            simulation.trials,
            simulation.settings.seed,
            lambda share: progress(0.5 + 0.5 * share),
        )
    limits = limit_trials(simulation, _MOST_LIMITS, wanted[:_MOST_LIMIT_FORECASTS])
    return Sensitivities(
        accepted=simulation.accepted,
        examined=max((each.trials for each in result), default=0),
        forecasts=tuple(
            ForecastSensitivity(
                forecast=forecast.name,
                units=forecast.units,
                trials=each.trials,
                influences=tuple(_with_sobol(influence, sobol, index) for influence in each.influences),
                omitted=len(model.live) - len(names),
                base=moves.base[index],
                bars=moves.bars[index],
                form=simulation.results[forecast.name].form,
            )
            for index, forecast, each, names in zip(wanted, forecasts, result, chosen.names, strict=True)
        ),
        omitted=len(model.live) - len(chosen.most_influential),
        medians=moves.medians,
        sobol_reason=reason,
        sobol_trials=sobol.pairs,
        filter_limits=tuple(_move_limit(forecasts[:_MOST_LIMIT_FORECASTS], tried) for tried in limits.tried),
        omitted_limits=limits.omitted,
        varying_limits=limits.varying,
        omitted_forecasts=len(model.forecasts) - len(model.categories) - len(wanted),
    )


def _measured_for(chosen: Chosen, wanted: Sequence[int]) -> dict[str, list[int]]:
    """Return the numbers of the forecasts that each assumption is measured for, the most influential first."""
    result: dict[str, list[int]] = {name: [] for name in chosen.most_influential}
    for index, names in zip(wanted, chosen.names, strict=True):
        for name in names:
            result[name].append(index)
    return result


def _with_sobol(influence: Influence, run: SobolRun, forecast: int) -> Influence:
    if influence.assumption not in run.indices:
        return influence
    first, total = run.indices[influence.assumption][forecast]
    return replace(influence, first_order=first, total=total)


def _move_limit(forecasts: Sequence[Forecast], tried: TriedLimit) -> FilterLimit:
    names, shares = [f.name for f in forecasts], [f.central for f in forecasts]
    with np.errstate(over="ignore", invalid="ignore"):  # forecasts near the largest double have no slope
        points, slopes = moved_limit(tried.trials, tried.grid, names, shares) if tried.grid else ((), ())
    return FilterLimit(
        filter=tried.limit.filter.name,
        cell=str(tried.limit.filter.cell),
        relation=_WORDS[tried.limit.relation],
        limit=tried.trials.limit,
        points=points,
        slopes=slopes,
        trials=tried.trials.trials,
        loosened_trials=tried.trials.loosened,
        form=tried.limit.filter.form,
    )
