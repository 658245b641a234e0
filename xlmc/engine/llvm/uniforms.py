"""The uniforms of several random streams in one loop: the numbers that NumPy's PCG64DXSM gives, to the last bit.

One stream waits for its own last state at every step; four side by side keep the processor's multiplier busy. Where it
can multiply eight numbers of 52 bits at once, eight states of one stream go on together, by eight steps each, which
takes half the time. Each uniform u is written as offset + factor·u, rounded twice as by NumPy: this is the draw of a
`Uniform`, at no cost.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any, Final

import numpy as np
from llvmlite import ir
from numpy.typing import NDArray

from xlmc.engine.engine import UniformStream
from xlmc.engine.llvm.machine import NativeLoop, machine

__all__ = ["Fill", "filler", "halves", "jump"]

_NAME: Final = "fill"
_SIDE_BY_SIDE: Final = 4
_TILE: Final = 128
"""Steps of a stream whose states are stored, in the first-level cache, before numbers are made of them."""

_MULTIPLIER: Final = 0xDA942042E4DD58B5
"""PCG64DXSM's, O'Neill's "cheap" multiplier, of the state and of its output function."""

_WORDS: Final = 6
"""The words of a stream: state and increment, 128 bits each, offset and factor."""

_LAST_BIT: Final = 2.0**-53
"""Of a uniform. The wide loop is given the factor times this, which changes nothing as long as it is exact."""

_LANES: Final = 8
"""States of a stream that go on together."""

_LIMB: Final = 52
"""Bits of a part of a state; a state is made of three such parts."""

_BYTE, _LONG, _STATE, _DOUBLE = ir.IntType(8), ir.IntType(64), ir.IntType(128), ir.DoubleType()


_LONGS, _DOUBLES = ir.VectorType(_LONG, _LANES), ir.VectorType(_DOUBLE, _LANES)

_ALL_BITS: Final = (1 << 128) - 1
_LOW_HALF: Final = (1 << 64) - 1


def filler(streams: Sequence[UniformStream], maps: Sequence[tuple[float, float]], rows: NDArray[np.float64]) -> Fill:
    """Make a `Fill` that fills `rows` (k, block) with offset + factor·uniform, from a trial on.

    Args:
        streams: k of them; `beginning` gives the state before trial 0 and the increment.
        maps: the offset and the factor of each.
        rows: written to.
    """
    words = np.empty((len(streams), _WORDS), np.uint64)
    for word, stream in zip(words, streams, strict=True):
        word[:4] = [half for number in stream.beginning for half in halves(number)]
    jump_words = np.empty(4, np.uint64)
    of_maps = np.array(maps, np.float64).reshape(-1, 2)
    scaled = of_maps * (1.0, _LAST_BIT)
    wide = machine().multiplies_52_bits and bool((scaled[:, 1] / _LAST_BIT == of_maps[:, 1]).all())
    words[:, 4:] = (scaled if wide else of_maps).view(np.uint64)
    addresses = [array.__array_interface__["data"][0] for array in (*rows, *words, jump_words)]
    calls: list[tuple[NativeLoop, Any]] = []
    side_by_side = 1 if wide else _SIDE_BY_SIDE
    for first in range(0, len(streams), side_by_side):
        chosen = range(first, min(first + side_by_side, len(streams)))
        of_chosen = [addresses[i] for i in chosen] + [addresses[len(streams) + i] for i in chosen] + addresses[-1:]
        calls.append((_wide_loop() if wide else _loop(len(chosen)), (ctypes.c_void_p * len(of_chosen))(*of_chosen)))
    return Fill(calls, words, jump_words, rows)


class Fill:
    """Calls the loops; it keeps the arrays that these know by their addresses.

    Attributes:
        calls: the loops, with the addresses that each takes.
        jump: `(4,)` the jump to the first trial, which the loops read; see `go_to`.
    """

    def __init__(
        self,
        calls: Sequence[tuple[NativeLoop, Any]],
        words: NDArray[np.uint64],
        jump: NDArray[np.uint64],
        rows: NDArray[np.float64],
    ) -> None:
        self.calls, self.jump, self._words, self._rows = calls, jump, words, rows

    def __call__(self, start: int) -> None:
        self.go_to(start)
        for call, arguments in self.calls:
            call(arguments, self._rows.shape[1])

    def go_to(self, start: int) -> None:
        """Let the loops begin at a trial."""
        self.jump[:] = [half for number in jump(start) for half in halves(number)]


def halves(number: int) -> tuple[int, int]:
    return number & _LOW_HALF, number >> 64


