"""The formula tree: a dozen frozen nodes. Passes over it are functions in the modules beside this one.

`parse` makes trees with `Reference`, `Name` and `TableReference` leaves, as written. `resolve` replaces these by
`Cell` and `Area` leaves, seen from one host cell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, assert_never

from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell

if TYPE_CHECKING:
    from xlmc.excel.functions.registry import Function

__all__ = [
    "Array",
    "Binary",
    "Call",
    "Corner",
    "ErrorLiteral",
    "Expression",
    "FunctionName",
    "Invoke",
    "Lambda",
    "Let",
    "Logical",
    "Missing",
    "Name",
    "Number",
    "Reference",
    "TableReference",
    "Text",
    "Unary",
    "Variable",
    "chain",
    "formula_text",
    "marked_as",
]


@dataclass(frozen=True, slots=True)
class Number:
    """`12.5`."""

    value: float


@dataclass(frozen=True, slots=True)
class Text:
    """`"abc"`."""

    value: str


@dataclass(frozen=True, slots=True)
class Logical:
    """`TRUE`, `FALSE`."""

    value: bool


@dataclass(frozen=True, slots=True)
class ErrorLiteral:
    """`#N/A`.

    Attributes:
        name: the defined name that is not there, where it is the `#NAME?` of one.
    """

    code: ErrorCode
    name: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Missing:
    """The argument left out in `IF(a,,b)`."""


@dataclass(frozen=True, slots=True)
class Corner:
    """One corner of a reference. A whole column has no row, a whole row no column; `$` fixes either."""

    row: int | None
    column: int | None
    row_fixed: bool = False
    column_fixed: bool = False


@dataclass(frozen=True, slots=True)
class Reference:
    """`B7`, `$A$1:B2`, `C:C`, `Data!A1`; `last_sheet` of `Jan:Dec!A1`; `book` of `[1]Data!A1`."""

    first: Corner
    last: Corner | None = None
    sheet: str | None = None
    last_sheet: str | None = None
    book: str | None = None


@dataclass(frozen=True, slots=True)
class Name:
    """A defined name, `Rate` or `Data!Rate`."""

    name: str
    sheet: str | None = None
    book: str | None = None


@dataclass(frozen=True, slots=True)
class TableReference:
    """`Table1[[#This Row],[a]:[b]]`: `table` is None in `[@x]`; `items` are folded, `#this row` among them."""

    table: str | None
    items: tuple[str, ...] = ()
    first: str | None = None
    last: str | None = None


@dataclass(frozen=True, slots=True)
class Unary:
    """`-x`, `+x`, and the postfix `x%`."""

    operator: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class Binary:
    """`x + y` and the rest; `:` makes a range, a blank intersects, `,` joins references.

    Attributes:
        last: it is the `+` or `-` that a cell's formula ends with, outside of all brackets: Excel makes 0 of a
            result that cancels but for the last bits.
        all_bits: it compares numbers to the last bit, as xlmc does with the limits in its tables; a comparison in a
            formula is one at 15 digits.
    """

    operator: str
    left: Expression
    right: Expression
    last: bool = field(default=False, kw_only=True)
    all_bits: bool = field(default=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Call:
    """`SUM(x, y)`: the name in capitals, without `_xlfn.`. `@x` is `SINGLE(x)`, `A1#` is `ANCHORARRAY(A1)`.

    Attributes:
        foreign: whether the file marks it as of an add-in (`_xll.`, `[1]!`) or of a newer Excel (`_xlfn.`).
        given: what computes it, where it is a function that no file holds; None for one of the registry.
    """

    name: str
    arguments: tuple[Expression, ...]
    foreign: bool = field(default=False, compare=False)
    given: Function | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Variable:
    """A name that `LET` or `LAMBDA` binds, folded."""

    name: str


@dataclass(frozen=True, slots=True)
class Let:
    """`LET(x, 1, y, x+1, body)`: each binding sees those before it, and itself if `recursive`, as defined names may."""

    bindings: tuple[tuple[str, Expression], ...]
    body: Expression
    recursive: bool = False


@dataclass(frozen=True, slots=True)
class Lambda:
    """`LAMBDA(x, y, body)`: so many of the last parameters are `optional`, which Excel shows in square brackets."""

    parameters: tuple[str, ...]
    body: Expression
    optional: int = 0


@dataclass(frozen=True, slots=True)
class FunctionName:
    """A function of Excel given as a value, `BYROW(A1:C3, SUM)`: its name in capitals."""

    name: str


@dataclass(frozen=True, slots=True)
class Invoke:
    """A `LAMBDA`, or a variable or name that stands for one, called with arguments."""

    function: Expression
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Array:
    """`{1,2;3,4}`."""

    rows: tuple[tuple[Expression, ...], ...]


Expression = (
    Number
    | Text
    | Logical
    | ErrorLiteral
    | Missing
    | Reference
    | Name
    | TableReference
    | Cell
    | Area
    | Unary
    | Binary
    | Call
    | Variable
    | Let
    | Lambda
    | FunctionName
    | Invoke
    | Array
)


def chain(tree: Expression) -> tuple[Expression, list[tuple[str, Expression]]]:
    """Split `a + b - c` into `a` and `[("+", b), ("-", c)]`; anything but a binary operation is itself and nothing.

    Long sums lean to the left, one level a term: passes walk them in a loop, and recurse only into brackets. Operators
    that make references (`:`, blank, `,`) are never in one chain with others.
    """
    rest: list[tuple[str, Expression]] = []
    joins = isinstance(tree, Binary) and tree.operator in ":, "
    while isinstance(tree, Binary) and (tree.operator in ":, ") is joins:
        rest.append((tree.operator, tree.right))
        tree = tree.left
    return tree, rest[::-1]


def marked_as(built: Expression, tree: Binary) -> Expression:
    """Rebuild a binary operation from its parts, with the marks of that operation itself."""
    if not isinstance(built, Binary) or not (tree.last or tree.all_bits):
        return built
    return replace(built, last=tree.last, all_bits=tree.all_bits)


_PARAMETER: Final = "_xlpm."
"""What files put before a variable: without it, `x:y` would be two columns."""

_OPTIONAL: Final = "_xlop."
_FUNCTION: Final = "_xleta."
"""What they put before a parameter that may be left out, and before a function that is given as a value."""


def formula_text(tree: Expression, name: Callable[[Cell | Area], str] = str) -> str:
    """Write a resolved tree without its leading `=`, every operation in brackets of its own."""
    match tree:
        case Cell() | Area():
            return name(tree)
        case Number(value):
            return repr(value) if value >= 0 else f"({value!r})"
        case Text(value):
            return '"' + value.replace('"', '""') + '"'
        case Logical(value):
            return "TRUE" if value else "FALSE"
        case ErrorLiteral(code):
            return code.text
        case Missing():
            return ""
        case Unary("%", operand):
            return f"({formula_text(operand, name)}%)"
        case Unary(operator, operand):
            return f"({operator}({formula_text(operand, name)}))"
        case Binary():
            first, rest = chain(tree)
            terms = [f"{operator}{formula_text(right, name)})" for operator, right in rest]
            return "(" * len(terms) + formula_text(first, name) + "".join(terms)
        case Call(function, arguments):
            return f"{function}({','.join(formula_text(part, name) for part in arguments)})"
        case Variable(variable):
            return _PARAMETER + variable
        case FunctionName(function):
            return _FUNCTION + function
        case Let(bindings, body):
            pairs = (f"{_PARAMETER}{bound},{formula_text(value, name)}" for bound, value in bindings)
            return f"LET({','.join(pairs)},{formula_text(body, name)})"
        case Lambda(parameters, body, optional):
            needed = len(parameters) - optional
            bound = ((_PARAMETER if i < needed else _OPTIONAL) + name_ for i, name_ in enumerate(parameters))
            return f"LAMBDA({','.join([*bound, formula_text(body, name)])})"
        case Invoke(called, arguments):
            return f"{formula_text(called, name)}({','.join(formula_text(part, name) for part in arguments)})"
        case Array(rows):
            return "{" + ";".join(",".join(formula_text(part, name) for part in row) for row in rows) + "}"
        case Reference() | Name() | TableReference():
            raise TypeError(f"not resolved: {tree}")
        case _:
            assert_never(tree)
