"""Parameters that are computed from their assumption's own cell, `Low` as `=D7*0.97`: from its base value.

A draw cannot have limits that move with itself. What a person means is 3 % below the value that stands in the cell.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

from xlmc.address import Cell, InFormula
from xlmc.definitions.model import CUTOFFS, Assumption, Definitions, Parameter, name_key
from xlmc.distributions.parameters import show
from xlmc.errors import DefinitionError, Notice
from xlmc.evaluation.graph.lower import Lowering, lower_until_complete
from xlmc.formula import Graph, Resolver, build_graph
from xlmc.run.drawing import settled
from xlmc.run.scene import upstream
from xlmc.workbook.model import Workbook

__all__ = ["with_base_parameters"]


def with_base_parameters(workbook: Workbook, definitions: Definitions) -> Definitions:
    """The definitions with a number for every parameter and cutoff that depends on its assumption's own cell.

    Raises:
        DefinitionError: such a parameter depends on another assumption, too, or the cell is blank.
        FormulaError: its formula cannot be computed.
    """
    assumptions = definitions.assumptions
    sought = [cell for a in assumptions if not isinstance(a.cell, InFormula) for cell in a.formulas.values()]
    if not sought:
        return definitions
    rows = {a.cell: a for a in assumptions if not isinstance(a.cell, InFormula)}
    resolver = Resolver(workbook, [a.cell for a in assumptions], rewritten=definitions.rewritten)
    given = frozenset(a.cell for a in assumptions)
    graph = build_graph(resolver, sought, given, strict=False)
    if given.isdisjoint(graph.reached):
        return definitions
    changed = {cell: _Own(resolver, definitions, assumption).found(graph) for cell, assumption in rows.items()}
    numbers = {cell: found for cell, found in changed.items() if found}
    notices = (_notice(rows[cell], found) for cell, found in numbers.items())
    changed_ones = tuple(_with_numbers(a, numbers.get(a.cell, {})) for a in assumptions)
    return replace(definitions, assumptions=changed_ones, notices=(*definitions.notices, *notices))


class _Own:
    """One assumption, and those of its parameters that its own cell reaches."""

    def __init__(self, resolver: Resolver, definitions: Definitions, assumption: Assumption) -> None:
        self._resolver, self._definitions, self._assumption = resolver, definitions, assumption

    def found(self, graph: Graph) -> dict[str, float]:
        """Key of each such parameter -> its number."""
        reached = ((key, cell, upstream(graph, [cell], {})) for key, cell in self._assumption.formulas.items())
        numbers = {key: self._number(key, cell, up) for key, cell, up in reached if self._assumption.cell in up}
        return {key: number for key, number in numbers.items() if number is not None}

    def _number(self, key: str, cell: Cell, upstream: Set[Cell]) -> float | None:
        """The number; None where another assumption reaches it, and this one is held, so that nothing asks for it."""
        own = self._assumption
        if own.base is None:
            message = f"{_heading(own, key)} of {own.name!r} depends on the assumption's own cell, which is blank"
            raise DefinitionError(message, where=cell, hint=f"Type the measured value into {own.cell}")
        others = (a for a in self._definitions.assumptions if not a.frozen and a.cell != own.cell)
        value = self._computed(cell)
        if isinstance(value, Cell) and own.frozen:
            return None
        if isinstance(value, Cell):
            other = next((a for a in others if a.cell in upstream), None)
            more = "another assumption" if other is None else f"the assumption {other.name!r}"
            message = f"{_heading(own, key)} of {own.name!r} depends on the assumption's own cell and on {more}"
            hint = f"In its formula, type the number {show(own.base)} in place of {own.cell}"
            raise DefinitionError(message, where=cell, hint=hint)
        return value

    def _computed(self, cell: Cell) -> Parameter:
        """What the cell is with the assumption at its base value; the cell where another assumption reaches it."""
        assumptions, own = self._definitions.assumptions, self._assumption.cell
        drawn = {a.cell: name_key(a.name) for a in assumptions if not a.frozen and a.cell != own}
        held = {a.cell: a.base for a in assumptions if a.cell not in drawn and a.base is not None}

        def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
            graph = build_graph(self._resolver, [cell], frozenset(drawn), frozenset(held), more=more)
            return Lowering(graph, drawn, held)

        return settled(cell, lower_until_complete(lower))


def _with_numbers(assumption: Assumption, numbers: Mapping[str, float]) -> Assumption:
    if not numbers:
        return assumption
    parameters = {key: numbers.get(key, value) for key, value in assumption.parameters.items()}
    cutoffs = {key: number for key, number in numbers.items() if key in CUTOFFS}
    return replace(assumption, parameters=parameters, **cutoffs)  # type: ignore[arg-type]


def _notice(assumption: Assumption, numbers: Mapping[str, float]) -> Notice:
    base = "" if assumption.base is None else f" ({show(assumption.base)})"
    shown = ", ".join(f"{_heading(assumption, key)} {show(number)}" for key, number in numbers.items())
    return Notice(f"computed from the base value of the assumption's own cell{base}: {shown}", assumption.row)


def _heading(assumption: Assumption, key: str) -> str:
    headings = {spec.key: spec.heading for spec in assumption.family.parameters}
    return headings.get(key) or CUTOFFS[key]
