"""Functions that take one of their arguments: IF, IFS, SWITCH, CHOOSE, IFERROR, IFNA.

A condition that is known decides while the formula is lowered, and the other branches are never lowered. In a plain
formula, conditions and computed branches take the cell of a range beside the formula, also within SUMPRODUCT and its
like, as in Excel; a branch that is a range stays whole. Of references, a choice by one condition gives a reference:
where a range is wanted, its empty cells, texts and logicals are those of a range (`lower_reference`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from xlmc.engine.graph.arrays import as_range, cell_by_cell, either_reference, sizes_differ
from xlmc.engine.graph.circles import hidden_error
from xlmc.engine.graph.computed_references import NoReference, areas_of
from xlmc.engine.graph.graph import MANY
from xlmc.engine.graph.nodes import Constant, IfErrorNode, Range
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area
from xlmc.excel.formula import ir
from xlmc.excel.functions import Kind
from xlmc.excel.functions.operators import ALL_BITS, IS_CASE
from xlmc.excel.functions.values import ERROR, NUMBER

__all__ = ["CHOICES", "lower_reference"]

Arguments = tuple[ir.Expression, ...]


def _if(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    no = arguments[2] if len(arguments) == 3 else ir.Logical(False)
    return _choose_branch(lowering, lowering.lower(arguments[0], scope.plainly()), (arguments[1], no), scope.branch())


def _choose_branch(lowering: TreeLowering, condition: int, branches: Arguments, scope: Scope) -> int:
    known = lowering.lookup_condition(condition)
    if known is not None:
        return _branch(lowering, branches[0 if known else 1], scope)
    if _is_error(lowering, condition):
        return condition
    yes, no = (_branch(lowering, branch, scope) for branch in branches)
    return _select(lowering, condition, yes, no, scope)


def _branch(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> int:
    """Lower a branch; an empty cell is 0, but where a range is wanted."""
    node = lower_reference(lowering, tree, scope)
    return node if lowering.dag.sizes[node] is not None else lowering.zero_if_blank(node)


def lower_reference(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> int:
    """Lower a tree; a reference to one cell is a range of one cell where a range is wanted.

    Functions pass over empty cells, texts and logicals of ranges. A cell of which it is known that it holds a number
    stays a single value, which is the same to them.
    """
    node = lowering.lower(tree, scope)
    if not scope.whole or lowering.dag.sizes[node] not in (None, MANY) or lowering.dag.types[node] is Kind.NUMBER:
        return node
    return as_range(lowering.dag, node) if _is_reference(lowering, tree, scope) else node


def _is_reference(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree refers to one cell, perhaps to another one in each trial, that may hold no number."""
    match tree:
        case ir.Call("INDEX", (cells, *_)) | ir.Call("XLOOKUP", (_, _, cells)):
            pass
        case ir.Call("XLOOKUP", (_, _, cells, ir.Missing() | ir.Number(), *_)):
            pass
        case _:
            cells = tree
    try:
        areas = areas_of(lowering, cells, scope)
    except NoReference:
        return False
    return areas is not None and not all(_holds_numbers(lowering, area) for area in areas)


def _holds_numbers(lowering: TreeLowering, area: Area) -> bool:
    """Whether it is known that all cells of an area hold numbers."""
    if area.is_cut:
        return False
    dag, node = lowering.dag, lowering.range(area)
    match dag.nodes[node]:
        case Range(rows):
            return all(dag.types[cell] is Kind.NUMBER for row in rows for cell in row)
        case Constant(value):
            return bool((value.kinds == NUMBER).all())
        case _:
            return False


def _select(lowering: TreeLowering, condition: int, yes: int, no: int, scope: Scope) -> int:
    """Lower a choice; where a range is wanted, one of two ranges keeps its empty cells."""
    sizes = lowering.dag.sizes
    if not scope.whole or sizes[condition] is not None or sizes[yes] is sizes[no] is None:
        return lowering.select(condition, yes, no)
    if None in (sizes[yes], sizes[no]):
        yes, no = (_beside_range(lowering, node, other) for node, other in ((yes, no), (no, yes)))
    if sizes_differ(lowering.dag, condition, yes, no):
        return lowering.select(condition, yes, no)
    return either_reference(lowering.dag, condition, yes, no)


def _beside_range(lowering: TreeLowering, node: int, other: int) -> int:
    """Turn a number into a range of one cell where the other branch is one, as functions make no difference."""
    dag = lowering.dag
    alone = dag.sizes[node] is None and dag.types[node] is Kind.NUMBER
    return as_range(dag, node) if alone and dag.sizes[other] == (1, 1) else node


