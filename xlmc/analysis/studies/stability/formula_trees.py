"""Formulas as trees: their parts with the nodes that compute them, and their text with the names that people gave."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

from xlmc.engine.graph.computed_references import NotYetNeeded
from xlmc.engine.graph.scope import Scope
from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, host_of, parse_address
from xlmc.excel.formula import ir
from xlmc.excel.formula.ir import formula_text
from xlmc.excel.formula.resolve import Resolver
from xlmc.excel.formula.substitute import substitute, unfold
from xlmc.excel.workbook.workbook import DefinedName, Formula, Workbook
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Trees", "factors", "parts_of", "replace_part", "terms"]

_OF_EXCEL = "_xlnm."
"""What the names begin with that Excel gives: of areas to print, of filters."""

_RANKS: Final[Mapping[str, int]] = {
    **dict.fromkeys(("=", "<>", "<", "<=", ">", ">="), 1),
    "&": 2,
    **dict.fromkeys("+-", 3),
    **dict.fromkeys("*/", 4),
    "^": 5,
}
_SIGN: Final = 6
_WHOLE: Final = 9

_CORNERS: Final = re.compile(r"(?<![\w.])\$?[A-Za-z]{1,3}\$?\d+(?::\$?[A-Za-z]{1,3}\$?\d+)?(?![\w.(])")


class _Naming:
    """The defined names of single cells."""

    def __init__(self, workbook: Workbook) -> None:
        self._names: dict[Cell, list[DefinedName]] = {}
        self._local: set[tuple[str, str]] = set()
        for defined in workbook.names:
            if defined.name.casefold().startswith(_OF_EXCEL):
                continue
            if defined.sheet is not None:
                self._local.add((defined.sheet, defined.name.casefold()))
            try:
                reference = parse_address(defined.text.replace("$", ""), "")
            except ValueError:
                continue
            if isinstance(reference, Cell):
                self._names.setdefault(reference, []).append(defined)

    def of(self, cell: Cell, sheet: str) -> str | None:
        """Return the name that a formula on a sheet may use for a cell; otherwise None.

        A name of another sheet is not known there, and one of the whole workbook is hidden by one of the sheet.
        """
        for defined in self._names.get(cell, ()):
            if defined.sheet == sheet or (
                defined.sheet is None and (sheet, defined.name.casefold()) not in self._local
            ):
                return defined.name
        return None

    def anywhere(self, cell: Cell) -> str:
        """Return a name of a cell, whatever sheet it is for; empty where it has none."""
        return next((defined.name for defined in self._names.get(cell, ())), "")


class Trees:
    """The formulas that a model needs."""

    def __init__(self, model: CompiledModel) -> None:
        self._model = model
        self.lowering, self._graph = model.lowering, model.lowering.graph
        self._formulas: dict[Cell, ir.Expression] = {}
        self._naming = _Naming(self._graph.workbook)

    def formula(self, cell: Cell) -> ir.Expression:
        """Return the formula of a cell, the same object whenever it is asked for; variables of LET are written out."""
        if cell not in self._formulas:
            self._formulas[cell] = unfold(self._graph.formulas[cell])
        return self._formulas[cell]

    def title(self, cell: Cell) -> str:
        """Return what people call a cell: a forecast, a filter, an assumption, or its defined name."""
        rows = [(row.cell, row.name) for row in self._model.forecasts]
        rows += [(row.cell, row.name) for row in self._model.filters]
        rows += [(row.cell, row.name) for row in self._model.assumptions]
        return next((name for named, name in rows if named == cell), self._naming.anywhere(cell))

    def written_formula(self, cell: Cell) -> str:
        """Return the formula of a cell as in the file, with `=`; empty where it has none."""
        text = self._graph.text(cell)
        return text and f"={text}"

    def node_of(self, tree: ir.Expression, cell: Cell) -> int | None:
        """Return the node of a part of a cell's formula; None if it has none of its own."""
        formula = self._graph.workbook.content(host_of(cell)).formula
        array = formula is not None and (formula.array is not None or formula.dynamic)
        try:
            return self.lowering.first_cell(self.lowering.lower(tree, Scope(cell, array)))
        except (FormulaError, NotYetNeeded):
            return None

    def parts(self, cell: Cell) -> Iterator[ir.Expression]:
        """Return the parts of a cell's formula, outer ones first, but for those inside LAMBDA."""
        return (part for part in parts_of(self.formula(cell)) if not isinstance(part, Cell | Area))

    def open_references(self, tree: ir.Expression) -> ir.Expression:
        """Put the formulas of cells into a part of a formula instead of references to them, one step back."""
        graph = self._graph

        def change(part: ir.Expression) -> ir.Expression | None:
            if not isinstance(part, Cell) or part in self.lowering.inputs or part not in graph.formulas:
                return None
            formula = graph.workbook.content(part).formula
            return None if formula is None or formula.array is not None or formula.dynamic else self.formula(part)

        return substitute(tree, change)

    def text(self, tree: ir.Expression, host: Cell) -> str:
        """Write a formula, without `=`, with defined names, and brackets only where they are needed."""
        return self._text(tree, host)[0]

    def read_back(self, tree: ir.Expression, cell: Cell) -> ir.Expression | None:
        """Return what a formula is once its text is typed into a cell; None if it cannot be typed."""
        resolver = Resolver(self._graph.workbook, self.lowering.inputs)
        try:
            return resolver.formula(cell, Formula(self.text(tree, cell), cell.row, cell.column))
        except FormulaError:
            return None

    def offer_formula(self, tree: ir.Expression | None, cell: Cell) -> str | None:
        """Return a formula with `=` that may be typed into a cell.

        None if its text does not say it: a number has more digits than Excel reads, or what it names has no address,
        as the draw of `RAND()`.
        """
        typed = None if tree is None else self.read_back(tree, cell)
        if tree is None or typed is None or formula_text(typed) != formula_text(tree):
            return None
        return f"={self.text(tree, cell)}"

    def _reference(self, area: Cell | Area, host: Cell) -> str:
        named = self._naming.of(area, host.sheet) if isinstance(area, Cell) else None
        if named is not None:
            return named
        text = str(area)
        sheet, mark, corners = text.rpartition("!")
        corners = _as_typed(self._graph.text(host)).get(corners, corners)
        return corners if area.sheet == host.sheet else f"{sheet}{mark}{corners}"

    def _text(self, tree: ir.Expression, host: Cell) -> tuple[str, int]:
        """Return the text, and how tightly it holds together."""
        match tree:
            case ir.Number(value) if value >= 0:
                return f"{value:.15g}", _WHOLE
            case ir.Unary("%", operand):
                return f"{self._within(operand, host, _WHOLE)}%", _WHOLE
            case ir.Unary(operator, operand):
                return f"{operator}{self._within(operand, host, _SIGN)}", _SIGN
            case ir.Binary(operator, left, right) if operator in _RANKS:
                rank = _RANKS[operator]
                return f"{self._within(left, host, rank)}{operator}{self._within(right, host, rank + 1)}", rank
            case ir.Call(name, arguments):
                return f"{name}({','.join(self._text(part, host)[0] for part in arguments)})", _WHOLE
            case _:
                return formula_text(tree, lambda area: self._reference(area, host)), _WHOLE

    def _within(self, tree: ir.Expression, host: Cell, rank: int) -> str:
        text, own = self._text(tree, host)
        return text if own >= rank else f"({text})"


