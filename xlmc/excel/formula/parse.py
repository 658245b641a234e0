r"""Formula text to tree, through the tokenizer and the shunting-yard of `formulas`.

    formula   = expression
    operand   = number | "text" | TRUE | #ERROR! | reference | name | table[…] | {array} | (expression) | FN(arguments)
    reference = [prefix!] ( A1 | A1:B2 | A:B | 1:2 | name )          prefix = Sheet | 'a sheet' | First:Last | [1]Sheet
    operators = from tightest:  : blank ,   - + @ (before)   % # (after)   ^   * /   + -   &   = < > <= >= <>

`formulas` reads tokens by a list of classes and hands the postfix stream to a builder; both are class attributes of its
`Parser`. The classes are ours (`formula_tokens.py`), and our builder makes tree nodes. The stack machine is theirs.
Nothing but these two modules imports `formulas`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import accumulate
from typing import Any

import numpy as np
from formulas.errors import FormulaError as ForeignFormulaError
from formulas.errors import TokenError
from formulas.parser import Parser
from formulas.tokens.function import Function as FunctionToken
from formulas.tokens.operand import Empty, XlError
from formulas.tokens.operand import Error as ErrorToken
from schedula import EMPTY, DispatcherError

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.formula import ir
from xlmc.excel.formula.formula_tokens import (
    QUOTED,
    Invocation,
    Leaf,
    absolute_reference,
    opens_array,
    tokens_at,
    without_line_breaks,
)
from xlmc.excel.formula.reference_text import prefix

__all__ = ["compile_with_formulas", "parse", "parse_cell"]

_LONGEST = 4 * 8192
"""Characters of a formula in a file, where functions have prefixes and tables their long names."""

_ADD_INS = ("CB.", "RISK")
"""Functions before which the file of their add-in may stand, in quotes like a sheet: `'CB.xla'!CB.GetForeStatFN(`."""


class _TreeBuilder:
    """Takes the postfix stream, and keeps one tree for each completed operand."""

    def __init__(self, match: object = None) -> None:
        self._operands: list[ir.Expression] = []

    def __len__(self) -> int:
        return len(self._operands)

    def __getitem__(self, index: int) -> ir.Expression:
        return self._operands[index]

    def append(self, token: Any) -> None:
        self._operands.append(self._node(token))

    def finish(self) -> None:
        """Nothing waits: every node was made when its last operand came."""

    def _node(self, token: Any) -> ir.Expression:
        if isinstance(token, Leaf):
            return token.node
        if isinstance(token, Empty):
            return ir.Missing()
        if isinstance(token, Invocation):
            called, *arguments = self._take(token.get_n_args + 1)
            if not isinstance(called, ir.Call | ir.Invoke):
                raise ForeignFormulaError
            return ir.Invoke(called, tuple(arguments))
        operands = self._take(token.get_n_args)
        return _call(token, operands) if isinstance(token, FunctionToken) else _operation(token.name, operands)

    def _take(self, count: int) -> tuple[ir.Expression, ...]:
        if count > len(self._operands):
            raise ForeignFormulaError
        cut = len(self._operands) - count
        taken = tuple(self._operands[cut:])
        del self._operands[cut:]
        return taken


def _call(token: Any, arguments: tuple[ir.Expression, ...]) -> ir.Expression:
    if not opens_array(token):
        name = re.sub(r"^(_xlfn\.|_xlws\.|_xll\.|_xludf\.)+", "", token.name, flags=re.IGNORECASE)
        sheet, _, book = prefix(token.attr)
        if sheet is not None and not name.upper().startswith(_ADD_INS):
            return ir.Invoke(ir.Name(name, sheet, book), arguments)
        elsewhere = book not in (None, "[0]")  # [0] is this book
        return ir.Call(name.upper(), arguments, elsewhere or sheet is not None or name != token.name)
    if arguments and isinstance(arguments[0], ir.Array):  # the outer of the two nested ARRAY( that `formulas` makes
        return ir.Array(tuple(row for part in arguments if isinstance(part, ir.Array) for row in part.rows))
    if not all(_is_constant(element) for element in arguments):
        raise ForeignFormulaError
    return ir.Array((arguments,))


def _is_constant(element: ir.Expression) -> bool:
    if isinstance(element, ir.Unary) and element.operator in "+-":
        return isinstance(element.operand, ir.Number)
    return isinstance(element, ir.Number | ir.Text | ir.Logical | ir.ErrorLiteral)


def _operation(operator: str, operands: tuple[ir.Expression, ...]) -> ir.Expression:
    if any(isinstance(operand, ir.Missing) for operand in operands):
        raise ForeignFormulaError
    if operator in ("@", "#"):
        return ir.Call("SINGLE" if operator == "@" else "ANCHORARRAY", operands)
    if len(operands) == 1:
        return ir.Unary(operator.removeprefix("u"), operands[0])
    return ir.Binary(operator, *operands)


class _Parser(Parser):  # type: ignore[misc]  # formulas has no types
    """`formulas.Parser` with our tokens and our builder; it goes through `filters` once for each token.

    Attributes:
        rest: what was left when the last token was looked for.
    """

    ast_builder = _TreeBuilder

    def __init__(self) -> None:
        super().__init__()
        self.rest = ""
        self.filters = _Filters(self)


class _Filters:
    """What is tried for the next token: first what only notes the text at hand, then the classes that may be meant."""

    def __init__(self, parser: _Parser) -> None:
        self._parser = parser

    def __iter__(self) -> Iterator[Callable[..., Any]]:
        yield self._note
        yield from tokens_at(self._parser.rest)

    def _note(self, text: str, context: object, parser: object) -> Any:
        self._parser.rest = text
        raise TokenError(text)


@lru_cache(maxsize=65_536)
def parse(text: str) -> ir.Expression:
    """Return the tree of a formula, given without its leading `=`.

    Raises:
        FormulaError: the text is not a formula; the error says where the faulty part is.
    """
    if len(text) > _LONGEST:
        raise FormulaError(
            f"the formula has {len(text):,} characters, more than {_LONGEST:,}; Excel takes 8,192",
            hint="split it over several cells",
            text=f"{text[:60]}…",
        )
    flat = without_line_breaks(text).strip()
    reference = absolute_reference(flat)
    if reference is not None:
        return reference
    parser = _Parser()
    try:
        _, builder = parser.ast("=" + flat)
    except ForeignFormulaError:
        start = min(max(0, len(text.rstrip()) - len(parser.rest)), max(0, len(text.rstrip()) - 1))
        raise _unread(text, start) from None
    closing = _closes_too_early(text)
    if closing is not None:
        raise _unread(text, closing)
    tree: ir.Expression = builder[-1]
    return tree


def _unread(text: str, start: int) -> FormulaError:
    return FormulaError(
        "the formula cannot be read from the marked character on",
        hint="check brackets, separators and quotes there",
        text=text,
        span=(start, start + 1),
    )


def _closes_too_early(text: str) -> int | None:
    """Return the position of a closing bracket without an opening one: `formulas` reads `A1)-(B1` as if brackets stood
    around it.
    """
    depths = _depths(QUOTED.sub(lambda quoted: " " * len(quoted[0]), text))
    return next((index for index, depth in enumerate(depths) if depth < 0), None)


def _depths(signs: str) -> Iterator[int]:
    """How many brackets are open after each sign."""
    return accumulate((sign == "(") - (sign == ")") for sign in signs)


def parse_cell(text: str) -> ir.Expression:
    """Return the tree of a cell's whole formula: its last operation is marked where that is a `+` or `-` outside of
    brackets.

    Raises:
        FormulaError: as `parse`.
    """
    tree = parse(text)
    if isinstance(tree, ir.Binary) and tree.operator in ("+", "-") and not _is_bracketed(text.strip()):
        return replace(tree, last=True)
    return tree


def _is_bracketed(text: str) -> bool:
    """Whether the bracket that a formula begins with is closed at its end."""
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depths = list(_depths(QUOTED.sub("", text)))
    return all(depths[:-1])


def compile_with_formulas(text: str) -> Callable[[Mapping[str, Any]], object]:
    """Return what `formulas` itself compiles from a formula, for one trial: the slow reference.

    Args:
        text: a formula without its leading `=`, whose references name no sheet.

    Returns:
        A callable. It takes the values of the references by name (`A1`, `B1:C3`): float, bool, str, `ErrorCode` or
        None, in an `(r, c)` object array for an area. It gives one such value.

    Raises:
        FormulaError: `formulas` cannot read the formula; from the callable, it cannot compute it.
    """
    refused = FormulaError("the engine `formulas` cannot compute this", hint="use the engine `numpy`", text=text)
    try:
        compiled = Parser().ast("=" + text)[1].compile()
    except (ForeignFormulaError, DispatcherError):
        raise refused from None
    names = list(compiled.inputs)

    def call(values: Mapping[str, Any]) -> object:
        if not values.keys() >= set(names):  # it reads `(A1,B1)` as one name
            raise refused
        try:
            return _from_foreign(compiled(*(_to_foreign(values[name]) for name in names)))
        except DispatcherError:
            raise refused from None

    return call


def _to_foreign(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.array([[_to_foreign(item) for item in row] for row in value], dtype=object)
    if isinstance(value, ErrorCode):
        return ErrorToken.errors[value.text]
    return EMPTY if value is None else value


def _from_foreign(result: Any) -> object:
    item = np.asarray(result, dtype=object).ravel()[0]
    if isinstance(item, XlError):
        return ErrorCode.from_text(str(item))
    if isinstance(item, bool | np.bool_):
        return bool(item)
    if item is EMPTY:
        return None
    if isinstance(item, complex):  # Python's power of a negative number
        return ErrorCode.NUM
    return item if isinstance(item, str) else float(item)
