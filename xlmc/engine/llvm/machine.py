"""LLVM: modules to native code for this machine's processor.

Numbers below 2^-1022 are 0 to Excel: during a loop the processor makes 0 of them, as operands and as results. x86-64
does so with the bits FTZ and DAZ of MXCSR (Intel SDM, vol. 1, 10.2.3), ARM with the bit FZ of FPCR. They are set when
native code is entered and put back when it is left: all other code of the thread computes as ever. On any other
processor the loop checks each result.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any, Final

from llvmlite import binding, ir

from xlmc.engine.llvm.code_cache import code_key, load_code, save_code

__all__ = ["Machine", "NativeLoop", "machine", "this_machine", "while_flushing"]

_KEPT: Final = 64

_SPEED_LEVEL: Final = 3
_PIPELINE: Final = f"speed level {_SPEED_LEVEL}, loops vectorised"
"""What a module goes through: code that went through something else is no longer used."""

_X86: Final = ("x86_64", "amd64")
_ARM: Final = ("aarch64", "arm64")

_FTZ_AND_DAZ: Final = 1 << 15 | 1 << 6
_FZ: Final = 1 << 24

_BYTES, _INT, _LONG, _NOTHING = ir.IntType(8).as_pointer(), ir.IntType(32), ir.IntType(64), ir.VoidType()


class NativeLoop:
    """Takes the addresses of the arrays and the number of trials; gives how many of them must be computed again.

    Args:
        keep: the object that must live as long as the code.

    Attributes:
        address: of the code, for other native code.
    """

    def __init__(self, address: int, keep: Any) -> None:
        self.address, self._keep = address, keep
        self._call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64)(address)

    def __call__(self, addresses: Any, n: int) -> int:
        value: int = self._call(addresses, n)
        return value


class Machine:
    """Compiles for a processor.

    Args:
        cpu, features: in LLVM's names.

    Attributes:
        fused: whether it multiplies and adds in one instruction, rounding once.
        triple: its kind, in LLVM's words.
        multiplies_52_bits: whether it adds the halves of products of eight numbers of 52 bits in one instruction each.
        many_wide_registers: whether it has 32 registers of eight numbers each.
        flushes: whether it makes 0 of numbers that are too small for Excel.
    """

    def __init__(self, cpu: str, features: str) -> None:
        self._cpu, self._features = cpu, features
        self._compiled = lru_cache(_KEPT)(self._compile)
        self.triple = triple = binding.get_default_triple()
        self.fused = "+fma" in features.split(",") or triple.startswith(("aarch64", "arm64"))
        self.multiplies_52_bits = {"+avx512ifma", "+avx512dq"} <= {*features.split(",")} and triple.startswith("x86_64")
        self.many_wide_registers = "+avx512f" in features.split(",")
        self.flushes = flushes(triple)

    def _target(self) -> Any:
        """Make a new target machine each time, for the compiled code takes it over."""
        value = binding.Target.from_default_triple()
        return value.create_target_machine(cpu=self._cpu, features=self._features, opt=_SPEED_LEVEL)

    def native(self, module: ir.Module, name: str) -> NativeLoop:
        """Compile the function `name` of a module to native code that runs without holding Python's lock.

        The last modules are kept: a model that is run again is not compiled again. See `code_cache` for other programs.
        Its own type is `i64 (i8**, i64)`.
        """
        return self._compiled(str(module), name)

    def _compile(self, module: str, name: str) -> NativeLoop:
        target = self._target()
        llvm = ".".join(map(str, binding.llvm_version_info))
        key = code_key(_PIPELINE, llvm, self.triple, self._cpu, self._features, module)
        code = load_code(key)
        if code is None:
            return self._compile_anew(module, name, target, key)
        engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
        engine.add_object_file(binding.ObjectFileRef.from_data(code))
        engine.finalize_object()
        return NativeLoop(engine.get_function_address(name), engine)

    def _compile_anew(self, module: str, name: str, target: Any, key: str) -> NativeLoop:
        parsed = binding.parse_assembly(module)
        parsed.triple, parsed.data_layout = target.triple, str(target.target_data)
        parsed.verify()
        tuning = binding.create_pipeline_tuning_options(speed_level=_SPEED_LEVEL)
        tuning.loop_vectorization = True
        passes = binding.create_pass_builder(target, tuning)
        passes.getModulePassManager().run(parsed, passes)
        engine = binding.create_mcjit_compiler(parsed, target)
        engine.set_object_cache(lambda _, code: save_code(key, code))
        engine.finalize_object()
        return NativeLoop(engine.get_function_address(name), engine)


def this_machine() -> Machine:
    """Describe the processor that runs this, with its widest vectors: by default LLVM uses half of AVX-512's.

    With AVX2, LLVM would read tables number by number, and so compute the indices one by one, too, divisions and all.
    """
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    value = binding.get_host_cpu_features()
    wide = ",-prefer-256-bit" if value.get("avx512f") else ",+fast-gather" if value.get("avx2") else ""
    return Machine(binding.get_host_cpu_name(), value.flatten() + wide)


machine = cache(this_machine)


def flushes(triple: str) -> bool:
    """Whether the processor of that name can make 0 of numbers too small for Excel."""
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