def jump(steps: int) -> tuple[int, int]:
    """Return two factors: the state so many steps on is the first times the state plus the second times the increment.

    Brown (1994), "Random number generation with arbitrary strides".
    """
    factor, summand = 1, 0
    while steps:
        power, total = _double(steps.bit_length() - 1)
        factor, summand = factor * power & _ALL_BITS, (summand * power + total) & _ALL_BITS
        steps ^= 1 << (steps.bit_length() - 1)
    return factor, summand


@cache
def _double(times: int) -> tuple[int, int]:
    """Return the jump of 2^times steps."""
    if times == 0:
        return _MULTIPLIER, 1
    factor, summand = _double(times - 1)
    return factor * factor & _ALL_BITS, (factor + 1) * summand & _ALL_BITS


@cache
def _loop(k: int) -> NativeLoop:
    """Write the loop over the trials of k streams; it takes the addresses of k rows, of k streams' words and of the
    jump.
    """
    module = ir.Module()
    finished = _finish(module)
    function = ir.Function(module, ir.FunctionType(_LONG, [_BYTE.as_pointer().as_pointer(), _LONG]), _NAME)
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    addresses, n = function.args
    arrays = [builder.load(builder.gep(addresses, [_LONG(i)])) for i in range(2 * k + 1)]
    rows = [builder.bitcast(array, _DOUBLE.as_pointer()) for array in arrays[:k]]
    jump_ = _load_numbers(builder, arrays[-1])
    loaded = [_load_stream(builder, array, jump_) for array in arrays[k:-1]]
    buffers = [tuple(builder.alloca(_LONG, _TILE) for _ in range(2)) for _ in range(k)]
    before, body, after = builder.block, *(function.append_basic_block(name) for name in ("body", "after"))
    builder.cbranch(builder.icmp_signed("<", _LONG(0), n), body, after)

    builder.position_at_end(body)
    first = builder.phi(_LONG)
    states = [builder.phi(_STATE) for _ in range(k)]
    left = builder.sub(n, first)
    size = builder.select(builder.icmp_signed("<", left, _LONG(_TILE)), left, _LONG(_TILE))
    advanced = _advance(builder, states, [increment for _, increment, _, _ in loaded], buffers, size)
    for row, halves_, (_, _, offset, factor) in zip(rows, buffers, loaded, strict=True):
        builder.call(finished, [*halves_, builder.gep(row, [first]), offset, factor, size])
    following = builder.add(first, size)
    first.add_incoming(_LONG(0), before)
    first.add_incoming(following, builder.block)
    for state, (beginning, _, _, _), ahead in zip(states, loaded, advanced, strict=True):
        state.add_incoming(beginning, before)
        state.add_incoming(ahead, builder.block)
    builder.cbranch(builder.icmp_signed("<", following, n), body, after)

    builder.position_at_end(after)
    builder.ret(_LONG(0))
    return machine().native(module, _NAME)


@cache
def _wide_loop() -> NativeLoop:
    """Write the loop over the trials of one stream, `_LANES` at a time; it takes the addresses that `_loop` takes."""
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(_LONG, [_BYTE.as_pointer().as_pointer(), _LONG]), _NAME)
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    addresses, n = function.args
    row, words, jump_words = (builder.load(builder.gep(addresses, [_LONG(i)])) for i in range(3))
    row = builder.bitcast(row, _DOUBLE.as_pointer())
    state, increment, offset, scale = _load_stream(builder, words, _load_numbers(builder, jump_words))
    ahead, further = jump(_LANES)
    summands = [_repeat(builder, limb) for limb in _limbs(builder, builder.mul(increment, _STATE(further)))]
    factors = _constant_limbs([ahead] * _LANES)
    offsets, scales = _repeat(builder, offset), _repeat(builder, scale)
    beginning = _lanes(builder, state, increment)
    spare = builder.alloca(_DOUBLE, _LANES)
    before, body, after = builder.block, *(function.append_basic_block(name) for name in ("body", "after"))
    builder.cbranch(builder.icmp_signed("<", _LONG(0), n), body, after)

    builder.position_at_end(body)
    i, limbs = builder.phi(_LONG), [builder.phi(_LONGS) for _ in range(3)]
    following = builder.add(i, _LONG(_LANES))
    is_whole = builder.icmp_signed("<=", following, n)
    target = builder.select(is_whole, builder.gep(row, [i]), spare)
    value = builder.fadd(builder.fmul(_fraction(builder, *_halves_of_limbs(builder, limbs)), scales), offsets)
    builder.store(value, builder.bitcast(target, _DOUBLES.as_pointer()), align=8)
    moved = _advance_limbs(builder, limbs, factors, summands)
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, body)
    for limb, start, next_ in zip(limbs, beginning, moved, strict=True):
        limb.add_incoming(start, before)
        limb.add_incoming(next_, body)
    builder.cbranch(builder.icmp_signed("<", following, n), body, after)

    builder.position_at_end(after)
    rest = builder.and_(n, _LONG(_LANES - 1))
    first_of_rest = builder.sub(n, rest)
    for lane in range(_LANES - 1):
        with builder.if_then(builder.icmp_signed("<", _LONG(lane), rest)):
            number = builder.load(builder.gep(spare, [_LONG(lane)]))
            builder.store(number, builder.gep(row, [builder.add(first_of_rest, _LONG(lane))]))
    builder.ret(_LONG(0))
    return machine().native(module, _NAME)


