"""Arithmetic on numbers in the loop, for the functions that are made of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from llvmlite import ir

__all__ = ["Arithmetic", "intrinsic"]

_SPLIT: Final = 2.0**27 + 1

_DOUBLE, _INTEGER = ir.DoubleType(), ir.IntType(64)


def intrinsic(builder: Any, real: ir.Type, name: str, *arguments: Any) -> Any:
    """A call of one of LLVM's own functions of numbers."""
    of = ir.FunctionType(real, [real] * len(arguments))
    return builder.call(builder.module.declare_intrinsic(name, [real], of), arguments)


class Arithmetic:
    """Reals and integers of their size on a builder, doubles by default.

    `fused` says whether the processor multiplies and adds at once.
    """

    def __init__(self, builder: Any, fused: bool, real: ir.Type = _DOUBLE, integer: ir.IntType = _INTEGER) -> None:
        self._builder, self._fused, self._real, self._integer = builder, fused, real, integer
        self.add, self.sub, self.mul, self.div = builder.fadd, builder.fsub, builder.fmul, builder.fdiv
        self.select, self.negative = builder.select, builder.fneg

    def number(self, value: float) -> Any:
        return ir.Constant(self._real, value)

    def above(self, x: Any, y: Any) -> Any:
        """Whether x > y; not where one is NaN."""
        return self._builder.fcmp_ordered(">", x, y)

    def size(self, x: Any) -> Any:
        return self._intrinsic("llvm.fabs", x)

    def root(self, x: Any) -> Any:
        return self._intrinsic("llvm.sqrt", x)

    def with_sign_of(self, x: Any, size: Any) -> Any:
        """A size with the sign of `x`."""
        return self._intrinsic("llvm.copysign", size, x)

    def plus(self, z: Any, x: Any, y: Any) -> Any:
        """Z + x·y, rounded once or twice."""
        return self._intrinsic("llvm.fma", x, y, z) if self._fused else self.add(z, self.mul(x, y))

    def minus(self, z: Any, x: Any, y: Any) -> Any:
        """Z - x·y, rounded once or twice."""
        return self.plus(z, self.negative(x), y)

    def polynomial(self, x: Any, coefficients: Sequence[float]) -> Any:
        """The coefficients from the lowest power up."""
        result = self.number(coefficients[-1])
        for coefficient in reversed(coefficients[:-1]):
            result = self.plus(self.number(coefficient), result, x)
        return result

    def lost(self, k: Any, constant: float, product: Any) -> Any:
        """k·constant less the product as rounded, exactly; k is whole and below 2^27."""
        if self._fused:
            return self._intrinsic("llvm.fma", k, self.number(constant), self.negative(product))
        high = _SPLIT * constant - (_SPLIT * constant - constant)
        rest = self.sub(self.mul(k, self.number(high)), product)
        return self.add(rest, self.mul(k, self.number(constant - high)))

    def less_multiple(self, angle: Any, k: Any, constant: float) -> Any:
        """What k·constant leaves of the angle, exactly: the two nearly cancel."""
        if self._fused:
            return self.minus(angle, k, self.number(constant))
        product = self.mul(k, self.number(constant))
        return self.sub(self.sub(angle, product), self.lost(k, constant, product))

    def bits(self, x: Any) -> Any:
        return self._builder.bitcast(x, self._integer)

    def odd(self, whole: Any) -> Any:
        return self._builder.trunc(whole, ir.IntType(1))

    def turned(self, x: Any, quadrant: Any, one_more: bool) -> Any:
        """`x` negated where the second bit of the quadrant, or of the one after it, is set."""
        if one_more:
            quadrant = self._builder.add(quadrant, ir.Constant(self._integer, 1))
        sign = self._builder.and_(quadrant, ir.Constant(self._integer, 2))
        flipped = self._builder.xor(
            self.bits(x), self._builder.shl(sign, ir.Constant(self._integer, self._integer.width - 2))
        )
        return self._builder.bitcast(flipped, self._real)

    def _intrinsic(self, name: str, *arguments: Any) -> Any:
        return intrinsic(self._builder, self._real, name, *arguments)
