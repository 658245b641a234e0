"""Names, tables and relative references to cells and areas, seen from one host cell.

A resolved tree has `Cell` and `Area` leaves; no `Reference`, `Name` or `TableReference` is left in it, and `:` and the
blank have become areas.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final, assert_never

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.areas import (
    COPY,
    cells_of,
    combine,
    is_far,
    linked_name,
    linked_sheet,
    meant_book,
    seen_from,
    table_rows,
)
from xlmc.excel.formula.callables import calls_function, function_named_by, stands_for_function
from xlmc.excel.formula.parse import parse
from xlmc.excel.formula.shape import Shapes
from xlmc.excel.formula.stencil import Stencil, stencil
from xlmc.excel.workbook.workbook import Formula, Table, Workbook

if TYPE_CHECKING:
    from xlmc.excel.functions import Function

__all__ = ["Resolver"]


_PARAMETER: Final = re.compile(r"_xl[po][mp]\.", re.IGNORECASE)
_OPTIONAL: Final = "_xlop."
_NEEDED: Final = "_xlpm."

_DEEPEST: Final = 200
"""Levels of brackets, calls and names in a formula; Excel stops at 64 calls."""

_LONGEST: Final = 100_000
"""Parts of a formula with its names written out; Excel stops at 8192 characters. Names of names can double it on."""


class Resolver:
    """Resolves the formulas of one workbook.

    Args:
        inputs: cells that count as used although the file may hold nothing there.
        strict: whether a name that is not there is a mistake to tell of, unless Excel saved `#NAME?` in the cell too;
            `#NAME?` otherwise, as in Excel.
        rewritten: resolved trees that replace cells' formulas, or why a cell cannot be computed.
    """

    def __init__(
        self,
        workbook: Workbook,
        inputs: Iterable[Cell] = (),
        *,
        strict: bool = True,
        rewritten: Mapping[Cell, ir.Expression | FormulaError] | None = None,
    ) -> None:
        self.workbook = workbook
        self.rewritten = rewritten or {}
        self._strict = strict
        self.inputs = tuple(inputs)
        self._used: dict[str, tuple[int, int]] = {}
        self._shapes = Shapes()
        self._open_names: list[str] = []
        self._recursive: set[str] = set()
        self._linked: str | None = None  # the workbook whose name is open
        self._in_global = False  # the text at hand is that of a name of the whole workbook
        self._variables: frozenset[str] = frozenset()
        self._depth = self._parts = 0

    def formula(self, cell: Cell, formula: Formula) -> ir.Expression:
        """Resolve a cell's formula.

        Raises:
            FormulaError: names the cell; the formula cannot be read, or names something that is not there.
        """
        expression = self.tree_or_stencil(cell, formula)
        return expression.at(cell) if isinstance(expression, Stencil) else expression

    def tree_or_stencil(self, cell: Cell, formula: Formula) -> ir.Expression | Stencil:
        """Resolve a cell's formula; if it was filled into many cells, return the stencil that these have in common.

        Raises:
            FormulaError: as `formula`.
        """
        try:
            shape = self._shapes.parse(formula.text, formula.row, formula.column)
            common = shape.stencils.get(cell.sheet)
            if common is not None and common.fits(cell) and formula.array is None and not formula.dynamic:
                return common
            self._depth = self._parts = 0
            self._variables = frozenset()
            tree = self._resolve(shape.tree, cell, shape.origin)
            if cell.sheet not in shape.stencils:
                shape.stencils[cell.sheet] = stencil(shape.tree, tree, cell)
            return tree
        except FormulaError as error:
            complete = error if error.text is not None else _about(error, formula.text)
            raise complete.at(cell) from None

    def tree(self, tree: ir.Expression, host: Cell) -> ir.Expression:
        """Resolve a tree as if it stood in a cell.

        Raises:
            FormulaError: it names something that is not there.
        """
        self._depth = self._parts = 0
        self._variables = frozenset()
        return self._resolve(tree, host, (host.row, host.column))

    def _resolve(self, tree: ir.Expression, host: Cell, origin: tuple[int, int]) -> ir.Expression:
        self._depth += 1
        self._parts += 1
        if self._depth > _DEEPEST or self._parts > _LONGEST:
            size = f"nested deeper than {_DEEPEST} levels" if self._depth > _DEEPEST else "too long"
            raise FormulaError(f"with its names written out, the formula is {size}", hint="split it over several cells")
        resolved = self._resolve_node(tree, host, origin)
        self._depth -= 1
        return resolved

    def _resolve_node(self, tree: ir.Expression, host: Cell, origin: tuple[int, int]) -> ir.Expression:
        match tree:
            case ir.Reference():
                return self._reference(tree, host, origin)
            case ir.Name():
                return self._name(tree, host)
            case ir.TableReference():
                return self._table(tree, host)
            case ir.Unary(operator, operand):
                return ir.Unary(operator, self._resolve(operand, host, origin))
            case ir.Binary():
                return self._chain(tree, host, origin)
            case ir.Call("LET", arguments):
                return self._let(arguments, host, origin)
            case ir.Call("LAMBDA", arguments):
                return self._lambda(arguments, host, origin)
            case ir.Call(name, arguments, foreign):
                resolved = tuple(self._resolve(part, host, origin) for part in arguments)
                called = None if foreign else self._called(name, host)
                if called is not None:
                    return ir.Invoke(called, resolved)
                return replace(tree, arguments=resolved, given=self._own(name, arguments))
            case ir.Invoke(function, arguments):
                called = self._resolve(function, host, origin)
                return ir.Invoke(called, tuple(self._resolve(part, host, origin) for part in arguments))
            case ir.Array(rows):
                return ir.Array(tuple(tuple(self._resolve(part, host, origin) for part in row) for row in rows))
            case ir.Number() | ir.Text() | ir.Logical() | ir.ErrorLiteral() | ir.Missing() | Cell() | Area():
                return tree
            case ir.Variable() | ir.Let() | ir.Lambda() | ir.FunctionName():
                raise TypeError(f"resolved twice: {tree}")
            case _:
                assert_never(tree)

    def _let(self, arguments: tuple[ir.Expression, ...], host: Cell, origin: tuple[int, int]) -> ir.Expression:
        if len(arguments) < 3 or len(arguments) % 2 == 0:
            raise FormulaError("LET takes pairs of a name and a value, and then a calculation")
        outer, bindings = self._variables, []
        for name, value in zip(arguments[:-1:2], arguments[1::2], strict=True):
            resolved = self._resolve(value, host, origin)
            variable = _variable(name, "LET")
            bindings.append((_bare(variable), resolved))
            self._variables = self._variables | {variable}
        body = self._resolve(arguments[-1], host, origin)
        self._variables = outer
        return ir.Let(tuple(bindings), body)

    def _lambda(self, arguments: tuple[ir.Expression, ...], host: Cell, origin: tuple[int, int]) -> ir.Expression:
        if not arguments:
            raise FormulaError("LAMBDA takes at least a calculation")
        parameters = [_parameter(name) for name in arguments[:-1]]
        names = {form for name, _ in parameters for form in _forms(name)}
        outer, self._variables = self._variables, self._variables | names
        body = self._resolve(arguments[-1], host, origin)
        self._variables = outer
        return ir.Lambda(tuple(_bare(name) for name, _ in parameters), body, _optional(parameters))

    def _own(self, name: str, arguments: tuple[ir.Expression, ...]) -> Function | None:
        """Return the person's own function of a name; None if there is none."""
        functions = self.workbook.functions
        return None if functions is None else functions.named(name, len(arguments))

    def _called(self, name: str, host: Cell) -> ir.Expression | None:
        """Return what a call calls that is no function of Excel: a variable, or a defined name that stands for a
        LAMBDA.
        """
        if name.casefold() in self._variables:
            return ir.Variable(_bare(name))
        if not calls_function(self.workbook, name, self._seen_by(host)):
            return None
        return self._name(ir.Name(name), host)

    def _chain(self, tree: ir.Binary, host: Cell, origin: tuple[int, int]) -> ir.Expression:
        first, rest = ir.chain(tree)
        resolved = self._resolve(first, host, origin)
        for operator, right in rest:
            combined = combine(operator, resolved, self._resolve(right, host, origin))
            resolved = self._cut(combined) if isinstance(combined, Area) else combined
        return ir.marked_as(resolved, tree)

    def _reference(self, tree: ir.Reference, host: Cell, origin: tuple[int, int]) -> ir.Expression:
        book = meant_book(self.workbook, tree.book, self._linked)
        if tree.last_sheet is not None:
            if book is not None:
                raise FormulaError("the formula refers to several sheets of another workbook", hint=COPY)
            return self._over_sheets(tree, host, origin)
        sheet = self._sheet(tree.sheet, host) if book is None else linked_sheet(self.workbook, book, tree.sheet, host)
        if book is not None and sheet in self.workbook.links[book].broken:
            return ir.ErrorLiteral(ErrorCode.REF)
        expression = seen_from(tree, sheet, host, origin, wraps=bool(self._open_names))
        return self._cut(expression) if isinstance(expression, Area) else expression

    def _over_sheets(self, tree: ir.Reference, host: Cell, origin: tuple[int, int]) -> ir.Expression:
        """`Jan:Dec!A1` as the areas of each sheet between the two tabs, joined."""
        tabs = list(self.workbook.sheets)
        ends = sorted(tabs.index(self._sheet(name, host)) for name in (tree.sheet, tree.last_sheet))
        parts = [
            self._resolve(ir.Reference(tree.first, tree.last, sheet), host, origin)
            for sheet in tabs[ends[0] : ends[1] + 1]
        ]
        joined = parts[0]
        for part in parts[1:]:
            joined = ir.Binary(",", joined, part)
        return joined

    def _linked_name(self, book: str, name: ir.Name) -> ir.Expression:
        """Resolve a name of another workbook, by what it stood for when Excel last read that."""
        defined_name = linked_name(self.workbook, book, name)
        if self._linked is not None:
            raise FormulaError(
                f"the formula refers to {name.name!r} of another workbook, which stands for another name", hint=COPY
            )
        variables, self._variables, self._linked = self._variables, frozenset(), book
        try:
            return self._resolve(parse(defined_name.text), Cell(defined_name.sheet or book, 1, 1), (1, 1))
        finally:
            self._variables, self._linked = variables, None

    def _sheet(self, name: str | None, host: Cell) -> str:
        if name is None:
            return host.sheet
        sheet = self.workbook.sheet_named(name)
        if sheet is None:
            raise FormulaError(f"there is no sheet {name!r}", hint=_did_you_mean(name, self.workbook.sheets))
        return sheet.name

    def to_the_last_cell(self, area: Area) -> Area:
        """End the area with the cells that are filled where it goes on far beyond them; the rest is counted."""
        used = self.last_cell(area.sheet)
        bottom = max(area.top, used[0]) if is_far(area.bottom, used[0], MAX_ROW) else area.bottom
        right = max(area.left, used[1]) if is_far(area.right, used[1], MAX_COLUMN) else area.right
        return Area(area.sheet, area.top, area.left, bottom, right, area.bottom - bottom, area.right - right)

    def last_cell(self, sheet: str) -> tuple[int, int]:
        """Return the last row and the last column of a sheet that are filled."""
        return self._used_range(sheet)

    def _cut(self, area: Area) -> Cell | Area:
        cut = self.to_the_last_cell(area.whole)
        return cut if cut.is_cut else cells_of(cut.sheet, cut.top, cut.left, cut.bottom, cut.right)

    def _used_range(self, sheet: str) -> tuple[int, int]:
        """Last row and column that hold anything: a whole column ends there."""
        if sheet not in self._used:
            cells = [(cell.row, cell.column) for cell in self.inputs if cell.sheet == sheet]
            result = self.workbook.sheet_of(Cell(sheet, 1, 1))
            cells += () if result is None else result.cells
            self._used[sheet] = (max((r for r, _ in cells), default=1), max((c for _, c in cells), default=1))
        return self._used[sheet]

    def _name(self, tree: ir.Name, host: Cell) -> ir.Expression:
        if tree.name.casefold() in self._variables and tree.sheet is None and tree.book is None:
            return ir.Variable(_bare(tree.name))
        function = function_named_by(tree.name)
        if function is not None:
            return ir.FunctionName(function)
        book = meant_book(self.workbook, tree.book, self._linked)
        if book is not None:
            return self._linked_name(book, tree)
        scope = host.sheet if tree.sheet is None else self._sheet(tree.sheet, host)
        defined_name = self.workbook.defined_name(tree.name, self._seen_by(host) if tree.sheet is None else scope)
        if defined_name is None and (not self._strict or self._is_saved_as_unknown(host)):
            return ir.ErrorLiteral(ErrorCode.NAME, tree.name)
        if defined_name is None:
            known = (name.name for name in self.workbook.names)
            raise FormulaError(f"there is no name {tree.name!r}", hint=_did_you_mean(tree.name, known))
        key = f"={defined_name.sheet}!{defined_name.name}={scope}".casefold()
        if key in self._open_names:
            return self._again(defined_name.name, key, scope)
        self._open_names.append(key)
        outer, self._variables = self._variables, frozenset()
        around, self._in_global = self._in_global, defined_name.sheet is None
        try:  # a name's relative references are written as seen from A1
            resolved = self._resolve(parse(defined_name.text), Cell(scope, host.row, host.column), (1, 1))
        finally:
            self._open_names.pop()
            self._variables, self._in_global = outer, around
            calls_itself = key in self._recursive
            self._recursive.discard(key)
        return ir.Let(((key, resolved),), ir.Variable(key), recursive=True) if calls_itself else resolved

    def _seen_by(self, host: Cell) -> str | None:
        """Return the sheet whose own names go first: none in a name of the whole workbook, which names other such
        names.

        Excel binds the names in a name when it is written, and files qualify those that belong to a sheet.
        """
        return None if self._in_global else host.sheet

    def _is_saved_as_unknown(self, host: Cell) -> bool:
        """Whether Excel did not know a name either: the cell whose own formula has it holds `#NAME?`."""
        return not self._open_names and self.workbook.content(host).value is ErrorCode.NAME

    def _again(self, name: str, key: str, scope: str) -> ir.Expression:
        """Resolve a name within its own definition: a LAMBDA may call itself, by whatever way round."""
        if not stands_for_function(self.workbook, name, scope):
            raise FormulaError(
                f"the name {name!r} is defined by itself", hint="correct it under Formulas ▸ Name Manager"
            )
        self._recursive.add(key)
        return ir.Variable(key)

    def _table(self, tree: ir.TableReference, host: Cell) -> ir.Expression:
        table = self._named_table(tree.table, host)
        rows = table_rows(table, tree.items, host)
        if rows is None:
            return ir.ErrorLiteral(ErrorCode.VALUE if "#this row" in tree.items else ErrorCode.REF)
        left = _table_column(table, tree.first) if tree.first else table.area.left
        right = _table_column(table, tree.last) if tree.last else (left if tree.first else table.area.right)
        return cells_of(table.area.sheet, rows[0], min(left, right), rows[1], max(left, right))

    def _named_table(self, name: str | None, host: Cell) -> Table:
        if name is None:
            around = [table for table in self.workbook.tables if host in table.area]
            if not around:
                raise FormulaError(
                    "a table's column is named without its table, outside any table", hint="write the table before it"
                )
            return around[0]
        result = self.workbook.table_named(name)
        if result is None:
            known = (table.name for table in self.workbook.tables)
            raise FormulaError(f"there is no table {name!r}", hint=_did_you_mean(name, known))
        return result


