"""The tokens of a formula, as the parser of `formulas` takes them.

`formulas` reads tokens by a list of classes. Ours stand in for those that lose something (`--x`, `1E5`, `5%%`,
`Data!Rate`, `Table1[Low]`, line breaks in texts) or that let two operands stand side by side (`(1)(2)`, `SUM(A1;B1)`).
"""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, Final

from formulas.errors import FormulaError as ForeignFormulaError
from formulas.errors import TokenError
from formulas.tokens.function import Array as ArrayToken
from formulas.tokens.function import Function as FunctionToken
from formulas.tokens.operand import Operand
from formulas.tokens.operator import Intersect, Operator, OperatorToken, Separator
from formulas.tokens.parenthesis import Parenthesis, _update_n_args

from xlmc.errors import ErrorCode
from xlmc.excel.formula import ir
from xlmc.excel.formula.reference_text import (
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

__all__ = [
    "QUOTED",
    "TOKENS",
    "Invocation",
    "Leaf",
    "absolute_reference",
    "opens_array",
    "tokens_at",
    "without_line_breaks",
]

_LINE_BREAK_IN_TEXT = "\0"  # no XML holds it, so no text of a workbook does

QUOTED = re.compile(r""""(?:[^"]|"")*"|'(?:[^']|'')*'|\[(?:'.|[^\[\]']|\[(?:'.|[^\[\]'])*\])*\]""", re.DOTALL)
"""Texts, names of sheets in quotes, and what stands in square brackets."""

_BLANKS = str.maketrans("\t\r\n", "   ")


def _follow(tokens: list[Any], *, an_operand: bool) -> None:
    """Pass on a token that may only stand behind an operand, or only elsewhere; a blank there may be an operator."""
    if bool(tokens and _ends_an_operand(tokens[-1])) is not an_operand:
        raise TokenError


class Leaf(Operand):  # type: ignore[misc]  # formulas has no types
    """An operand that knows its tree node."""

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _follow(tokens, an_operand=False)
        super().ast(tokens, stack, builder)

    @property
    @abstractmethod
    def node(self) -> ir.Expression:
        """What it is in a tree."""


class _Number(Leaf):
    _re = re.compile(r"\s*(?P<name>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[Ee][+-]?[0-9]+)?)(?![\w.(])")

    @property
    def node(self) -> ir.Expression:
        value = float(self.name)
        if value == float("inf"):
            raise ForeignFormulaError
        return ir.Number(value)


class _Logical(Leaf):
    _re = re.compile(r"\s*(?P<name>TRUE|FALSE)(?![\w.(!\[])", re.IGNORECASE)

    @property
    def node(self) -> ir.Expression:
        return ir.Logical(self.name.upper() == "TRUE")


class _Text(Leaf):
    _re = re.compile(r'\s*(?P<quote>")(?P<name>(?:""|[^"])*)"')

    @property
    def node(self) -> ir.Expression:
        return ir.Text(_with_line_breaks(self.name.replace('""', '"')))


class _Error(Leaf):
    """Also `#REF!$B$7`, what is left of a reference whose sheet was deleted."""

    _names = r"#(?:NULL!|DIV/0!|VALUE!|REF!|NAME\?|NUM!|N/A|SPILL!|CALC!|GETTING_DATA)"
    _re = re.compile(rf"\s*(?:{PREFIX})?(?P<name>{_names})(?:(?<=#REF!)(?:#REF!|{CELL}(?::{CELL})?))?", re.I)

    @property
    def node(self) -> ir.Expression:
        return ir.ErrorLiteral(ErrorCode.from_text(self.name))


class _Reference(Leaf):
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


def absolute_reference(text: str) -> ir.Reference | None:
    """Return the node of a text that is one reference with a `$`, as most defined names are: `Model!$D$29`.

    None for any other text, and for a reference that is not on a sheet.
    """
    match = _Reference._re.fullmatch(text) if "$" in text else None
    if match is None or "$" not in match["name"]:
        return None
    groups = {key: value for key, value in match.groupdict().items() if value is not None}
    first, _, last = groups["name"].partition(":")
    corners = corner(first), corner(last) if last else None
    if all(end is None or is_on_the_sheet(end) for end in corners):
        return ir.Reference(*corners, *prefix(groups))
    return None


class _Name(Leaf):
    _re = re.compile(rf"\s*(?:{PREFIX})?{NAME}(?![\w.(\[!])")

    @property
    def node(self) -> ir.Expression:
        sheet, _, book = prefix(self.attr)
        return ir.Name(self.attr["name"], sheet, book)


class _TableReference(Leaf):
    _re = TABLE_REFERENCE

    @property
    def node(self) -> ir.Expression:
        try:
            return parse_table_reference(self.attr.get("table"), _with_line_breaks(self.attr["name"]))
        except ValueError:
            raise ForeignFormulaError from None


class _Operator(OperatorToken):  # type: ignore[misc]  # formulas has no types
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


class _Intersect(Intersect):  # type: ignore[misc]  # formulas has no types
    _re = re.compile(r"\s+")

    def process(self, match: re.Match[str], context: object = None, parser: object = None) -> dict[str, str]:
        return {"name": " "}

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _follow(tokens, an_operand=True)
        super().ast(tokens, stack, builder)


class _Separator(Separator):  # type: ignore[misc]  # formulas has no types
    def ast(self, tokens: list[Any], stack: list[Any], builder: Any) -> None:
        _refuse_open_operator(tokens)
        super().ast(tokens, stack, builder)


class _Function(FunctionToken):  # type: ignore[misc]  # formulas has no types
    _re = re.compile(rf"\s*(?:{PREFIX})?(?P<name>[^\W\d][\w.]*)\(\s*(?P<call>\))?")

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        _follow(tokens, an_operand=False)
        super().ast(tokens, stack, builder, *rest)


class Invocation(FunctionToken):  # type: ignore[misc]  # formulas has no types
    """The second `(` of `LAMBDA(x, x+1)(2)`: a call of what stands before it."""

    _re = re.compile(r"(?P<name>\()\s*(?P<call>\))?")

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        if not (tokens and isinstance(tokens[-1], Parenthesis) and tokens[-1].has_end):
            raise TokenError
        if stack and isinstance(stack[-1], Parenthesis) and stack[-1].has_start:
            stack[-1].n_args -= 1  # what is called was counted as an operand of its own
        super().ast(tokens, stack, builder, *rest)


class _Array(ArrayToken):  # type: ignore[misc]  # formulas has no types
    """`{`, `;` and `}`; the last two only within an array, for `;` parts arguments in other languages of Excel."""

    def ast(self, tokens: list[Any], stack: list[Any], builder: Any, *rest: Any) -> None:
        if self.has_start:
            _follow(tokens, an_operand=False)
        elif not _within_array(stack):
            raise ForeignFormulaError
        else:
            _refuse_open_operator(tokens)
        super().ast(tokens, stack, builder, *rest)


class _Parenthesis(Parenthesis):  # type: ignore[misc]  # formulas has no types
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
    """Refuse what ends an operand behind an operator that still waits for one."""
    if tokens and isinstance(tokens[-1], _Operator | _Intersect) and not _ends_an_operand(tokens[-1]):
        raise ForeignFormulaError


def _within_array(stack: list[Any]) -> bool:
    """Whether the innermost open bracket is a `{`, which `formulas` makes a call of its own class."""
    opened = [index for index, token in enumerate(stack) if isinstance(token, Parenthesis)]
    return bool(opened and opened[-1] and opens_array(stack[opened[-1] - 1]))


def opens_array(token: Any) -> bool:
    return type(token) is FunctionToken


def _ends_an_operand(token: Any) -> bool:
    if isinstance(token, Parenthesis):
        return bool(token.has_end)
    return isinstance(token, Operand) or (isinstance(token, Operator) and token.name in "%#")


def without_line_breaks(text: str) -> str:
    """Line breaks and tabs between tokens are blanks to Excel; inside texts and brackets they are kept."""
    if not any(blank in text for blank in "\n\r\t"):
        return text
    pieces = re.split(f"({QUOTED.pattern})", text, flags=re.DOTALL)
    parts = [p.replace("\n", _LINE_BREAK_IN_TEXT) if i % 2 else p.translate(_BLANKS) for i, p in enumerate(pieces)]
    return "".join(parts)


def _with_line_breaks(text: str) -> str:
    return text.replace("\r" + _LINE_BREAK_IN_TEXT, "\n").replace(_LINE_BREAK_IN_TEXT, "\n")


TOKENS: list[Callable[..., Any]] = [
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
    Invocation,
    _Parenthesis,
    _Intersect,
]

_OF_DIGITS: Final = (_Reference, _Number, _Intersect)
_OF_LETTERS: Final = (_Error, _Reference, _Logical, _Name, _TableReference, _Function, _Intersect)
_OF_SIGNS: Final = (_Operator, _Separator, _Array, Invocation, _Parenthesis, _Intersect)
_BY_SIGN: Final = dict.fromkeys("0123456789", _OF_DIGITS) | dict.fromkeys("<>=-+*/^&%,;{}()", _OF_SIGNS)


def tokens_at(text: str) -> Sequence[Callable[..., Any]]:
    """Those of `TOKENS` that may stand at the start of a text, which its first sign behind the blanks decides."""
    sign = text.lstrip()[:1]
    return _OF_LETTERS if sign.isalpha() else _BY_SIGN.get(sign, TOKENS)
