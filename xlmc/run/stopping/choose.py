"""The rule that was asked for."""

from __future__ import annotations

from collections.abc import Sequence

from xlmc.definitions.model import Forecast, name_key
from xlmc.definitions.stopping import Stopping
from xlmc.errors import SimulationError
from xlmc.run.stopping.accepted import UntilAccepted
from xlmc.run.stopping.adaptive import UntilStable
from xlmc.run.stopping.precision import UntilPrecise
from xlmc.run.stopping.rule import Rule
from xlmc.sampling.methods import METHODS

__all__ = ["chosen_rule", "may_end_early", "refuse_other_sampling"]


def chosen_rule(asked: Stopping, forecasts: Sequence[Forecast]) -> Rule | None:
    """The rule; None where the run is to run its trials.

    Raises:
        SimulationError: there is no forecast of a name, or none at all.
    """
    if asked.accepted is not None:
        return UntilAccepted(asked.accepted)
    if asked.precision is not None:
        return UntilPrecise(asked.precision, _named(asked.forecasts, forecasts))
    if asked.digits is not None:
        return UntilStable(asked.digits, _named(asked.forecasts, forecasts))
    return None


def _named(names: Sequence[str], forecasts: Sequence[Forecast]) -> list[tuple[int, str, float]]:
    places = {name_key(forecast.name): place for place, forecast in enumerate(forecasts)}
    if not places:
        raise SimulationError("there is no forecast whose precision could be asked for", hint="Define a forecast")
    for name in names:
        if name_key(name) not in places:
            hint = f"choose from {', '.join(repr(forecast.name) for forecast in forecasts)}"
            raise SimulationError(f"there is no forecast {name!r}", hint=hint)
    found = dict.fromkeys(places[name_key(name)] for name in names) or range(len(forecasts))
    return [(place, forecasts[place].name, forecasts[place].central) for place in found]


def may_end_early(sampling: str) -> bool:
    """Whether the first trials of a run are a sample, as those of a Latin hypercube or a Sobol sequence are not."""
    return METHODS[sampling].independent


def refuse_other_sampling(sampling: str, asked: Stopping) -> None:
    """Refuse to end a run early whose trials belong together.

    Raises:
        SimulationError: something but the number of trials may end it.
    """
    if asked.asked and not may_end_early(sampling):
        message = f"a run with {sampling} sampling cannot end before all its trials are run"
        raise SimulationError(message, hint="Use mc, plain Monte Carlo, or give a number of trials alone")
