"""Functions of many cells, from left to right as the careful path goes: sums, extremes, means, AND, OR, XOR."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, reduce
from typing import Any, Final

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Range
from xlmc.engine.llvm.loop_rules import Emit, Emitter, Literal, LoopRule, Operand, first_operand, part_of
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import BLANK, LOGICAL, NUMBER, TEXT, Value

__all__ = ["over_cells"]

Part = Operand | Literal
Parts = Sequence[Any]

_MOST: Final = 200
"""Cells of a range that a loop reads one by one; a wider one is summed by NumPy."""

_ALL: Final = range(_MOST)


class _NotForTheLoopError(Exception):
    """A cell of the range is of no kind that is known before the run, or is an error."""


@dataclass(slots=True)
class _Members:
    """The cells of the arguments that count, and those that do not count but may be errors."""

    counting: list[Part]
    beside: list[Operand]


def over_cells(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of a function of ranges; otherwise None."""
    try:
        if node.function.name == "SUMPRODUCT":
            return _sum_of_products(dag, node)
        if node.function.name == "COUNT":
            return _count(dag, node)
        if node.function.name not in _ROWS:
            return None
        row = _ROWS[node.function.name]
        members = _members(dag, node)
    except _NotForTheLoopError:
        return None
    if not row.fewest <= len(members.counting) <= _MOST:
        return None
    return LoopRule(tuple(members.counting), row.emit, row.absorbs, row.makes, tuple(members.beside))


def _members(dag: Dag, node: Apply) -> _Members:
    members = _Members([], [])
    kind = node.function.parameters[0].kind
    for node_id in node.arguments:
        cells = _cells(dag, node_id)
        if cells is None:
            part = part_of(dag, node_id, kind)
            if part is None:
                raise _NotForTheLoopError
            members.counting.append(part)
            continue
        for cell in cells:
            expression = _counted(dag, cell, kind)
            if expression is not None:
                members.counting.append(expression)
            elif isinstance(cell, int):
                members.beside.append(Operand(cell, dag.types[cell]))
    return members


def _cells(dag: Dag, node_id: int) -> list[int | Value] | None:
    """Return the cells of a range: their nodes, and the values of those that are constant. None for a single value."""
    node = dag.nodes[node_id]
    if isinstance(node, Range):
        return [_value_or_node(dag, cell) for row in node.rows for cell in row]
    if isinstance(node, Constant) and dag.sizes[node_id] is not None:
        return list(_cells_of_constant(node.value))
    if dag.sizes[node_id] is not None:
        raise _NotForTheLoopError
    return None


def _value_or_node(dag: Dag, cell: int) -> int | Value:
    node = dag.nodes[cell]
    return node.value if isinstance(node, Constant) else cell


def _cells_of_constant(value: Value) -> Iterator[Value]:
    """Return the cells of a constant range, `(1,)` each."""
    _, rows, columns = value.shape
    spread = [None if a is None else np.broadcast_to(a, value.shape) for a in value.arrays()]
    for row in range(rows):
        for column in range(columns):
            parts = [None if a is None else a[:, row, column] for a in spread]
            yield Value(parts[0], parts[1], parts[2])  # type: ignore[arg-type]  # only texts may be None


def _counted(dag: Dag, cell: int | Value, kind: Kind) -> Part | None:
    """Return a cell of a range where it counts; None if it does not."""
    if isinstance(cell, Value):
        return _counted_constant(cell, kind)
    if dag.sizes[cell] is not None or dag.types[cell] not in (Kind.NUMBER, Kind.LOGICAL):
        raise _NotForTheLoopError
    return None if kind is Kind.NUMBER and dag.types[cell] is Kind.LOGICAL else Operand(cell, kind)


def _counted_constant(cell: Value, kind: Kind) -> Literal | None:
    value, number = int(cell.kinds.flat[0]), float(cell.numbers.flat[0])
    if value in (BLANK, TEXT) or (value == LOGICAL and kind is Kind.NUMBER):
        return None
    if value not in (NUMBER, LOGICAL):
        raise _NotForTheLoopError
    return Literal(number if kind is Kind.NUMBER else number != 0)


