"""Slow functions of a number of a constant table: they have as many values as the table has rows.

`SIN(ATAN(VLOOKUP(x, table, 2) / 100))` is a chain of functions, each of which takes what the one before it gives and
constants, and the first of which takes the cell that the lookup finds. An engine may compute it once for every row.
"""

from __future__ import annotations

from collections.abc import Container
from typing import Final, NamedTuple

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant
from xlmc.engine.graph.number_lookups import key_of, lookup_of
from xlmc.excel.functions import Kind
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.lookup.search_and_pick import Pick
from xlmc.excel.functions.values import Floats

__all__ = ["TableFunction", "table_function_of"]

_QUICK: Final = (np.add, np.subtract, np.multiply, np.divide, np.negative, np.absolute, np.sqrt)
"""These take no longer than a pick."""

_LONGEST: Final = 8
"""Functions of functions up to which a number of a table is looked for."""

_MOST_ROWS: Final = 4_096


class TableFunction(NamedTuple):
    """A chain of functions of a number of a table.

    Attributes:
        cell: the node of the cell that the lookup finds.
        position: the node of its position, counted from 1.
        numbers: `(rows,)` the column of the table.
        links: the nodes of the functions, the first one first.
        key: equal for chains that give the same in every row.
    """

    cell: int
    position: int
    numbers: Floats
    links: tuple[int, ...]
    key: tuple[object, ...]


def table_function_of(dag: Dag, node: int, last_only: Container[str] = ()) -> TableFunction | None:
    """Return the chain that ends with a node; None without a chain, or if its last function is not slow.

    Args:
        dag: of the node.
        node: any.
        last_only: the functions that no other one of a chain takes.
    """
    at = node
    links: list[int] = []
    while len(links) < _LONGEST:
        of = dag.nodes[at]
        if type(of) is not Apply:
            return None
        if links and isinstance(result := lookup_of(dag, of), Pick):
            return _chain(dag, at, of, result, links[::-1])
        if of.function.name in last_only if links else of.function.ufunc in _QUICK:
            return None
        further = _varying_argument(dag, at, of)
        if further is None:
            return None
        links.append(at)
        at = further
    return None


def _chain(dag: Dag, cell: int, node: Apply, column: Pick, links: list[int]) -> TableFunction | None:
    numbers = column.numbers[1:]
    if numbers.size > _MOST_ROWS:
        return None
    key = node.arguments[0], tuple(_form(dag, link) for link in links)
    return TableFunction(cell, key_of(node), numbers, tuple(links), key)


def _varying_argument(dag: Dag, at: int, node: Apply) -> int | None:
    """Return what varies of the arguments of a function of plain numbers; None of other nodes, or where there are
    several.
    """
    function, arguments = node
    if function.fast_arity != len(arguments) or function.name == SNAP_TO_ZERO.name or at in dag.folded:
        return None
    if any(dag.types[each] is not Kind.NUMBER or dag.sizes[each] is not None for each in (at, *arguments)):
        return None
    varying = {argument for argument in arguments if type(dag.nodes[argument]) is not Constant}
    return varying.pop() if len(varying) == 1 else None


def _form(dag: Dag, link: int) -> object:
    """Return what is the same for functions that differ in their varying argument alone."""
    node = dag.nodes[link]
    assert type(node) is Apply
    return node.function, tuple(a if type(dag.nodes[a]) is Constant else None for a in node.arguments)
