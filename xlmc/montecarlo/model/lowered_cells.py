"""Lower what the forecasts and filters need, and, apart from it, what the checks need."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.engine.graph.nodes import Target
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.model.needed import (
    Needed,
    chances_of,
    definitions_of_checks,
    drawing_order,
    find_needed,
    refuse_without_base,
)

__all__ = ["lower_checks", "lower_needed"]


def lower_needed(workbook: Workbook, definitions: Definitions, *, one_trial: bool = False) -> tuple[Needed, Lowering]:
    """Find what the forecasts and filters need, and its nodes; of `one_trial`, with all assumptions frozen, see
    `Lowering`.

    Raises:
        FormulaError, DefinitionError: as for `load`.
    """
    definitions = replace(definitions, assumptions=(*definitions.assumptions, *chances_of(definitions.filters)))
    inputs = {a.cell: a.name for a in definitions.assumptions if not a.frozen}
    frozen = {a.cell: a.base for a in definitions.assumptions if a.frozen and a.base is not None}
    results: list[Needed] = []

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        results.append(find_needed(workbook, definitions, more))
        return Lowering(results[-1].graph, inputs, frozen, one_trial=one_trial)

    lowering = lower_until_complete(lower)
    lowering.refuse_cells_beyond()
    needed = results[-1]
    if lowering.led_to:
        named = {a.name: a for a in definitions.assumptions}
        live = [named[name] for name in needed.live]  # in this order, on which correlated draws depend
        needed = replace(needed, stages=drawing_order(needed.graph, live, lowering.led_to))
    return needed, lowering


def lower_checks(workbook: Workbook, definitions: Definitions, live: Collection[str]) -> Lowering:
    """Return the nodes of the checks, apart from those of the run, which they must not change.

    Raises:
        FormulaError, DefinitionError: a check cannot be computed.
    """
    asked = definitions_of_checks(definitions, live)
    needed, lowering = lower_needed(workbook, asked)
    refuse_without_base(definitions.checks, needed, asked)
    for check in definitions.checks:
        lowering.target(Target(check.cell, check.cell))
    return lowering
