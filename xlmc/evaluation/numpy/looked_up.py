"""Functions of a number of a constant table, looked up instead of computed: they have as many values as it has rows.

`SIN(VLOOKUP(x, table, 2))` is computed once for every row of the table, as in a block, and so to the last bit; each
trial then picks its value at the position that was found. Where any row gives an error, or a number that is too small
for Excel, the function is computed in every trial, as all others are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Apply, Constant
from xlmc.evaluation.graph.number_lookups import key_of, lookup_of
from xlmc.evaluation.numpy.steps import plain_constant
from xlmc.functions import Kind
from xlmc.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.functions.lookup.search_and_pick import Pick
from xlmc.functions.math.trigonometry import sine_and_cosine
from xlmc.functions.values import Floats

__all__ = ["LookedUp", "aligned_array", "find_looked_up", "sines_with_cosines"]

_QUICK: Final = (np.add, np.subtract, np.multiply, np.divide, np.negative, np.absolute, np.sqrt)
"""These take no longer than a pick."""

_SINE: Final = "SIN"
_COSINE: Final = "COS"

_LONGEST: Final = 8
"""Functions of functions up to which a number of a table is looked for."""

_MOST_ROWS: Final = 4_096
_TOGETHER: Final = 2_048
"""Numbers are computed in multiples of so many, as in blocks: NumPy may treat the last few of an array differently."""

_CACHE_LINE: Final = 64
"""Bytes of a line of the processor's caches."""


class LookedUp(NamedTuple):
    """A node's value is what `pick` gives of the value of the node `position`."""

    pick: Pick
    position: int


def aligned_array(size: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """An array that begins with a line of the cache."""
    raw = np.empty(size * dtype.itemsize + _CACHE_LINE, np.uint8)
    start = -raw.ctypes.data % _CACHE_LINE
    return raw[start : start + size * dtype.itemsize].view(dtype)


def sines_with_cosines(dag: Dag, nodes: Sequence[int]) -> dict[int, tuple[int, int]]:
    """The sines and cosines of angles of which both are wanted: node_id -> (sine, cosine)."""
    found: dict[str, dict[int, int]] = {_SINE: {}, _COSINE: {}}
    for node_id in nodes:
        node = dag.nodes[node_id]
        if type(node) is Apply and node.function.name in found and dag.types[node.arguments[0]] is Kind.NUMBER:
            found[node.function.name][node.arguments[0]] = node_id
    both = [(found[_SINE][angle], found[_COSINE][angle]) for angle in found[_SINE].keys() & found[_COSINE].keys()]
    return {node_id: pair for pair in both for node_id in pair}


def find_looked_up(dag: Dag, sets: Sequence[Sequence[int]]) -> dict[int, LookedUp]:
    """The nodes that are to be looked up.

    Args:
        dag: of the nodes.
        sets: nodes that are computed on the same trials.
    """
    found: dict[int, LookedUp] = {}
    known: dict[object, Pick | None] = {}
    for nodes in sets:
        chains = {node: chain for node in nodes if (chain := _chain(dag, node)) is not None}
        pairs = sines_with_cosines(dag, nodes) if chains else {}
        for node, (cell, links) in chains.items():
            of_cell = dag.nodes[cell]
            assert type(of_cell) is Apply
            key = of_cell.arguments[0], tuple(_form(dag, link) for link in links), node in pairs
            if key not in known:
                known[key] = _table(dag, cell, links, paired=node in pairs)
            pick = known[key]
            if pick is not None:
                found[node] = LookedUp(pick, key_of(of_cell))
    return found


def _chain(dag: Dag, node: int) -> tuple[int, list[int]] | None:
    """The cell of a table that a node is a slow function of, and the functions, the first one first; else None."""
    at, links = node, list[int]()
    while len(links) < _LONGEST:
        of = dag.nodes[at]
        if type(of) is not Apply:
            return None
        if links and isinstance(lookup_of(dag, of), Pick):
            return at, links[::-1]
        # Whether a sine is one of a pair decides its last bit: no other function is looked up through it.
        if of.function.name in (_SINE, _COSINE) if links else of.function.ufunc in _QUICK:
            return None
        further = _varying_argument(dag, at, of)
        if further is None:
            return None
        links.append(at)
        at = further
    return None


def _varying_argument(dag: Dag, at: int, node: Apply) -> int | None:
    """What varies of the arguments of a function of plain numbers; None of other nodes, or where there are several."""
    function, arguments = node
    if function.fast_arity != len(arguments) or function.name == SNAP_TO_ZERO.name or at in dag.folded:
        return None
    if any(dag.types[each] is not Kind.NUMBER or dag.sizes[each] is not None for each in (at, *arguments)):
        return None
    varying = {argument for argument in arguments if type(dag.nodes[argument]) is not Constant}
    return varying.pop() if len(varying) == 1 else None


def _form(dag: Dag, link: int) -> object:
    """What is the same for functions that differ in their varying argument alone."""
    node = dag.nodes[link]
    assert type(node) is Apply
    return node.function, tuple(a if type(dag.nodes[a]) is Constant else None for a in node.arguments)


def _table(dag: Dag, cell: int, links: Sequence[int], *, paired: bool) -> Pick | None:
    """The last of the functions at every row of the table; None where it is too long, or a row gives no number."""
    of_cell = dag.nodes[cell]
    assert type(of_cell) is Apply
    column = lookup_of(dag, of_cell)
    assert isinstance(column, Pick)
    numbers = column.numbers[1:]
    if numbers.size > _MOST_ROWS:
        return None
    values: dict[int, Any] = {cell: _filled(numbers)}
    try:
        with np.errstate(all="raise"):
            for link, function, parts in _calls(dag, links):
                arguments = [values[part] if part in values else _number(dag, part) for part in parts]
                if function.guard is not None and not function.guard(*arguments):
                    return None
                values[link] = aligned_array(values[cell].size, np.dtype(np.float64))
                if paired and link == links[-1]:
                    _fill_pair(function.name, arguments[0], values[link])
                else:
                    function.ufunc(*arguments, out=values[link])
    except FloatingPointError:
        return None
    return Pick.of(values[links[-1]][: numbers.size])


def _calls(dag: Dag, links: Sequence[int]) -> Iterator[tuple[int, Any, tuple[int, ...]]]:
    for link in links:
        node = dag.nodes[link]
        assert type(node) is Apply
        yield link, node.function, node.arguments


def _number(dag: Dag, node_id: int) -> Any:
    node = dag.nodes[node_id]
    assert type(node) is Constant
    return plain_constant(node.value)


def _filled(numbers: Floats) -> Floats:
    """The numbers again and again, as many as are computed together."""
    filled = aligned_array(-(-numbers.size // _TOGETHER) * _TOGETHER, np.dtype(np.float64))
    filled[:] = np.resize(numbers, filled.size)
    return filled


def _fill_pair(name: str, angle: Floats, out: Floats) -> None:
    """The sine or the cosine of an angle of which both are wanted."""
    other, work = np.empty_like(out), np.empty_like(out)
    sine, cosine = (out, other) if name == _SINE else (other, out)
    sine_and_cosine(angle, sine, cosine, work)
