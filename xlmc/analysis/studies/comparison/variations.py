"""The same workbook with a definition changed: assumptions held, filters left out. The file stays as it is.

Every assumption has a random stream of its own, so a variation draws the same numbers for all that it still draws
(a correlated group counts as one).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from types import MappingProxyType
from typing import Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Assumption, Forecast
from xlmc.montecarlo.definitions.stopping import NO_GOAL
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["names_of", "names_of_rows", "with_changes", "with_plain_sampling"]

_NO_OTHERS: Final[Mapping[str, str]] = MappingProxyType({})


def with_changes(
    model: CompiledModel,
    *,
    frozen: Collection[str] = (),
    without: Collection[str] = (),
    drawn_as: Mapping[str, Assumption] | None = None,
    frozen_at: Mapping[str, float] | None = None,
) -> CompiledModel:
    """Make a model with changed definitions, and without the book's checks: these move no number of a run.

    Args:
        model: stays as it is.
        frozen: names of the assumptions to hold at their base values.
        without: names of the filters to leave out.
        drawn_as: name of an assumption -> the one whose distribution it takes.
        frozen_at: name of an assumption to hold -> the value to hold it at, instead of its base value.

    Raises:
        SimulationError: an assumption to hold has no base value.
    """
    definitions = replace(
        model.definitions,
        assumptions=tuple(_assumption(a, frozen, drawn_as or {}, frozen_at or {}) for a in model.assumptions),
        filters=tuple(f for f in model.filters if f.name not in without),
        checks=(),
    )
    return CompiledModel(model.workbook, definitions, model.path)


def with_plain_sampling(model: CompiledModel) -> CompiledModel:
    """Return the model with plain Monte Carlo for its sampling, and runs of a given length.

    Differences are judged from trials that are independent, the same trials of each model.
    """
    settings = model.definitions.settings
    plain = replace(settings, sampling="mc", stopping=NO_GOAL)
    if settings == plain:
        return model
    definitions = replace(model.definitions, settings=plain)
    return CompiledModel(model.workbook, definitions, model.path)


def _assumption(
    assumption: Assumption,
    frozen: Collection[str],
    drawn_as: Mapping[str, Assumption],
    frozen_at: Mapping[str, float],
) -> Assumption:
    name = assumption.name
    if name in frozen_at:
        return replace(assumption, frozen=True, base=frozen_at[name])
    if name in frozen:
        if assumption.base is None:
            message = f"the assumption {name!r} has no base value to be held at"
            raise SimulationError(message, where=assumption.cell, hint="type one into its cell")
        return replace(assumption, frozen=True)
    if name in drawn_as:
        other = drawn_as[name]
        return replace(
            assumption,
            distribution=other.distribution,
            given=other.given,
            own_family=other.own_family,
            data=other.data,
        )
    return assumption


def names_of(text: str, known: Sequence[str], kind: str, also: Mapping[str, str] = _NO_OTHERS) -> tuple[str, ...]:
    """Return the known names that a list of patterns fits, or the one that is the whole text.

    Args:
        text: the patterns, with commas between them.
        known: the names.
        kind: what they are names of, for the message.
        also: key of another name of one of them -> its name.

    Raises:
        SimulationError: a pattern fits none.
    """
    result: dict[str, None] = {}
    called = {**also, **{name_key(name): name for name in known}}
    for pattern in [text] if name_key(text) in called else text.split(","):
        fitting = [name for name in known if fnmatchcase(name_key(name), name_key(pattern))]
        if name_key(pattern) in called:
            fitting = [called[name_key(pattern)]]
        if not fitting:
            hint = f"there are {', '.join(map(repr, known))}"
            raise SimulationError(f"no {kind} has the name {pattern.strip()!r}", hint=hint)
        result |= dict.fromkeys(fitting)
    return tuple(result)


def names_of_rows(text: str, rows: Iterable[Assumption] | Iterable[Forecast], kind: str) -> tuple[str, ...]:
    """Return the names of the rows that a list of patterns fits; see `names_of`.

    Raises:
        SimulationError: a pattern fits none.
    """
    known = by_names(rows)
    names = [*dict.fromkeys(each.name for each in known.values())]
    return names_of(text, names, kind, {key: each.name for key, each in known.items()})
