"""What a saved run says beside its columns, as JSON holds it, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Final

import numpy as np

from xlmc.definitions.model import Settings
from xlmc.definitions.stopping import GOALS, MOST_TRIALS, RARE, Goal, Stopping, WholeGoal, only_one
from xlmc.evaluation.engines import ENGINES
from xlmc.results.saved.typed import counts, made, mapping, texts, told, whole
from xlmc.run.blocks import FilterTally
from xlmc.run.rare.account import RareAccount
from xlmc.run.simulation import Origin
from xlmc.run.stopping.stopped import WITHOUT_GOAL, Stopped
from xlmc.sampling.methods import METHODS
from xlmc.sampling.plan import Plan

__all__ = [
    "FORMAT",
    "VERSION",
    "origin_of",
    "plan_of",
    "rare_of",
    "settings_document",
    "settings_of",
    "stopped_of",
    "tally_document",
    "tally_of",
]

FORMAT: Final = "xlmc saved run"
VERSION: Final = 2
"""Of version 1 were the runs that could be computed in float32; those in float64 are opened all the same."""


def settings_document(settings: Settings) -> dict[str, Any]:
    """The settings, with an entry for every goal: a number, or the fields of one that has several."""
    asked = settings.stopping
    goals = {kind.saved_as or kind.key: _goal_document(asked.goal, kind) for kind in GOALS.values()}
    more = {name: value for name, value in asdict(asked).items() if name != "goal"}
    return {**asdict(settings), "stopping": goals | more}


def _goal_document(goal: Goal | None, kind: type[Goal]) -> object:
    if not isinstance(goal, kind):
        return None
    return goal.number if isinstance(goal, WholeGoal) else asdict(goal)


def settings_of(found: object) -> Settings:
    """The settings again.

    Raises:
        ValueError, SimulationError: they are none.
    """
    given = dict(mapping(found, "its settings"))
    stopping = _stopping_of(given.pop("stopping", {}))
    settings = replace(made(Settings, given, "its settings"), stopping=stopping)
    told(1 <= settings.trials <= MOST_TRIALS, "its number of trials")
    told(settings.seed >= 0, "its seed")
    told(settings.sampling in METHODS, "its sampling")
    told(settings.engine in ENGINES, "its engine")
    told(settings.lognorm in ("", "@RISK", "XLRisk"), "its RiskLognorm")
    return settings


def _stopping_of(found: object) -> Stopping:
    """What the run was to go on until; no run may be asked for anything else."""
    given = dict(mapping(found, "its end"))
    told("goal" not in given, "its end has the unknown field goal")  # each goal has a field of its own
    goals = [_goal_of(kind, given.pop(kind.saved_as or kind.key, None)) for kind in GOALS.values()]
    forecasts = texts(given.pop("forecasts", []), "the forecasts that its end looks at")
    limits = made(Stopping, given, "its end")
    told(limits.seconds is None or limits.seconds > 0, "its time limit")
    told(limits.rare is None or limits.rare in RARE, "what is done where accepted trials are rare")
    return replace(limits, goal=only_one([goal for goal in goals if goal is not None]), forecasts=forecasts)


def _goal_of(kind: type[Goal], found: object) -> Goal | None:
    if found is None:
        return None
    return made(kind, {"number": found} if issubclass(kind, WholeGoal) else found, f"its goal, {kind.noun}")


def plan_of(settings: Settings, order: object) -> Plan:
    """The plan again: a function of the settings, but for the order of the dimensions.

    Raises:
        ValueError: the order is none.
    """
    return replace(Plan.of(settings.sampling, settings.trials), order=texts(order, "its order of dimensions"))


def tally_document(tally: FilterTally) -> dict[str, Any]:
    """The counts of the filters as lists."""
    return {
        "rejected": tally.rejected.tolist(),
        "only": tally.only.tolist(),
        "together": tally.together.tolist(),
        "errors": [dict(sorted(errors.items())) for errors in tally.errors],
        "by_error": tally.by_error,
    }


def tally_of(found: object, filters: int, trials: int) -> FilterTally:
    """The counts of so many filters over so many trials again.

    Raises:
        ValueError: they are none.
    """
    given = made(_Counts, found, "its filters")
    rows = (given.rejected, given.only, *given.together)
    told(len(given.together) == len(given.errors) == filters, "its filters")
    told(all(len(row) == filters and all(0 <= count <= trials for count in row) for row in rows), "its filters")
    return FilterTally(
        rejected=np.array(given.rejected, np.int64),
        only=np.array(given.only, np.int64),
        together=np.array(given.together, np.int64).reshape(filters, filters),
        errors=[counts(errors, "the errors of its filters") for errors in given.errors],
        by_error=whole(given.by_error, "its filters"),
    )


@dataclass(frozen=True, slots=True)
class _Counts:
    """What `tally_document` gives."""

    rejected: tuple[int, ...]
    only: tuple[int, ...]
    together: tuple[tuple[int, ...], ...]
    errors: tuple[Mapping[str, int], ...]
    by_error: int


def stopped_of(found: object) -> Stopped:
    """What ended the run.

    Raises:
        ValueError: it is something else.
    """
    stopped = made(Stopped, found, "its end")
    told(stopped.by in {*GOALS, *WITHOUT_GOAL}, "its end")
    return stopped


def rare_of(found: object) -> RareAccount | None:
    """Where the accepted trials come from, if they are rare.

    Raises:
        ValueError: it is something else.
    """
    if found is None:
        return None
    account = made(RareAccount, found, "its account of rare trials")
    told(0 < account.acceptance.value <= 1, "its probability of acceptance")
    numbers = [each.name for each in fields(account) if each.name not in ("acceptance", "solved")]
    told(all(0 <= getattr(account, name) < 2**63 for name in numbers), "its search")
    return account


def origin_of(found: object) -> Origin:
    """Where the run was made.

    Raises:
        ValueError: it is something else.
    """
    return made(Origin, found, "its origin")
