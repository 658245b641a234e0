"""Ranges of which a function reads only some cells: those beside cells that meet criteria, or beside a key.

In a circle of cells it matters which: a table of subtotals adds up rows of its own column, and a plan looks up when the
steps before end, in its own table. Where all that decides is known before the run, the other cells are not asked for.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Final, Protocol

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.node_values import evaluate_node
from xlmc.engine.graph.nodes import Apply, Constant, Range
from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.excel.functions import Function
from xlmc.excel.functions.values import ERROR, NUMBER, Value, constant

__all__ = ["PICKING", "range_as_read"]

PICKING: Final[Mapping[str, int]] = {
    **dict.fromkeys(("SUMIFS", "AVERAGEIFS", "MAXIFS", "MINIFS"), 0),
    **dict.fromkeys(("SUMIF", "AVERAGEIF", "LOOKUP", "XLOOKUP"), 2),
    **dict.fromkeys(("VLOOKUP", "HLOOKUP"), 1),
}
"""Functions that read of one argument only the cells which the others say."""


class Reads(Protocol):
    """What reads the cells of a graph, as far as `range_as_read` asks it to."""

    dag: Dag

    def not_there(self, area: Area) -> Collection[Cell]:
        """Return the cells of an area that are in a circle and have no value yet."""

    def read_first(self, cells: Collection[Cell]) -> None:
        """Ask for all cells that must be lowered first."""

    def range(self, area: Area) -> int:
        """Return the node of all cells of an area."""

    def cell(self, cell: Cell) -> int:
        """Return the node of a cell's value."""


def range_as_read(
    lowering: Reads, function: Function, picked: int, area: Area, given: Mapping[int, Sequence[int]]
) -> int | None:
    """Return the node of a range with the cells that a function reads, and those that are there; the others are empty.

    Args:
        lowering: of the workbook.
        function: one of `PICKING`.
        picked: the position of the range.
        area: the range.
        given: the nodes of all other arguments.

    Returns:
        The node; None if it is not known before the run which cells are read.
    """
    waiting = lowering.not_there(area)
    others = {position: _known(lowering.dag, nodes) for position, nodes in given.items()}
    cells = _searched_cells(lowering, function.name, area, waiting)
    if not waiting or cells is None or any(value is None for value in others.values()):
        return None
    everything = list(area.cells())
    asked = [index for index, cell in enumerate(everything) if cell in waiting]
    values = {position: value for position, value in others.items() if value is not None}
    unread = {everything[index] for index in set(asked).difference(_find_read(function, picked, values, cells, asked))}
    lowering.read_first([cell for cell in everything if cell not in unread])
    empty = lowering.dag.constant(constant(None))
    nodes = [empty if cell in unread else lowering.cell(cell) for cell in everything]
    rows = range(0, len(nodes), area.columns)
    return lowering.dag.add(Range(tuple(tuple(nodes[start : start + area.columns]) for start in rows)))


def _known(dag: Dag, nodes: Sequence[int]) -> Value | None:
    """Return the value of an argument that does not vary."""
    node = dag.nodes[nodes[0]]
    return node.value if len(nodes) == 1 and isinstance(node, Constant) and nodes[0] not in dag.missing else None


def _searched_cells(lowering: Reads, name: str, area: Area, waiting: Collection[Cell]) -> Value | None:
    """(1, r, c): zeros, but for the column (or row) of a table that is searched; None if that varies."""
    shape = (1, area.rows, area.columns)
    cells = Value(np.zeros(shape), np.full(shape, NUMBER, np.uint8))
    if name not in ("VLOOKUP", "HLOOKUP"):
        return cells
    across = name == "HLOOKUP"
    part = replace(area, bottom=area.top) if across else replace(area, right=area.left)
    searched = None if any(cell in part for cell in waiting) else _known(lowering.dag, [lowering.range(part)])
    if searched is None:
        return None
    beside = ((0, 0), (0, area.rows - 1), (0, 0)) if across else ((0, 0), (0, 0), (0, area.columns - 1))
    return Value(
        np.pad(searched.numbers, beside),
        np.pad(np.broadcast_to(searched.kinds, searched.shape), beside, constant_values=NUMBER),
        None if searched.texts is None else np.pad(searched.texts, beside, constant_values=""),
    )


_READ: Final = ERROR + ErrorCode.CALC


def _find_read(
    function: Function, picked: int, given: Mapping[int, Value], cells: Value, asked: Sequence[int]
) -> list[int]:
    """Find which cells of an argument a function reads: an error in such a cell is an error of the result."""
    results: list[int] = []
    groups = [list(asked)]
    node = Apply(function, tuple(range(len(given) + 1)))
    while groups:
        result = evaluate_node(node, {**given, picked: _with_errors(cells, groups)})
        shown = (result.kinds == _READ).reshape(len(result.kinds), -1).any(axis=1)
        read = np.broadcast_to(shown, len(groups))
        hit = [group for group, is_read in zip(groups, read.tolist(), strict=True) if is_read]
        results += [group[0] for group in hit if len(group) == 1]
        halves = [(group[: len(group) // 2], group[len(group) // 2 :]) for group in hit if len(group) > 1]
        groups = [half for pair in halves for half in pair]
    return results


def _with_errors(cells: Value, groups: Sequence[Sequence[int]]) -> Value:
    """(n, r, c): the cells once for each group, with an error in each cell of the group."""
    shape = (len(groups), *cells.shape[1:])
    kinds = np.broadcast_to(cells.kinds, shape).copy()
    for row, group in zip(kinds.reshape(len(groups), -1), groups, strict=True):
        row[group] = _READ
    texts = None if cells.texts is None else np.broadcast_to(cells.texts, shape)
    return Value(np.broadcast_to(cells.numbers, shape), kinds, texts)
