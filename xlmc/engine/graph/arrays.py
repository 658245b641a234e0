"""Make nodes of nodes while formulas are lowered: of single values, and of arrays cell by cell.

A function that takes single values and is given arrays becomes an array of calls (`NodeBuilder.apply`).

An array that varies is kept as a `Range` of single nodes wherever its size is known, so that array formulas run on the
fast path like any other.

A choice between values of different sizes is a node of its own: `IF(x>0,A1:A3,5)` is three cells in one trial and one
in another. A function of it becomes the same choice between the function's two results, which for `SUM` and its like
are single values again and run on the fast path; only a choice that remains is computed trial by trial.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial
from math import prod
from typing import Final

import numpy as np

from xlmc.engine.graph.circles import refuse_hidden
from xlmc.engine.graph.graph import MANY, Dag
from xlmc.engine.graph.nodes import Apply, Constant, Range, Select
from xlmc.engine.graph.number_lookups import NumberLookups
from xlmc.engine.graph.running_totals import PAIRED_OR_COUNTED, RunningTotals
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.registry import Anything, Cells
from xlmc.excel.functions.values import BLANK, ShapeVaries, Value, constant

__all__ = [
    "LARGEST",
    "MOST_OUTCOMES",
    "NodeBuilder",
    "beside",
    "cell_by_cell",
    "either",
    "element",
    "grid",
    "pick",
    "share_out",
    "size_of",
    "sizes_differ",
    "spread",
]

MOST_OUTCOMES: Final = 256
"""The most combinations of outcomes of the choices in a function's arguments for which `share_out` still works."""

LARGEST: Final = 10_000
"""Cells of a varying array that are made nodes of their own; a larger one is computed as a whole."""


def size_of(dag: Dag, node: int) -> tuple[int, int] | None:
    """Rows and columns of a value of many cells; None for a single one.

    Raises:
        FormulaError: the size is not known before the run.
    """
    size = dag.sizes[node]
    if size == MANY:
        raise FormulaError("the size of an array is known only during the run", hint="give it a fixed number of rows")
    return None if size is None else (size[0], size[1])


def element(dag: Dag, node_id: int, row: int, column: int) -> int:
    """Return the node of one cell of a value, counted from 0; a single row, column or value repeats, beyond it is
    `#N/A`.
    """
    node, size = dag.nodes[node_id], dag.sizes[node_id]
    if size is None:
        return node_id
    if size != MANY:
        row, column = (0 if size[0] == 1 else row), (0 if size[1] == 1 else column)
        if row >= size[0] or column >= size[1]:
            return dag.constant(constant(ErrorCode.NA))
    if isinstance(node, Range):
        return node.rows[row][column]
    if isinstance(node, Constant):
        return dag.part_of(node_id, pick(node.value, row, column))
    chosen = _parts_of(dag, node_id)
    if chosen is not None:
        return dag.add(Select(chosen[0], *(element(dag, part, row, column) for part in chosen[1:])))
    return dag.add(Apply(_picker(row, column), (node_id,)))


@cache
def _picker(row: int, column: int) -> Function:
    return Function(f"cell {row},{column}", (Cells,), partial(pick, row=row, column=column), Kind.ANY)


def pick(value: Value, row: int, column: int) -> Value:
    """(n, r, c) -> (n,); does what `element` does, where the size is known only during the run."""
    if value.numbers.ndim == 1:
        return value
    _, rows, columns = value.shape
    row, column = (0 if rows == 1 else row), (0 if columns == 1 else column)
    if row >= rows or column >= columns:
        return constant(ErrorCode.NA)
    parts = [None if a is None else np.broadcast_to(a, value.shape)[:, row, column] for a in value.arrays()]
    return Value(parts[0], parts[1], parts[2])  # type: ignore[arg-type]  # only texts may be None


def beside(dag: Dag, node: int, row: int, column: int) -> int:
    """Return the node of a single value: of a whole column or row of a range it is the cell beside the formula.

    Args:
        dag: of the nodes.
        node: a cell, column, row or all of a range.
        row: that of the formula, counted from the first cell of the range.
        column: that of the formula, counted likewise.
    """
    return node if dag.sizes[node] is None else dag.add(Apply(_picker_beside(row, column), (node,)))


