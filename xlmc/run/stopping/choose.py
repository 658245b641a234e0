"""The rule that was asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from xlmc.definitions.model import Forecast, name_key
from xlmc.definitions.stopping import Stopping
from xlmc.errors import SimulationError
from xlmc.run.stopping.accepted import UntilAccepted
from xlmc.run.stopping.adaptive import UntilStable
from xlmc.run.stopping.precision import UntilPrecise
from xlmc.run.stopping.rule import Rule
from xlmc.sampling.methods import METHODS

__all__ = ["RULES", "chosen_rule", "may_end_early", "refuse_other_sampling"]

RULES: Final[dict[str, Callable[..., Rule]]] = {
    UntilAccepted.key: UntilAccepted,
    UntilPrecise.key: UntilPrecise,
    UntilStable.key: UntilStable,
}
"""The key of a goal -> its rule: made of the goal and, where it looks at forecasts, of these, each as (place, name,
share of the central range)."""


def chosen_rule(asked: Stopping, forecasts: Sequence[Forecast]) -> Rule | None:
    """The rule; None where the run is to run its trials.

    Raises:
        SimulationError: there is no forecast of a name, or none at all.
    """
    goal = asked.goal
    if goal is None:
        return None
    rule = RULES[goal.key]
    return rule(goal, _named(asked.forecasts, forecasts)) if goal.of_forecasts else rule(goal)


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
