r"""Formula text to tree, through the tokenizer and the shunting-yard of `formulas`. Nothing else imports `formulas`.

    formula   = expression
    operand   = number | "text" | TRUE | #ERROR! | reference | name | table[…] | {array} | (expression) | FN(arguments)
    reference = [prefix!] ( A1 | A1:B2 | A:B | 1:2 | name )          prefix = Sheet | 'a sheet' | First:Last | [1]Sheet
    operators = from tightest:  : blank ,   - + @ (before)   % # (after)   ^   * /   + -   &   = < > <= >= <>

`formulas` reads tokens by a list of classes and hands the postfix stream to a builder; both are class attributes of its
`Parser`. Our classes stand in for those of its tokens that lose something (`--x`, `1E5`, `5%%`, `Data!Rate`,
`Table1[Low]`, line breaks in texts) or that let two operands stand side by side (`(1)(2)`, `SUM(A1;B1)`), and our
builder makes tree nodes. The stack machine is theirs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import accumulate
from typing import Any, ClassVar

import numpy as np
from formulas.errors import FormulaError as ForeignFormulaError
from formulas.errors import TokenError
from formulas.parser import Parser
from formulas.tokens.function import Array as ArrayToken
from formulas.tokens.function import Function as FunctionToken
from formulas.tokens.operand import Empty, Operand, XlError
from formulas.tokens.operand import Error as ErrorToken
from formulas.tokens.operator import Intersect, Operator, OperatorToken, Separator
from formulas.tokens.parenthesis import Parenthesis, _update_n_args
from schedula import EMPTY, DispatcherError

from xlmc.errors import ErrorCode, FormulaError
from xlmc.formula import ir
from xlmc.formula.reference_text import (
    CELL,
    NAME,
    PREFIX,
    REFERENCE,
    TABLE_REFERENCE,
    corner,
    is_on_the_sheet,
    parse_table_reference,
    prefix,
)

__all__ = ["compile_with_formulas", "parse", "parse_cell"]

_LINE_BREAK_IN_TEXT = "\0"  # no XML holds it, so no text of a workbook does
_LONGEST = 4 * 8192
"""Characters of a formula in a file, where functions have prefixes and tables their long names."""

_ADD_INS = ("CB.", "RISK")
"""Functions before which the file of their add-in may stand, in quotes like a sheet: `'CB.xla'!CB.GetForeStatFN(`."""

_QUOTED = re.compile(r""""(?:[^"]|"")*"|'(?:[^']|'')*'|\[(?:'.|[^\[\]']|\[(?:'.|[^\[\]'])*\])*\]""", re.DOTALL)
"""Texts, names of sheets in quotes, and what stands in square brackets."""

_BLANKS = str.maketrans("\t\r\n", "   ")


def _follow(tokens: list[Any], *, an_operand: bool) -> None:
    """Pass on a token that may only stand behind an operand, or only elsewhere; a blank there may be an operator."""
    if bool(tokens and _ends_an_operand(tokens[-1])) is not an_operand:
        raise TokenError


class _Leaf(Operand):  # type: ignore[misc]  # formulas has no types
    """An operand that knows its tree node."""

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _follow(tokens, an_operand=False)
        super().ast(tokens, stack, builder)

    @property
    def node(self) -> ir.Expression:
        raise NotImplementedError


class _Number(_Leaf):
    _re = re.compile(r"\s*(?P<name>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[Ee][+-]?[0-9]+)?)(?![\w.(])")

    @property
    def node(self) -> ir.Expression:
        value = float(self.name)
        if value == float("inf"):
            raise ForeignFormulaError
        return ir.Number(value)


class _Logical(_Leaf):
    _re = re.compile(r"\s*(?P<name>TRUE|FALSE)(?![\w.(!\[])", re.IGNORECASE)

    @property
    def node(self) -> ir.Expression:
        return ir.Logical(self.name.upper() == "TRUE")


class _Text(_Leaf):
    _re = re.compile(r'\s*(?P<quote>")(?P<name>(?:""|[^"])*)"')

    @property
    def node(self) -> ir.Expression:
        return ir.Text(_with_line_breaks(self.name.replace('""', '"')))


class _Error(_Leaf):
    """Also `#REF!$B$7`, what is left of a reference whose sheet was deleted."""

    _names = r"#(?:NULL!|DIV/0!|VALUE!|REF!|NAME\?|NUM!|N/A|SPILL!|CALC!|GETTING_DATA)"
    _re = re.compile(rf"\s*(?:{PREFIX})?(?P<name>{_names})(?:(?<=#REF!)(?:#REF!|{CELL}(?::{CELL})?))?", re.I)

    @property
    def node(self) -> ir.Expression:
        return ir.ErrorLiteral(ErrorCode.from_text(self.name))


