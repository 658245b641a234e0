"""Draws in cells whose numbers are no distribution, where a formula need not ask for them.

@RISK and Crystal Ball show `#VALUE!` for such a call. `=IF(A1="N",RiskNormal(B1,C1),RiskUniform(D1,E1))` with blank
cells for the distribution that is not chosen is none the worse, nor is a lookup that picks another row. Where every
trial would be an error, the numbers are a mistake, and the workbook is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.graph.nodes import Apply, Input, Node, Range, Select, uses
from xlmc.errors import DefinitionError, ErrorCode, Notice
from xlmc.excel.address import InFormula
from xlmc.excel.formula import ir
from xlmc.excel.functions import Kind
from xlmc.excel.functions.fifteen_digits import COMPARISONS
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions
from xlmc.montecarlo.model.draw_binding import VaryingError, draw_of, parameter_target
from xlmc.montecarlo.model.needed import Needed, targets_of
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["possible_draws", "with_errors"]


def possible_draws(
    needed: Needed, lowering: Lowering, definitions: Definitions
) -> tuple[dict[str, Draw], dict[str, DefinitionError]]:
    """Return the draws in cells that a run needs, by name, and why the others among them are no distribution.

    Raises:
        DefinitionError: one of the latter would make every trial an error.
    """
    calls = {a.name: a for a in definitions.assumptions if isinstance(a.cell, InFormula)}
    draws: dict[str, Draw] = {}
    faults: dict[str, DefinitionError] = {}
    for name in needed.live:
        if name in calls:
            try:
                draws[name] = draw_of(calls[name], lowering)
            except VaryingError:
                raise
            except DefinitionError as error:
                faults[name] = error
    if faults:
        always = _reached(lowering, definitions, _spreading)
        for name, fault in faults.items():
            if name in always:
                raise fault
    return draws, faults


def with_errors(definitions: Definitions, faults: Mapping[str, DefinitionError], lowering: Lowering) -> Definitions:
    """Return the definitions with `#VALUE!` instead of these draws, with a notice if a trial may use one."""
    gone = [a for a in definitions.assumptions if a.name in faults]
    usable = _reached(lowering, definitions, uses)
    reported = [a for a in gone if a.name in usable]
    return replace(
        definitions,
        assumptions=tuple(a for a in definitions.assumptions if a.name not in faults),
        rewritten={**definitions.rewritten, **{a.cell: ir.ErrorLiteral(ErrorCode.VALUE) for a in gone}},
        notices=(*definitions.notices, *([_notice(reported, faults[reported[0].name])] if reported else [])),
    )


def _notice(reported: list[Assumption], error: DefinitionError) -> Notice:
    what = (
        "this draw is"
        if len(reported) == 1
        else f"{count_text(len(reported))} draws in cells, of which this is the first, are"
    )
    return Notice(f"{what} no distribution ({error.message}): #VALUE! in the trials that use it", reported[0].row)


def _reached(lowering: Lowering, definitions: Definitions, parts: Callable[[Node], Iterable[int]]) -> set[str]:
    """Return the names of the draws that the forecasts and filters lead to, from each node to these parts of it."""
    formulas = {a.name: a.formulas.values() for a in definitions.assumptions}
    targets = targets_of(definitions.forecasts, (*definitions.filters, *definitions.forecast_filters))
    waiting = [lowering.cell(cell) for cell in targets]
    seen: set[int] = set()
    result: set[str] = set()
    while waiting:
        node_id = waiting.pop()
        if node_id in seen:
            continue
        seen.add(node_id)
        node = lowering.dag.nodes[node_id]
        if isinstance(node, Input):
            result.add(node.name)
            waiting += [lowering.target(parameter_target(cell)) for cell in formulas.get(node.name, ())]
        waiting += parts(node)
    return result


def _spreading(node: Node) -> Iterable[int]:
    """Return the parts of a node whose error is always its own."""
    match node:
        case Select(condition):
            return (condition,)
        case Range():
            return uses(node)
        case Apply(function, arguments) if function.name in COMPARISONS:
            return arguments
        case Apply(function, arguments):
            return [x for i, x in enumerate(arguments) if function.parameter(i).kind is not Kind.ANY]
        case _:
            return ()
