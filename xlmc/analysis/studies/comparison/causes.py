"""What two books of one scene share, and why they differ.

What one book has beyond the other is taken out, and the two are run again.

These are tried in this order, until the difference is within the tolerance: the filters that only one book has; the
assumptions that only one draws (held at their base values) and the distributions in which the books differ (the second
takes the first's); all of these. The cause is then the shortest list of such steps that is found: the most effective
single steps are added one by one until the difference is within the tolerance, and each step that turns out not to be
needed is left out again. Of many steps, groups that are not needed are left out before. Where nothing helps, the cause
is in the formulas or in values that are held.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.analysis.studies.comparison.variations import with_changes
from xlmc.montecarlo.definitions.definitions import Assumption, Filter
from xlmc.montecarlo.definitions.units import factor_between
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_limits
from xlmc.montecarlo.number_text import exact_text
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Inputs", "Step", "Unlike", "Variations", "cause_of", "inputs_of", "steps_between"]

_SAME: Final = 1e-9
"""A share of the largest draw: draws that differ by less come from one distribution, and differ by rounding of units.
"""

Floats = NDArray[np.float64]

Run = Callable[[CompiledModel, str], RunResult]

_FEW: Final = 20
"""Of more steps than this, groups are left out before any is taken alone."""

_KINDS = ("filter", "assumption", "distribution")


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
        frozen_differently: assumptions of both that only one draws, the other holds.
        drawn: for either book, the assumptions that it draws and the other does not: it has none, or holds it.
        filters: for either book, the filters that the other has not, or not with the same limits.
    """

    alike: tuple[str, ...]
    unlike: tuple[Unlike, ...]
    frozen_differently: tuple[Unlike, ...]
    drawn: tuple[tuple[str, ...], tuple[str, ...]]
    filters: tuple[tuple[str, ...], tuple[str, ...]]


def inputs_of(first: RunResult, second: RunResult) -> Inputs:
    """Compare the inputs of two runs over the same trials; what no forecast or filter needs is left out."""
    mine, theirs = (_needed(run.model) for run in (first, second))
    both = [(mine[key], theirs[key]) for key in mine if key in theirs]
    drawn = [(a, b) for a, b in both if not (a.frozen or b.frozen)]
    same = [(a, b) for a, b in drawn if _draws_alike(a, b, first.prior[a.name], second.prior[b.name])]
    frozen_differently = [(a, b) for a, b in both if a.frozen != b.frozen or (a.frozen and not _frozen_alike(a, b))]
    return Inputs(
        alike=tuple(a.name for a, _ in same),
        unlike=tuple(_unlike(a, b) for a, b in drawn if (a, b) not in same),
        frozen_differently=tuple(_unlike(a, b) for a, b in frozen_differently),
        drawn=(_drawn_only(mine, theirs), _drawn_only(theirs, mine)),
        filters=(_filters_only(first.model, second.model), _filters_only(second.model, first.model)),
    )


def _needed(model: CompiledModel) -> dict[str, Assumption]:
    return {name_key(a.name): a for a in model.assumptions if a not in model.needed.idle}


def _drawn_only(mine: Mapping[str, Assumption], theirs: Mapping[str, Assumption]) -> tuple[str, ...]:
    return tuple(a.name for key, a in mine.items() if not a.frozen and (key not in theirs or theirs[key].frozen))


def _draws_alike(first: Assumption, second: Assumption, mine: Floats, theirs: Floats) -> bool:
    factor = factor_between(second.units, first.units)
    if factor is None:
        return False
    n = min(mine.size, theirs.size)  # as many as both have kept
    atol = _SAME * float(np.nanmax(np.abs(mine), initial=0.0))
    return np.allclose(theirs[:n] * factor, mine[:n], rtol=0.0, atol=atol, equal_nan=True)


def _frozen_alike(first: Assumption, second: Assumption) -> bool:
    factor = factor_between(second.units, first.units)
    if factor is None or first.base is None or second.base is None:
        return False
    return abs(second.base * factor - first.base) <= _SAME * abs(first.base)


def _unlike(first: Assumption, second: Assumption) -> Unlike:
    return Unlike(first.name, _words(first), _words(second))


def _words(assumption: Assumption) -> str:
    base = assumption.base if assumption.frozen else None
    what = distribution_text(assumption) if base is None else f"held at {exact_text(base)}"
    return f"{what} {assumption.units}".rstrip()


def _filters_only(mine: CompiledModel, theirs: CompiledModel) -> tuple[str, ...]:
    known = {name_key(f.name): _limits(f) for f in theirs.filters}
    return tuple(f.name for f in mine.filters if known.get(name_key(f.name)) != _limits(f))


def _limits(filter_: Filter) -> list[tuple[str, object]]:
    bell = None if filter_.evidence is None else filter_.evidence.bell
    limits: list[tuple[str, object]] = [(relation, bound) for relation, bound in filter_limits(filter_)]
    return limits if bell is None else [("agrees with", bell)]


