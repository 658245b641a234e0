"""How the loop computes each node: operators and functions of single values as instructions, and choices.

A function that is neither here nor in `sets` has a body in NumPy, and runs there. To compare with a constant at 15
digits (see `functions.fifteen_digits`), the loop compares with the first or last double that is equal to it. Trials in
which two numbers that vary nearly agree are left to the careful path.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from llvmlite import ir

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Node, Select
from xlmc.engine.llvm.lookups import lookup_rule
from xlmc.engine.llvm.loop_arithmetic import Arithmetic, arccosine, arcsine, arctangent, arctangent_of_two
from xlmc.engine.llvm.loop_powers import common_logarithm, exponential, logarithm, power
from xlmc.engine.llvm.loop_rounding import (
    MOST_DIGITS,
    ROUNDED,
    down_to_whole,
    is_even,
    nearest_multiple,
    round_to,
    whole_quotient,
)
from xlmc.engine.llvm.loop_rules import (
    PLAIN,
    Emit,
    Emitter,
    Literal,
    LoopRule,
    Operand,
    first_operand,
    literal,
    part_of,
)
from xlmc.engine.llvm.sets import over_cells
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.denormals import TINIEST
from xlmc.excel.functions.fifteen_digits import EIGHT_UNITS, EXCHANGED, NEAR, SNAP_TO_ZERO, Comparison, equal_range

__all__ = ["loop_rule_of"]

_RELATIONS: Final = {"=": "==", "<>": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}

_INTEGER: Final = ir.IntType(64)
_EXPONENT: Final = 0x7FF << 52
"""The bits of a double that hold its power of two."""

_ALL: Final = range(255)

_FEW: Final = 63
"""Cells that the loop reads at once, though there are nodes that take them one by one."""

_NO_FRACTION: Final = 2.0**52
_TINY_DIVISOR: Final = 1e-290

_LEAST_DIVISOR: Final = 2.0**-64

_LARGEST_ANGLE: Final = 2.0**27
"""Excel refuses the sine of a larger angle: the trial is computed again."""


def loop_rule_of(dag: Dag, node: int) -> LoopRule | None:
    """How the loop computes a node; None if it cannot."""
    kind = dag.types[node]
    if dag.sizes[node] is not None or kind not in PLAIN:
        return None
    rule, folded = _rule(dag, dag.nodes[node], kind), dag.folded.get(node)
    if rule is not None and (folded is None or len(rule.operands) <= _FEW):
        return rule
    if folded is not None and not isinstance(dag.nodes[folded], Constant):  # a count is one only if no cell is an error
        return LoopRule((Operand(folded, Kind.NUMBER),), first_operand, makes=False)
    return None


def _rule(dag: Dag, node: Node, kind: Kind) -> LoopRule | None:
    match node:
        case Apply():
            return _operation(dag, node) or lookup_rule(dag, node) or over_cells(dag, node)
        case Select(condition, yes, no):
            taken = (condition, Kind.LOGICAL), (yes, kind), (no, kind)
            return _of_single_values(dag, taken, _Row(_choose, makes=False))
        case IfErrorNode(value) if dag.types[value] is kind:
            # Where the value may be an error the trial is computed again: the other value is never needed here.
            return _of_single_values(dag, [(value, kind)], _Row(first_operand, makes=False))
        case _:
            return None


def _choose(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.select(*parts)


@dataclass(frozen=True, slots=True)
class _Row:
    """See `LoopRule`. `kinds` are the kinds allowed for an argument that the function takes as any kind."""

    emit: Emit
    absorbs: Container[int] = ()
    makes: bool = True
    kinds: Sequence[Kind] = (Kind.NUMBER,)


def _of_single_values(dag: Dag, taken: Iterable[tuple[int, Kind]], row: _Row) -> LoopRule | None:
    """Return the rule of a function of nodes that are taken as these kinds; None if one cannot be."""
    operands = []
    for node, kind in taken:
        if kind is Kind.ANY:
            kind = dag.types[node]
            if kind not in row.kinds:
                return None
        part = part_of(dag, node, kind)
        if part is None:
            return None
        operands.append(part)
    return LoopRule(tuple(operands), row.emit, row.absorbs, row.makes)


def _operation(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of a function of single values; otherwise None."""
    function, arguments = node
    if isinstance(function.ufunc, Comparison):
        return _compare(dag, node, function.ufunc.symbol)
    row = _power(dag, node) if function.name == "^" else _ROWS.get(function.name)
    if row is not None:
        kinds = _kinds(function)
        return _of_single_values(dag, zip(arguments, kinds, strict=True), row) if len(arguments) == len(kinds) else None
    if function.name == "LOG":
        return _logarithm(dag, node)
    return _rounding(dag, node) if function.name in ROUNDED else None