class _Reference(_Leaf):
    _re = re.compile(rf"\s*(?:{PREFIX})?{REFERENCE}(?![\w.(\[\\?])")

    @property
    def node(self) -> ir.Expression:
        text = self.attr["name"]
        first, _, last = text.partition(":")
        corners = corner(first), corner(last) if last else None
        if all(end is None or is_on_the_sheet(end) for end in corners):
            return ir.Reference(*corners, *prefix(self.attr))
        if last or "$" in text:
            raise ForeignFormulaError
        sheet, _, book = prefix(self.attr)
        return ir.Name(text, sheet, book)  # no cell, so a name may look like it: `YAW1`


class _Name(_Leaf):
    _re = re.compile(rf"\s*(?:{PREFIX})?{NAME}(?![\w.(\[!])")

    @property
    def node(self) -> ir.Expression:
        sheet, _, book = prefix(self.attr)
        return ir.Name(self.attr["name"], sheet, book)


class _TableReference(_Leaf):
    _re = TABLE_REFERENCE

    @property
    def node(self) -> ir.Expression:
        try:
            return parse_table_reference(self.attr.get("table"), _with_line_breaks(self.attr["name"]))
        except ValueError:
            raise ForeignFormulaError from None


class _Operator(OperatorToken):  # type: ignore[misc]
    """One operator at a time; a prefix waits on the stack for its operand, so that `--x` is two of them."""

    _re = re.compile(r"\s*(?P<name><=|>=|<>|[-+*/^&=<>:@%]|\#(?![A-Za-z]))(?:(?<![%#])\s+)?")  # `A1# B:B` intersects
    _re_process = None
    _n_args: ClassVar[dict[str, int]] = {"u-": 1, "u+": 1, "@": 1, "%": 1, "#": 1}
    _precedences = Operator._precedences | {"#": 10, ":": 9}  # `:` before the blank that intersects

    def process(self, match: re.Match[str], context: object = None, parser: object = None) -> dict[str, str]:
        return match.groupdict()

    @property
    def get_n_args(self) -> int:
        return self._n_args.get(self.name, 2)

    def update_name(self, tokens: list[Any], stack: list[Any]) -> None:
        """`ast` below tells prefixes apart; `formulas` would take the `-` of `A1#-1` for one."""

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        if self.name == "@":
            _follow(tokens, an_operand=False)
        elif self.name not in "+-" or (tokens and _ends_an_operand(tokens[-1])):
            _follow(tokens, an_operand=True)
            super().ast(tokens, stack, builder)
            return
        else:
            self.attr["name"] = "u" + self.name
        tokens.append(self)
        _update_n_args(stack)
        stack.append(self)


class _Intersect(Intersect):  # type: ignore[misc]
    _re = re.compile(r"\s+")

    def process(self, match: re.Match[str], context: object = None, parser: object = None) -> dict[str, str]:
        return {"name": " "}

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _follow(tokens, an_operand=True)
        super().ast(tokens, stack, builder)


class _Separator(Separator):  # type: ignore[misc]
    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _refuse_open_operator(tokens)
        super().ast(tokens, stack, builder)


class _Function(FunctionToken):  # type: ignore[misc]
    _re = re.compile(rf"\s*(?:{PREFIX})?(?P<name>[^\W\d][\w.]*)\(\s*(?P<call>\))?")

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        _follow(tokens, an_operand=False)
        super().ast(tokens, stack, builder, *rest)


class _Invocation(FunctionToken):  # type: ignore[misc]
    """The second `(` of `LAMBDA(x, x+1)(2)`: a call of what stands before it."""

    _re = re.compile(r"(?P<name>\()\s*(?P<call>\))?")

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        if not (tokens and isinstance(tokens[-1], Parenthesis) and tokens[-1].has_end):
            raise TokenError
        if stack and isinstance(stack[-1], Parenthesis) and stack[-1].has_start:
            stack[-1].n_args -= 1  # what is called was counted as an operand of its own
        super().ast(tokens, stack, builder, *rest)


class _Array(ArrayToken):  # type: ignore[misc]
    """`{`, `;` and `}`; the last two only within an array, for `;` parts arguments in other languages of Excel."""

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        if self.has_start:
            _follow(tokens, an_operand=False)
        elif not _within_array(stack):
            raise ForeignFormulaError
        else:
            _refuse_open_operator(tokens)
        super().ast(tokens, stack, builder, *rest)