def _lanes(builder: ir.IRBuilder, state: Any, increment: Any) -> Any:
    """Emit the parts of the states that follow from a state by 0, 1, 2, ... steps."""
    jumps = [jump(lane) for lane in range(_LANES)]
    factors, summands = (_constant_limbs([each[part] for each in jumps]) for part in (0, 1))
    states, increments = ([_repeat(builder, limb) for limb in _limbs(builder, number)] for number in (state, increment))
    added = _advance_limbs(builder, increments, summands, [_vector(0)] * 3)
    without_carries = [builder.and_(limb, _vector((1 << _LIMB) - 1)) for limb in added]
    return _advance_limbs(builder, states, factors, without_carries)


def _constant_limbs(numbers: Sequence[int]) -> list[Any]:
    """Make vectors of the three parts of `_LANES` numbers, the lowest first."""
    mask = (1 << _LIMB) - 1
    return [ir.Constant(_LONGS, [number >> _LIMB * i & mask for number in numbers]) for i in range(3)]


def _limbs(builder: ir.IRBuilder, state: Any) -> list[Any]:
    """Emit the three parts of a state, the lowest first."""
    mask = _STATE((1 << _LIMB) - 1)
    return [builder.trunc(builder.and_(builder.lshr(state, _STATE(_LIMB * i)), mask), _LONG) for i in range(3)]


def _repeat(builder: ir.IRBuilder, number: Any) -> Any:
    """Emit a vector of one number."""
    vector, index = ir.VectorType(number.type, _LANES), ir.IntType(32)
    one = builder.insert_element(ir.Constant(vector, ir.Undefined), number, index(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(index, _LANES), [0] * _LANES))


def _advance_limbs(builder: ir.IRBuilder, limbs: Sequence[Any], factors: Sequence[Any], summands: Sequence[Any]) -> Any:
    """Emit the states times the factor plus the summand.

    A product's upper and lower 52 bits come from instructions of their own, which read the lowest 52 bits of each part;
    so only what the sums carry must be added to the next part.
    """
    type_ = ir.FunctionType(_LONGS, [_LONGS] * 3)
    low, high = (builder.module.declare_intrinsic(f"llvm.x86.avx512.vpmadd52{half}.uq.512", (), type_) for half in "lh")
    carry = _vector(_LIMB)
    (a, b, c), (d, e, f) = limbs, factors
    first, second, third = summands
    first = builder.call(low, [first, a, d])
    for half, x, y in ((high, a, d), (low, a, e), (low, b, d)):
        second = builder.call(half, [second, x, y])
    second = builder.add(second, builder.lshr(first, carry))
    for half, x, y in ((high, a, e), (low, a, f), (high, b, d), (low, b, e), (low, c, d)):
        third = builder.call(half, [third, x, y])
    return first, second, builder.add(third, builder.lshr(second, carry))


def _halves_of_limbs(builder: ir.IRBuilder, limbs: Sequence[Any]) -> tuple[Any, Any]:
    """Emit the upper and the lower halves of states; the lower ones odd, as `_fraction` wants them.

    Two words shifted together are one instruction, which also drops what was carried.
    """
    first, second, third = limbs
    type_ = ir.FunctionType(_LONGS, [_LONGS] * 3)
    shifted = builder.module.declare_intrinsic("llvm.fshl.v8i64", (), type_)
    unused = 64 - _LIMB
    high = builder.call(shifted, [third, builder.shl(second, _vector(unused)), _vector(2 * _LIMB - 64)])
    upper = builder.call(shifted, [second, _vector(1 << unused), _vector(_LIMB)])
    return high, builder.or_(builder.and_(first, _vector((1 << _LIMB) - 1)), upper)


