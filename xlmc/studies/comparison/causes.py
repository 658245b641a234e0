"""Why two books differ: what one of them has beyond the other is taken out, and the two are run again.

In this order, until the difference is within the tolerance: the filters that only one book has; the assumptions that
only one draws (held at their base values) and the distributions in which they differ (the second takes the first's);
all of these. The cause is then the shortest list of such steps found: the most effective single ones first, added one
by one until the difference is within the tolerance, and each that turns out not to be needed left out again. Where
nothing helps, the cause lies in the formulas or in values that are held.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from xlmc.address import Cell
from xlmc.definitions.model import Assumption, name_key
from xlmc.run.model import Model
from xlmc.run.simulation import Simulation
from xlmc.studies.comparison.inputs import Inputs
from xlmc.studies.comparison.units import factor_between
from xlmc.studies.comparison.variations import varied

__all__ = ["Step", "Variations", "cause_of", "steps_between"]

Run = Callable[[Model, str], Simulation]


@dataclass(frozen=True, slots=True)
class Step:
    """One thing to take out.

    Attributes:
        kind: `filter`, `assumption` or `distribution`.
        side: 0 for the first book, 1 for the second.
        name: as that book spells it.
    """

    kind: str
    side: int
    name: str


def steps_between(inputs: Inputs, first: Simulation, second: Simulation) -> tuple[Step, ...]:
    """What can be taken out: filters that reject a trial, assumptions with a base value, plain distributions."""
    found = []
    for side, run in enumerate((first, second)):
        rejected = {f.name: int(n) for f, n in zip(run.model.filters, run.tally.rejected, strict=True)}
        found += [Step("filter", side, name) for name in inputs.filters[side] if rejected[name]]
        base = {a.name: a.base for a in run.model.assumptions}
        found += [Step("assumption", side, name) for name in inputs.drawn[side] if base[name] is not None]
    mine, theirs = (_by_key(run.model) for run in (first, second))
    for unlike in inputs.unlike:
        key = name_key(unlike.name)
        if _may_swap(mine[key], theirs[key]):
            found.append(Step("distribution", 1, theirs[key].name))
    return tuple(found)


def _by_key(model: Model) -> dict[str, Assumption]:
    return {name_key(a.name): a for a in model.assumptions}


def _may_swap(first: Assumption, second: Assumption) -> bool:
    """Whether the second may be drawn as the first: in the same unit, and from no cell of the first's book."""
    own = (*first.parameters.values(), first.lower_cutoff, first.upper_cutoff)
    from_cells = any(isinstance(value, Cell) for value in own)
    return factor_between(second.units, first.units) == 1.0 and not from_cells and first.data is None


class Variations:
    """Runs of two books with steps taken, each made once.

    Args:
        first, second: the books as they are.
        run: simulates a model over the same trials.
    """

    def __init__(self, first: Simulation, second: Simulation, run: Run) -> None:
        self._books, self._run = (first, second), run
        self._made: dict[tuple[int, frozenset[Step]], Simulation] = {
            (side, frozenset()): book for side, book in enumerate(self._books)
        }

    def pair(self, steps: Iterable[Step]) -> tuple[Simulation, Simulation]:
        """Both books with these steps taken."""
        taken = frozenset(steps)
        first, second = (self._side(side, frozenset(s for s in taken if s.side == side)) for side in (0, 1))
        return first, second

    def _side(self, side: int, steps: frozenset[Step]) -> Simulation:
        if (side, steps) not in self._made:
            book, other = self._books[side].model, _by_key(self._books[1 - side].model)
            names = {kind: [name_key(s.name) for s in steps if s.kind == kind] for kind in _KINDS}
            swapped = {key: other[key] for key in names["distribution"]}
            model = varied(book, frozen=names["assumption"], without=names["filter"], drawn_as=swapped)
            what = ", ".join(sorted(repr(step.name) for step in steps))
            self._made[side, steps] = self._run(model, f"{book.path.name} without {what}")
        return self._made[side, steps]


_KINDS = ("filter", "assumption", "distribution")


def cause_of(steps: Sequence[Step], left: Callable[[Iterable[Step]], float]) -> tuple[Step, ...]:
    """The steps that bring a difference within its tolerance; empty where none do.

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


def _shortest(tier: Sequence[Step], left: Callable[[Iterable[Step]], float]) -> tuple[Step, ...]:
    ordered = sorted(tier, key=lambda step: left([step]))
    length = next(n for n in range(1, len(ordered) + 1) if left(ordered[:n]) <= 1.0)
    chosen = ordered[:length]
    for step in ordered[: length - 1]:
        fewer = [each for each in chosen if each != step]
        if left(fewer) <= 1.0:
            chosen = fewer
    return tuple(chosen)