@cache
def _kinds(function: Function) -> tuple[Kind, ...]:
    """Return the kinds of the parameters of a function that has a row."""
    return tuple([parameter.kind for parameter in function.parameters])


def _instruction(name: str, *absorbs: int) -> _Row:
    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        return getattr(body.builder, name)(*parts)

    return _Row(emit, absorbs)


def _quotient(body: Emitter, parts: Sequence[Any]) -> Any:
    """Emit a division; by a number in the code, without the slow instruction for it.

    The trials of numbers that are too small for that are computed again.
    """
    dividend, divisor = parts
    known = divisor.constant if isinstance(divisor, ir.Constant) else 0.0
    if not _LEAST_DIVISOR <= abs(known) <= 1 / _LEAST_DIVISOR:
        return body.builder.fdiv(dividend, divisor)
    value, too_small = body.of_doubles(Arithmetic.quotient, dividend, known)
    if too_small is not None:
        body.flag(too_small)
    return value


def _comparison(relation: str) -> _Row:
    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        return body.builder.fcmp_ordered(relation, *parts)

    return _Row(emit, _ALL)


def _fixed_answer(answer: bool) -> _Row:
    """Answer a question about a value's kind, which has one answer: a trial with an error is computed again."""
    return _Row(lambda body, parts: body.truth(answer), _ALL, kinds=PLAIN)


def _sign(body: Emitter, parts: Sequence[Any]) -> Any:
    zero = body.number(0.0)
    above, below = (body.builder.fcmp_ordered(relation, parts[0], zero) for relation in (">", "<"))
    negative = body.builder.select(below, body.number(-1.0), zero)
    return body.builder.select(above, body.number(1.0), negative)


def _of_angle(body: Emitter, angle: Any) -> tuple[Any, Any]:
    """Sine and cosine; angles too large are flagged, NaN among them."""
    size = body.intrinsic("llvm.fabs", angle)
    body.flag(body.builder.fcmp_unordered(">=", size, body.number(_LARGEST_ANGLE)))
    return body.sine_and_cosine(angle)


def _sine(body: Emitter, parts: Sequence[Any]) -> Any:
    return _of_angle(body, parts[0])[0]


def _cosine(body: Emitter, parts: Sequence[Any]) -> Any:
    return _of_angle(body, parts[0])[1]


def _tangent(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(*_of_angle(body, parts[0]))


def _secant(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), _of_angle(body, parts[0])[1])


def _cosecant(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), _of_angle(body, parts[0])[0])


def _remainder(body: Emitter, parts: Sequence[Any]) -> Any:
    """Emit the exact remainder with the sign of the divisor, also of a zero; NaN by zero.

    Rounded, the quotient is never below a whole number that it reaches, and at most one step above those that it does
    not. So the rest by its whole part is exact, and has the other sign where that is one too large. Quotients that hold
    no fraction, and divisors whose rests may be too small, are left to the careful path.
    """
    (x, divisor), builder, zero = parts, body.builder, body.number(0.0)
    size = body.intrinsic("llvm.fabs", divisor)
    steps = body.intrinsic("llvm.trunc", builder.fdiv(x, divisor))
    body.flag(builder.fcmp_ordered(">=", body.intrinsic("llvm.fabs", steps), body.number(_NO_FRACTION)))
    body.flag(builder.fcmp_ordered("<", size, body.number(_TINY_DIVISOR)))
    rest = body.of_doubles(Arithmetic.less_product, x, steps, divisor)
    too_far = builder.fcmp_ordered("<", builder.fmul(_sign(body, [rest]), x), zero)
    rest = builder.select(too_far, builder.fadd(rest, body.intrinsic("llvm.copysign", size, x)), rest)
    apart = builder.xor(builder.fcmp_ordered("<", rest, zero), builder.fcmp_ordered("<", divisor, zero))
    moved = builder.select(apart, builder.fadd(rest, divisor), rest)
    none = body.intrinsic("llvm.copysign", zero, divisor)
    return builder.select(builder.fcmp_ordered("==", rest, zero), none, moved)