@cache
def _picker_beside(row: int, column: int) -> Function:
    body = partial(_pick_beside, row=row, column=column)
    return Function(f"cell beside {row},{column}", (Cells,), body, Kind.ANY)


def _pick_beside(value: Value, row: int, column: int) -> Value:
    """(n, r, c) -> (n,)."""
    rows, columns = value.shape[1:] or (1, 1)
    at = (0 if rows == 1 else row), (0 if columns == 1 else column)
    if (rows > 1 and columns > 1) or not (0 <= at[0] < rows and 0 <= at[1] < columns):
        return constant(ErrorCode.VALUE)
    return pick(value, *at)


def grid(dag: Dag, rows: int, columns: int, at: Callable[[int, int], int]) -> int:
    """Return the node of an array made of single nodes."""
    return dag.add(Range(tuple(tuple(at(r, c) for c in range(columns)) for r in range(rows))))


def spread(dag: Dag, function: Function, loose: tuple[int, ...], apply: Callable[[tuple[int, ...]], int]) -> int | None:
    """Do `cell_by_cell` for a function's arguments of single values, as far as the function allows it.

    A function whose result has a size that these arguments decide is called once for each cell, also where all are
    constant. INDEX of row or column 0, which gives whole columns or rows, is called once for all cells; where 0 is one
    of many numbers, once for each cell.
    """
    shaping = function.facts.sized_by_numbers
    if function.name == "INDEX":
        zeros = [node for node in loose if _has_zero(dag, node)]
        if any(dag.sizes[node] is None for node in zeros):
            return None
        shaping = bool(zeros)
    return cell_by_cell(dag, loose, apply, constants=shaping)


def _has_zero(dag: Dag, node_id: int) -> bool:
    """Whether any cell of a constant counts as 0 where whole numbers are wanted."""
    node = dag.nodes[node_id]
    if not isinstance(node, Constant):
        return False
    numbers, errors = node.value.to_numbers()
    return bool(np.any((np.abs(numbers) < 1) & (errors == 0)))


def cell_by_cell(
    dag: Dag, nodes: tuple[int, ...], apply: Callable[[tuple[int, ...]], int], *, constants: bool = False
) -> int | None:
    """Apply `apply` to the cells of each of `nodes` and return the node of the array; None if that is not worth it.

    Constants are computed at once, unless `constants` is set; values of unknown sizes cannot be taken apart. Where
    sizes do not fit each other, a cell without a partner is `#N/A`.

    Raises:
        FormulaError: `constants` is set and there are too many cells.
    """
    sizes = [size for node in nodes if (size := dag.sizes[node]) is not None]
    if not sizes or MANY in sizes:
        return None
    rows, columns = max(size[0] for size in sizes), max(size[1] for size in sizes)
    fit = all(size[0] in (1, rows) and size[1] in (1, columns) for size in sizes)
    constant_ = all(isinstance(dag.nodes[node], Constant) for node in nodes)
    if constants and rows * columns > LARGEST:
        raise FormulaError(f"{rows * columns:,} cells would each make an array", hint="give a single number for them")
    if fit and ((constant_ and not constants) or rows * columns > LARGEST):
        return None
    return grid(dag, rows, columns, lambda r, c: apply(tuple(element(dag, node, r, c) for node in nodes)))


def _either(condition: Value, yes: Value, no: Value) -> Value:
    """One of two values as a whole, or the condition's error: (n,) and values of any size.

    Raises:
        ShapeVaries: not all trials choose alike, so that their results may differ in size.
    """
    truth, errors = condition.to_logicals()
    outcome = np.unique(np.where(np.broadcast_to(errors, condition.shape) > 0, 2, truth))
    if outcome.size > 1:
        raise ShapeVaries
    if outcome[0] == 2:
        return Value.of_errors(np.broadcast_to(errors, condition.shape))
    return yes if outcome[0] else no


_EITHER: Final = Function("one of two sizes", (Anything, Cells, Cells), _either, Kind.ANY, facts=Facts(spills=True))