def _count(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of `COUNT`, for ranges: a number, unless a cell is an error."""
    columns = [_cells(dag, node_id) for node_id in node.arguments]
    cells = [cell for column in columns for cell in column or ()]
    if None in columns:
        return None
    numbers = sum(_counted(dag, cell, Kind.NUMBER) is not None for cell in cells)
    varying = tuple([Operand(cell, dag.types[cell]) for cell in cells if isinstance(cell, int)])
    if len(varying) > _MOST:
        return None
    return LoopRule((Literal(float(numbers)),), first_operand, makes=False, beside=varying)


def _sum_of_products(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of `SUMPRODUCT`, for ranges of one size: a cell that is no number is 0."""
    columns, shapes = [], set()
    beside: list[Operand] = []
    for node_id in node.arguments:
        cells = _cells(dag, node_id)
        shapes.add(dag.sizes[node_id])
        if cells is None or len(shapes) > 1:
            return None
        parts: list[Part] = []
        for cell in cells:
            if isinstance(cell, Value) and int(cell.kinds.flat[0]) == TEXT and len(cells) == 1:
                return None  # the careful path knows what Excel makes of it
            expression = _counted(dag, cell, Kind.NUMBER)
            parts.append(Literal(0.0) if expression is None else expression)
            if expression is None and isinstance(cell, int):
                beside.append(Operand(cell, dag.types[cell]))
        columns.append(parts)
    height = len(columns[0])
    if height * len(columns) > _MOST:
        return None
    operands = tuple(part for column in columns for part in column)
    return LoopRule(operands, _products_added_up(height), beside=tuple(beside))


@cache
def _products_added_up(height: int) -> Emit:
    """How the loop adds up products of columns of so many cells: one for all, so that loops are alike."""

    def emit(body: Emitter, parts: Parts) -> Any:
        products = [_product(body, parts[cell::height]) for cell in range(height)]
        return reduce(body.builder.fadd, products)

    return emit


def _fold(instruction: str) -> Emit:
    def emit(body: Emitter, parts: Parts) -> Any:
        return reduce(getattr(body.builder, instruction), parts)

    return emit


_sum = _fold("fadd")


def _product(body: Emitter, parts: Parts) -> Any:
    return reduce(lambda so_far, part: body.flush(body.builder.fmul(so_far, part)), parts)


def _extreme(relation: str) -> Emit:
    def emit(body: Emitter, parts: Parts) -> Any:
        def better(best: Any, part: Any) -> Any:
            return body.builder.select(body.builder.fcmp_ordered(relation, best, part), best, part)

        return reduce(better, parts)

    return emit


def _mean(body: Emitter, parts: Parts) -> Any:
    return body.builder.fdiv(_sum(body, parts), body.number(float(len(parts))))


def _sum_of_squares(body: Emitter, parts: Parts) -> Any:
    return _sum(body, [body.builder.fmul(part, part) for part in parts])


def _variance(lost: int) -> Emit:
    """Mean squared distance from the mean, by k - `lost`."""

    def emit(body: Emitter, parts: Parts) -> Any:
        mean = _mean(body, parts)
        total = _sum_of_squares(body, [body.builder.fsub(part, mean) for part in parts])
        return body.builder.fdiv(total, body.number(float(len(parts) - lost)))

    return emit


def _deviation(lost: int) -> Emit:
    variance = _variance(lost)
    return lambda body, parts: body.intrinsic("llvm.sqrt", variance(body, parts))


@dataclass(frozen=True, slots=True)
class _Row:
    """See `LoopRule`; with fewer than `fewest` cells the result is an error, or follows another rule."""

    emit: Callable[[Emitter, Parts], Any]
    fewest: int = 1
    absorbs: Container[int] = ()
    makes: bool = True


_ROWS: Final[Mapping[str, _Row]] = {
    "SUM": _Row(_sum),
    "PRODUCT": _Row(_product),
    "MIN": _Row(_extreme("<"), absorbs=_ALL, makes=False),
    "MAX": _Row(_extreme(">"), absorbs=_ALL, makes=False),
    "AVERAGE": _Row(_mean),
    "SUMSQ": _Row(_sum_of_squares),
    "VAR.S": _Row(_variance(1), 2),
    "VAR.P": _Row(_variance(0)),
    "STDEV.S": _Row(_deviation(1), 2),
    "STDEV.P": _Row(_deviation(0)),
    "AND": _Row(_fold("and_")),
    "OR": _Row(_fold("or_")),
    "XOR": _Row(_fold("xor")),
}