def _of_doubles(function: Callable[..., Any], *absorbs: int, makes: bool) -> _Row:
    return _Row(lambda body, parts: body.of_doubles(function, *parts), absorbs, makes)


def _root(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.intrinsic("llvm.sqrt", parts[0])


def _reciprocal(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), parts[0])


def _cube(body: Emitter, parts: Sequence[Any]) -> Any:
    return body.builder.fmul(body.flush(body.builder.fmul(parts[0], parts[0])), parts[0])


def _compare(dag: Dag, node: Apply, symbol: str) -> LoopRule | None:
    """How the loop compares two numbers."""
    if any(dag.types[node_id] is not Kind.NUMBER for node_id in node.arguments):
        return None
    left, right = (part_of(dag, node_id, Kind.NUMBER) for node_id in node.arguments)
    if left is None or right is None:
        return None
    if isinstance(left, Operand) and isinstance(right, Operand):
        return LoopRule((left, right), _of_two(symbol), _ALL)
    varying, known, relation = (left, right, symbol) if isinstance(right, Literal) else (right, left, EXCHANGED[symbol])
    assert isinstance(known, Literal)  # what is constant alone is no node of the loop
    least, most = equal_range(float(known.value))
    limits = {"<": [least], ">=": [least], "<=": [most], ">": [most]}.get(relation, [least, most])
    return LoopRule((varying, *map(Literal, limits)), _with_constant(relation), _ALL)


@cache
def _of_two(symbol: str) -> Emit:
    """How the loop compares two numbers that vary."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        body.flag(_may_be_equal(body, *parts))
        return body.builder.fcmp_ordered(_RELATIONS[symbol], *parts)

    return emit


def _may_be_equal(body: Emitter, x: Any, y: Any) -> Any:
    """Whether two numbers differ by so little that only their decimal digits tell whether they are equal."""
    builder = body.builder
    apart = body.intrinsic("llvm.fabs", builder.fsub(x, y))
    share = builder.fmul(body.intrinsic("llvm.fabs", x), body.number(NEAR))
    near = builder.fcmp_ordered("<=", apart, builder.fadd(share, body.number(TINIEST)))
    return builder.and_(near, builder.fcmp_ordered("!=", x, y))


@cache
def _with_constant(symbol: str) -> Emit:
    """How the loop compares a number with the ends of the range that is equal to a constant, or with one of them."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        number, *limits = parts
        compare = body.builder.fcmp_ordered
        if symbol == "=":
            return body.builder.and_(compare(">=", number, limits[0]), compare("<=", number, limits[1]))
        if symbol == "<>":
            return body.builder.or_(compare("<", number, limits[0]), compare(">", number, limits[1]))
        return compare(symbol, number, limits[0])

    return emit


def _last_sum(body: Emitter, parts: Sequence[Any]) -> Any:
    """0 where a sum is less than eight units in the last bit of its first number, else the sum."""
    total, first = parts
    builder = body.builder
    exponent = builder.and_(builder.bitcast(first, _INTEGER), ir.Constant(_INTEGER, _EXPONENT))
    limit = builder.fmul(builder.bitcast(exponent, body.real), body.number(EIGHT_UNITS))
    dust = builder.fcmp_ordered("<", body.intrinsic("llvm.fabs", total), limit)
    return builder.select(dust, body.number(0.0), total)


_POWERS: Final = {
    0.5: _Row(_root),
    1.0: _Row(first_operand, makes=False),
    -1.0: _Row(_reciprocal, (0,)),
    3.0: _Row(_cube),
}
"""Exponents that need no logarithm; the results are within 1 ulp, and 0 and infinity come out as of `pow`."""


def _power(dag: Dag, node: Apply) -> _Row:
    exponent = literal(dag, Operand(node.arguments[1], Kind.NUMBER))
    if exponent is None:
        return _Row(_power_of_any, (0, 1))
    value = float(exponent.value)
    return _POWERS.get(value) or _Row(_power_of_constant(value > 0, value.is_integer(), value % 2 == 1), (0, 1))


def _power_of_any(body: Emitter, parts: Sequence[Any]) -> Any:
    """Emit a power of any base; where the base is 0 or less, it is left to the careful path."""
    body.flag(body.builder.fcmp_ordered("<=", parts[0], body.number(0.0)))
    return body.of_doubles(power, *parts)


