"""Numbers below 2^-1022 are 0 to Excel: a loop runs while the processor makes 0 of them, as operands and as results.

x86-64 does with the bits FTZ and DAZ of MXCSR (Intel SDM, vol. 1, 10.2.3), ARM with the bit FZ of FPCR. They are set as
native code is entered and put back as it is left: all other code of the thread computes as ever. On any other processor
each result is looked at.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from llvmlite import ir

__all__ = ["flushes", "while_flushing"]

_X86: Final = ("x86_64", "amd64")
_ARM: Final = ("aarch64", "arm64")

_FTZ_AND_DAZ: Final = 1 << 15 | 1 << 6
_FZ: Final = 1 << 24

_BYTES, _INT, _LONG, _NOTHING = ir.IntType(8).as_pointer(), ir.IntType(32), ir.IntType(64), ir.VoidType()


def flushes(triple: str) -> bool:
    """Whether the processor of that name does it by itself."""
    return triple.startswith((*_X86, *_ARM))


def while_flushing(builder: ir.IRBuilder, triple: str, do: Callable[[], Any]) -> Any:
    """Emit `do` between setting the bits and putting them back; gives what `do` gives."""
    if triple.startswith(_X86):
        return _on_x86(builder, do)
    return _on_arm(builder, do) if triple.startswith(_ARM) else do()


def _on_x86(builder: ir.IRBuilder, do: Callable[[], Any]) -> Any:
    store, load = (
        builder.module.declare_intrinsic(f"llvm.x86.sse.{name}", (), ir.FunctionType(_NOTHING, [_BYTES]))
        for name in ("stmxcsr", "ldmxcsr")
    )
    before, during = builder.alloca(_INT), builder.alloca(_INT)
    builder.call(store, [builder.bitcast(before, _BYTES)])
    builder.store(builder.or_(builder.load(before), _INT(_FTZ_AND_DAZ)), during)
    builder.call(load, [builder.bitcast(during, _BYTES)])
    result = do()
    builder.call(load, [builder.bitcast(before, _BYTES)])
    return result


def _on_arm(builder: ir.IRBuilder, do: Callable[[], Any]) -> Any:
    get = builder.module.declare_intrinsic("llvm.aarch64.get.fpcr", (), ir.FunctionType(_LONG, []))
    set_ = builder.module.declare_intrinsic("llvm.aarch64.set.fpcr", (), ir.FunctionType(_NOTHING, [_LONG]))
    before = builder.call(get, [])
    builder.call(set_, [builder.or_(before, _LONG(_FZ))])
    result = do()
    builder.call(set_, [before])
    return result
