"""What of a workbook a run needs: its cells, and the assumptions that reach one of them, in the order to draw them."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from xlmc.errors import DefinitionError, Notice
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.formula.graph import reached
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Check, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.evidence import Bell
from xlmc.montecarlo.number_text import count_text

__all__ = [
    "Needed",
    "accepted_by_chance",
    "chances_of",
    "definitions_of_checks",
    "drawing_order",
    "filter_condition",
    "filter_limits",
    "find_needed",
    "refuse_without_base",
    "targets_of",
    "upstream",
]


MOST_CALLS: Final = 10_000
"""Draws in cells that a run may need; a block of trials holds some 0.3 MB of each."""


@dataclass(frozen=True)
class Needed:
    """The needed part of a workbook.

    Attributes:
        graph: the needed formula cells.
        stages: names of the assumptions to draw; the parameters of a stage depend on earlier stages only.
        idle: the assumptions that nothing needs.
    """

    graph: Graph
    stages: tuple[tuple[str, ...], ...]
    idle: tuple[Assumption, ...]

    @property
    def live(self) -> tuple[str, ...]:
        """The names of the assumptions to draw, in order."""
        return tuple(name for stage in self.stages for name in stage)

    def notices(self, checked: Container[Cell] = ()) -> tuple[Notice, ...]:
        """Say what was left out but for frozen rows, which vary nothing; draws in cells, which may be many, together.

        Args:
            checked: the cells that checks need.
        """

        def notice(what: str, cell: Cell) -> Notice:
            frozen = ": the checks take its base value" if cell in checked else ""
            return Notice(f"no forecast or filter needs {what}{frozen}", cell)

        calls = [a.cell for a in self.idle if isinstance(a.cell, InFormula)]
        rows = [a for a in self.idle if not isinstance(a.cell, InFormula) and not a.frozen]
        result = [notice(f"the assumption {a.name!r}", a.cell) for a in rows]
        if calls:
            many = f"{count_text(len(calls))} draws in cells, of which this is the first"
            result.append(notice("this draw" if len(calls) == 1 else many, calls[0]))
        return tuple(result)


def find_needed(
    workbook: Workbook, definitions: Definitions, more: Mapping[Cell, Iterable[Cell]] | None = None
) -> Needed:
    """Find what the forecasts and filters need.

    Args:
        workbook: to look through.
        definitions: what it asks for.
        more: cells that a formula cell turned out to need beside those its formula names.

    Raises:
        FormulaError: a needed formula cannot be read.
        DefinitionError: assumptions need each other in a circle, or there are too many draws in cells.
    """
    needs = {a.cell: a.cells for a in definitions.assumptions if not a.frozen}
    frozen = frozenset(a.cell for a in definitions.assumptions if a.frozen)
    resolver = Resolver(workbook, [*needs, *frozen], rewritten=definitions.rewritten)
    targets = targets_of(definitions.forecasts, (*definitions.filters, *definitions.forecast_filters))
    while True:  # the parameters of needed assumptions may need more cells, and these more assumptions
        graph = build_graph(resolver, targets, frozenset(needs), frozen, more=more)
        wanted = [cell for drawn, cells in needs.items() if drawn in graph.reached for cell in cells]
        if set(wanted) <= set(targets):
            break
        targets = list(dict.fromkeys(targets + wanted))
    calls = [a for a in definitions.assumptions if isinstance(a.cell, InFormula) and a.cell in graph.reached]
    _refuse_too_many([a for a in calls if not a.frozen])
    idle = tuple(a for a in definitions.assumptions if a.cell not in graph.reached)
    return Needed(graph, drawing_order(graph, definitions.assumptions, {}), idle)


def drawing_order(
    graph: Graph, assumptions: Sequence[Assumption], led_to: Mapping[Cell, Iterable[Cell]]
) -> tuple[tuple[str, ...], ...]:
    """Return the names of the assumptions to draw, in stages: the parameters of a stage depend on earlier stages only.

    Args:
        graph: of the needed cells.
        assumptions: all of them, or those to draw; within a stage they keep this order.
        led_to: formula cell -> the cells that OFFSET and INDIRECT in it lead to, beside those that it names.

    Raises:
        DefinitionError: assumptions need each other in a circle.
    """
    drawn = {a.cell: a.name for a in assumptions if not a.frozen and a.cell in graph.reached}
    waiting = {a.cell: upstream(graph, a.cells, led_to) for a in assumptions if a.cell in drawn}
    stages: list[tuple[str, ...]] = []
    while waiting:
        ready = [cell for cell in waiting if not waiting[cell] & waiting.keys()]
        if not ready:
            raise _circle_error([a for a in assumptions if a.cell in waiting], waiting)
        stages.append(tuple(drawn[cell] for cell in ready))
        for cell in ready:
            del waiting[cell]
    return tuple(stages)


def definitions_of_checks(definitions: Definitions, live: Collection[str]) -> Definitions:
    """Return the checks as what is asked for, over the assumptions that a run draws; all others have their base values.

    Args:
        definitions: the workbook's.
        live: names of the assumptions that its forecasts and filters have drawn. A check adds none to them: it must
            not change a run.
    """
    assumptions = tuple(a if a.name in live else replace(a, frozen=True) for a in definitions.assumptions)
    asked = tuple(Forecast(check.name, check.cell, check.row) for check in definitions.checks)
    return replace(
        definitions,
        assumptions=assumptions,
        forecasts=asked,
        filters=(),
        correlations=(),
        checks=(),
        forecast_filters=(),
    )


def refuse_without_base(checks: Sequence[Check], needed: Needed, definitions: Definitions) -> None:
    """Refuse checks that need an assumption that is held, and that has no value to be held at.

    Raises:
        DefinitionError: one does.
    """
    frozen = [a for a in definitions.assumptions if a.frozen and a.base is None]
    without = next((a for a in frozen if a.cell in needed.graph.reached), None)
    if without is None:
        return
    message = f"the checks need {without.name!r}, which no forecast or filter needs and which has no base value"
    if isinstance(without.cell, InFormula):
        hint = "give the draw a base value, such as RiskStatic, or point the check to another cell"
        raise DefinitionError(message, where=checks[0].row, hint=hint)
    raise DefinitionError(message, where=without.cell, hint="type its base value into the cell")


def _refuse_too_many(calls: Sequence[Assumption]) -> None:
    """Refuse a sheet that repeats a model in thousands of rows and draws more than a run, or its report, can take."""
    if len(calls) > MOST_CALLS:
        message = (
            f"the forecasts and filters need {count_text(len(calls))} draws in cells; a run "
            f"takes at most {count_text(MOST_CALLS)}"
        )
        hint = "where rows repeat one model, mark the answer of a single row, and let the run repeat it"
        raise DefinitionError(message, where=calls[0].row, hint=hint)


def targets_of(forecasts: Iterable[Forecast], filters: Iterable[Filter]) -> list[Cell]:
    """Return the cells of the forecasts and filters, and those that hold the filters' limits."""
    targets = [forecast.cell for forecast in forecasts]
    for filter_ in filters:
        targets += [filter_.cell, *(bound for _, bound in filter_limits(filter_) if isinstance(bound, Cell))]
        if filter_.evidence is not None and filter_.evidence.by_chance:
            targets.append(filter_.evidence.chance)
    return targets