class _Parenthesis(Parenthesis):  # type: ignore[misc]
    """`)` also closes a call's list; blanks after it may be an intersection and stay."""

    _re = re.compile(r"\s*(?P<name>(?P<start>\()\s*|(?P<end>\)))")

    def process(self, match: re.Match[str], context: object = None, parser: object = None) -> dict[str, str]:
        groups = {key: text for key, text in match.groupdict().items() if text is not None}
        return groups | {"name": groups["name"].strip()}

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        if self.has_start:
            _follow(tokens, an_operand=False)
        elif _within_array(stack):
            raise ForeignFormulaError
        else:
            _refuse_open_operator(tokens)
        super().ast(tokens, stack, builder)


def _refuse_open_operator(tokens: list[Any]) -> None:
    """What ends an operand must not follow an operator that still waits for one."""
    if tokens and isinstance(tokens[-1], _Operator | _Intersect) and not _ends_an_operand(tokens[-1]):
        raise ForeignFormulaError


def _within_array(stack: list[Any]) -> bool:
    """Whether the innermost open bracket is a `{`, which `formulas` makes a call of its own class."""
    opened = [index for index, token in enumerate(stack) if isinstance(token, Parenthesis)]
    return bool(opened and opened[-1] and _opens_array(stack[opened[-1] - 1]))


def _opens_array(token: Any) -> bool:
    return type(token) is FunctionToken


def _ends_an_operand(token: Any) -> bool:
    if isinstance(token, Parenthesis):
        return bool(token.has_end)
    return isinstance(token, Operand) or (isinstance(token, Operator) and token.name in "%#")


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
        if isinstance(token, _Leaf):
            return token.node
        if isinstance(token, Empty):
            return ir.Missing()
        if isinstance(token, _Invocation):
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
    if not _opens_array(token):
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


class _Parser(Parser):  # type: ignore[misc]
    """`formulas.Parser` with our tokens and our builder. `rest` is what was left when the last token was looked for."""

    ast_builder = _TreeBuilder

    def __init__(self) -> None:
        super().__init__()
        self.rest = 0
        self.filters: list[Callable[..., Any]] = [self._note, *_TOKENS]

    def _note(self, text: str, context: object, parser: object) -> Any:
        self.rest = len(text)
        raise TokenError(text)


_TOKENS: list[Callable[..., Any]] = [
    _Error,
    _Text,
    _Reference,
    _Number,
    _Logical,
    _Name,
    _TableReference,
    _Operator,
    _Separator,
    _Function,
    _Array,
    _Invocation,
    _Parenthesis,
    _Intersect,
]


@lru_cache(maxsize=65_536)
def parse(text: str) -> ir.Expression:
    """The tree of a formula, given without its leading `=`.

    Raises:
        FormulaError: the text is not a formula; the error says where the faulty part is.
    """
    if len(text) > _LONGEST:
        raise FormulaError(
            f"the formula has {len(text):,} characters, more than {_LONGEST:,}; Excel takes 8,192",
            hint="split it over several cells",
            text=f"{text[:60]}…",
        )
    parser = _Parser()
    flat = _without_line_breaks(text).strip()
    try:
        _, builder = parser.ast("=" + flat)
    except ForeignFormulaError:
        start = min(max(0, len(text.rstrip()) - parser.rest), max(0, len(text.rstrip()) - 1))
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
    """Where a bracket is closed that nothing opened: `formulas` reads `A1)-(B1` as if brackets stood around it."""
    depths = _depths(_QUOTED.sub(lambda quoted: " " * len(quoted[0]), text))
    return next((index for index, depth in enumerate(depths) if depth < 0), None)


def _depths(signs: str) -> Iterator[int]:
    """How many brackets are open after each sign."""
    return accumulate((sign == "(") - (sign == ")") for sign in signs)


def parse_cell(text: str) -> ir.Expression:
    """The tree of a cell's whole formula: its last operation is marked where that is a `+` or `-` outside of brackets.

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
    depths = list(_depths(_QUOTED.sub("", text)))
    return all(depths[:-1])


def _without_line_breaks(text: str) -> str:
    """Line breaks and tabs between tokens are blanks to Excel; inside texts and brackets they are kept."""
    if not any(blank in text for blank in "\n\r\t"):
        return text
    pieces = re.split(f"({_QUOTED.pattern})", text, flags=re.DOTALL)
    kept = [p.replace("\n", _LINE_BREAK_IN_TEXT) if i % 2 else p.translate(_BLANKS) for i, p in enumerate(pieces)]
    return "".join(kept)


def _with_line_breaks(text: str) -> str:
    return text.replace("\r" + _LINE_BREAK_IN_TEXT, "\n").replace(_LINE_BREAK_IN_TEXT, "\n")


def compile_with_formulas(text: str) -> Callable[[Mapping[str, Any]], object]:
    """What `formulas` itself compiles from a formula, for one trial: the slow reference.

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
    return item if isinstance(item, str) else float(item)
