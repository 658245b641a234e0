"""One forward sweep over the graph of nodes computes every value, and its derivatives beside it.

The values are those of the careful path (`evaluation.tracking`), so that errors, texts and blanks are as in a run. A
node's value is dropped as soon as nothing reads it any more.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.graph.node_values import Ragged, evaluate_node
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Node, Range, Select, uses
from xlmc.engine.passes.derivatives import elementary, lookup_rules, sums  # noqa: F401 - they register their rules
from xlmc.engine.passes.derivatives.conditions import if_, if_error
from xlmc.engine.passes.derivatives.derivative import Notes
from xlmc.engine.passes.derivatives.jet import Jet, align
from xlmc.engine.passes.derivatives.lookup_rules import Drawer
from xlmc.engine.passes.derivatives.numerical import by_differences
from xlmc.engine.passes.derivatives.rules import RULES, Operand, Outcome
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import ERROR, TEXT, Bools, Floats, ShapeVaries, Value

__all__ = ["UnequalSizes", "owners", "sweep_forward"]

_NO_DERIVATIVE: Final = "the function has none there"


class UnequalSizes(Exception):  # noqa: N818 - it asks for another way
    """An array differs in size between trials: evaluate these one by one."""


def sweep_forward(
    dag: Dag, wanted: Collection[int], draws: Mapping[str, Floats], order: int, notes: Notes, start: int = 0
) -> Iterator[tuple[int, Value, Jet]]:
    """Return the value and the derivatives of the nodes wanted, in their order.

    Args:
        dag: the nodes.
        wanted: which of them.
        draws: of every input, `(n,)` each; derivatives count them in this order.
        order: 1 or 2.
        notes: notes are added to it.
        start: the number of the first trial, for the notes.

    Raises:
        UnequalSizes: see the class; not with a single trial.
    """
    numbers = {name: number for number, name in enumerate(draws)}
    nodes = dag.upstream(sorted(wanted))
    last = {used: node_id for node_id in nodes for used in uses(dag.nodes[node_id])}
    valued = _read_as_values(dag, nodes)
    values: dict[int, Value] = {}
    jets: dict[int, Jet] = {}
    for node_id in sorted({*wanted} - {*nodes}):
        node = dag.nodes[node_id]
        assert isinstance(node, Constant)
        yield node_id, node.value, Jet.still(node.value.numbers)
    for node_id in nodes:
        node = dag.nodes[node_id]
        if isinstance(node, Input):
            values[node_id] = Value.of_numbers(draws[node.name])
            jets[node_id] = Jet.of_input(draws[node.name], numbers[node.name], order)
        else:
            operands = [_operand(dag, used, values, jets) for used in uses(node)]
            known = dict(zip(uses(node), (operand.value for operand in operands), strict=True))
            values[node_id] = result = evaluate_node(node, known)  # type: ignore[arg-type]  # a constant is not upstream
            if isinstance(result, Ragged):
                raise UnequalSizes
            if any(operand.jet.active for operand in operands):
                jets[node_id] = _differentiate(dag, node_id, result, operands, notes, start, node_id in valued)
            else:
                jets[node_id] = Jet.still(result.numbers)
        if node_id in wanted:
            yield node_id, values[node_id], jets[node_id]
        for used in {*uses(node)}:
            if last[used] == node_id:
                values.pop(used, None)
                jets.pop(used, None)


def _read_as_values(dag: Dag, nodes: Sequence[int]) -> set[int]:
    """Return the nodes that a function reads as values; conditions are mostly read by choices and other conditions."""
    result: set[int] = set()
    for node_id in nodes:
        node = dag.nodes[node_id]
        if isinstance(node, Apply) and node.function.returns is not Kind.LOGICAL:
            result.update(node.arguments)
    return result


def _operand(dag: Dag, node_id: int, values: Mapping[int, Value], jets: Mapping[int, Jet]) -> Operand:
    node = dag.nodes[node_id]
    value = node.value if isinstance(node, Constant) else values[node_id]
    jet = jets.get(node_id)
    if jet is None or not jet.active:
        jet = Jet.still(value.to_numbers()[0])
    return Operand(value, jet)


def _differentiate(
    dag: Dag, node: int, result: Value, operands: Sequence[Operand], notes: Notes, start: int, valued: bool
) -> Jet:
    """Return the derivatives of a node, with notes taken."""
    name, why, jumps = _describe(dag, node)
    with np.errstate(all="ignore"):
        try:
            outcome = _outcome(dag, node, result, operands)
        except ShapeVaries:
            raise UnequalSizes from None
        jet = _mask_undefined(outcome.jet, result)
    if outcome.branches is not None and (valued or not _is_condition(dag.nodes[node])):
        notes.took(node, name, outcome.branches, jumps)
    if outcome.numerical:
        notes.note_difference(node, name, jet.first, jet.error)
    _note_losses(node, name, why, result, jet, operands, notes, start)
    return jet


def _is_condition(node: Node) -> bool:
    return isinstance(node, Apply) and node.function.facts.condition


def _describe(dag: Dag, node_id: int) -> tuple[str, str, bool]:
    """Say what the node is called, why it may have no derivative, and whether it jumps between its branches."""
    node = dag.nodes[node_id]
    if isinstance(node, Apply):
        rule = RULES.get(node.function.name)
        why = (rule.why if rule else "") or _NO_DERIVATIVE
        return node.function.name, why, rule is not None and rule.jumps
    if isinstance(node, Select):
        return "IF", "the condition is at its limit there", True
    return ("IFERROR" if isinstance(node, IfErrorNode) else "a range"), _NO_DERIVATIVE, True


def _outcome(dag: Dag, node_id: int, result: Value, operands: Sequence[Operand]) -> Outcome:
    node = dag.nodes[node_id]
    if isinstance(node, Range):
        return Outcome(_stack(node, result, operands))
    if isinstance(node, Select):
        return if_(result, operands)
    if isinstance(node, IfErrorNode):
        return if_error(result, operands, node.only_na)
    assert isinstance(node, Apply)
    function = node.function
    if function.name.startswith("cell "):
        drawer = Drawer.of(operands)
        return Outcome(drawer.draw(function(drawer.tags), result))
    if function.name in RULES:
        return RULES[function.name].apply(function, result, operands)
    if function.returns is Kind.LOGICAL:
        return Outcome(Jet.still(result.numbers), result.numbers if result.numbers.ndim == 1 else None)
    return by_differences(function, result, operands)


def _stack(node: Range, result: Value, operands: Sequence[Operand]) -> Jet:
    """Cells `(n,)` side by side, `(n, r, c)`."""
    jets = align([operand.jet for operand in operands])
    n, rows, columns = result.shape
    order = min(jet.order for jet in jets)

    def grid(name: str, axes: int) -> Floats | None:
        parts = [getattr(jet, name) for jet in jets]
        if all(part is None for part in parts):
            return None
        lead = (len(jets[0].active),) * axes
        out = np.zeros((*lead, n, rows * columns))
        for cell, part in enumerate(parts):
            if part is not None:
                out[..., cell] = part
        return out.reshape(*lead, n, rows, columns)

    first = grid("first", 1)
    assert first is not None
    second = grid("second", 2) if order > 1 else None
    errors = grid("error", 1), grid("second_error", 2)
    return Jet(result.numbers, jets[0].active, first, second, *errors)


def _mask_undefined(jet: Jet, result: Value) -> Jet:
    """Make derivatives that are not finite, and those of errors and texts, NaN."""
    errors = np.asarray(result.kinds >= ERROR)
    first = np.where(errors | ~np.isfinite(jet.first), np.nan, jet.first)
    lost = np.isnan(first)
    second = jet.second
    if second is not None:
        gone = lost[:, None] | lost[None, :]
        second = np.where(gone | ~np.isfinite(second), np.nan, second)
    return Jet(result.numbers, jet.active, first, second, jet.error, jet.second_error)


def _note_losses(
    node: int,
    name: str,
    why: str,
    result: Value,
    jet: Jet,
    operands: Sequence[Operand],
    notes: Notes,
    start: int,
) -> None:
    """Note the trials in which the function itself lost derivatives, or made an error."""
    n = max(result.shape[0], jet.first.shape[1])
    lost = _any_of_trial(np.isnan(jet.first), n, 1)
    if not lost.any():
        return
    before = np.zeros(n, bool)
    wrong = np.zeros(n, bool)
    for operand in operands:
        before |= _any_of_trial(np.isnan(operand.jet.first), n, 1)
        wrong |= _any_of_trial(np.asarray(operand.value.kinds >= ERROR), n, 0)
    errors = np.broadcast_to(np.asarray(result.kinds >= ERROR), result.shape)
    failed = _any_of_trial(errors, n, 0)
    for code in np.unique(result.kinds[result.kinds >= ERROR]):
        here = _any_of_trial(np.asarray(result.kinds == code), n, 0) & ~wrong
        if here.any():
            notes.lose(node, name, f"it is {ErrorCode(int(code) - ERROR).text}", here, start)
    if (result.kinds == TEXT).any():
        why = "its digits pass through a text"
    own = lost & ~before & ~failed
    if own.any():
        notes.lose(node, name, why, own, start)


def _any_of_trial(part: Bools, n: int, axes: int) -> Bools:
    """Whether it is so for any assumption and any cell of a trial, `(n,)`."""
    whole: Bools = np.logical_or.reduce(part, axis=0) if axes else part
    rows: Bools = np.logical_or.reduce(whole.reshape(whole.shape[0], -1), axis=1)
    return np.array(np.broadcast_to(rows, (n,)))


def owners(lowering: Lowering) -> dict[int, Cell]:
    """Node -> the cell whose formula it is in, for every node that varies.

    Nodes are shared: the first cell that needs one stands for all.
    """
    result: dict[int, Cell] = {lowering.cell(cell): cell for cell in lowering.inputs}
    nodes = lowering.dag.nodes
    for cell in lowering.graph.formulas:
        open_ = [lowering.cell(cell)]
        while open_:
            node = open_.pop()
            if node not in result:
                result[node] = cell
                open_ += uses(nodes[node])
    return result