@cache
def _power_of_constant(positive: bool, whole: bool, odd: bool) -> Emit:
    """How the loop computes powers whose exponent is a constant of that kind."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        base, exponent = parts
        zero, compare = body.number(0.0), body.builder.fcmp_ordered
        if not whole:
            body.flag(compare("<", base, zero))
        if not positive:
            body.flag(compare("==", base, zero))
        value = body.of_doubles(power, body.intrinsic("llvm.fabs", base), exponent)
        if positive:
            value = body.builder.select(compare("==", base, zero), zero, value)
        return body.intrinsic("llvm.copysign", value, base) if odd else value

    return emit


def _logarithm(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of a logarithm to base 10; other bases are left to NumPy."""
    number, *base = node.arguments
    if base and literal(dag, Operand(base[0], Kind.NUMBER)) != Literal(10.0):
        return None
    return _of_single_values(dag, [(number, Kind.NUMBER)], _ROWS["LOG10"])


def _rounding(dag: Dag, node: Apply) -> LoopRule | None:
    """Return the rule of a rounding to digits that are known; others are left to NumPy."""
    number, *given = node.arguments
    known = literal(dag, Operand(given[0], Kind.NUMBER)) if given else Literal(0.0)
    digits = None if known is None else float(known.value)
    if digits is None or not abs(digits) < MOST_DIGITS + 1:
        return None
    row = _Row(round_to(node.function.name, int(digits)), absorbs=(0,), makes=digits < 0)
    return _of_single_values(dag, [(number, Kind.NUMBER)], row)


def _above_zero(function: Callable[..., Any]) -> _Row:
    """Make a function of numbers above 0; Excel refuses others: the trial is computed again."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        body.flag(body.builder.fcmp_ordered("<=", parts[0], body.number(0.0)))
        return body.of_doubles(function, *parts)

    return _Row(emit, (0,), makes=False)


_ROWS: Final[Mapping[str, _Row]] = {
    "+": _instruction("fadd"),
    "-": _instruction("fsub"),
    "*": _instruction("fmul"),
    "/": _Row(_quotient, (1,)),
    "u-": _Row(lambda body, parts: body.builder.fneg(parts[0]), makes=False),
    "%": _Row(lambda body, parts: _quotient(body, (parts[0], body.number(100.0)))),
    "=": _comparison("=="),
    "<>": _comparison("!="),
    "<": _comparison("<"),
    "<=": _comparison("<="),
    ">": _comparison(">"),
    ">=": _comparison(">="),
    SNAP_TO_ZERO.name: _Row(_last_sum, makes=False),
    "NOT": _Row(lambda body, parts: body.builder.not_(parts[0])),
    "ABS": _Row(lambda body, parts: body.intrinsic("llvm.fabs", parts[0]), makes=False),
    "SQRT": _Row(_root),
    "MOD": _Row(_remainder, (1,)),
    "SIGN": _Row(_sign, _ALL, makes=False),
    "INT": _Row(down_to_whole, (0,), makes=False),
    "MROUND": _Row(nearest_multiple),
    "QUOTIENT": _Row(whole_quotient, (1,)),
    "ISEVEN": _Row(is_even, _ALL),
    "ISODD": _Row(lambda body, parts: body.builder.not_(is_even(body, parts)), _ALL),
    "SIN": _Row(_sine, makes=False),
    "COS": _Row(_cosine, makes=False),
    "TAN": _Row(_tangent),
    "SEC": _Row(_secant),
    "CSC": _Row(_cosecant),
    "ATAN": _of_doubles(arctangent, 0, makes=False),
    "ATAN2": _of_doubles(arctangent_of_two, 0, 1, makes=True),
    "ASIN": _of_doubles(arcsine, makes=True),
    "ACOS": _of_doubles(arccosine, makes=True),
    "EXP": _of_doubles(exponential, 0, makes=True),
    "LN": _above_zero(logarithm),
    "LOG10": _above_zero(common_logarithm),
    "ISERROR": _fixed_answer(False),
    "ISERR": _fixed_answer(False),
    "ISNA": _fixed_answer(False),
    "ISTEXT": _fixed_answer(False),
    "ISBLANK": _fixed_answer(False),
    "ISNONTEXT": _fixed_answer(True),
}
