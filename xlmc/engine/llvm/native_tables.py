"""Functions of a number of a constant table, looked up instead of computed (see `graph.table_functions`).

A loop computes the function once for every row of the table, when the program is made, by the very instructions that
would compute it in every trial: so what a trial picks has the same bits. Where a row is marked, as in a trial that must
be computed again, the function is computed in every trial.
"""

from __future__ import annotations

import ctypes
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.table_functions import TableFunction, table_function_of
from xlmc.engine.llvm.lookups import emit_lookup, rule_of_lookup
from xlmc.engine.llvm.loop import Load, compile_loop
from xlmc.engine.llvm.loop_rules import Emit, LoopRule, Operand
from xlmc.engine.llvm.machine import Machine, NativeLoop
from xlmc.engine.llvm.shapes import Forms
from xlmc.engine.llvm.stages import LoopPlan
from xlmc.excel.functions import Kind
from xlmc.excel.functions.lookup.search_and_pick import Pick
from xlmc.excel.functions.values import Floats

__all__ = ["rules_of_looked_up"]

_MOST_ALIKE: Final = 8
"""Tables of functions that are alike but for constants: a table is part of the code of a loop, and so the loops of
rows that each had one of their own would no longer share their code."""


def rules_of_looked_up(
    dag: Dag, nodes: Iterable[int], rules: Mapping[int, LoopRule], machine: Machine
) -> dict[int, LoopRule]:
    """Find the nodes that are to be looked up, each with its new rule.

    Args:
        dag: of the nodes.
        nodes: that are computed.
        rules: of those that loops can compute.
        machine: computes the rows.
    """
    chains = {node: chain for node in nodes if (chain := table_function_of(dag, node)) is not None}
    chains = {node: chain for node, chain in chains.items() if rules.keys() >= {chain.position, *chain.links}}
    alike: defaultdict[object, set[object]] = defaultdict(set)
    for chain in chains.values():
        alike[_functions(chain, rules)].add(chain.key)
    forms, compiled = Forms(rules, dag.types), dict[object, NativeLoop]()
    known: dict[object, Emit | None] = {}
    result: dict[int, LoopRule] = {}
    for node, chain in chains.items():
        if len(alike[_functions(chain, rules)]) > _MOST_ALIKE:
            continue
        if chain.key not in known:
            values = _at_every_row(dag, chain, rules, machine, forms, compiled)
            known[chain.key] = None if values is None else emit_lookup(Pick.of(values))
        emit = known[chain.key]
        if emit is not None:
            result[node] = rule_of_lookup(chain.position, emit)
    return result


def _functions(chain: TableFunction, rules: Mapping[int, LoopRule]) -> object:
    return tuple(rules[link].emit for link in chain.links)


def _at_every_row(
    dag: Dag,
    chain: TableFunction,
    rules: Mapping[int, LoopRule],
    machine: Machine,
    forms: Forms,
    compiled: dict[object, NativeLoop],
) -> Floats | None:
    """Compute the last of the functions at every row of the table, `(rows,)`; None if a row is marked.

    Loops that were compiled before are used again where they differ in constants alone.
    """
    load = Load(Operand(chain.cell, Kind.NUMBER), Kind.NUMBER, picked=False, fallible=True)
    plan = LoopPlan({link: rules[link] for link in chain.links}, (load,), chain.links[-1:], forms.of(chain.links))
    if plan.shape not in compiled:
        compiled[plan.shape] = compile_loop(dag, machine, plan.rules, plan.loads, plan.stores, plan.slots, 1)
    rows = chain.numbers.size
    numbers, values = np.ascontiguousarray(chain.numbers), np.empty(rows)
    survivors, marks, constants = np.empty(0, np.int64), np.zeros(rows, np.uint8), plan.numbers
    addresses = [array.ctypes.data for array in (numbers, values, survivors, marks, constants)]
    marked = compiled[plan.shape]((ctypes.c_void_p * len(addresses))(*addresses), rows)
    return None if marked else values