def filter_limits(filter_: Filter) -> list[tuple[str, float | Cell]]:
    """Return the limits of a filter as (relation, bound)."""
    limits = [(">=", filter_.at_least), ("<=", filter_.at_most), (">", filter_.above), ("<", filter_.below)]
    return [(relation, bound) for relation, bound in limits if bound is not None]


def filter_condition(filter_: Filter, *, certain: bool = False) -> ir.Expression:
    """Write what a filter asks as a formula. Its cell is taken as a number, so that a text is `#VALUE!`, not "large".

    Limits are compared to the last bit, not at the 15 digits of comparisons in formulas.

    Args:
        filter_: of a row of `xlmc_filters` or `xlmc_evidence`.
        certain: evidence whose error is no limit keeps every trial whose probability is above 0.
    """
    if filter_.evidence is not None and (bell := filter_.evidence.bell) is not None:
        by_chance = filter_.evidence.by_chance and not certain
        return accepted_by_chance(bell, filter_.cell, filter_.evidence.chance if by_chance else None)
    number = ir.Binary("+", filter_.cell, ir.Number(0.0))
    limits = filter_limits(filter_)
    if not limits:
        return ir.Binary("<>", number, ir.Number(0.0), all_bits=True)
    parts = tuple(ir.Binary(relation, number, _bound(bound), all_bits=True) for relation, bound in limits)
    return parts[0] if len(parts) == 1 else ir.Call("AND", parts)


