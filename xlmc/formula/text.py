"""A resolved tree back to formula text, with every reference under a name of the caller's choice."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, assert_never

from xlmc.address import Area, Cell
from xlmc.formula import ir

__all__ = ["formula_text"]

_PARAMETER: Final = "_xlpm."
"""What files put before a variable: without it, `x:y` would be two columns."""

_OPTIONAL: Final = "_xlop."
_FUNCTION: Final = "_xleta."
"""What they put before a parameter that may be left out, and before a function that is given as a value."""


def formula_text(tree: ir.Expression, name: Callable[[Cell | Area], str] = str) -> str:
    """The text of a resolved tree without its leading `=`, every operation in brackets of its own."""
    match tree:
        case Cell() | Area():
            return name(tree)
        case ir.Number(value):
            return repr(value) if value >= 0 else f"({value!r})"
        case ir.Text(value):
            return '"' + value.replace('"', '""') + '"'
        case ir.Logical(value):
            return "TRUE" if value else "FALSE"
        case ir.ErrorLiteral(code):
            return code.text
        case ir.Missing():
            return ""
        case ir.Unary("%", operand):
            return f"({formula_text(operand, name)}%)"
        case ir.Unary(operator, operand):
            return f"({operator}({formula_text(operand, name)}))"
        case ir.Binary():
            first, rest = ir.chain(tree)
            terms = [f"{operator}{formula_text(right, name)})" for operator, right in rest]
            return "(" * len(terms) + formula_text(first, name) + "".join(terms)
        case ir.Call(function, arguments):
            return f"{function}({','.join(formula_text(part, name) for part in arguments)})"
        case ir.Variable(variable):
            return _PARAMETER + variable
        case ir.FunctionName(function):
            return _FUNCTION + function
        case ir.Let(bindings, body):
            pairs = (f"{_PARAMETER}{bound},{formula_text(value, name)}" for bound, value in bindings)
            return f"LET({','.join(pairs)},{formula_text(body, name)})"
        case ir.Lambda(parameters, body, optional):
            needed = len(parameters) - optional
            bound = ((_PARAMETER if i < needed else _OPTIONAL) + name_ for i, name_ in enumerate(parameters))
            return f"LAMBDA({','.join([*bound, formula_text(body, name)])})"
        case ir.Invoke(called, arguments):
            return f"{formula_text(called, name)}({','.join(formula_text(part, name) for part in arguments)})"
        case ir.Array(rows):
            return "{" + ";".join(",".join(formula_text(part, name) for part in row) for row in rows) + "}"
        case ir.Reference() | ir.Name() | ir.TableReference():
            raise TypeError(f"not resolved: {tree}")
        case _:
            assert_never(tree)
