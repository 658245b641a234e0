"""Functions that take one of their arguments: IF, IFS, SWITCH, CHOOSE, IFERROR, IFNA.

A condition that is known decides while the formula is lowered, and the other branches are never lowered. In a plain
formula, conditions and computed branches take the cell of a range beside the formula, also within SUMPRODUCT and its
like, as in Excel; a branch that is a range stays whole.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph.arrays import cell_by_cell, sizes_differ
from xlmc.evaluation.graph.lowering import Scope, TreeLowering
from xlmc.evaluation.graph.nodes import IfErrorNode
from xlmc.formula import ir
from xlmc.functions.operators import ALL_BITS
from xlmc.functions.values import ERROR

__all__ = ["CHOICES"]

Arguments = tuple[ir.Expression, ...]


def _if(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    no = arguments[2] if len(arguments) == 3 else ir.Logical(False)
    return _choose_branch(lowering, lowering.lower(arguments[0], scope.plainly()), (arguments[1], no), scope.branch())


def _choose_branch(lowering: TreeLowering, condition: int, branches: Arguments, scope: Scope) -> int:
    known = lowering.lookup_condition(condition)
    if known is not None:
        return lowering.zero_if_blank(lowering.lower(branches[0 if known else 1], scope))
    yes, no = (lowering.zero_if_blank(lowering.lower(branch, scope)) for branch in branches)
    return lowering.select(condition, yes, no)


def _ifs(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    if len(arguments) % 2:
        raise FormulaError("IFS takes pairs of a condition and a value")
    node = lowering.error(ErrorCode.NA)
    pairs = list(zip(arguments[::2], arguments[1::2], strict=True))
    for test, value in reversed(pairs):
        condition = lowering.lower(test, scope.plainly())
        node = lowering.select(condition, lowering.zero_if_blank(lowering.lower(value, scope.branch())), node)
    return node


def _switch(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    subject, rest = lowering.lower(arguments[0], scope.plainly()), arguments[1:]
    last = rest[-1] if len(rest) % 2 else ir.ErrorLiteral(ErrorCode.NA)
    node = lowering.zero_if_blank(lowering.lower(last, scope.branch()))
    for match, result in reversed(list(zip(rest[: len(rest) // 2 * 2 : 2], rest[1::2], strict=True))):
        same = lowering.apply(ALL_BITS["="], (subject, lowering.lower(match, scope.plainly())))
        node = lowering.select(same, lowering.zero_if_blank(lowering.lower(result, scope.branch())), node)
    return node


def _choose(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    index = lowering.call("TRUNC", (lowering.lower(arguments[0], scope.plainly()),))
    scope = scope.branch()
    known = lowering.lookup_constant(index)
    if known is not None and known.plain:
        which = int(known.numbers[0])
        inside = 1 <= which < len(arguments)
        return lowering.zero_if_blank(lowering.lower(arguments[which], scope)) if inside else _bad_index(lowering)
    node = _bad_index(lowering)
    for number in range(len(arguments) - 1, 0, -1):
        is_it = lowering.apply(ALL_BITS["="], (index, lowering.number(float(number))))
        node = lowering.select(is_it, lowering.zero_if_blank(lowering.lower(arguments[number], scope)), node)
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