def _ifs(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    if len(arguments) % 2:
        raise FormulaError("IFS takes pairs of a condition and a value")
    pairs = zip(arguments[::2], arguments[1::2], strict=True)
    conditions = ((lowering.lower(test, scope.plainly()), value) for test, value in pairs)
    return _first_true(lowering, conditions, ir.ErrorLiteral(ErrorCode.NA), scope.branch())


def _first_true(
    lowering: TreeLowering, pairs: Iterator[tuple[int, ir.Expression]], last: ir.Expression, scope: Scope
) -> int:
    """Choose the value behind the first condition that is true, else `last`; what known conditions exclude is not
    lowered.
    """
    varying: list[tuple[int, int]] = []
    node = None
    for condition, value in pairs:
        known = lowering.lookup_condition(condition)
        if known is not None and not known:
            continue
        if known or _is_error(lowering, condition):
            node = _branch(lowering, value, scope) if known else condition
            break
        varying.append((condition, _branch(lowering, value, scope)))
    node = _branch(lowering, last, scope) if node is None else node
    for condition, value_node in reversed(varying):
        node = _select(lowering, condition, value_node, node, scope)
    return node


def _is_error(lowering: TreeLowering, condition: int) -> bool:
    known = lowering.lookup_constant(condition)
    return known is not None and int(known.kinds[0]) >= ERROR


def _switch(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    subject, rest = lowering.lower(arguments[0], scope.plainly()), arguments[1:]
    last = rest[-1] if len(rest) % 2 else ir.ErrorLiteral(ErrorCode.NA)
    pairs = zip(rest[: len(rest) // 2 * 2 : 2], rest[1::2], strict=True)
    conditions = (
        (lowering.apply(IS_CASE, (subject, lowering.lower(match, scope.plainly()))), result) for match, result in pairs
    )
    return _first_true(lowering, conditions, last, scope.branch())


def _choose(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    index = lowering.call("TRUNC", (lowering.lower(arguments[0], scope.plainly()),))
    scope = scope.branch()
    known = lowering.lookup_constant(index)
    if known is not None and known.plain:
        which = int(known.numbers[0])
        inside = 1 <= which < len(arguments)
        return _branch(lowering, arguments[which], scope) if inside else _bad_index(lowering)
    node = _bad_index(lowering)
    for number in range(len(arguments) - 1, 0, -1):
        is_it = lowering.apply(ALL_BITS["="], (index, lowering.number(float(number))))
        node = _select(lowering, is_it, _branch(lowering, arguments[number], scope), node, scope)
    return node


def _bad_index(lowering: TreeLowering) -> int:
    return lowering.error(ErrorCode.VALUE)


def _if_error(only_na: bool) -> Callable[[TreeLowering, Arguments, Scope], int]:
    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
        return _lower_if_error(
            lowering, lowering.lower(arguments[0], scope.plainly()), arguments[1], scope.branch(), only_na
        )

    return lower


def _lower_if_error(lowering: TreeLowering, value: int, instead: ir.Expression, scope: Scope, only_na: bool) -> int:
    value = lowering.zero_if_blank(value)
    if value in lowering.dag.missing:
        raise hidden_error("IFNA" if only_na else "IFERROR")
    known = lowering.lookup_constant(value)
    if known is not None:
        kind = int(known.kinds[0])
        lost = kind == ERROR + ErrorCode.NA or (kind >= ERROR and not only_na)
        return lowering.zero_if_blank(lowering.lower(instead, scope)) if lost else value
    other = lowering.zero_if_blank(lowering.lower(instead, scope))
    if sizes_differ(lowering.dag, value, value, other):
        lost_ = lowering.call("ISNA" if only_na else "ISERROR", (value,))
        return lowering.select(lost_, other, value)

    def single(picked: tuple[int, ...]) -> int:
        node = IfErrorNode(picked[0], picked[1], only_na)
        return lowering.dag.add(node)

    spread = cell_by_cell(lowering.dag, (value, other), single)
    return single((value, other)) if spread is None else spread


def _single(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    """`@x`: the cell of a range beside the formula."""
    plain = Scope(scope.cell, variables=scope.variables, depth=scope.depth)
    return lowering.first_cell(lowering.lower(arguments[0], plain))


CHOICES: Mapping[str, Callable[[TreeLowering, Arguments, Scope], int]] = {
    "IF": _if,
    "IFS": _ifs,
    "SWITCH": _switch,
    "CHOOSE": _choose,
    "IFERROR": _if_error(only_na=False),
    "IFNA": _if_error(only_na=True),
    "SINGLE": _single,
}