def _vector(number: int) -> Any:
    return ir.Constant(_LONGS, [number] * _LANES)


def _advance(
    builder: ir.IRBuilder, states: Sequence[Any], increments: Sequence[Any], buffers: Sequence[Any], n: Any
) -> list[Any]:
    """Emit the states `n` steps on; the states on the way are stored in `buffers`, as upper and lower halves."""
    before, body, after = builder.block, *(builder.append_basic_block(name) for name in ("steps", "stepped"))
    builder.branch(body)
    builder.position_at_end(body)
    i, moved = builder.phi(_LONG), []
    here = [builder.phi(_STATE) for _ in states]
    for state, beginning, increment, (high, low) in zip(here, states, increments, buffers, strict=True):
        builder.store(builder.trunc(builder.lshr(state, _STATE(64)), _LONG), builder.gep(high, [i]))
        builder.store(builder.trunc(state, _LONG), builder.gep(low, [i]))
        ahead = builder.add(builder.mul(state, _STATE(_MULTIPLIER)), increment)
        state.add_incoming(beginning, before)
        state.add_incoming(ahead, body)
        moved.append(ahead)
    following = builder.add(i, _LONG(1))
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, body)
    builder.cbranch(builder.icmp_signed("<", following, n), body, after)
    builder.position_at_end(after)
    return moved


def _finish(module: ir.Module) -> ir.Function:
    """Write a function from halves of states to offset + factor·uniform; it does several at a time, as none needs
    another.
    """
    words, doubles = _LONG.as_pointer(), _DOUBLE.as_pointer()
    types = [words, words, doubles, _DOUBLE, _DOUBLE, _LONG]
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), types), "finished")
    function.linkage = "internal"
    function.attributes.add("noinline")  # see `loop`
    for argument in function.args[:3]:
        argument.add_attribute("noalias")
    high, low, row, offset, factor, n = function.args
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    before, body, after = builder.block, *(function.append_basic_block(name) for name in ("body", "after"))
    builder.branch(body)
    builder.position_at_end(body)
    i = builder.phi(_LONG)
    halves_ = (builder.load(builder.gep(half, [i])) for half in (high, low))
    value = builder.fadd(builder.fmul(_uniform(builder, *halves_), factor), offset)
    builder.store(value, builder.gep(row, [i]))
    following = builder.add(i, _LONG(1), flags=["nuw", "nsw"])
    i.add_incoming(_LONG(0), before)
    i.add_incoming(following, body)
    builder.cbranch(builder.icmp_signed("<", following, n), body, after)
    builder.position_at_end(after)
    builder.ret_void()
    return function


def _load_numbers(builder: ir.IRBuilder, words: Any) -> tuple[Any, Any]:
    """Two numbers of 128 bits, lower half first."""
    longs = builder.bitcast(words, _LONG.as_pointer())
    parts = [builder.zext(builder.load(builder.gep(longs, [_LONG(i)])), _STATE) for i in range(4)]
    first, second = (builder.or_(low, builder.shl(high, _STATE(64))) for low, high in (parts[:2], parts[2:]))
    return first, second


def _load_stream(builder: ir.IRBuilder, words: Any, jump: tuple[Any, Any]) -> tuple[Any, Any, Any, Any]:
    """State after the jump, increment, offset and factor of a stream."""
    state, increment = _load_numbers(builder, words)
    state = builder.add(builder.mul(state, jump[0]), builder.mul(increment, jump[1]))
    doubles = builder.bitcast(words, _DOUBLE.as_pointer())
    offset, factor = (builder.load(builder.gep(doubles, [_LONG(i)])) for i in (4, 5))
    return state, increment, offset, factor


def _uniform(builder: ir.IRBuilder, high: Any, low: Any) -> Any:
    """Emit the number of a state, as a fraction of 1."""
    return builder.fmul(_fraction(builder, high, low), ir.Constant(_DOUBLE, _LAST_BIT))


def _fraction(builder: ir.IRBuilder, high: Any, low: Any) -> Any:
    """Emit the output function "DXSM" of a state, or of several: its upper 53 bits, in units of the last."""
    several = isinstance(high.type, ir.VectorType)
    constant = _vector if several else _LONG
    odd = builder.or_(low, constant(1))
    high = builder.xor(high, builder.lshr(high, constant(32)))
    high = builder.mul(high, constant(_MULTIPLIER))
    high = builder.xor(high, builder.lshr(high, constant(48)))
    high = builder.lshr(builder.mul(high, odd), constant(11))
    return builder.uitofp(high, _DOUBLES if several else _DOUBLE)
