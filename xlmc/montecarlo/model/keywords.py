"""Names that people type: of forecasts, and of assumptions, also as keywords: `road_friction` for `Road friction`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions.spelling import by_names, did_you_mean, name_key

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["assumption_named", "forecast_named", "keyword"]

_NO_LETTER: Final = re.compile(r"[\W_]+")


def keyword(name: str) -> str:
    """Return a name as a keyword: letters and digits, other signs as underscores.

    >>> keyword("Nissan delta-V, mph")
    'nissan_delta_v_mph'
    """
    return _NO_LETTER.sub("_", name.casefold()).strip("_")


def assumption_named(model: CompiledModel, name: str, *, drawn: bool = False) -> str:
    """Return the name of an assumption as defined, from that name whatever its case, or from its keyword.

    Args:
        model: with the assumption.
        name: or keyword.
        drawn: look among those alone that are drawn.

    Raises:
        SimulationError: there is none, or several have this keyword.
    """
    those = model.live if drawn else model.assumptions
    names = [a.name for a in those]
    known = by_names(those).get(name_key(name))
    result = [known.name] if known else [each for each in names if keyword(each) == keyword(name)]
    if len(result) == 1:
        return result[0]
    if result:
        message = f"{name!r} may be {' or '.join(map(repr, result))}"
        raise SimulationError(message, hint="Give the name as it is spelt there; to with_ in a dict: {name: …}")
    if drawn:
        message, listed = f"no assumption that is drawn is called {name!r}", ", ".join(map(repr, names))
        raise SimulationError(message, hint=f"They are {listed or 'none'}")
    raise SimulationError(f"there is no assumption {name!r}", hint=did_you_mean(name, names))


def forecast_named(model: CompiledModel, name: str) -> str:
    """Return the name of a forecast as defined, from that name whatever its case.

    Raises:
        SimulationError: there is none.
    """
    forecast = by_names(model.forecasts).get(name_key(name))
    if forecast is None:
        raise SimulationError(
            f"there is no forecast {name!r}", hint=did_you_mean(name, [f.name for f in model.forecasts])
        )
    return forecast.name