def sizes_differ(dag: Dag, condition: int, yes: int, no: int) -> bool:
    """Whether a single condition chooses between values of different, or of unknown, sizes."""
    sizes = dag.sizes[yes], dag.sizes[no]
    return dag.sizes[condition] is None and (sizes[0] != sizes[1] or MANY in sizes)


def either(dag: Dag, condition: int, yes: int, no: int) -> int:
    """Return the node of such a choice."""
    return dag.add(Apply(_EITHER, (condition, yes, no)))


_AS_RANGE: Final = Function("as a range", (Cells,), Value.as_range, Kind.ANY, facts=Facts(spills=True))


def as_range(dag: Dag, node: int) -> int:
    """Return the node of a single value as a range of one cell; of a range, the range."""
    return dag.add(Range(((node,),)) if dag.sizes[node] is None else Apply(_AS_RANGE, (node,)))


def _one_of_two(condition: Value, yes: Value, no: Value) -> Value:
    """(n,) and two values of one size -> the cells of either; an empty cell stays empty."""
    truth, errors = condition.to_logicals()
    return choose(truth, yes, no, errors)


_ONE_OF_TWO: Final = Function("one of two references", (Anything, Anything, Anything), _one_of_two, Kind.ANY)


def either_reference(dag: Dag, condition: int, yes: int, no: int) -> int:
    """Return the node of a choice between two ranges of one size, in which an empty cell stays empty; an IF
    makes it 0.
    """

    def one(picked: tuple[int, ...]) -> int:
        numbers = all(dag.types[node] is Kind.NUMBER for node in picked[1:])
        return dag.add(Select(*picked) if numbers else Apply(_ONE_OF_TWO, picked))

    cells = cell_by_cell(dag, (condition, yes, no), one)
    return one((condition, yes, no)) if cells is None else cells


def _parts_of(dag: Dag, node_id: int) -> tuple[int, int, int] | None:
    """Return the condition and the two values of such a choice; None for any other node."""
    node = dag.nodes[node_id]
    if not isinstance(node, Apply) or node.function is not _EITHER:
        return None
    condition, yes, no = node.arguments
    return condition, yes, no


def _outcomes(dag: Dag, node: int) -> int:
    """Count the outcomes of choices within each other, up to `MOST_OUTCOMES` and a little beyond."""
    parts, outcomes = _parts_of(dag, node), 1
    while parts is not None and outcomes <= MOST_OUTCOMES:
        outcomes += 1 + _outcomes(dag, parts[1])
        parts = _parts_of(dag, parts[2])
    return outcomes


def share_out(
    dag: Dag,
    arguments: tuple[int, ...],
    made: Callable[[tuple[int, ...]], int],
    is_error: Callable[[int], int],
    select: Callable[[int, int, int], int],
) -> int | None:
    """Return the function of arguments of which one is a choice, as that choice between its results; `made` makes
    these.

    None if there is no such choice, or too many of them. Where the condition is an error, it is the argument.
    """
    for position, node in enumerate(arguments):
        parts = _parts_of(dag, node)
        if parts is not None and prod(_outcomes(dag, each) for each in arguments) <= MOST_OUTCOMES:
            before, after = arguments[:position], arguments[position + 1 :]
            wrong, yes, no = (made((*before, part, *after)) for part in parts)
            return select(is_error(parts[0]), wrong, select(parts[0], yes, no))
    return None


