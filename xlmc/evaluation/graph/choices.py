"""Functions that take one of their arguments: IF, IFS, SWITCH, CHOOSE, IFERROR, IFNA.

A condition that is known decides while the formula is lowered, and the other branches are never looked at. In a plain
formula, conditions and what is computed in branches take the cell of a range beside the formula, also within SUMPRODUCT
and its like, as in Excel; a branch that is a range goes on whole.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph.arrays import cell_by_cell
from xlmc.evaluation.graph.dag import Rescue, Select
from xlmc.evaluation.graph.either import differ, either
from xlmc.evaluation.graph.scope import Scope
from xlmc.formula import ir
from xlmc.functions.operators import ALL_BITS
from xlmc.functions.values import ERROR

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["CHOICES", "decided", "select"]

Arguments = tuple[ir.Expression, ...]


def decided(lowering: Lowering, condition: int) -> bool | None:
    """What a condition is known to be; None where it varies, is an error, a text or many cells."""
    known = lowering.known_single(condition)
    return None if known is None or not known.plain else bool(known.numbers[0])


def _if(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    no = arguments[2] if len(arguments) == 3 else ir.Logical(False)
    return _chosen(lowering, lowering.lower(arguments[0], scope.plainly()), (arguments[1], no), scope.branch())


def _chosen(lowering: Lowering, condition: int, branches: Arguments, scope: Scope) -> int:
    known = decided(lowering, condition)
    if known is not None:
        return lowering.zero_if_blank(lowering.lower(branches[0 if known else 1], scope))
    yes, no = (lowering.zero_if_blank(lowering.lower(branch, scope)) for branch in branches)
    return select(lowering, condition, yes, no)


def select(lowering: Lowering, condition: int, yes: int, no: int) -> int:
    """The node of an IF between two nodes."""

    def single(picked: tuple[int, ...]) -> int:
        return select(lowering, *picked)

    known = decided(lowering, condition)
    if known is not None:
        return yes if known else no
    if differ(lowering.dag, condition, yes, no):
        return either(lowering.dag, condition, yes, no)
    spread = cell_by_cell(lowering.dag, (condition, yes, no), single)
    return lowering.dag.add(Select(condition, yes, no)) if spread is None else spread


def _ifs(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    if len(arguments) % 2:
        raise FormulaError("IFS takes pairs of a condition and a value")
    place = lowering.error(ErrorCode.NA)
    pairs = list(zip(arguments[::2], arguments[1::2], strict=True))
    for test, value in reversed(pairs):
        condition = lowering.lower(test, scope.plainly())
        place = select(lowering, condition, lowering.zero_if_blank(lowering.lower(value, scope.branch())), place)
    return place


def _switch(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    subject, rest = lowering.lower(arguments[0], scope.plainly()), arguments[1:]
    last = rest[-1] if len(rest) % 2 else ir.ErrorLiteral(ErrorCode.NA)
    place = lowering.zero_if_blank(lowering.lower(last, scope.branch()))
    for match, result in reversed(list(zip(rest[: len(rest) // 2 * 2 : 2], rest[1::2], strict=True))):
        same = lowering.made(ALL_BITS["="], (subject, lowering.lower(match, scope.plainly())))
        place = select(lowering, same, lowering.zero_if_blank(lowering.lower(result, scope.branch())), place)
    return place


def _choose(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    index = lowering.call("TRUNC", (lowering.lower(arguments[0], scope.plainly()),))
    scope = scope.branch()
    known = lowering.known_single(index)
    if known is not None and known.plain:
        place = int(known.numbers[0])
        inside = 1 <= place < len(arguments)
        return lowering.zero_if_blank(lowering.lower(arguments[place], scope)) if inside else _bad_index(lowering)
    place = _bad_index(lowering)
    for number in range(len(arguments) - 1, 0, -1):
        is_it = lowering.made(ALL_BITS["="], (index, lowering.number(float(number))))
        place = select(lowering, is_it, lowering.zero_if_blank(lowering.lower(arguments[number], scope)), place)
    return place


def _bad_index(lowering: Lowering) -> int:
    return lowering.error(ErrorCode.VALUE)


def _rescue(only_na: bool) -> Callable[[Lowering, Arguments, Scope], int]:
    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
        return _rescued(lowering, lowering.lower(arguments[0], scope.plainly()), arguments[1], scope.branch(), only_na)

    return lower


def _rescued(lowering: Lowering, value: int, instead: ir.Expression, scope: Scope, only_na: bool) -> int:
    value = lowering.zero_if_blank(value)
    known = lowering.known_single(value)
    if known is not None:
        kind = int(known.kinds[0])
        lost = kind == ERROR + ErrorCode.NA or (kind >= ERROR and not only_na)
        return lowering.zero_if_blank(lowering.lower(instead, scope)) if lost else value
    other = lowering.zero_if_blank(lowering.lower(instead, scope))
    if differ(lowering.dag, value, value, other):
        lost_ = lowering.call("ISNA" if only_na else "ISERROR", (value,))
        return select(lowering, lost_, other, value)

    def single(picked: tuple[int, ...]) -> int:
        node = Rescue(picked[0], picked[1], only_na)
        return lowering.dag.add(node)

    spread = cell_by_cell(lowering.dag, (value, other), single)
    return single((value, other)) if spread is None else spread


def _single(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    """`@x`: the cell of a range beside the formula."""
    plain = Scope(scope.cell, variables=scope.variables, depth=scope.depth)
    return lowering.single(lowering.lower(arguments[0], plain))


CHOICES: Mapping[str, Callable[[Lowering, Arguments, Scope], int]] = {
    "IF": _if,
    "IFS": _ifs,
    "SWITCH": _switch,
    "CHOOSE": _choose,
    "IFERROR": _rescue(only_na=False),
    "IFNA": _rescue(only_na=True),
    "SINGLE": _single,
}
