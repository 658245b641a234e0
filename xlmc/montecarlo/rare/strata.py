"""Divide all trials into strata, by the branches of formulas and by discrete assumptions.

In `IF(A3=1, A1-68.3, A2-153200)` at least 0, how far a trial is from acceptance is in miles an hour in one branch and
in pounds in the other. Each is explored apart, so that distances of one are never compared with those of the other. A
*switch* is what divides: an IF, IFS, CHOOSE or SWITCH, an OR, the argument that a MAX or MIN takes, a discrete
assumption. A *stratum* takes one alternative of every switch; together the strata are all trials.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.model.needed import filter_limits, upstream
from xlmc.montecarlo.rare.limit_state import LimitState

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.model.model import CompiledModel
from collections import deque
from collections.abc import Mapping
from itertools import product

from xlmc.montecarlo.rare.limit_state import Fails, Leaf, Together, comparisons_of, leaves

__all__ = ["MOST_STRATA", "strata_of"]

_MOST_CELLS: Final = 1_000
"""The most cells of an area that are looked at."""

_RANKS: Final = np.concatenate([[1e-12, 1e-9, 1e-6], np.linspace(1e-4, 1.0 - 1e-4, 4_001), [1 - 1e-6, 1 - 1e-9]])
"""The probabilities at which values of a discrete assumption are looked for."""


def strata_of(model: CompiledModel, filters: Sequence[LimitState]) -> list[tuple[LimitState, ...]]:
    """Return what each stratum asks beside the filters; a single one, which asks nothing, without switches.

    Args:
        model: with filters.
        filters: what they ask.
    """
    graph = model.needed.graph
    limits = (bound for f in model.filters for _, bound in filter_limits(f))
    asked_of = [*(f.cell for f in model.filters), *(bound for bound in limits if isinstance(bound, Cell))]
    needed = upstream(graph, asked_of, {})
    of_discrete = {
        a.cell: switch for a in model.live if a.cell in needed and (switch := _discrete_switch(model, a)) is not None
    }
    drawn = {a.cell for a in model.live}
    switches = list(of_discrete.values())
    for decided_by, switch in _formula_switches(filters, graph.formulas):
        reached = drawn if decided_by is None else upstream(graph, cells_of(decided_by), {}) & drawn
        if not reached or not reached <= of_discrete.keys():  # else its values decide it
            switches.append(switch)
    return _combine(switches)


def _discrete_switch(model: CompiledModel, assumption: Assumption) -> Switch | None:
    """Return the values of an assumption that has few; None of any other."""
    draw = model.draws[assumption.name]
    if not draw.fixed:
        return None
    values = _RANKS.copy()
    draw.fill(values, {})
    result = np.unique(values)
    if not 1 < result.size <= MOST_STRATA // 2 or assumption.name in model.fallible:
        return None
    return _value_switch(assumption.cell, result.tolist())


def cells_of(tree: ir.Expression) -> Iterator[Cell]:
    """Return the cells that a tree names, those of its areas among them."""
    match tree:
        case Cell():
            yield tree
        case Area():
            yield from islice(tree.cells(), _MOST_CELLS)
        case ir.Call(_, parts):
            yield from _cells_of_all(parts)
        case ir.Binary(_, left, right):
            yield from _cells_of_all((left, right))
        case ir.Unary(_, operand):
            yield from cells_of(operand)


def _cells_of_all(parts: Iterable[ir.Expression]) -> Iterator[Cell]:
    for part in parts:
        yield from cells_of(part)


MOST_STRATA: Final = 12
"""Strata that are explored apart: more have too small populations."""

_MOST_ARGUMENTS: Final = 6
"""The most arguments of a function whose alternatives are separated."""

_MOST_SWITCHES: Final = 32
"""The most switches that are looked for; far fewer can be separated."""

_LONGEST_AREA: Final = 100
"""The most cells of an area that is searched."""

_OF_AREAS: Final = frozenset({"SUM", "MAX", "MIN", "AVERAGE", "COUNT", "COUNTA", "AND", "OR", "SUMSQ", "PRODUCT"})
"""Functions that make one value of an area."""

Switch = tuple[LimitState, ...]
"""The alternatives of a switch, one of which every trial takes."""


def _combine(switches: Sequence[Switch]) -> list[tuple[LimitState, ...]]:
    """Return what each stratum asks: one alternative of every switch, of as many switches as `MOST_STRATA` allows."""
    taken, count = list[Switch](), 1
    for switch in switches:
        if len(switch) > 1 and count * len(switch) <= MOST_STRATA:
            taken.append(switch)
            count *= len(switch)
    return list(product(*taken))


def _value_switch(cell: Cell, values: Sequence[float]) -> Switch:
    """Which of few values a discrete assumption has."""
    return tuple(_comparison("=", cell, ir.Number(value), cell) for value in values)


def _formula_switches(
    filters: Sequence[LimitState], formulas: Mapping[Cell, ir.Expression]
) -> list[tuple[ir.Expression | None, Switch]]:
    """Return the switches in the filters' formulas, the nearest to the filters first; each with the value that decides
    it, if any.

    Args:
        filters: what they ask.
        formulas: the resolved formulas of the cells that they may lead to.
    """
    result = list[tuple[ir.Expression | None, Switch]]()
    waiting: deque[tuple[ir.Expression, Cell, int]] = deque()
    for each in filters:
        result += [(None, switch) for switch in _any_of(each)]
        waiting += [(leaf.holds.tree, leaf.holds.cell, 0) for leaf in leaves(each)]
    seen = set[Cell]()
    while waiting and len(result) < _MOST_SWITCHES:
        tree, cell, rising = waiting.popleft()
        if isinstance(tree, Cell):
            if tree in formulas and tree not in seen:
                seen.add(tree)
                waiting.append((formulas[tree], tree, rising))
            continue
        if isinstance(tree, Area):
            waiting += [(each, cell, rising) for each in islice(tree.cells(), _LONGEST_AREA)]
            continue
        switch = _alternatives(tree, cell, formulas, rising) if _is_single(tree) else None
        if switch is not None:
            result.append(switch)
        waiting += [(part, cell, side) for part, side in _parts(tree, rising)]
    return result


def _is_single(tree: ir.Expression) -> bool:
    """Whether a formula has one value: nothing in it stands for several cells, or for what is only known within it."""
    match tree:
        case Cell() | ir.Number() | ir.Text() | ir.Logical():
            return True
        case ir.Binary(_, left, right):
            return _is_single(left) and _is_single(right)
        case ir.Unary(_, operand):
            return _is_single(operand)
        case ir.Call(name, parts):
            return all(_is_single(part) or (name in _OF_AREAS and isinstance(part, Area)) for part in parts)
    return False


def _any_of(limit_state: LimitState) -> Iterator[Switch]:
    """Yield the ORs among what a filter asks: the first part that holds decides the stratum."""
    if isinstance(limit_state, Together):
        if not limit_state.every:
            parts = limit_state.parts
            yield tuple(Together((*map(Fails, parts[:number]), part), every=True) for number, part in enumerate(parts))
        for part in limit_state.parts:
            yield from _any_of(part)


def _alternatives(
    tree: ir.Expression, cell: Cell, formulas: Mapping[Cell, ir.Expression], rising: int
) -> tuple[ir.Expression | None, Switch] | None:
    """Return the alternatives of a function that takes one of several values; None for anything else."""
    match tree:
        case ir.Call("IF", (condition, *_)):
            return condition, tuple(
                comparisons_of(condition, cell, formulas, wanted=wanted) for wanted in (True, False)
            )
        case ir.Call("IFS", (*parts,)) if len(parts) <= 2 * _MOST_ARGUMENTS:
            return None, _first_of([comparisons_of(each, cell, formulas, wanted=True) for each in parts[::2]])
        case ir.Call("CHOOSE", (index, *values)) if len(values) <= _MOST_ARGUMENTS:
            indices = range(1, len(values) + 1)
            return index, tuple(
                Together((_at_least(index, k, cell), _comparison("<", index, ir.Number(k + 1.0), cell)), every=True)
                for k in indices
            )
        case ir.Call("SWITCH", (value, *parts)) if len(parts) <= 2 * _MOST_ARGUMENTS:
            cases = [_comparison("=", value, each, cell) for each in parts[:-1:2]]
            others = (Together(tuple(map(Fails, cases)), every=True),) if len(parts) % 2 else ()
            return value, (*cases, *others)
        case ir.Call("MAX" | "MIN", arguments) if rising != (-1 if tree.name == "MAX" else 1):
            values = _scalars(arguments)
            relation = ">=" if tree.name == "MAX" else "<="
            if 1 < len(values) <= _MOST_ARGUMENTS:
                return None, tuple(_extreme(relation, number, values, cell) for number in range(len(values)))
    return None


def _first_of(conditions: Sequence[LimitState]) -> Switch:
    return tuple(
        Together((*map(Fails, conditions[:number]), each), every=True) for number, each in enumerate(conditions)
    )


def _extreme(relation: str, number: int, values: Sequence[ir.Expression], cell: Cell) -> LimitState:
    """Make the condition that this one of several values is the largest, or the smallest."""
    others = [value for i, value in enumerate(values) if i != number]
    return Together(tuple(_comparison(relation, values[number], other, cell) for other in others), every=True)


def _scalars(arguments: Sequence[ir.Expression]) -> list[ir.Expression]:
    """Return the values that arguments are; none where an area is large, or an argument left out."""
    result = list[ir.Expression]()
    for each in arguments:
        if isinstance(each, ir.Missing):
            return []
        result += islice(each.cells(), _MOST_ARGUMENTS + 1) if isinstance(each, Area) else [each]
    return result


def _comparison(relation: str, left: ir.Expression, right: ir.Expression, cell: Cell) -> Leaf:
    leaf = comparisons_of(ir.Binary(relation, left, right), cell, {}, wanted=True)
    assert isinstance(leaf, Leaf)
    return leaf


def _at_least(index: ir.Expression, least: int, cell: Cell) -> Leaf:
    return _comparison(">=", index, ir.Number(float(least)), cell)


def _parts(tree: ir.Expression, rising: int) -> Iterator[tuple[ir.Expression, int]]:
    """Yield what a value is made of, and whether acceptance is nearer the larger it is (1), the smaller (-1), or
    neither (0).

    Conditions are left out: they say which part is taken, and are none themselves.
    """
    match tree:
        case ir.Binary(">=" | ">", left, right):
            yield from ((left, 1), (right, -1))
        case ir.Binary("<=" | "<", left, right):
            yield from ((left, -1), (right, 1))
        case ir.Binary("+", left, right):
            yield from ((left, rising), (right, rising))
        case ir.Binary("-", left, right):
            yield from ((left, rising), (right, -rising))
        case ir.Binary("*" | "/", left, ir.Number(factor)) if factor > 0:
            yield left, rising
        case ir.Binary("*", ir.Number(factor), right) if factor > 0:
            yield right, rising
        case ir.Binary(_, left, right):
            yield from ((left, 0), (right, 0))
        case ir.Unary(operator, operand):
            yield operand, -rising if operator == "-" else rising
        case ir.Call("IF", (_, *values)):
            yield from ((value, rising) for value in values)
        case ir.Call("IFS", (*parts,)):
            yield from ((value, rising) for value in parts[1::2])
        case ir.Call("CHOOSE", (_, *values)):
            yield from ((value, rising) for value in values)
        case ir.Call("SWITCH", (_, *parts)):
            yield from ((value, rising) for value in (*parts[1::2], *parts[len(parts) - len(parts) % 2 :]))
        case ir.Call("MAX" | "MIN", arguments):
            yield from ((value, rising) for value in arguments)
        case ir.Call(_, arguments):
            yield from ((value, 0) for value in arguments)