def accepted_by_chance(bell: Bell, cell: Cell, chance: Cell | None) -> ir.Expression:
    """Whether a trial is kept, with the chance of its reading: exp(-z²/2), z standard deviations from it; or Φ(±z).

    An item of evidence has a uniform number U of its own, from a random stream of its own, and keeps the trial where
    U is not above that chance. What is kept are then exact draws, of equal weight, from the inputs given the reading
    (rejection sampling).

    Args:
        bell: the error of the reading.
        cell: the model's quantity.
        chance: a uniform number; None to keep every trial whose probability is above 0.
    """
    probability = bell.tree_of_chance(cell)
    accepted: ir.Expression = ir.Binary(">", probability, ir.Number(0.0), all_bits=True)
    if chance is not None:
        accepted = ir.Binary("<=", chance, probability, all_bits=True)
    if not bell.logarithmic:
        return accepted
    positive = ir.Binary(">", ir.Binary("+", cell, ir.Number(0.0)), ir.Number(0.0), all_bits=True)
    return ir.Call("IF", (positive, accepted, ir.Logical(value=False)))


def chances_of(filters: Iterable[Filter]) -> tuple[Assumption, ...]:
    """Return the uniform numbers of the filters whose error is no limit; their base value, 0, keeps every trial."""
    items = [each.evidence for each in filters if each.evidence is not None]
    return tuple(
        Assumption(each.stream, each.chance, "Uniform", {"low": 0.0, "high": 1.0}, each.row, base=0.0)
        for each in items
        if each.by_chance
    )


def _bound(bound: float | Cell) -> ir.Expression:
    return ir.Binary("+", bound, ir.Number(0.0)) if isinstance(bound, Cell) else ir.Number(bound)


def upstream(graph: Graph, cells: Iterable[Cell], led_to: Mapping[Cell, Iterable[Cell]]) -> set[Cell]:
    """Return the cells and all that they depend on; assumptions among them, but not what these depend on."""
    return {*reached(cells, lambda cell: (*graph.needs.get(cell, ()), *led_to.get(cell, ())))}


def _circle_error(among: list[Assumption], waiting: dict[Cell, set[Cell]]) -> DefinitionError:
    """Follow needs until an assumption comes up again: from there on it is the circle."""
    trail = [among[0]]
    while True:
        following = next(a for a in among if a.cell in waiting[trail[-1].cell])
        if following in trail:
            circle = [*trail[trail.index(following) :], following]
            break
        trail.append(following)
    names = " → ".join(repr(a.name) for a in circle)
    hint = "give one of them parameters that are numbers"
    if circle[0] is circle[-1] and len(circle) == 2:
        hint = f"refer to {circle[0].cell} in its parameters without OFFSET and INDIRECT, or type them as numbers"
    return DefinitionError(
        f"parameters of assumptions need each other in a circle: {names}", where=circle[0].row, hint=hint
    )
