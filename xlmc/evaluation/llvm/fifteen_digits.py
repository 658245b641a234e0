"""Comparisons at 15 digits, and the last sum of a formula, in the loop. See `functions.fifteen_digits`, `last_sum`.

A comparison with a constant is one with the last double that is equal to it. Two numbers that vary and nearly agree
are left to the careful path, trial by trial.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from llvmlite import ir

from xlmc.evaluation.graph.dag import Apply, Dag
from xlmc.evaluation.llvm.recipes import Emit, Operand, literal
from xlmc.functions import Kind
from xlmc.functions.denormals import TINIEST
from xlmc.functions.fifteen_digits import EIGHT_UNITS, NEAR, TWINS, equals

if TYPE_CHECKING:
    from xlmc.evaluation.llvm.body import Body

__all__ = ["at_15_digits", "settled"]

_RELATIONS: Final = {"=": "==", "<>": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}

_INTEGER: Final = ir.IntType(64)
_EXPONENT: Final = 0x7FF << 52
"""The bits of a double that hold its power of two."""


def at_15_digits(dag: Dag, node: Apply, symbol: str) -> Emit:
    """How the loop compares two numbers."""
    left, right = (literal(dag, Operand(place, Kind.NUMBER)) for place in node.arguments)
    if right is not None:
        return _with_constant(symbol, 0, float(right.value))
    if left is not None:
        return _with_constant(TWINS[symbol], 1, float(left.value))

    def emit(body: Body, parts: Sequence[Any]) -> Any:
        body.flag(_nearly_equal(body, *parts))
        return body.builder.fcmp_ordered(_RELATIONS[symbol], *parts)

    return emit


def _nearly_equal(body: Body, x: Any, y: Any) -> Any:
    """Whether two numbers differ by so little that their digits must be counted."""
    builder = body.builder
    apart = body.intrinsic("llvm.fabs", builder.fsub(x, y))
    share = builder.fmul(body.intrinsic("llvm.fabs", x), body.number(NEAR))
    near = builder.fcmp_ordered("<=", apart, builder.fadd(share, body.number(TINIEST)))
    return builder.and_(near, builder.fcmp_ordered("!=", x, y))


def _with_constant(symbol: str, varying: int, number: float) -> Emit:
    """How the loop compares one of its operands with a constant."""
    least, most = equals(number)

    def emit(body: Body, parts: Sequence[Any]) -> Any:
        def is_(relation: str, limit: float) -> Any:
            return body.builder.fcmp_ordered(relation, parts[varying], body.number(limit))

        match symbol:
            case "<" | ">=":
                return is_(symbol, least)
            case "<=" | ">":
                return is_(symbol, most)
            case "=":
                return body.builder.and_(is_(">=", least), is_("<=", most))
            case _:
                return body.builder.or_(is_("<", least), is_(">", most))

    return emit


def settled(body: Body, parts: Sequence[Any]) -> Any:
    """0 where a sum is within eight units in the last place of its first number, else the sum."""
    total, first = parts
    builder = body.builder
    exponent = builder.and_(builder.bitcast(first, _INTEGER), ir.Constant(_INTEGER, _EXPONENT))
    limit = builder.fmul(builder.bitcast(exponent, body.real), body.number(EIGHT_UNITS))
    dust = builder.fcmp_ordered("<", body.intrinsic("llvm.fabs", total), limit)
    return builder.select(dust, body.number(0.0), total)
