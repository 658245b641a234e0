"""Functions of a number of a constant table, looked up instead of computed (see `graph.table_functions`).

`SIN(VLOOKUP(x, table, 2))` is computed once for every row of the table, as in a block, and so to the last bit; each
trial then picks its value at the position that was found. Where any row gives an error, or a number that is too small
for Excel, the function is computed in every trial, as all others are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from xlmc.engine.cache_lines import aligned_array
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant
from xlmc.engine.graph.table_functions import TableFunction, table_function_of
from xlmc.engine.numpy.sine_pairs import COSINE, SINE, sines_with_cosines
from xlmc.engine.numpy.steps import plain_constant
from xlmc.excel.functions.lookup.search_and_pick import Pick
from xlmc.excel.functions.math.trigonometry import sine_and_cosine
from xlmc.excel.functions.values import Floats

__all__ = ["LookedUp", "find_looked_up"]

_TOGETHER: Final = 2_048
"""Numbers are computed in multiples of so many, as in blocks: NumPy may treat the last few of an array differently."""


class LookedUp(NamedTuple):
    """A node's value is what `pick` gives of the value of the node `position`."""

    pick: Pick
    position: int


def find_looked_up(dag: Dag, sets: Sequence[Sequence[int]]) -> dict[int, LookedUp]:
    """Return the nodes that are to be looked up.

    Args:
        dag: of the nodes.
        sets: nodes that are computed on the same trials.
    """
    result: dict[int, LookedUp] = {}
    known: dict[object, Pick | None] = {}
    for nodes in sets:
        # Whether a sine is one of a pair decides its last bit: no other function is looked up through it.
        chains = {node: chain for node in nodes if (chain := table_function_of(dag, node, (SINE, COSINE))) is not None}
        pairs = sines_with_cosines(dag, nodes) if chains else {}
        for node, chain in chains.items():
            key = chain.key, node in pairs
            if key not in known:
                known[key] = _table(dag, chain, paired=node in pairs)
            pick = known[key]
            if pick is not None:
                result[node] = LookedUp(pick, chain.position)
    return result


def _table(dag: Dag, chain: TableFunction, *, paired: bool) -> Pick | None:
    """Compute the last of the functions at every row of the table; None if a row gives no number."""
    values: dict[int, Any] = {chain.cell: _filled(chain.numbers)}
    last = chain.links[-1]
    try:
        with np.errstate(all="raise"):
            for link, function, parts in _calls(dag, chain.links):
                arguments = [values[part] if part in values else _number(dag, part) for part in parts]
                if function.guard is not None and not function.guard(*arguments):
                    return None
                values[link] = aligned_array(values[chain.cell].size, np.dtype(np.float64))
                if paired and link == last:
                    _fill_pair(function.name, arguments[0], values[link])
                else:
                    function.ufunc(*arguments, out=values[link])
    except FloatingPointError:
        return None
    return Pick.of(values[last][: chain.numbers.size])


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
    """Repeat the numbers as often as makes a block that is computed together."""
    filled = aligned_array(-(-numbers.size // _TOGETHER) * _TOGETHER, np.dtype(np.float64))
    filled[:] = np.resize(numbers, filled.size)
    return filled


def _fill_pair(name: str, angle: Floats, out: Floats) -> None:
    """Compute the sine or the cosine of an angle of which both are wanted."""
    other, work = np.empty_like(out), np.empty_like(out)
    sine, cosine = (out, other) if name == SINE else (other, out)
    sine_and_cosine(angle, sine, cosine, work)
