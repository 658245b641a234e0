"""What goes into two books of one scene: which assumptions and filters they share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.definitions.model import Assumption, Filter, name_key
from xlmc.results.record.wording import distribution_text
from xlmc.run.model import Model
from xlmc.run.scene import filter_limits
from xlmc.run.simulation import Simulation
from xlmc.studies.comparison.units import factor_between

__all__ = ["Inputs", "Unlike", "inputs_of"]

SAME: Final = 1e-9
"""Of the largest draw: draws that differ by less are of one distribution, rounded in another unit at most."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Unlike:
    """An assumption of both books that is not the same in them: how either draws it, in words."""

    name: str
    first: str
    second: str


@dataclass(frozen=True, slots=True)
class Inputs:
    """The assumptions and filters of two books, by name as the book that has them spells it.

    Attributes:
        alike: assumptions that both draw, with equal draws in every trial.
        unlike: assumptions that both draw, but differently.
        held: assumptions of both that only one draws, the other holds.
        drawn: for either book, the assumptions that it draws and the other does not: it has none, or holds it.
        filters: for either book, the filters that the other has not, or not with the same limits.
    """

    alike: tuple[str, ...]
    unlike: tuple[Unlike, ...]
    held: tuple[Unlike, ...]
    drawn: tuple[tuple[str, ...], tuple[str, ...]]
    filters: tuple[tuple[str, ...], tuple[str, ...]]


def inputs_of(first: Simulation, second: Simulation) -> Inputs:
    """Compare the inputs of two runs over the same trials; what no forecast or filter needs is left out."""
    mine, theirs = (_needed(run.model) for run in (first, second))
    both = [(mine[key], theirs[key]) for key in mine if key in theirs]
    drawn = [(a, b) for a, b in both if not (a.frozen or b.frozen)]
    same = [(a, b) for a, b in drawn if _draws_alike(a, b, first.prior[a.name], second.prior[b.name])]
    held = [(a, b) for a, b in both if a.frozen != b.frozen or (a.frozen and not _held_alike(a, b))]
    return Inputs(
        alike=tuple(a.name for a, _ in same),
        unlike=tuple(_unlike(a, b) for a, b in drawn if (a, b) not in same),
        held=tuple(_unlike(a, b) for a, b in held),
        drawn=(_drawn_only(mine, theirs), _drawn_only(theirs, mine)),
        filters=(_filters_only(first.model, second.model), _filters_only(second.model, first.model)),
    )


def _needed(model: Model) -> dict[str, Assumption]:
    return {name_key(a.name): a for a in model.assumptions if a not in model.scene.idle}


def _drawn_only(mine: Mapping[str, Assumption], theirs: Mapping[str, Assumption]) -> tuple[str, ...]:
    return tuple(a.name for key, a in mine.items() if not a.frozen and (key not in theirs or theirs[key].frozen))


def _draws_alike(first: Assumption, second: Assumption, mine: Floats, theirs: Floats) -> bool:
    factor = factor_between(second.units, first.units)
    if factor is None:
        return False
    n = min(mine.size, theirs.size)  # as many as both have kept
    atol = SAME * float(np.nanmax(np.abs(mine), initial=0.0))
    return np.allclose(theirs[:n] * factor, mine[:n], rtol=0.0, atol=atol, equal_nan=True)


def _held_alike(first: Assumption, second: Assumption) -> bool:
    factor = factor_between(second.units, first.units)
    if factor is None or first.base is None or second.base is None:
        return False
    return abs(second.base * factor - first.base) <= SAME * abs(first.base)


def _unlike(first: Assumption, second: Assumption) -> Unlike:
    return Unlike(first.name, _words(first), _words(second))


def _words(assumption: Assumption) -> str:
    what = f"held at {assumption.base:g}" if assumption.frozen else distribution_text(assumption)
    return f"{what} {assumption.units}".rstrip()


def _filters_only(mine: Model, theirs: Model) -> tuple[str, ...]:
    known = {name_key(f.name): _limits(f) for f in theirs.filters}
    return tuple(f.name for f in mine.filters if known.get(name_key(f.name)) != _limits(f))


def _limits(filter_: Filter) -> list[tuple[str, object]]:
    return [(relation, bound) for relation, bound in filter_limits(filter_)]
