"""The uniforms of several random streams in one loop: the numbers that NumPy's PCG64DXSM gives, to the last bit.

One stream waits for its own last state at every step; four side by side keep the processor's multiplier busy. Each
uniform u is written as offset + factor·u, rounded twice as by NumPy: this is the draw of a `Uniform`, at no cost.
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

_BYTE, _LONG, _STATE, _DOUBLE = ir.IntType(8), ir.IntType(64), ir.IntType(128), ir.DoubleType()


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
    words[:, 4:] = np.array(maps, np.float64).reshape(-1, 2).view(np.uint64)
    addresses = [array.__array_interface__["data"][0] for array in (*rows, *words, jump_words)]
    calls: list[tuple[NativeLoop, Any]] = []
    for first in range(0, len(streams), _SIDE_BY_SIDE):
        chosen = range(first, min(first + _SIDE_BY_SIDE, len(streams)))
        of_chosen = [addresses[i] for i in chosen] + [addresses[len(streams) + i] for i in chosen] + addresses[-1:]
        calls.append((_loop(len(chosen)), (ctypes.c_void_p * len(of_chosen))(*of_chosen)))
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
    """Emit the number of a state: the output function "DXSM", its upper 53 bits as a fraction of 1."""
    odd = builder.or_(low, _LONG(1))
    high = builder.xor(high, builder.lshr(high, _LONG(32)))
    high = builder.mul(high, _LONG(_MULTIPLIER))
    high = builder.xor(high, builder.lshr(high, _LONG(48)))
    high = builder.lshr(builder.mul(high, odd), _LONG(11))
    return builder.fmul(builder.uitofp(high, _DOUBLE), ir.Constant(_DOUBLE, 2.0**-53))