def _as_typed(text: str) -> dict[str, str]:
    """Map references of a formula as they would be without `$` -> as they stand there."""
    result: dict[str, str] = {}
    for typed in _CORNERS.findall(text):
        if "$" in typed:
            result.setdefault(typed.replace("$", "").upper(), typed.upper())
    return result


def parts_of(tree: ir.Expression) -> Iterator[ir.Expression]:
    """Return the parts of a formula, itself first, in the order in which they are written; not those inside LAMBDA and
    LET.
    """
    open_ = [tree]
    while open_:
        one = open_.pop()
        yield one
        match one:
            case ir.Unary(_, operand):
                open_.append(operand)
            case ir.Binary(_, left, right):
                open_ += [right, left]
            case ir.Call(_, arguments):
                open_ += reversed(arguments)
            case _:
                pass


def replace_part(tree: ir.Expression, part: ir.Expression, other: ir.Expression) -> ir.Expression:
    """Replace one part of a formula, the very object."""
    if tree is part:
        return other
    match tree:
        case ir.Unary(_, operand):
            return replace(tree, operand=replace_part(operand, part, other))
        case ir.Binary(_, left, right):
            return replace(tree, left=replace_part(left, part, other), right=replace_part(right, part, other))
        case ir.Call(_, arguments):
            return replace(tree, arguments=tuple(replace_part(one, part, other) for one in arguments))
        case _:
            return tree


def factors(tree: ir.Expression, *, below: bool = False) -> tuple[list[ir.Expression], list[ir.Expression]]:
    """Split a product of quotients into the factors above and below the line; signs are a factor of -1.

    Args:
        tree: any.
        below: whether it stands below the line itself.
    """
    match tree:
        case ir.Binary("*", left, right):
            parts = factors(left, below=below), factors(right, below=below)
        case ir.Binary("/", left, right):
            parts = factors(left, below=below), factors(right, below=not below)
        case ir.Unary("-", operand):
            parts = factors(operand, below=below), ([ir.Number(-1.0)], [])
        case ir.Unary("+", operand):
            return factors(operand, below=below)
        case _:
            return ([], [tree]) if below else ([tree], [])
    return parts[0][0] + parts[1][0], parts[0][1] + parts[1][1]


def terms(tree: ir.Expression) -> list[tuple[int, ir.Expression]]:
    """Split a sum into its terms with their signs."""
    match tree:
        case ir.Binary("+", left, right):
            return terms(left) + terms(right)
        case ir.Binary("-", left, right):
            return terms(left) + [(-sign, term) for sign, term in terms(right)]
        case ir.Unary("-", operand):
            return [(-sign, term) for sign, term in terms(operand)]
        case ir.Unary("+", operand):
            return terms(operand)
        case _:
            return [(1, tree)]
