"""Operators and functions of single values as instructions. What is not here has a body in NumPy, and runs there."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from xlmc.evaluation.graph.dag import Apply, Dag
from xlmc.evaluation.llvm.arcsine import arccosine, arcsine
from xlmc.evaluation.llvm.arctangent import arctangent, arctangent_of_two
from xlmc.evaluation.llvm.fifteen_digits import at_15_digits, settled
from xlmc.evaluation.llvm.recipes import PLAIN, Emit, Operand, Recipe, literal
from xlmc.functions import Kind
from xlmc.functions.fifteen_digits import SETTLED, Comparison

if TYPE_CHECKING:
    from xlmc.evaluation.llvm.body import Body

__all__ = ["operation"]

_ALL: Final = range(255)


@dataclass(frozen=True, slots=True)
class _Row:
    """See `Recipe`. `kinds` are the kinds that an argument of any kind may be of."""

    emit: Emit
    absorbs: Container[int] = ()
    makes: bool = True
    kinds: Sequence[Kind] = (Kind.NUMBER,)


def operation(dag: Dag, node: Apply) -> Recipe | None:
    """The recipe of a function of single values; None where there is none."""
    row = _row(dag, node)
    if row is None or len(node.arguments) != len(node.function.parameters):
        return None
    operands = []
    for position, place in enumerate(node.arguments):
        kind = node.function.parameter(position).kind
        if kind is Kind.ANY:
            kind = dag.types[place]
            if kind not in row.kinds:
                return None
        operands.append(Operand(place, kind))
    return Recipe(tuple(operands), row.emit, row.absorbs, row.makes)


def _row(dag: Dag, node: Apply) -> _Row | None:
    function = node.function
    if isinstance(function.ufunc, Comparison):
        return _Row(at_15_digits(dag, node, function.ufunc.symbol), _ALL)
    return _power(dag, node) if function.name == "^" else _ROWS.get(function.name)


def _instruction(name: str, *absorbs: int) -> _Row:
    def emit(body: Body, parts: Sequence[Any]) -> Any:
        return getattr(body.builder, name)(*parts)

    return _Row(emit, absorbs)


def _comparison(relation: str) -> _Row:
    def emit(body: Body, parts: Sequence[Any]) -> Any:
        return body.builder.fcmp_ordered(relation, *parts)

    return _Row(emit, _ALL)


def _known(answer: bool) -> _Row:
    """What is asked of a value's kind, where that is certain: were it an error the trial would be computed again."""
    return _Row(lambda body, parts: body.truth(answer), _ALL, kinds=PLAIN)


def _sign(body: Body, parts: Sequence[Any]) -> Any:
    zero = body.number(0.0)
    above, below = (body.builder.fcmp_ordered(relation, parts[0], zero) for relation in (">", "<"))
    negative = body.builder.select(below, body.number(-1.0), zero)
    return body.builder.select(above, body.number(1.0), negative)


def _of_angle(body: Body, angle: Any) -> tuple[Any, Any]:
    """Sine and cosine; angles too large are flagged, NaN among them."""
    size = body.intrinsic("llvm.fabs", angle)
    body.flag(body.builder.fcmp_unordered(">=", size, body.number(body.largest_angle)))
    return body.sine_and_cosine(angle)


def _sine(body: Body, parts: Sequence[Any]) -> Any:
    return _of_angle(body, parts[0])[0]


def _cosine(body: Body, parts: Sequence[Any]) -> Any:
    return _of_angle(body, parts[0])[1]


def _tangent(body: Body, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(*_of_angle(body, parts[0]))


def _secant(body: Body, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), _of_angle(body, parts[0])[1])


def _cosecant(body: Body, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), _of_angle(body, parts[0])[0])


def _remainder(body: Body, parts: Sequence[Any]) -> Any:
    """Exact, then with the sign of the divisor, a zero too; NaN by zero."""
    builder, zero, divisor = body.builder, body.number(0.0), parts[1]
    rest = builder.frem(*parts)
    apart = builder.xor(builder.fcmp_ordered("<", rest, zero), builder.fcmp_ordered("<", divisor, zero))
    moved = builder.select(apart, builder.fadd(rest, divisor), rest)
    none = body.intrinsic("llvm.copysign", zero, divisor)
    return builder.select(builder.fcmp_ordered("==", rest, zero), none, moved)


def _of_doubles(function: Callable[..., Any], *absorbs: int, makes: bool) -> _Row:
    return _Row(lambda body, parts: body.of_doubles(function, *parts), absorbs, makes)


def _root(body: Body, parts: Sequence[Any]) -> Any:
    return body.intrinsic("llvm.sqrt", parts[0])


def _reciprocal(body: Body, parts: Sequence[Any]) -> Any:
    return body.builder.fdiv(body.number(1.0), parts[0])


def _cube(body: Body, parts: Sequence[Any]) -> Any:
    return body.builder.fmul(body.flushed(body.builder.fmul(parts[0], parts[0])), parts[0])


_POWERS: Final = {
    0.5: _Row(_root),
    1.0: _Row(lambda _, parts: parts[0], makes=False),
    -1.0: _Row(_reciprocal, (0,)),
    3.0: _Row(_cube),
}
"""Exponents that need no logarithm; the results are within 1 ulp, and 0 and infinity come out as of `pow`."""


def _power(dag: Dag, node: Apply) -> _Row | None:
    exponent = literal(dag, Operand(node.arguments[1], Kind.NUMBER))
    return None if exponent is None else _POWERS.get(float(exponent.value))


_ROWS: Final[Mapping[str, _Row]] = {
    "+": _instruction("fadd"),
    "-": _instruction("fsub"),
    "*": _instruction("fmul"),
    "/": _instruction("fdiv", 1),
    "u-": _Row(lambda body, parts: body.builder.fneg(parts[0]), makes=False),
    "%": _Row(lambda body, parts: body.builder.fdiv(parts[0], body.number(100.0))),
    "=": _comparison("=="),
    "<>": _comparison("!="),
    "<": _comparison("<"),
    "<=": _comparison("<="),
    ">": _comparison(">"),
    ">=": _comparison(">="),
    SETTLED.name: _Row(settled, makes=False),
    "NOT": _Row(lambda body, parts: body.builder.not_(parts[0])),
    "ABS": _Row(lambda body, parts: body.intrinsic("llvm.fabs", parts[0]), makes=False),
    "SQRT": _Row(_root),
    "MOD": _Row(_remainder, (1,)),
    "SIGN": _Row(_sign, _ALL, makes=False),
    "SIN": _Row(_sine, makes=False),
    "COS": _Row(_cosine, makes=False),
    "TAN": _Row(_tangent),
    "SEC": _Row(_secant),
    "CSC": _Row(_cosecant),
    "ATAN": _of_doubles(arctangent, 0, makes=False),
    "ATAN2": _of_doubles(arctangent_of_two, 0, 1, makes=True),
    "ASIN": _of_doubles(arcsine, makes=True),
    "ACOS": _of_doubles(arccosine, makes=True),
    "ISERROR": _known(False),
    "ISERR": _known(False),
    "ISNA": _known(False),
    "ISTEXT": _known(False),
    "ISBLANK": _known(False),
    "ISNONTEXT": _known(True),
}
