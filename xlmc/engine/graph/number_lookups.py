"""Lookups of one number in constant tables of numbers, as a position and the number there.

Lookups of one key in one column then share the search, and give what is known to be a number.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Final

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.lookup.picked_cells import map_parts, transpose_cells
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION, Pick, Search, numbers_of
from xlmc.excel.functions.values import LOGICAL, NUMBER, Value, constant

__all__ = ["NumberLookups", "key_of", "lookup_of"]

_RISING: Final = 1.0
_EQUAL: Final = 0.0

_KEPT: Final = 64
"""Tables that are kept ready to be searched."""


class NumberLookups:
    """Makes the nodes of such lookups.

    Args:
        dag: takes them.
    """

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._columns: dict[tuple[int, int, bool], int | None] = {}

    def apply(self, function: Function, arguments: Sequence[int]) -> int | None:
        """Make the node of a lookup of a number that varies in constant numbers; None of any other call."""
        form = _FORMS.get(function.name)
        return None if form is None or len(arguments) < 2 else form(self, arguments)

    def position(self, arguments: Sequence[int]) -> int | None:
        """MATCH: key, vector, and 1, 0 or -1."""
        order = _RISING if len(arguments) == 2 else _constant_number(self._dag, arguments[2])
        column = self._vector(arguments[1])
        if len(arguments) > 3 or order is None or column is None:
            return None
        return self._position(arguments[0], column, float(np.sign(order)))

    def by_line(self, arguments: Sequence[int], *, across: bool) -> int | None:
        """VLOOKUP, or HLOOKUP where `across`: key, table, column (row), and whether the key may lie between two."""
        if not 3 <= len(arguments) <= 4:
            return None
        line, near = (_constant_number(self._dag, node) for node in (*arguments[2:], arguments[2])[:2])
        if line is None or near is None or line < 1:
            return None
        order = _RISING if len(arguments) == 3 or near else _EQUAL
        first, value = (self._column(arguments[1], at, across=across) for at in (0, int(line) - 1))
        return self._look_up(arguments[0], first, value, order)

    def by_order(self, arguments: Sequence[int]) -> int | None:
        """LOOKUP: key, vector, results; or key and a table that begins with the one and ends with the other."""
        rows, columns = self._size(arguments[1])
        if len(arguments) == 3:
            return self._look_up(arguments[0], self._vector(arguments[1]), self._vector(arguments[2]), _RISING)
        across = columns > rows
        last = (rows if across else columns) - 1
        first, value = (self._column(arguments[1], at, across=across) for at in (0, last))
        return self._look_up(arguments[0], first, value, _RISING)

    def by_value(self, arguments: Sequence[int]) -> int | None:
        """XLOOKUP of three arguments: key, vector, results."""
        if len(arguments) != 3 or self._size(arguments[1]) != self._size(arguments[2]):
            return None
        return self._look_up(arguments[0], self._vector(arguments[1]), self._vector(arguments[2]), _EQUAL)

    def by_position(self, arguments: Sequence[int]) -> int | None:
        """INDEX: a vector and a position, or a table, a row and a constant column."""
        if len(arguments) == 2:
            return self._cell_at(self._vector(arguments[0]), arguments[1])
        column = _constant_number(self._dag, arguments[2])
        if len(arguments) > 3 or column is None or column < 1:
            return None
        return self._cell_at(self._column(arguments[0], int(column) - 1), arguments[1])

    def _look_up(self, key: int, column: int | None, results: int | None, order: float) -> int | None:
        """Return the result at the position of a key in a column."""
        if column is None or results is None or self._size(results) < self._size(column):
            return None
        position = self._position(key, column, order)
        return None if position is None else self._dag.add(Apply(CELL_AT, (results, position)))

    def _position(self, key: int, column: int, order: float) -> int | None:
        """Return the position of a key in a column; None if the key is no number, or the column not in order."""
        dag = self._dag
        varies = dag.types[key] is Kind.NUMBER and dag.sizes[key] is None and not isinstance(dag.nodes[key], Constant)
        cells = _constant_cells(dag, column)
        if not varies or cells is None or _search(cells, order) is None:
            return None
        return dag.add(Apply(POSITION, (key, column, dag.constant(constant(order)))))

    def _cell_at(self, column: int | None, position: int) -> int | None:
        """Return the number of a column at the position of a lookup in no more numbers.

        That the position's node decides, and not its type alone, is safe: an INDEX is lowered in each cell anew.
        """
        node = self._dag.nodes[position]
        if column is None or type(node) is not Apply or node.function.name != POSITION.name:
            return None
        if self._size(node.arguments[1]) > self._size(column):
            return None
        return self._dag.add(Apply(CELL_AT, (column, position)))

    def _vector(self, table: int) -> int | None:
        """Turn a row or a column of numbers into a column."""
        rows, columns = self._size(table)
        return self._column(table, 0, across=rows == 1) if 1 in (rows, columns) else None

    def _column(self, table: int, at: int, *, across: bool = False) -> int | None:
        """Return a column of a constant table, or its row if `across`, as a column; None if not all cells are
        numbers.
        """
        if (table, at, across) not in self._columns:
            self._columns[table, at, across] = self._make_column(table, at, across=across)
        return self._columns[table, at, across]

    def _make_column(self, table: int, at: int, *, across: bool) -> int | None:
        cells = _constant_cells(self._dag, table)
        if cells is None:
            return None
        cells = transpose_cells(cells) if across else cells
        if not 0 <= at < cells.shape[2]:
            return None
        column = map_parts(cells, lambda part: part[:, :, at, None].copy())
        return None if numbers_of(column) is None else self._dag.constant(column)

    def _size(self, table: int) -> tuple[int, int]:
        """Rows and columns; none of what is no such range."""
        cells = _constant_cells(self._dag, table)
        return (0, 0) if cells is None else (cells.shape[1], cells.shape[2])


_FORMS: Final[Mapping[str, Callable[[NumberLookups, Sequence[int]], int | None]]] = {
    "MATCH": NumberLookups.position,
    "VLOOKUP": lambda lookups, arguments: lookups.by_line(arguments, across=False),
    "HLOOKUP": lambda lookups, arguments: lookups.by_line(arguments, across=True),
    "LOOKUP": NumberLookups.by_order,
    "XLOOKUP": NumberLookups.by_value,
    "INDEX": NumberLookups.by_position,
}


def lookup_of(dag: Dag, node: Apply) -> Search | Pick | None:
    """Return what computes a search or a pick of plain numbers; None of any other node."""
    if node.function.name == CELL_AT.name:
        cells = _constant_cells(dag, node.arguments[0])
        return None if cells is None else _pick(cells)
    if node.function.name == POSITION.name:
        cells, order = _constant_cells(dag, node.arguments[1]), _constant_number(dag, node.arguments[2])
        return None if cells is None or order is None else _search(cells, order)
    return None


def key_of(node: Apply) -> int:
    """Return the key of a search, or the position of a pick: the argument that varies."""
    return node.arguments[0 if node.function.name == POSITION.name else 1]


@lru_cache(_KEPT)
def _pick(cells: Value) -> Pick | None:
    numbers = numbers_of(cells)
    return None if numbers is None else Pick.of(numbers)


@lru_cache(_KEPT)
def _search(cells: Value, order: float) -> Search | None:
    numbers = numbers_of(cells)
    return None if numbers is None else Search.of(numbers, order)


def _constant_cells(dag: Dag, node_id: int) -> Value | None:
    """Return the cells of a range that does not vary."""
    node = dag.nodes[node_id]
    return node.value if isinstance(node, Constant) and node.value.numbers.ndim == 3 else None


def _constant_number(dag: Dag, node_id: int) -> float | None:
    node = dag.nodes[node_id]
    if not isinstance(node, Constant) or dag.sizes[node_id] is not None:
        return None
    return float(node.value.numbers[0]) if int(node.value.kinds[0]) in (NUMBER, LOGICAL) else None
