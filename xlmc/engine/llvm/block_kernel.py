"""A whole block in one native call: draw, filter, count, gather and forecast, as many trials at a time as caches hold.

All that the call needs to know lies in one array of 64-bit words, the argument table: addresses, and lists of addresses
for the loops that it calls. A `Layout` says what is where.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

from llvmlite import ir

from xlmc.engine.llvm.machine import Machine, NativeLoop
from xlmc.engine.llvm.uniforms import jump

__all__ = ["WORD", "Layout", "compile_kernel"]

WORD: Final = 64
"""Trials whose filters are compared at once, a bit each."""

_NAME: Final = "block"
_KEPT: Final = 16
"""Layouts whose code is kept: every thread of a run asks for the same."""

_BYTE, _LONG, _STATE, _DOUBLE = ir.IntType(8), ir.IntType(64), ir.IntType(128), ir.DoubleType()
_LOOP: Final = ir.FunctionType(_LONG, [_BYTE.as_pointer().as_pointer(), _LONG])


@dataclass(frozen=True, slots=True)
class Layout:
    """Positions in the argument table.

    Attributes:
        chunk: trials at a time, a multiple of `WORD`.
        fills, first, late: how many loops; two words for each follow, the address of its code and that of the addresses
            that it takes. These draw, those run on all trials, the last on the survivors.
        jump: the address of where `fills` begin; -1 without fills.
        filters: addresses of truth values, `(chunk,)`.
        by_chunk: addresses of doubles that move on with every chunk.
        by_accepted: addresses of doubles that move on by the trials kept.
        survivors: the address of `(chunk,)` int64 for the trials kept of a chunk; without filters it holds all of them.
        trials: the address of int64 for all trials kept, counted from the block's first; not written without filters.
        counts: the address of the counters: pairs of filters, the lower triangle by rows, then each filter alone.
        gathers: how many columns are gathered; the words after it are addresses of doubles, from and to.
    """

    chunk: int
    fills: int
    first: int
    late: int
    jump: int
    filters: tuple[int, ...]
    by_chunk: tuple[int, ...]
    by_accepted: tuple[int, ...]
    survivors: int
    trials: int
    counts: int
    gathers: int


@lru_cache(_KEPT)
def compile_kernel(machine: Machine, layout: Layout) -> NativeLoop:
    """Native code that takes the table's address and the number of chunks; it overwrites the table.

    It gives the number of trials kept, or -1 as soon as a trial must be computed again.
    """
    module = ir.Module()
    gather = _gather(module, layout.chunk)
    function = ir.Function(module, _LOOP, _NAME)
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    chunks = function.args[1]
    table = _ArgumentTable(builder, builder.bitcast(function.args[0], _LONG.as_pointer()))
    body, after, failed = (function.append_basic_block(name) for name in ("body", "after", "failed"))
    before = builder.block
    builder.branch(body)

    builder.position_at_end(body)
    chunk, total = builder.phi(_LONG), builder.phi(_LONG)
    table.call_all(layout.fills, _LONG(layout.chunk))
    if layout.jump >= 0:
        _advance_jump(builder, table.address(layout.jump, _LONG), layout.chunk)
    _fail_if(builder, table.call_all(layout.first, _LONG(layout.chunk)), failed)
    survivors = table.address(layout.survivors, _LONG)
    survived = _LONG(layout.chunk)
    if layout.filters:
        filters = [table.address(position, _BYTE) for position in layout.filters]
        counts = table.address(layout.counts, _LONG)
        survived = builder.call(_sieve(module, len(filters), layout.chunk), [*filters, survivors, counts])
        trials = builder.gep(table.address(layout.trials, _LONG), [total])
        first_trial = builder.mul(chunk, _LONG(layout.chunk))
        _for_each(builder, survived, lambda i: _store_shifted(builder, survivors, trials, first_trial, i))
    _fail_if(builder, table.call_all(layout.late, survived), failed)
    _for_each(
        builder,
        table.word(layout.gathers),
        lambda i: table.gather_column(gather, layout.gathers, i, survivors, survived),
    )
    for position in layout.by_chunk:
        table.move(position, _LONG(8 * layout.chunk))
    for position in layout.by_accepted:
        table.move(position, builder.mul(survived, _LONG(8)))
    ahead, so_far = builder.add(chunk, _LONG(1)), builder.add(total, survived)
    for value, start, following in ((chunk, _LONG(0), ahead), (total, _LONG(0), so_far)):
        value.add_incoming(start, before)
        value.add_incoming(following, builder.block)
    builder.cbranch(builder.icmp_signed("<", ahead, chunks), body, after)

    builder.position_at_end(after)
    builder.ret(so_far)
    builder.position_at_end(failed)
    builder.ret(_LONG(-1))
    return machine.native(module, _NAME)


class _ArgumentTable:
    """Reads and writes the argument table."""

    def __init__(self, builder: ir.IRBuilder, words: Any) -> None:
        self._builder, self._words = builder, words

    def word(self, position: int) -> Any:
        return self._builder.load(self._at(_LONG(position)))

    def address(self, position: int, of: ir.Type) -> Any:
        return self._builder.inttoptr(self.word(position), of.as_pointer())

    def move(self, position: int, size: Any) -> None:
        at = self._at(_LONG(position))
        self._builder.store(self._builder.add(self._builder.load(at), size), at)

    def call_all(self, position: int, n: Any) -> Any:
        """Call loops one after another; give how many trials must be computed again."""
        builder = self._builder
        with builder.goto_entry_block():
            wrong = builder.alloca(_LONG)
        builder.store(_LONG(0), wrong)

        def call(i: Any) -> None:
            at = builder.add(builder.mul(i, _LONG(2)), _LONG(position + 1))
            words = [builder.load(self._at(word)) for word in (at, builder.add(at, _LONG(1)))]
            types = (_LOOP.as_pointer(), _BYTE.as_pointer().as_pointer())
            code, arguments = (builder.inttoptr(word, of) for word, of in zip(words, types, strict=True))
            builder.store(builder.add(builder.load(wrong), builder.call(code, [arguments, n])), wrong)

        _for_each(builder, self.word(position), call)
        return builder.load(wrong)

    def gather_column(self, gather: ir.Function, gathers: int, i: Any, survivors: Any, survived: Any) -> None:
        """Gather a column, and move its target on for the next chunk."""
        builder = self._builder
        first = builder.add(builder.mul(i, _LONG(2)), _LONG(gathers + 1))
        source, target = self._at(first), self._at(builder.add(first, _LONG(1)))
        arrays = [builder.inttoptr(builder.load(at), _DOUBLE.as_pointer()) for at in (source, target)]
        builder.call(gather, [*arrays, survivors, survived])
        builder.store(builder.add(builder.load(target), builder.mul(survived, _LONG(8))), target)

    def _at(self, position: Any) -> Any:
        return self._builder.gep(self._words, [position])


def _fail_if(builder: ir.IRBuilder, wrong: Any, failed: Any) -> None:
    """Go to `failed` where anything went wrong."""
    following = builder.append_basic_block("fine")
    builder.cbranch(builder.icmp_signed("!=", wrong, _LONG(0)), failed, following)
    builder.position_at_end(following)


def _for_each(builder: ir.IRBuilder, n: Any, do: Any) -> None:
    """Emit `do` for i from 0 to n - 1."""
    before = builder.block
    body, after = builder.append_basic_block("each"), builder.append_basic_block("done")
    builder.cbranch(builder.icmp_signed("<", _LONG(0), n), body, after)
    builder.position_at_end(body)
    i = builder.phi(_LONG)
    do(i)
    following = builder.add(i, _LONG(1))
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, builder.block)
    builder.cbranch(builder.icmp_signed("<", following, n), body, after)
    builder.position_at_end(after)


def _store_shifted(builder: ir.IRBuilder, source: Any, target: Any, offset: Any, i: Any) -> None:
    value = builder.add(builder.load(builder.gep(source, [i])), offset)
    builder.store(value, builder.gep(target, [i]))


def _advance_jump(builder: ir.IRBuilder, halves: Any, chunk: int) -> None:
    """Change the jump to this chunk's first trial into that to the next chunk's: x ↦ a·x + c after the jump so far."""
    factor, summand = jump(chunk)
    factor_and_summand = [builder.bitcast(halves, _STATE.as_pointer()), builder.bitcast(halves, _STATE.as_pointer())]
    factor_and_summand[1] = builder.gep(factor_and_summand[1], [_LONG(1)])
    for at, more in zip(factor_and_summand, (0, summand), strict=True):
        moved = builder.mul(builder.load(at, align=8), _STATE(factor))
        builder.store(builder.add(moved, _STATE(more)), at, align=8)


def _gather(module: ir.Module, chunk: int) -> ir.Function:
    """Make a function that copies the doubles of the survivors, one after another."""
    types = [_DOUBLE.as_pointer(), _DOUBLE.as_pointer(), _LONG.as_pointer(), _LONG]
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), types), "gather")
    function.linkage = "internal"
    for argument in function.args[:-1]:
        argument.add_attribute("noalias")
    source, target, survivors, n = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))

    def copy(i: Any, of: Any) -> None:
        builder.store(builder.load(builder.gep(source, [of])), builder.gep(target, [i]))

    with builder.if_else(builder.icmp_signed("==", n, _LONG(chunk))) as (whole, some):
        with whole:
            _for_each(builder, _LONG(chunk), lambda i: copy(i, i))
        with some:
            _for_each(builder, n, lambda i: copy(i, builder.load(builder.gep(survivors, [i]))))
    builder.ret_void()
    return function


def _sieve(module: ir.Module, filters: int, chunk: int) -> ir.Function:
    """Make a function that counts what the filters reject of a chunk, and lists and counts the trials that survive."""
    types = [*[_BYTE.as_pointer()] * filters, _LONG.as_pointer(), _LONG.as_pointer()]
    function = ir.Function(module, ir.FunctionType(_LONG, types), "sieve")
    function.linkage = "internal"
    *answers, survivors, counters = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    survived = builder.alloca(_LONG)
    builder.store(_LONG(0), survived)

    def word(w: Any) -> None:
        first = builder.mul(w, _LONG(WORD))
        rejected = [_rejected_bits(builder, answer, first) for answer in answers]
        once, more = _LONG(0), _LONG(0)
        for bits in rejected:
            more = builder.or_(more, builder.and_(once, bits))
            once = builder.or_(once, bits)
        alone = builder.not_(more)
        sets = [builder.and_(rejected[i], rejected[j]) for i in range(filters) for j in range(i + 1)]
        sets += [builder.and_(bits, alone) for bits in rejected]
        for position, bits in enumerate(sets):
            at = builder.gep(counters, [_LONG(position)])
            builder.store(builder.add(builder.load(at), builder.ctpop(bits)), at)
        _list_bits(builder, builder.not_(once), first, survivors, survived)

    _for_each(builder, _LONG(chunk // WORD), word)
    builder.ret(builder.load(survived))
    return function


def _rejected_bits(builder: ir.IRBuilder, answers: Any, first: Any) -> Any:
    """Load a bit for each of the next trials, the first the lowest: set where the filter is FALSE."""
    vector = ir.VectorType(_BYTE, WORD)
    bytes_ = builder.load(builder.bitcast(builder.gep(answers, [first]), vector.as_pointer()), align=1)
    false = builder.icmp_unsigned("==", bytes_, ir.Constant(vector, [0] * WORD))
    return builder.bitcast(false, _LONG)


def _list_bits(builder: ir.IRBuilder, bits: Any, first: Any, survivors: Any, survived: Any) -> None:
    """Add the trials of the bits that are set to the list of those kept."""
    target = builder.gep(survivors, [builder.load(survived)])
    with builder.if_else(builder.icmp_signed("==", bits, _LONG(-1))) as (whole, some):
        with whole:
            _for_each(builder, _LONG(WORD), lambda i: builder.store(builder.add(first, i), builder.gep(target, [i])))
        with some:
            _list_some(builder, bits, first, target)
    builder.store(builder.add(builder.load(survived), builder.ctpop(bits)), survived)


def _list_some(builder: ir.IRBuilder, bits: Any, first: Any, target: Any) -> None:
    """List the trials of the bits that are set, one after another."""
    before = builder.block
    body, after = builder.append_basic_block("next"), builder.append_basic_block("none")
    builder.cbranch(builder.icmp_unsigned("!=", bits, _LONG(0)), body, after)
    builder.position_at_end(body)
    left, listed = builder.phi(_LONG), builder.phi(_LONG)
    trial = builder.add(first, builder.cttz(left, ir.Constant(ir.IntType(1), 1)))
    builder.store(trial, builder.gep(target, [listed]))
    rest, following = builder.and_(left, builder.sub(left, _LONG(1))), builder.add(listed, _LONG(1))
    for value, start, more in ((left, bits, rest), (listed, _LONG(0), following)):
        value.add_incoming(start, before)
        value.add_incoming(more, body)
    builder.cbranch(builder.icmp_unsigned("!=", rest, _LONG(0)), body, after)
    builder.position_at_end(after)
