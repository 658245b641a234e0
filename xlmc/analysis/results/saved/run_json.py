"""What a saved run holds beside its columns: written as JSON, and read back with every value checked."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import MISSING, asdict, dataclass, fields, is_dataclass, replace
from types import NoneType
from typing import Any, Final, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from xlmc.montecarlo.definitions.run_settings import Settings, check_settings
from xlmc.montecarlo.definitions.stopping import GOALS, Goal, Stopping, WholeGoal, only_one
from xlmc.montecarlo.loop.blocks import FilterTally
from xlmc.montecarlo.loop.stopping.stopped import WITHOUT_GOAL, Stopped
from xlmc.montecarlo.rare.account import RareAccount
from xlmc.montecarlo.simulation.simulation import ChangedFrom, Origin

__all__ = [
    "FORMAT",
    "VERSION",
    "build",
    "counts",
    "mapping",
    "origin_of",
    "rare_of",
    "require",
    "settings_document",
    "settings_of",
    "stopped_of",
    "tally_document",
    "tally_of",
    "texts",
    "whole",
]


FORMAT: Final = "xlmc saved run"
VERSION: Final = 2
"""Of the document; runs of version 1, of xlmc 0.3.0 and before, could be computed in float32 and are not opened."""

_LARGEST: Final = 2**63  # what a count never reaches
T = TypeVar("T")


def settings_document(settings: Settings) -> dict[str, Any]:
    """Return the settings, with an entry for every goal: a number, or the fields of one that has several."""
    asked = settings.stopping
    goals = {kind.saved_as or kind.key: _goal_document(asked.goal, kind) for kind in GOALS.values()}
    more = {name: value for name, value in asdict(asked).items() if name != "goal"}
    return {**asdict(settings), "stopping": goals | more}


def _goal_document(goal: Goal | None, kind: type[Goal]) -> object:
    if not isinstance(goal, kind):
        return None
    return goal.number if isinstance(goal, WholeGoal) else asdict(goal)


def settings_of(value: object) -> Settings:
    """Read the settings again.

    Raises:
        ValueError, SimulationError: they are none.
    """
    given = dict(mapping(value, "its settings"))
    stopping = _stopping_of(given.pop("stopping", {}))
    settings = replace(build(Settings, given, "its settings"), stopping=stopping)
    check_settings(settings)
    require(settings.evidence != "auto", "how it used evidence")
    return settings


def _stopping_of(value: object) -> Stopping:
    """Read what was to end the run; anything that no run can be asked for is refused."""
    given = dict(mapping(value, "its end"))
    require("goal" not in given, "its end has the unknown field goal")  # each goal has a field of its own
    goals = [_goal_of(kind, given.pop(kind.saved_as or kind.key, None)) for kind in GOALS.values()]
    forecasts = texts(given.pop("forecasts", []), "the forecasts that its end looks at")
    limits = build(Stopping, given, "its end")
    return replace(limits, goal=only_one([goal for goal in goals if goal is not None]), forecasts=forecasts)


def _goal_of(kind: type[Goal], value: object) -> Goal | None:
    if value is None:
        return None
    return build(kind, {"number": value} if issubclass(kind, WholeGoal) else value, f"its goal, {kind.noun}")


def tally_document(tally: FilterTally) -> dict[str, Any]:
    """Return the counts of the filters as lists."""
    return {
        "rejected": tally.rejected.tolist(),
        "only": tally.only.tolist(),
        "together": tally.together.tolist(),
        "errors": [dict(sorted(errors.items())) for errors in tally.errors],
        "by_error": tally.by_error,
    }


def tally_of(value: object, filters: int, trials: int) -> FilterTally:
    """Read the counts of so many filters over so many trials again.

    Raises:
        ValueError: they are none.
    """
    given = build(_Counts, value, "its filters")
    rows = (given.rejected, given.only, *given.together)
    require(len(given.together) == len(given.errors) == filters, "its filters")
    require(all(len(row) == filters and all(0 <= count <= trials for count in row) for row in rows), "its filters")
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


def stopped_of(value: object) -> Stopped:
    """Return what ended the run.

    Raises:
        ValueError: it is something else.
    """
    stopped = build(Stopped, value, "its end")
    require(stopped.by in {*GOALS, *WITHOUT_GOAL}, "its end")
    return stopped


def rare_of(value: object) -> RareAccount | None:
    """How the accepted trials were found, if they are rare.

    Raises:
        ValueError: it is something else.
    """
    if value is None:
        return None
    account = build(RareAccount, value, "its account of rare trials")
    require(0 < account.acceptance.value <= 1, "its probability of acceptance")
    numbers = [each.name for each in fields(account) if each.name not in ("acceptance", "solved")]
    require(all(0 <= getattr(account, name) < 2**63 for name in numbers), "its search")
    return account


def origin_of(value: object) -> Origin:
    """Return the software and the processor of the run.

    Raises:
        ValueError: it is something else.
    """
    return build(Origin, value, "its origin")


def changed_from_of(value: object) -> ChangedFrom | None:
    """Return the workbook that the run's own was made of, if it is such a run.

    Raises:
        ValueError: it is something else.
    """
    return None if value is None else build(ChangedFrom, value, "its account of what was changed")


def require(holds: bool, what: str) -> None:
    """Refuse a saved run in which something is not as it must be.

    Raises:
        ValueError: it is not; the message names what.
    """
    if not holds:
        raise ValueError(what)


def build(kind: type[T], result: object, what: str) -> T:
    """Make an instance of a dataclass from its fields; those with a default may be missing. Lists become tuples.

    Raises:
        ValueError: a field is missing or unknown, or has another type than it must.
    """
    require(isinstance(result, dict), what)
    assert isinstance(result, dict)
    assert is_dataclass(kind)
    required = {each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING}
    hints = get_type_hints(kind)
    known = {each.name: hints[each.name] for each in fields(kind)}
    require(required <= result.keys(), f"{what} lacks {', '.join(sorted(required - result.keys()))}")
    require(
        result.keys() <= known.keys(), f"{what} has the unknown field {', '.join(sorted(result.keys() - known.keys()))}"
    )
    given = {name: _read_typed(known[name], value, f"{what}, {name}") for name, value in result.items()}
    return kind(**given)


def mapping(value: object, what: str) -> dict[str, Any]:
    """Require a JSON object.

    Raises:
        ValueError: it is none.
    """
    require(isinstance(value, dict), what)
    assert isinstance(value, dict)
    return value


def counts(value: object, what: str) -> Counter[str]:
    """Name -> how many.

    Raises:
        ValueError: it is something else.
    """
    return Counter({name: whole(count, what) for name, count in mapping(value, what).items()})


def texts(value: object, what: str) -> tuple[str, ...]:
    """Require a list of texts.

    Raises:
        ValueError: it is something else.
    """
    require(isinstance(value, list) and all(isinstance(each, str) for each in value), what)
    assert isinstance(value, list)
    return tuple(value)


def whole(value: object, what: str) -> int:
    """Require a count, 0 or more.

    Raises:
        ValueError: it is none.
    """
    require(type(value) is int and 0 <= value < _LARGEST, what)
    assert isinstance(value, int)
    return value


def _read_typed(hint: Any, value: object, what: str) -> Any:
    """Return the value, if it has the type of an annotation."""
    origin, arguments = get_origin(hint), get_args(hint)
    if NoneType in arguments:
        other = next(each for each in arguments if each is not NoneType)
        return None if value is None else _read_typed(other, value, what)
    if origin is tuple:
        return _tuple(arguments, value, what)
    if origin is not None:  # Mapping[str, …]
        return {name: _read_typed(arguments[1], each, what) for name, each in mapping(value, what).items()}
    if is_dataclass(hint):
        return build(hint, value, what)  # type: ignore[arg-type]
    if hint is float:
        return _number(value, what)
    require(type(value) is hint, what)
    return value


def _tuple(kinds: tuple[Any, ...], value: object, what: str) -> tuple[Any, ...]:
    require(isinstance(value, list), what)
    assert isinstance(value, list)
    if kinds[1:] == (Ellipsis,):
        return tuple(_read_typed(kinds[0], each, what) for each in value)
    require(len(value) == len(kinds), what)
    return tuple(_read_typed(kind, each, what) for kind, each in zip(kinds, value, strict=True))


def _number(value: object, what: str) -> float | int:
    require(type(value) in (int, float), what)
    assert isinstance(value, int | float)
    require(abs(value) < _LARGEST if type(value) is int else math.isfinite(value), what)
    return value