class NodeBuilder:
    """Makes nodes of nodes.

    Attributes:
        dag: takes the nodes.
    """

    def __init__(self, dag: Dag, totals: RunningTotals) -> None:
        self.dag, self._totals, self._lookups = dag, totals, NumberLookups(dag)
        self._numbers: dict[float, int] = {}

    def number(self, value: float) -> int:
        """Return the node of a number."""
        if value not in self._numbers:
            self._numbers[value] = self.dag.constant(constant(value))
        return self._numbers[value]

    def error(self, code: ErrorCode) -> int:
        """Return the node of an error."""
        return self.dag.constant(constant(code))

    def first_cell(self, node: int) -> int:
        """Return the node of one cell of a value: the first of many."""
        return element(self.dag, node, 0, 0)

    def lookup_constant(self, node_id: int) -> Value | None:
        """Return the value of a single constant; None of any other node."""
        node = self.dag.nodes[node_id]
        return node.value if isinstance(node, Constant) and self.dag.sizes[node_id] is None else None

    def lookup_condition(self, node: int) -> bool | None:
        """Return what a condition is known to be; None if it varies, is an error, a text or many cells."""
        known = self.lookup_constant(node)
        return None if known is None or not known.plain else bool(known.numbers[0])

    def zero_if_blank(self, node: int) -> int:
        """Return what a formula gives for an empty cell."""
        known = self.lookup_constant(node)
        return self.number(0.0) if known is not None and int(known.kinds[0]) == BLANK else node

    def select(self, condition: int, yes: int, no: int) -> int:
        """Return the node of an IF between two nodes."""
        known = self.lookup_condition(condition)
        if known is not None:
            return yes if known else no
        if sizes_differ(self.dag, condition, yes, no):
            return either(self.dag, condition, yes, no)
        cells = cell_by_cell(self.dag, (condition, yes, no), lambda picked: self.select(*picked))
        return self.dag.add(Select(condition, yes, no)) if cells is None else cells

    def call(self, name: str, arguments: tuple[int, ...]) -> int:
        """Return the node of an operator, or of a function that takes single values."""
        if name == "+" and self.number(0.0) in arguments:
            other = arguments[arguments[0] == self.number(0.0)]
            if self.dag.types[other] is Kind.NUMBER:
                return other
        if name == "^" and arguments[1] == self.number(2.0):
            return self.call("*", (arguments[0], arguments[0]))
        return self.apply(REGISTRY[name], arguments)

    def apply(self, function: Function, arguments: tuple[int, ...]) -> int:
        """Return the node of a function of nodes, cell by cell where it takes single values and is given many."""
        if self.dag.missing:
            refuse_hidden(self.dag, function, arguments)
        if function.facts.factor is not None:
            return self.call("*", (arguments[0], self.number(function.facts.factor)))
        if function.name == "/" and (factor := self._inverse(arguments[1])) is not None:
            return self.call("*", (arguments[0], self.number(factor)))
        chosen = self._share_out(function, arguments)
        if chosen is not None:
            return chosen
        if function.takes_sets or function.name in PAIRED_OR_COUNTED:
            return self._totals.apply(function, arguments)
        value = self._lookups.apply(function, arguments)
        if value is not None:
            return value
        if all(self.dag.sizes[node] is None for node in arguments):
            return self.dag.add(Apply(function, arguments))
        loose = tuple(p for i, p in enumerate(arguments) if not function.parameter(i).ranged)
        cells = spread(
            self.dag, function, loose, lambda picked: self.apply(function, _merge(function, arguments, picked))
        )
        return self.dag.add(Apply(function, arguments)) if cells is None else cells

    def _share_out(self, function: Function, arguments: tuple[int, ...]) -> int | None:
        """Return the function of a choice between sizes, as a choice between two results; None without such an
        argument.
        """
        return share_out(
            self.dag,
            arguments,
            partial(self.apply, function),
            lambda node: self.call("ISERROR", (node,)),
            self.select,
        )

    def _inverse(self, node_id: int) -> float | None:
        """Return the inverse of a power of two: to multiply by it gives the quotient to the last bit. None of other
        nodes.
        """
        node = self.dag.nodes[node_id]
        if not isinstance(node, Constant) or self.dag.types[node_id] is not Kind.NUMBER:
            return None
        number = float(node.value.numbers[0])
        return 1.0 / number if abs(math.frexp(number)[0]) == 0.5 and 2.0**-60 < abs(number) < 2.0**60 else None


def _merge(function: Function, arguments: tuple[int, ...], picked: tuple[int, ...]) -> tuple[int, ...]:
    """Return the arguments with those that take single values replaced, in order."""
    singles = iter(picked)
    return tuple(p if function.parameter(i).ranged else next(singles) for i, p in enumerate(arguments))
