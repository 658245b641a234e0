"""LLVM: modules to native code for this machine's processor."""

from __future__ import annotations

import ctypes
from functools import cache, lru_cache
from typing import Any, Final

from llvmlite import binding, ir

from xlmc.evaluation.llvm.flushing import flushes

__all__ = ["Machine", "NativeLoop", "machine", "this_machine"]

_KEPT: Final = 64


class NativeLoop:
    """Takes the addresses of the arrays and the number of trials; gives how many of them must be computed again.

    Args:
        keep: what must live as long as the code.

    Attributes:
        address: of the code, for other native code.
    """

    def __init__(self, address: int, keep: Any) -> None:
        self.address, self._keep = address, keep
        self._call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64)(address)

    def __call__(self, addresses: Any, n: int) -> int:
        found: int = self._call(addresses, n)
        return found


class Machine:
    """Compiles for a processor.

    Args:
        cpu, features: in LLVM's names.

    Attributes:
        fused: whether it multiplies and adds in one instruction, rounding once.
        triple: its kind, in LLVM's words.
        flushes: whether it makes 0 of numbers that are too small for Excel.
    """

    def __init__(self, cpu: str, features: str) -> None:
        self._cpu, self._features = cpu, features
        self._compiled = lru_cache(_KEPT)(self._compile)
        self.triple = triple = binding.get_default_triple()
        self.fused = "+fma" in features.split(",") or triple.startswith(("aarch64", "arm64"))
        self.flushes = flushes(triple)

    def _target(self) -> Any:
        """Made anew each time, for the code that comes of it takes it over."""
        found = binding.Target.from_default_triple()
        return found.create_target_machine(cpu=self._cpu, features=self._features, opt=3)

    def native(self, module: ir.Module, name: str) -> NativeLoop:
        """The function `name` of a module, as native code that runs without holding Python's lock.

        The last modules are kept: a model that is run again is not compiled again.
        Its own type is `i64 (i8**, i64)`.
        """
        return self._compiled(str(module), name)

    def _compile(self, module: str, name: str) -> NativeLoop:
        target = self._target()
        parsed = binding.parse_assembly(module)
        parsed.triple, parsed.data_layout = target.triple, str(target.target_data)
        parsed.verify()
        tuning = binding.create_pipeline_tuning_options(speed_level=3)
        tuning.loop_vectorization = True
        passes = binding.create_pass_builder(target, tuning)
        passes.getModulePassManager().run(parsed, passes)
        engine = binding.create_mcjit_compiler(parsed, target)
        engine.finalize_object()
        return NativeLoop(engine.get_function_address(name), engine)


def this_machine() -> Machine:
    """The processor that runs this, its widest vectors in use: LLVM alone would take half of AVX-512."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    found = binding.get_host_cpu_features()
    wide = ",-prefer-256-bit" if found.get("avx512f") else ""
    return Machine(binding.get_host_cpu_name(), found.flatten() + wide)


machine = cache(this_machine)
