"""A loop over trials: nodes computed one after another for each trial, from arrays and into arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from llvmlite import ir

from xlmc.engine.cache_lines import CACHE_LINE
from xlmc.engine.graph.graph import Dag
from xlmc.engine.llvm.body import Body, Loaded, contexts
from xlmc.engine.llvm.loop_rules import LoopRule, Operand
from xlmc.engine.llvm.machine import Machine, NativeLoop, while_flushing
from xlmc.excel.functions import Kind

__all__ = ["SIDE_BY_SIDE", "Load", "compile_loop", "loop_over_trials", "write_entry"]

_NAME: Final = "over_trials"
SIDE_BY_SIDE: Final = 2
"""Vectors of trials that are computed at once. Cells follow from each other, and so the processor waits for one result
after another; a second vector gives it something to do meanwhile. It doubles the time to compile."""

_BYTE, _BIT, _LONG = ir.IntType(8), ir.IntType(1), ir.IntType(64)
_DOUBLE = ir.DoubleType()


class Load(NamedTuple):
    """An array that a loop reads.

    Attributes:
        operand: the node, and the kind it is read as.
        stored: the kind of the array: doubles or truth values.
        picked: whether trial i of the loop is trial `survivors[i]` of the array.
        fallible: whether its numbers may be infinite or NaN.
    """

    operand: Operand
    stored: Kind
    picked: bool
    fallible: bool


def compile_loop(
    dag: Dag,
    machine: Machine,
    rules: Mapping[int, LoopRule],
    loads: Sequence[Load],
    stores: Sequence[int],
    numbers: Mapping[tuple[int, int], int],
    side_by_side: int = SIDE_BY_SIDE,
) -> NativeLoop:
    """Compile the loop that computes the nodes of `rules` to native code.

    It takes the addresses of: the loads, the stores, the survivors (int64; not read where no load is picked), one byte
    a trial, which it sets to 1 where the trial must be computed again, and the constants that are not part of the code:
    `numbers` gives their indices by node and position of the operand. So many vectors of trials are computed at once,
    or with 0 one trial after another, which gives the same numbers, takes a third of the time to compile, and runs at
    an eighth to a half of the speed.
    """
    module = ir.Module()
    inner = _inner(dag, module, machine, rules, loads, stores, numbers, side_by_side)
    write_entry(module, inner, machine)
    return machine.native(module, _NAME)


def _pointer_type(kind: Kind) -> ir.Type:
    return (_DOUBLE if kind is Kind.NUMBER else _BYTE).as_pointer()


def _inner(
    dag: Dag,
    module: ir.Module,
    machine: Machine,
    rules: Mapping[int, LoopRule],
    loads: Sequence[Load],
    stores: Sequence[int],
    numbers: Mapping[tuple[int, int], int],
    side_by_side: int,
) -> ir.Function:
    """Write the loop itself; its arrays do not overlap, so that it can run several trials at once."""
    arrays = [*(load.stored for load in loads), *(dag.types[node] for node in stores)]
    types = [*map(_pointer_type, arrays), _LONG.as_pointer(), _BYTE.as_pointer(), _DOUBLE.as_pointer(), _LONG]
    function = _loop_function(module, types)
    *pointers, survivors, wrongs, constants, n = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    constants_in = {of: builder.load(builder.gep(constants, [_LONG(at)])) for of, at in numbers.items()}
    before, body_block, after = builder.block, *(function.append_basic_block(name) for name in ("body", "after"))
    builder.cbranch(builder.icmp_signed("<", _LONG(0), n), body_block, after)

    builder.position_at_end(body_block)
    i, count = builder.phi(_LONG), builder.phi(_LONG)
    picked = builder.load(builder.gep(survivors, [i])) if any(load.picked for load in loads) else i
    loaded = {
        load.operand: Loaded(_load(builder, pointer, picked if load.picked else i), load.fallible)
        for load, pointer in zip(loads, pointers, strict=False)
    }
    body = Body(dag, builder, loaded, contexts(dag, rules, stores), machine, constants_in)
    for node, rule in rules.items():
        body.compute(node, rule)
    for node, pointer in zip(stores, pointers[len(loads) :], strict=True):
        result = body.result(node)
        stored = builder.zext(result, _BYTE) if result.type == _BIT else result
        builder.store(stored, builder.gep(pointer, [i]))
    wrong = body.wrong()
    counted = count
    if wrong is not None:
        flag = builder.gep(wrongs, [i])
        builder.store(builder.or_(builder.load(flag), builder.zext(wrong, _BYTE)), flag)
        counted = builder.add(count, builder.zext(wrong, _LONG))
    following = builder.add(i, _LONG(1), flags=["nuw", "nsw"])
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, body_block)
    count.add_incoming(_LONG(0), before)
    count.add_incoming(counted, body_block)
    again = builder.cbranch(builder.icmp_signed("<", following, n), body_block, after)
    again.set_metadata("llvm.loop", _interleaved(module, side_by_side))

    builder.position_at_end(after)
    total = builder.phi(_LONG)
    total.add_incoming(_LONG(0), before)
    total.add_incoming(counted, body_block)
    builder.ret(total)
    return function


def loop_over_trials(
    module: ir.Module, arrays: Sequence[Kind], trial: Callable[[ir.IRBuilder, Sequence[Any], Any], None]
) -> ir.Function:
    """Write a loop over trials that calls nothing, of arrays that do not overlap; it always gives 0.

    Args:
        module: it is written to.
        arrays: doubles or truth values.
        trial: emits the computation of one trial, from the arrays' pointers and its number.
    """
    types = [*map(_pointer_type, arrays), _LONG]
    function = _loop_function(module, types)
    *pointers, n = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    before, body, after = builder.block, *(function.append_basic_block(name) for name in ("body", "after"))
    builder.cbranch(builder.icmp_signed("<", _LONG(0), n), body, after)
    builder.position_at_end(body)
    i = builder.phi(_LONG)
    trial(builder, pointers, i)
    following = builder.add(i, _LONG(1), flags=["nuw", "nsw"])
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, body)
    again = builder.cbranch(builder.icmp_signed("<", following, n), body, after)
    again.set_metadata("llvm.loop", _interleaved(module, 1))
    builder.position_at_end(after)
    builder.ret(_LONG(0))
    return function


def _loop_function(module: ir.Module, types: Sequence[ir.Type]) -> ir.Function:
    """Begin the function of a loop; all of its arguments but the last are arrays that do not overlap."""
    function = ir.Function(module, ir.FunctionType(_LONG, types), "loop")
    function.linkage = "internal"
    function.attributes.add("noinline")  # in its caller, each access would list all the arrays that it does not overlap
    function.attributes.alignstack = CACHE_LINE  # else LLVM lets vectors on the stack lie in two lines
    for argument in function.args[:-1]:
        argument.add_attribute("noalias")
    return function


def _interleaved(module: ir.Module, side_by_side: int) -> Any:
    """Ask LLVM to compute so many vectors of trials side by side; with 0, one trial after another."""
    name, asked = ("interleave.count", ir.IntType(32)(side_by_side)) if side_by_side else ("vectorize.enable", _BIT(0))
    value = module.add_metadata([module.add_metadata([ir.MetaDataString(module, f"llvm.loop.{name}"), asked])])
    value.operands = (value, *value.operands)  # LLVM wants the first to be itself, so that no two loops share one
    return value


def _load(builder: ir.IRBuilder, pointer: Any, i: Any) -> Any:
    value = builder.load(builder.gep(pointer, [i]))
    return builder.icmp_unsigned("!=", value, _BYTE(0)) if value.type == _BYTE else value


def write_entry(module: ir.Module, inner: ir.Function, machine: Machine) -> None:
    """Write the function to call: it takes the arrays' addresses as one array."""
    function = ir.Function(module, ir.FunctionType(_LONG, [_BYTE.as_pointer().as_pointer(), _LONG]), _NAME)
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    addresses, n = function.args
    arguments = []
    for position, argument in enumerate(inner.args[:-1]):
        address = builder.load(builder.gep(addresses, [_LONG(position)]))
        arguments.append(builder.bitcast(address, argument.type))

    def loop() -> Any:
        return builder.call(inner, [*arguments, n])

    builder.ret(while_flushing(builder, machine.triple, loop))
