"""Excel's own random numbers, and inverse distribution functions of them: `NORM.INV(RAND(), m, s)` draws a Normal.

The inverse functions are recognised so that what is drawn is known by its name and parameters. Any other use of
`RAND()` is right, too: the formula goes on from a uniform draw.

Source: Microsoft's pages on `NORM.INV`, `BETA.INV`, … ; degrees of freedom and trials are cut to whole numbers there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area
from xlmc.excel.formula import ir
from xlmc.excel.formula.substitute import substitute
from xlmc.montecarlo.definitions.in_cells.call_arguments import is_left_out, number_of, quotient, whole_part
from xlmc.montecarlo.definitions.in_cells.call_draws import Arguments, Drawn, Properties, Signature
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.number_text import count_text

__all__ = ["INVERSES", "may_be_many", "random_draw"]

_RAND: Final = ir.Call("RAND", ())

_NORMAL = Signature("Normal", ("RAND", "mean", "std_dev"))
_STANDARD = Signature("Normal", ("RAND",), {"mean": 0.0, "std_dev": 1.0})
_BETA = Signature("Beta", ("RAND", "alpha", "beta"), {"low": 0.0, "high": 1.0})
_BETA_BETWEEN = Signature("Beta", ("RAND", "alpha", "beta", "low", "high"))
_GAMMA = Signature("Gamma", ("RAND", "shape", "scale"), {"location": 0.0})
_LOGNORMAL = Signature("Lognorm2", ("RAND", "mu", "sigma"), {"location": 0.0})
_STUDENT = Signature(
    "Student's t",
    ("RAND", "freedom"),
    {"midpoint": 0.0, "scale": 1.0},
    {"degrees": lambda given: whole_part(given["freedom"])},
)


def _half(given: Arguments) -> ir.Expression:
    return quotient(whole_part(given["freedom"]), ir.Number(2.0))


_CHI_SQUARE = Signature("Gamma", ("RAND", "freedom"), {"location": 0.0, "scale": 2.0}, {"shape": _half})
_BINOMIAL = Signature(
    "Binomial", ("number", "probability", "RAND"), computed={"trials": lambda given: whole_part(given["number"])}
)

INVERSES: Final = {
    "NORM.INV": (_NORMAL,),
    "NORMINV": (_NORMAL,),
    "NORM.S.INV": (_STANDARD,),
    "NORMSINV": (_STANDARD,),
    "BETA.INV": (_BETA, _BETA_BETWEEN),
    "BETAINV": (_BETA, _BETA_BETWEEN),
    "GAMMA.INV": (_GAMMA,),
    "GAMMAINV": (_GAMMA,),
    "LOGNORM.INV": (_LOGNORMAL,),
    "LOGINV": (_LOGNORMAL,),
    "T.INV": (_STUDENT,),
    "CHISQ.INV": (_CHI_SQUARE,),
    "BINOM.INV": (_BINOMIAL,),
    "CRITBINOM": (_BINOMIAL,),
}
"""Inverse function -> what its arguments are, `RAND` among them, by how many there are."""

_MOST: Final = 10_000
"""Draws of one `RANDARRAY`."""

_MAKING_ARRAYS: Final = frozenset({"RANDARRAY", "SEQUENCE", "MUNIT", "MAKEARRAY"})
"""Functions that give arrays of numbers alone."""


def random_draw(tree: ir.Expression) -> Drawn | None:
    """Return what a part of a formula draws with Excel's own functions; None if it is no draw.

    Raises:
        FormulaError: a call has arguments that it cannot have here.
    """
    match tree:
        case ir.Call("RAND", arguments):
            if arguments:
                raise FormulaError("RAND takes no arguments", hint="write RAND()")
            return _uniform("RAND")
        case ir.Call("RANDBETWEEN", arguments):
            return _between(arguments)
        case ir.Call("RANDARRAY", arguments):
            return _array(arguments)
        case ir.Unary("-", ir.Call("LN", (ir.Call("RAND", ()),))):
            return Drawn("-LN(RAND())", FAMILIES["Exponential"], {"rate": ir.Number(1.0)})
        case ir.Call(name, arguments) if name in INVERSES:
            return _inverse(name, arguments)
        case _:
            return None


def may_be_many(tree: ir.Expression, in_array: bool) -> bool:
    """Report whether an expression may give several values where one is meant.

    Args:
        tree: resolved.
        in_array: the formula is an array formula, in which a range gives all its values.
    """
    match tree:
        case ir.Array(rows):
            return len(rows) * len(rows[0]) > 1
        case Area():
            return in_array and tree.rows * tree.columns > 1
        case ir.Unary(_, operand):
            return may_be_many(operand, in_array)
        case ir.Binary(_, left, right):
            return may_be_many(left, in_array) or may_be_many(right, in_array)
        case ir.Call() | ir.Let() | ir.Invoke():
            return in_array and any(map(_gives_many, _parts(tree)))
        case _:
            return False


def _gives_many(part: ir.Expression) -> bool:
    if isinstance(part, ir.Call):
        return part.name in _MAKING_ARRAYS
    return isinstance(part, ir.Array | Area) and may_be_many(part, in_array=True)


def _parts(tree: ir.Expression) -> list[ir.Expression]:
    result: list[ir.Expression] = []
    substitute(tree, result.append)
    return result


def _inverse(name: str, arguments: tuple[ir.Expression, ...]) -> Drawn | None:
    """Return the draw of an inverse function where its probability is `RAND()` itself."""
    for signature in INVERSES[name]:
        index = signature.takes.index("RAND")
        fits = len(signature.takes) == len(arguments) and not any(map(is_left_out, arguments))
        if fits and arguments[index] == _RAND:
            return signature.drawn(name, arguments, Properties())
    return None


def _uniform(function: str) -> Drawn:
    return Drawn(function, FAMILIES["Uniform"], {"low": ir.Number(0.0), "high": ir.Number(1.0)})


def _between(arguments: tuple[ir.Expression, ...]) -> Drawn:
    if len(arguments) != 2 or any(map(is_left_out, arguments)):
        raise FormulaError("RANDBETWEEN takes two numbers", hint="write RANDBETWEEN(lowest, highest)")
    return _whole_numbers("RANDBETWEEN", *arguments)


def _whole_numbers(function: str, low: ir.Expression, high: ir.Expression) -> Drawn:
    """Whole numbers from `low`, raised to the next one, to `high`, lowered to the next one."""
    raised = ir.Unary("-", whole_part(ir.Unary("-", low)))
    return Drawn(function, FAMILIES["Discrete Uniform"], {"low": raised, "high": whole_part(high)})


def _array(arguments: tuple[ir.Expression, ...]) -> Drawn:
    if len(arguments) > 5:
        raise FormulaError(f"RANDARRAY has {len(arguments)} arguments; it takes 0 to 5")
    given = [*arguments, *[ir.Missing()] * (5 - len(arguments))]
    rows, columns, low, high, whole = given
    low = ir.Number(0.0) if is_left_out(low) else low
    high = ir.Number(1.0) if is_left_out(high) else high
    if not isinstance(whole, ir.Missing | ir.Logical):
        raise FormulaError("RANDARRAY's last argument must be TRUE or FALSE here", hint="write TRUE for whole numbers")
    is_whole = isinstance(whole, ir.Logical) and whole.value
    drawn = (
        _whole_numbers("RANDARRAY", low, high)
        if is_whole
        else Drawn("RANDARRAY", FAMILIES["Uniform"], {"low": low, "high": high})
    )
    size = _size(rows), _size(columns)
    if size[0] * size[1] > _MOST:
        raise _too_many()
    return drawn if size == (1, 1) else replace(drawn, grid=size)


def _size(tree: ir.Expression) -> int:
    number = 1.0 if is_left_out(tree) else number_of(tree)
    if number is None or not 1 <= number <= _MOST:
        raise _too_many()
    return int(number)


def _too_many() -> FormulaError:
    hint = "write its rows and columns as numbers, so that each draw keeps its own stream"
    return FormulaError(f"RANDARRAY must have a fixed size of 1 to {count_text(_MOST)} draws", hint=hint)
