"""What the targets need: their formula cells in dependency order, and which of them vary with an assumption."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import assert_never

from xlmc.address import Area, Cell
from xlmc.errors import FormulaError
from xlmc.formula import ir
from xlmc.formula.resolve import Resolver
from xlmc.formula.spills import Spills
from xlmc.workbook.model import Workbook

__all__ = ["Graph", "build_graph", "references"]


_LOOKED_AT = {
    "ROW",
    "COLUMN",
    "ROWS",
    "COLUMNS",
    "AREAS",
    "SHEET",
    "SHEETS",
    "ISREF",
    "ISFORMULA",
    "FORMULATEXT",
    "CELL",
}
"""Functions that ask where their arguments are, not what they hold."""


@dataclass(frozen=True)
class Graph:
    """The needed part of a workbook.

    Attributes:
        formulas: resolved trees of the needed formula cells, each after the cells it needs. A cell that an array
            formula in another cell fills has that other cell for a tree.
        needs: every formula cell's own direct precedents that hold a formula or are inputs.
        varying: the cells among `formulas` and the inputs that depend on an input.
        reached: the inputs and held cells that something needs.
        faults: formula cells that cannot be read or need themselves, where that was allowed.
    """

    workbook: Workbook
    formulas: Mapping[Cell, ir.Expression]
    needs: Mapping[Cell, tuple[Cell, ...]]
    varying: frozenset[Cell]
    reached: frozenset[Cell]
    faults: Mapping[Cell, FormulaError]

    def text(self, cell: Cell) -> str:
        """The formula of a cell as the file holds it."""
        formula = self.workbook.content(cell).formula
        return "" if formula is None else formula.text


def build_graph(
    resolver: Resolver,
    targets: Iterable[Cell],
    inputs: frozenset[Cell],
    held: frozenset[Cell] = frozenset(),
    *,
    more: Mapping[Cell, Iterable[Cell]] | None = None,
    strict: bool = True,
) -> Graph:
    """Walk upstream from `targets`; an input is taken as given, whatever its cell holds, and so is a held cell.

    Args:
        resolver: of the workbook.
        targets: the cells wanted.
        inputs: cells that vary.
        held: cells that do not, whatever they hold.
        more: cells that a formula cell turned out to need beside those its formula names.
        strict: raise at the first faulty formula; collect the faults otherwise.

    Raises:
        FormulaError: a needed formula cannot be read, or the needed cells form a cycle.
    """
    formulas: dict[Cell, ir.Expression] = {}
    needs: dict[Cell, tuple[Cell, ...]] = {}
    reached: set[Cell] = set()
    trail: dict[Cell, Iterator[Cell]] = {}
    trees: dict[Cell, ir.Expression] = {}
    faults: dict[Cell, FormulaError] = {}

    def enter(cell: Cell) -> None:
        if cell in given:
            reached.add(cell)
        elif cell in trail:
            loop = [*trail][[*trail].index(cell) :]
            if strict:
                raise _cycle(loop)
            faults.update(dict.fromkeys(loop, _cycle(loop)))  # one message: it is as long as the loop
        elif cell not in formulas and (tree := read(cell)) is not None:
            trees[cell] = tree
            needs[cell] = (*_precedents(workbook, spills, tree, given), *(more or {}).get(cell, ()))
            trail[cell] = iter(needs[cell])

    def read(cell: Cell) -> ir.Expression | None:
        try:
            return _tree(resolver, spills, cell)
        except FormulaError as error:
            if strict:
                raise
            faults[cell] = error
            return ir.Missing()

    workbook, spills, given = resolver.workbook, Spills(resolver.workbook), inputs | held
    for target in targets:
        enter(target)
        while trail:
            cell = next(reversed(trail))
            following = next(trail[cell], None)
            if following is not None:
                enter(following)
            else:
                formulas[cell] = trees[cell]
                trail.popitem()
    return Graph(workbook, formulas, needs, _varying(formulas, needs, reached & inputs), frozenset(reached), faults)


def _tree(resolver: Resolver, spills: Spills, cell: Cell) -> ir.Expression | None:
    formula = resolver.workbook.content(cell).formula
    return spills.anchor(cell) if formula is None else resolver.formula(cell, formula)


def _precedents(workbook: Workbook, spills: Spills, tree: ir.Expression, inputs: frozenset[Cell]) -> Iterator[Cell]:
    for place in dict.fromkeys(references(tree)):
        for cell in (place,) if isinstance(place, Cell) else _held(workbook, place, inputs):
            if cell in inputs or workbook.content(cell).formula is not None or spills.anchor(cell) is not None:
                yield cell


def _held(workbook: Workbook, area: Area, inputs: frozenset[Cell]) -> Iterator[Cell]:
    """The area's cells that hold something, row by row."""
    sheet = workbook.sheets[area.sheet]
    if area.rows * area.columns <= len(sheet.cells):
        yield from area.cells()
        return
    extra = {cell for cell in inputs if cell in area}
    held = {Cell(area.sheet, row, column) for row, column in sheet.cells}
    yield from sorted(cell for cell in held | extra if cell in area)


def references(tree: ir.Expression) -> Iterator[Cell | Area]:
    """Every cell and area a resolved tree reads, from left to right."""
    match tree:
        case Cell() | Area():
            yield tree
        case ir.Unary(_, operand):
            yield from references(operand)
        case ir.Binary():
            first, rest = ir.chain(tree)
            yield from references(first)
            for _, right in rest:
                yield from references(right)
        case ir.Call(name, arguments):
            looked_at = name in _LOOKED_AT
            for part in arguments:
                if not (looked_at and isinstance(part, Cell | Area)):
                    yield from references(part)
        case ir.Let(bindings, body):
            for _, value in bindings:
                yield from references(value)
            yield from references(body)
        case ir.Lambda(_, body):
            yield from references(body)
        case ir.Invoke(function, arguments):
            yield from references(function)
            for part in arguments:
                yield from references(part)
        case ir.Array(rows):
            for row in rows:
                for part in row:
                    yield from references(part)
        case ir.Variable() | ir.Number() | ir.Text() | ir.Logical() | ir.ErrorLiteral() | ir.Missing():
            return
        case ir.Reference() | ir.Name() | ir.TableReference():
            raise TypeError(f"not resolved: {tree}")
        case _:
            assert_never(tree)


def _varying(
    formulas: Iterable[Cell], needs: Mapping[Cell, tuple[Cell, ...]], inputs: Iterable[Cell]
) -> frozenset[Cell]:
    varying = set(inputs)
    for cell in formulas:  # in dependency order: what a cell needs was settled before it
        if any(need in varying for need in needs[cell]):
            varying.add(cell)
    return frozenset(varying)


def _cycle(cells: list[Cell]) -> FormulaError:
    loop = " → ".join(str(cell) for cell in [*cells, cells[0]])
    return FormulaError(
        f"the cells need each other in a circle: {loop}",
        where=cells[0],
        hint="break the circle; iterative calculation is not supported",
    )