@dataclass(frozen=True, slots=True)
class Step:
    """One thing to take out.

    Attributes:
        kind: `filter`, `assumption` or `distribution`.
        side: 0 for the first book, 1 for the second.
        name: as that book spells it.
        of_evidence: the filter is an item of evidence.
    """

    kind: str
    side: int
    name: str
    of_evidence: bool = False

    @property
    def word(self) -> str:
        """What to call it."""
        return "evidence" if self.of_evidence else self.kind


def steps_between(inputs: Inputs, first: RunResult, second: RunResult) -> tuple[Step, ...]:
    """Return the steps that can be taken: filters that reject a trial, assumptions with a base value, plain
    distributions.
    """
    steps = []
    for side, run in enumerate((first, second)):
        rejected = {f.name: int(n) for f, n in zip(run.model.filters, run.tally.rejected, strict=True)}
        items = {f.name for f in run.model.filters if f.evidence is not None}
        steps += [Step("filter", side, name, name in items) for name in inputs.filters[side] if rejected[name]]
        base = {a.name: a.base for a in run.model.assumptions}
        steps += [Step("assumption", side, name) for name in inputs.drawn[side] if base[name] is not None]
    mine, theirs = (_by_key(run.model) for run in (first, second))
    for unlike in inputs.unlike:
        key = name_key(unlike.name)
        if _may_swap(mine[key], theirs[key]):
            steps.append(Step("distribution", 1, theirs[key].name))
    return tuple(steps)


def _by_key(model: CompiledModel) -> dict[str, Assumption]:
    return {name_key(a.name): a for a in model.assumptions}


def _may_swap(first: Assumption, second: Assumption) -> bool:
    """Whether the second may be drawn as the first: in the same unit, and from no cell of the first's book."""
    return factor_between(second.units, first.units) == 1.0 and not first.formulas and first.data is None


class Variations:
    """Runs of two books after steps, each run made once.

    Args:
        first, second: the books as they are.
        run: simulates a model over the same trials.
    """

    def __init__(self, first: RunResult, second: RunResult, run: Run) -> None:
        self._books, self._run = (first, second), run
        self._made: dict[tuple[int, frozenset[Step]], RunResult] = {
            (side, frozenset()): book for side, book in enumerate(self._books)
        }

    def pair(self, steps: Iterable[Step]) -> tuple[RunResult, RunResult]:
        """Return the runs of both books after these steps."""
        taken = frozenset(steps)
        first, second = (self._side(side, frozenset(s for s in taken if s.side == side)) for side in (0, 1))
        return first, second

    def _side(self, side: int, steps: frozenset[Step]) -> RunResult:
        if (side, steps) not in self._made:
            book, other = self._books[side].model, _by_key(self._books[1 - side].model)
            names = {kind: [s.name for s in steps if s.kind == kind] for kind in _KINDS}
            swapped = {name: other[name_key(name)] for name in names["distribution"]}
            model = with_changes(book, frozen=names["assumption"], without=names["filter"], drawn_as=swapped)
            what = ", ".join(sorted(repr(step.name) for step in steps))
            self._made[side, steps] = self._run(model, f"{book.path.name} without {what}")
        return self._made[side, steps]


def cause_of(steps: Sequence[Step], left: Callable[[Iterable[Step]], float]) -> tuple[Step, ...]:
    """Return the steps that bring a difference within its tolerance; empty where none do.

    Args:
        steps: what can be taken out.
        left: the difference that is left after some steps, measured in its tolerance.
    """
    filters = [step for step in steps if step.kind == "filter"]
    others = [step for step in steps if step.kind != "filter"]
    for tier in (filters, others, list(steps)):
        if tier and left(tier) <= 1.0:
            return _shortest(tier, left)
    return ()


def _narrowed(tier: Sequence[Step], left: Callable[[Iterable[Step]], float]) -> list[Step]:
    """Leave out groups of many steps that are not needed: halves first, then smaller ones (Zeller & Hildebrandt 2002,
    the complements of delta debugging).
    """
    result, parts = list(tier), 2
    while len(result) > _FEW and parts <= len(result):
        ends = [len(result) * k // parts for k in range(parts + 1)]
        shorter = (result[:start] + result[end:] for start, end in pairwise(ends))
        fewer = next((steps for steps in shorter if left(steps) <= 1.0), None)
        result, parts = (result, 2 * parts) if fewer is None else (fewer, max(parts - 1, 2))
    return result


def _shortest(tier: Sequence[Step], left: Callable[[Iterable[Step]], float]) -> tuple[Step, ...]:
    tier = _narrowed(tier, left)
    ordered = sorted(tier, key=lambda step: left([step]))
    length = next(n for n in range(1, len(ordered) + 1) if left(ordered[:n]) <= 1.0)
    chosen = ordered[:length]
    for step in ordered[: length - 1]:
        fewer = [each for each in chosen if each != step]
        if left(fewer) <= 1.0:
            chosen = fewer
    return tuple(chosen)
