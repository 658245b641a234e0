"""Constant doubles that stand in a module, for instructions that read the one at an index."""

from __future__ import annotations

from hashlib import sha256
from typing import Any

from llvmlite import ir

from xlmc.engine.llvm.loop_rules import Emitter
from xlmc.excel.functions.values import Floats

__all__ = ["ConstantColumn"]


class ConstantColumn:
    """Numbers, `(k,)`, kept once in a module."""

    def __init__(self, body: Emitter, numbers: Floats) -> None:
        self._builder = body.builder
        type_ = ir.ArrayType(body.real, numbers.size)
        name = f"column.{sha256(numbers.tobytes()).hexdigest()[:32]}"
        known = body.builder.module.globals
        if name not in known:
            column = ir.GlobalVariable(body.builder.module, type_, name)
            column.linkage, column.global_constant = "internal", True
            column.initializer = ir.Constant(type_, [ir.Constant(body.real, float(number)) for number in numbers])
        self._column = known[name]

    def at(self, index: Any) -> Any:
        """Load the double at an index."""
        return self._builder.load(self._builder.gep(self._column, [index.type(0), index]))
