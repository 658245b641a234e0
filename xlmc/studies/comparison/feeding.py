"""A book whose assumption is drawn from what another book answers: the model that the scene would need beside it.

A template of time and distance takes the speed at the impact as an assumption. A rough range may do: then no model of
the impact is needed. Whether it does is seen by drawing the assumption from the accepted trials of such a model, and
comparing. Each accepted trial is as likely as the others. The draws do not depend on the inputs that both books may
share; with other assumptions of the first book they are correlated as the replaced draws were.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

from xlmc.address import InFormula
from xlmc.definitions.definitions import Assumption, Forecast
from xlmc.distributions.empirical import Empirical
from xlmc.distributions.spelling import name_key
from xlmc.errors import SimulationError
from xlmc.run.model import Model
from xlmc.run.simulation import Simulation
from xlmc.studies.comparison.tolerances import factor_between

__all__ = ["fed_model"]

Named = TypeVar("Named", Assumption, Forecast)

_FEWEST: Final = 100
"""Accepted trials that stand for a distribution."""


def fed_model(model: Model, source: Simulation, feeds: Mapping[str, str]) -> Model:
    """The model with assumptions drawn from the accepted trials of another book.

    Args:
        model: stays as it is.
        source: the run of the other book.
        feeds: name of an assumption -> name of a forecast of the other book.

    Raises:
        SimulationError: there is no such assumption or forecast, nothing needs the assumption, a call in a formula
            draws it, units are of two kinds, or too few trials give a number.
    """
    named = {name_key(a.name): a for a in model.assumptions}
    given = {name_key(f.name): f for f in source.model.forecasts}
    fed: dict[str, Assumption] = {}
    for mine, theirs in feeds.items():
        assumption = _found(mine, named, "assumption", model)
        forecast = _found(theirs, given, "forecast", source.model)
        if assumption in model.needed.idle:
            message = f"no forecast or filter needs the assumption {assumption.name!r}"
            raise SimulationError(message, where=assumption.cell, hint="feed one that the answers depend on")
        if isinstance(assumption.cell, InFormula):  # whose formula may shift what the call draws
            message = f"the assumption {assumption.name!r} is drawn by a call in a formula"
            raise SimulationError(message, where=assumption.row, hint="give it a cell and a row in xlmc_assumptions")
        fed[assumption.name] = _drawn_from(assumption, forecast, source)
    definitions = replace(model.definitions, assumptions=tuple(fed.get(a.name, a) for a in model.assumptions))
    return Model(model.workbook, definitions, Path(f"{model.path.name} fed by {source.model.path.name}"))


def _found(name: str, known: Mapping[str, Named], kind: str, model: Model) -> Named:
    if name_key(name) not in known:
        hint = f"there are {', '.join(repr(each.name) for each in known.values())}"
        raise SimulationError(f"there is no {kind} {name.strip()!r}", where=model.path.name, hint=hint)
    return known[name_key(name)]


def _drawn_from(assumption: Assumption, forecast: Forecast, source: Simulation) -> Assumption:
    factor = factor_between(forecast.units, assumption.units)
    if factor is None:
        units = " and ".join(repr(each.units) if each.units else "no unit" for each in (assumption, forecast))
        message = f"the assumption {assumption.name!r} and the forecast {forecast.name!r} have the units {units}"
        raise SimulationError(message, where=assumption.cell, hint="give both the same Units, or such as mph, km/h, m")
    values = source.forecasts[forecast.name] * factor
    values = values[np.isfinite(values)]
    if values.size < _FEWEST:
        message = f"{forecast.name!r} is a number in {values.size} accepted trials, too few to draw from"
        raise SimulationError(message, where=source.model.path.name, hint="run more trials: -n")
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