def _variable(name: ir.Expression, of: str) -> str:
    if not isinstance(name, ir.Name) or name.sheet is not None or name.book is not None:
        raise FormulaError(f"{of} needs a name where it has something else", hint="a name that looks like no cell")
    return name.name.casefold()


def _parameter(name: ir.Expression) -> tuple[str, bool]:
    """Return the folded name of a parameter, and whether it may be left out: `[b]`, as Excel shows one, reads as a
    column.
    """
    if isinstance(name, ir.TableReference) and name.first and name == ir.TableReference(None, (), name.first):
        return name.first.casefold(), True
    text = _variable(name, "LAMBDA")
    return text, text.startswith(_OPTIONAL)


def _forms(parameter: str) -> tuple[str, ...]:
    """How the calculation may call a parameter."""
    return (parameter, _NEEDED + _bare(parameter)) if parameter.startswith(_OPTIONAL) else (parameter,)


def _optional(parameters: list[tuple[str, bool]]) -> int:
    """How many of the last parameters may be left out."""
    return next((i for i, (_, optional) in enumerate(reversed(parameters)) if not optional), len(parameters))


def _bare(name: str) -> str:
    """Return a variable's name without the prefix that files give it, and by which they tell `max` from `MAX(`."""
    return _PARAMETER.sub("", name).casefold()


def _about(error: FormulaError, text: str) -> FormulaError:
    return FormulaError(error.message, where=error.where, hint=error.hint, text=text)


def _did_you_mean(name: str, known: object) -> str | None:
    close = get_close_matches(name, list(known), n=1)  # type: ignore[call-overload]
    return f"did you mean {close[0]!r}?" if close else None


def _table_column(table: Table, name: str) -> int:
    folded = [column.casefold() for column in table.columns]
    if name.casefold() not in folded:
        hint = _did_you_mean(name, table.columns)
        raise FormulaError(f"the table {table.name!r} has no column {name!r}", hint=hint)
    return table.area.left + folded.index(name.casefold())
