"""Which cells of a workbook may be uncertain inputs, and which its answers: proposals for a person to choose from."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Final

from xlmc.engine.graph.lowering import lower_cells
from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Area, Cell, column_letters
from xlmc.excel.formula import Graph, Resolver, build_graph
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.labels import is_year, label_of
from xlmc.excel.workbook.workbook import CellContent, CellValue, Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.distributions.spelling import name_key

__all__ = ["MOST_FORECASTS", "Proposal", "Proposals", "proposals"]

_SMALL: Final = 24
"""Cells of a range that are looked at one by one; a longer one is a table that formulas look something up in."""

MOST_FORECASTS: Final = 24
"""Answers that are proposed: more would make a report that nobody reads."""

_PREFIX: Final = "xlmc"

_BLANK: Final = "is blank"

_Fault = Callable[[Cell], tuple[str, str] | None]
"""Takes a cell, and returns why it cannot be meant and what to do; None where it can."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """A cell with what a row of a table would call it."""

    cell: Cell
    name: str
    units: str
    value: CellValue


@dataclass(frozen=True, slots=True)
class Proposals:
    """What was found.

    Attributes:
        assumptions: numbers that formulas use.
        forecasts: formulas that no other formula uses, and that depend on these numbers.
        further: how many more such formulas there are.
        passed_over: cells that were asked for, and hold nothing that could be meant -> what they hold.
    """

    assumptions: tuple[Proposal, ...]
    forecasts: tuple[Proposal, ...]
    further: int = 0
    passed_over: tuple[tuple[Cell, str], ...] = ()


def proposals(
    book: Workbook,
    known: Collection[Cell] = (),
    assumptions: Iterable[Area] | None = None,
    forecasts: Iterable[Area] | None = None,
    left_out: Collection[str] = (),
) -> Proposals:
    """Find cells for the tables `xlmc_assumptions` and `xlmc_forecasts`.

    Args:
        book: with values for its formulas.
        known: cells that a table defines already.
        assumptions: where to look for inputs; everywhere where None.
        forecasts: where to look for answers; everywhere where None.
        left_out: sheets that are no part of the model, such as results of a run.

    Raises:
        DefinitionError: a cell that was asked for cannot be what it is asked for as, or nothing is found at all.
    """
    formulas = [cell for cell in book.formula_cells() if cell.sheet not in left_out and not _in_own_table(book, cell)]
    if not formulas:
        hint = "Write the model as formulas first; xlmc new lists workbooks to begin with"
        raise DefinitionError("the workbook has no formula", where=book.name, hint=hint)
    graph = build_graph(Resolver(book, strict=False), formulas, frozenset(), strict=False)
    computed = Computed(book, frozenset())
    used = [cell for cell in _used(graph, formulas) if not computed.by_formula(cell)]
    passed: list[tuple[Cell, str]] = []
    if assumptions is None:
        shown = {sheet.name for sheet in book.sheets.values() if sheet.visible}
        inputs = [cell for cell in used if cell.sheet in shown and _is_quantity(book, cell)]
    else:
        inputs = list(_asked(assumptions, lambda cell: _not_an_input(book, computed, cell), "assumption", passed))
    inputs = [cell for cell in inputs if cell not in known and not _in_own_table(book, cell)]
    if forecasts is None:
        numbers = inputs if assumptions is not None else [cell for cell in used if _is_quantity(book, cell)]
        ends = list(_ends(book, formulas, frozenset(numbers)))
    else:
        ends = list(_asked(forecasts, lambda cell: _not_an_answer(book, computed, cell), "forecast", passed))
    ends = [cell for cell in ends if cell not in known]
    most = MOST_FORECASTS if forecasts is None else len(ends)
    names: set[str] = set()
    answers: set[str] = set()
    order = {name: number for number, name in enumerate(book.sheets)}

    def in_order(cells: list[Cell], asked: bool) -> list[Cell]:
        """Return the cells in the order in which they were asked for, or in which the sheets are read; each once."""
        if asked:
            return list(dict.fromkeys(cells))
        return sorted(cells, key=lambda cell: (order[cell.sheet], cell.row, cell.column))

    inputs, ends = in_order(inputs, assumptions is not None), in_order(ends, forecasts is not None)
    shown_ends = list(islice(_computable(book, ends, inputs, passed), most)) if forecasts is None else ends
    further = sum(cell not in shown_ends for cell in ends) - sum(cell in ends for cell, _ in passed)
    return Proposals(
        tuple(_proposal(book, cell, names) for cell in inputs),
        tuple(_proposal(book, cell, answers) for cell in shown_ends),
        max(0, further),
        tuple(passed),
    )


def _computable(
    book: Workbook, cells: list[Cell], inputs: list[Cell], passed: list[tuple[Cell, str]]
) -> Iterator[Cell]:
    """Yield the cells that a run can compute, with all inputs held, and note why it cannot the others."""
    resolver, varying = (
        Resolver(book, inputs),
        build_graph(Resolver(book, strict=False), cells, frozenset(inputs), strict=False).varying,
    )
    given = {cell: float(book.content(cell).value) for cell in inputs}  # type: ignore[arg-type]  # inputs are numbers

    def fault(wanted: list[Cell]) -> FormulaError | None:
        try:
            lowering = lower_cells(resolver, wanted, {}, given)
        except FormulaError as error:
            return error
        return next((each for cell, each in lowering.faults.items() if cell in varying), None)

    sure = 0 if fault(cells[:MOST_FORECASTS]) else MOST_FORECASTS
    yield from cells[:sure]
    for cell in cells[sure:]:
        why = fault([cell])
        if why is not None:
            cure = f"; {why.hint}" if why.hint else ""
            passed.append((cell, f"cannot be computed ({why.message}{cure})"))
        else:
            yield cell


def _in_own_table(book: Workbook, cell: Cell) -> bool:
    return any(table.name.casefold().startswith(_PREFIX) and cell in table.area for table in book.tables)


def _used(graph: Graph, formulas: Iterable[Cell]) -> list[Cell]:
    """Return the cells without a formula that formulas name one by one, or in a short range."""
    result: dict[Cell, None] = {}
    for cell in formulas:
        if cell not in graph.formulas:
            continue
        for part in references(graph.formulas[cell]):
            if isinstance(part, Cell):
                result[part] = None
            elif part.rows * part.columns <= _SMALL:
                result |= dict.fromkeys(part.cells())
    return [cell for cell in result if graph.workbook.content(cell).formula is None]


def _ends(book: Workbook, formulas: Collection[Cell], inputs: frozenset[Cell]) -> Iterator[Cell]:
    """Yield the numbers that depend on an input and that no formula uses."""
    graph = build_graph(Resolver(book, strict=False), formulas, inputs, strict=False)
    read = {need for cell in graph.needs for need in graph.needs.of(cell)}
    for cell in formulas:
        content = book.content(cell)
        number = type(content.value) in (int, float, type(None))
        shown = book.sheets[cell.sheet].visible and not is_year(book, cell)
        if cell in graph.varying and cell not in read and number and shown:
            yield cell


def _asked(areas: Iterable[Area], fault: _Fault, what: str, passed: list[tuple[Cell, str]]) -> Iterator[Cell]:
    """Yield the cells of areas that can be meant, and note the others.

    Raises:
        DefinitionError: no cell of an area can be.
    """
    for area in areas:
        cells = [(cell, fault(cell)) for cell in area.cells()]
        good = [cell for cell, why in cells if why is None]
        if not good:
            where, reason = next((cell, why) for cell, why in cells if why is not None)
            raise DefinitionError(f"the cell {reason[0]}, so that it is no {what}", where=where, hint=reason[1])
        passed += [(cell, why[0]) for cell, why in cells if why is not None and why[0] != _BLANK]
        yield from good


def _not_an_input(book: Workbook, computed: Computed, cell: Cell) -> tuple[str, str] | None:
    content = book.content(cell)
    if computed.by_formula(cell):
        return "holds a formula", "Name a number that the formula is computed from, or --forecast it as an answer"
    if content.is_blank:
        return _BLANK, "Type its usual value into it, or name the cell that holds it"
    if not _is_number(content):
        return "holds no number", "Name the cell that holds the number"
    return None


def _not_an_answer(book: Workbook, computed: Computed, cell: Cell) -> tuple[str, str] | None:
    content = book.content(cell)
    if content.is_blank:
        return _BLANK, "Name the cell with the formula that gives the answer"
    if not computed.by_formula(cell):
        return "holds no formula", "Name the formula that gives the answer; a number that varies is an --assumption"
    return None


def _is_quantity(book: Workbook, cell: Cell) -> bool:
    """Whether a cell holds a number that is no year at the head of a column or a row."""
    return _is_number(book.content(cell)) and not is_year(book, cell)


def _is_number(content: CellContent) -> bool:
    value = content.value
    return content.formula is None and type(value) in (int, float)


def _proposal(book: Workbook, cell: Cell, names: set[str]) -> Proposal:
    label = label_of(book, cell)
    name = label.name or str(cell)
    if name_key(name) in names:
        place = cell if len(book.sheets) > 1 else f"{column_letters(cell.column)}{cell.row}"
        name = f"{name} ({place})"
    names.add(name_key(name))
    return Proposal(cell, name, label.unit, book.content(cell).value)
