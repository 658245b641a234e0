"""A book whose assumption is drawn from what another book answers: the model that the scene would need beside it.

A template of time and distance takes the speed at the impact as an assumption. A rough range may do: then no model of
the impact is needed. Whether it does is seen by drawing the assumption from the accepted trials of such a model, and
comparing. Each accepted trial is as likely as the others. Several assumptions that are fed are drawn from the same
trial, for answers of one model belong together. The draws do not depend on the inputs that both books may share; that
of a single assumption is correlated with other assumptions of the first book as the replaced draws were.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace
from pathlib import Path
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import SimulationError
from xlmc.excel.address import InFormula
from xlmc.montecarlo.definitions.definitions import Assumption, Copula, Definitions, Forecast
from xlmc.montecarlo.definitions.units import factor_between
from xlmc.montecarlo.distributions.empirical import Empirical
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["fed_model"]

Floats = NDArray[np.float64]

Named = TypeVar("Named", Assumption, Forecast)

_FEWEST: Final = 100
"""Accepted trials that stand for a distribution."""


def fed_model(model: CompiledModel, source: RunResult, feeds: Mapping[str, str]) -> CompiledModel:
    """Return the model with assumptions drawn from the accepted trials of another book.

    Args:
        model: stays as it is.
        source: the run of the other book.
        feeds: name of an assumption -> name of a forecast of the other book.

    Raises:
        SimulationError: there is no such assumption or forecast, nothing needs the assumption, a call in a formula
            draws it, units are of two kinds, too few trials give a number, or one of several assumptions is correlated
            with one that is not fed.
    """
    named, given = by_names(model.assumptions), by_names(source.model.forecasts)
    fed: dict[str, Assumption] = {}
    values: list[Floats] = []
    for mine, theirs in feeds.items():
        assumption = _named(mine, named, "assumption", model)
        forecast = _named(theirs, given, "forecast", source.model)
        if assumption in model.needed.idle:
            message = f"no forecast or filter needs the assumption {assumption.name!r}"
            raise SimulationError(message, where=assumption.cell, hint="feed one that the answers depend on")
        if isinstance(assumption.cell, InFormula):  # whose formula may shift what the call draws
            message = f"the assumption {assumption.name!r} is drawn by a call in a formula"
            raise SimulationError(message, where=assumption.row, hint="give it a cell and a row in xlmc_assumptions")
        fed[assumption.name] = assumption
        values.append(source.numbers_of(forecast.name) * _factor(assumption, forecast))
    trials = np.stack(values)
    trials = trials[:, np.isfinite(trials).all(axis=0)]
    if trials.shape[1] < _FEWEST:
        answers = " and ".join(repr(_named(each, given, "forecast", source.model).name) for each in feeds.values())
        number = "is a number" if len(feeds) == 1 else "are numbers together"
        message = f"{answers} {number} in {trials.shape[1]} accepted trials, too few to draw from"
        raise SimulationError(message, where=source.model.path.name, hint="run more trials: -n")
    drawn = {name: _drawn_from(a, row, source) for (name, a), row in zip(fed.items(), trials, strict=True)}
    definitions = replace(model.definitions, assumptions=tuple(drawn.get(a.name, a) for a in model.assumptions))
    if len(fed) > 1:
        definitions = _together(definitions, fed, trials, source, frozenset(model.needed.live))
    return CompiledModel(model.workbook, definitions, Path(f"{model.path.name} fed by {source.model.path.name}"))


def _named(name: str, known: Mapping[str, Named], kind: str, model: CompiledModel) -> Named:
    if name_key(name) not in known:
        hint = f"there are {', '.join(dict.fromkeys(repr(each.name) for each in known.values()))}"
        raise SimulationError(f"there is no {kind} {name.strip()!r}", where=model.path.name, hint=hint)
    return known[name_key(name)]


def _factor(assumption: Assumption, forecast: Forecast) -> float:
    """Return what the forecast is multiplied by for the unit of the assumption.

    Raises:
        SimulationError: their units are of two kinds.
    """
    factor = factor_between(forecast.units, assumption.units)
    if factor is None:
        units = " and ".join(repr(each.units) if each.units else "no unit" for each in (assumption, forecast))
        message = f"the assumption {assumption.name!r} and the forecast {forecast.name!r} have the units {units}"
        raise SimulationError(message, where=assumption.cell, hint="give both the same Units, or such as mph, km/h, m")
    return factor


def _drawn_from(assumption: Assumption, values: Floats, source: RunResult) -> Assumption:
    return replace(
        assumption,
        distribution=f"from {source.model.path.name}",
        given={},
        frozen=False,
        own_family=Empirical().built(values[:, np.newaxis]),
        data=None,
        call=None,
        checked=None,
    )


def _together(
    definitions: Definitions, fed: Mapping[str, Assumption], trials: Floats, source: RunResult, live: Set[str]
) -> Definitions:
    """Return the definitions with assumptions that are drawn from the same trial, in place of rank correlations among
    them.

    Args:
        definitions: of the first book.
        fed: its assumptions, by name.
        trials: their values, `(k, m)`.
        source: the run of the other book.
        live: names of what is drawn.

    Raises:
        SimulationError: one of them is correlated with an assumption that is not fed.
    """
    rows = []
    for row in definitions.correlations:
        pair = {row.first, row.second}
        inside = pair & fed.keys()
        if len(inside) == 1 and row.value and pair <= live | fed.keys():
            message = f"{row.first!r} and {row.second!r} are correlated, and only one of them is fed"
            hint = "feed one assumption alone, or take the row out in a copy"
            raise SimulationError(message, where=row.row, hint=hint)
        if not inside:
            rows.append(row)
    where = next(iter(fed.values())).row
    joined = Copula(f"of the same trials of {source.model.path.name}", tuple(fed), where, trials=trials)
    return replace(definitions, correlations=tuple(rows), copulas=(*definitions.copulas, joined))
