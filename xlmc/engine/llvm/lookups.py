"""Lookups in constant numbers as instructions: a search and a pick (see `functions.lookup.search_and_pick`).

The numbers stand in the module. A trial whose key has no position is computed again; until then it reads a number at an
end, never beyond one.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Final

from llvmlite import ir

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply
from xlmc.engine.graph.number_lookups import key_of, lookup_of
from xlmc.engine.llvm.constant_column import ConstantColumn
from xlmc.engine.llvm.loop_rules import Emit, Emitter, LoopRule, Operand
from xlmc.excel.functions import Kind
from xlmc.excel.functions.lookup.search_and_pick import Pick, Search

__all__ = ["emit_lookup", "lookup_rule", "rule_of_lookup"]

_MOST: Final = 4096
"""The most numbers that a module holds; longer columns are searched outside of the loop."""

_KEPT: Final = 64

_INDEX: Final = ir.IntType(32)


def lookup_rule(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of a lookup in constant numbers; None of any other node."""
    lookup = lookup_of(dag, node)
    if lookup is None:
        return None
    numbers = lookup.rising if isinstance(lookup, Search) else lookup.numbers
    if numbers.size > _MOST:
        return None
    return rule_of_lookup(key_of(node), emit_lookup(lookup))


def rule_of_lookup(key: int, emit: Emit) -> LoopRule:
    """Return the rule of a search for the value of a node, or of a pick at the position that it gives."""
    return LoopRule((Operand(key, Kind.NUMBER),), emit, absorbs=(0,), makes=False)


@lru_cache(_KEPT)
def emit_lookup(lookup: Search | Pick) -> Emit:
    """How the loop searches, or picks."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        if isinstance(lookup, Search):
            return _search(body, lookup, parts[0])
        return ConstantColumn(body, lookup.numbers).at(body.builder.fptosi(parts[0], _INDEX))

    return emit


def _search(body: Emitter, search: Search, key: Any) -> Any:
    """Emit the position of a key, counted from 1; the trial is computed again where it has none."""
    builder = body.builder
    key = key if search.sign > 0 else builder.fneg(key)
    if search.step:
        value = _by_division(body, search, key)
    else:
        value = _by_halves(body, search, key, "<" if search.positions is not None else "<=")
    if search.positions is None:
        body.flag(builder.fcmp_unordered("<", key, body.number(float(search.rising[0]))))
        return builder.sitofp(value, body.real)
    body.flag(builder.fcmp_unordered("!=", key, ConstantColumn(body, search.rising).at(value)))
    return ConstantColumn(body, search.positions.astype(float)).at(value)


def _by_division(body: Emitter, search: Search, key: Any) -> Any:
    """How many numbers are not above the key: by its distance from the first, corrected by one where that may miss."""
    builder, rising = body.builder, ConstantColumn(body, search.rising)
    first, last = float(search.rising[0]), float(search.rising[-2])
    inside = body.intrinsic("llvm.minnum", body.intrinsic("llvm.maxnum", key, body.number(first)), body.number(last))
    if search.divides:
        whole = builder.fptosi(builder.fdiv(builder.fsub(inside, body.number(first)), body.number(search.step)), _INDEX)
        return builder.add(whole, _INDEX(1))
    steps = builder.fmul(builder.fsub(inside, body.number(first)), body.number(1.0 / search.step))
    guess = builder.fptosi(steps, _INDEX)
    below = builder.zext(builder.fcmp_ordered("<", inside, rising.at(guess)), _INDEX)
    value = builder.add(builder.sub(guess, below), _INDEX(1))
    beyond = builder.zext(builder.fcmp_ordered(">=", inside, rising.at(value)), _INDEX)
    return builder.add(value, beyond)


def _by_halves(body: Emitter, search: Search, key: Any, relation: str) -> Any:
    """How many numbers stand in that relation to the key, which those at the front do."""
    builder, size = body.builder, search.rising.size - 1
    rising = ConstantColumn(body, search.rising)
    value, half = _INDEX(0), 1 << (size.bit_length() - 1)
    while half:
        reach = builder.add(value, _INDEX(half))
        inside = builder.icmp_signed("<=", reach, _INDEX(size))
        index = builder.select(inside, builder.sub(reach, _INDEX(1)), _INDEX(size))
        holds = builder.fcmp_ordered(relation, rising.at(index), key)
        value = builder.select(holds, reach, value)
        half //= 2
    return value
