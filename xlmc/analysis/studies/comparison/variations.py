"""The same workbook with a definition changed: assumptions held, filters left out. The file stays as it is.

Every assumption has a random stream of its own, so a variation draws the same numbers for all that it still draws
(a correlated group counts as one).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.stopping import NO_GOAL
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["names_of", "with_changes", "with_plain_sampling"]


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


def names_of(text: str, known: Sequence[str], kind: str) -> tuple[str, ...]:
    """Return the known names that a list of patterns fits.

    Raises:
        SimulationError: a pattern fits none.
    """
    found: dict[str, None] = {}
    for pattern in text.split(","):
        fitting = [name for name in known if fnmatchcase(name_key(name), name_key(pattern))]
        if not fitting:
            hint = f"there are {', '.join(map(repr, known))}"
            raise SimulationError(f"no {kind} has the name {pattern.strip()!r}", hint=hint)
        found |= dict.fromkeys(fitting)
    return tuple(found)
