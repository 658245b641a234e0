"""Cells that show results of a run, `=CB.GetForeStatFN(B9,2)`, and the cells that depend on them: their values.

A draw cell and all else keeps the value that Excel saved: the base case. A cell that should show a result and cannot,
and all that depends on it, shows #N/A: what Excel happened to hold there belongs to another run.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.engine.saved_values import array_of, faults_of
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.formula.graph import reached
from xlmc.excel.formula.precedents import mentioned_cells, references
from xlmc.excel.formula.substitute import substitute, unfold
from xlmc.excel.workbook.injection.formula_values import with_values
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.in_cells.call_arguments import number_of
from xlmc.montecarlo.definitions.in_cells.result_functions import is_result, result_call
from xlmc.montecarlo.definitions.unavailable import areas_text
from xlmc.montecarlo.diagnostics.result_answers import Answers
from xlmc.montecarlo.number_text import count_text

__all__ = ["ShownResults", "filled_sheets", "recalculated", "shown_results"]

_ANYWHERE: Final = re.compile(r"\b(?:OFFSET|INDIRECT|CELL)\s*\(", re.IGNORECASE)
"""Functions that look for their cells while they are computed."""

_DEPENDS: Final = "depends on such a cell"


@dataclass(frozen=True, slots=True)
class ShownResults:
    """What the workbook's own cells show of a run.

    Attributes:
        values: of the cells that could be computed.
        missing: those that could not be, each with the reason; they show #N/A.
    """

    values: Mapping[Cell, CellValue] = field(default_factory=dict)
    missing: Mapping[Cell, str] = field(default_factory=dict)

    @property
    def cells(self) -> dict[Cell, CellValue]:
        """Return the values of all these cells; #N/A for those without one."""
        return {**self.values, **dict.fromkeys(self.missing, ErrorCode.NA)}

    @property
    def warning(self) -> str:
        """Which cells show #N/A, in one sentence; empty where none does."""
        if not self.missing:
            return ""
        reasons = dict.fromkeys(self.missing.values())
        listed = [f"{areas_text(c for c, why in self.missing.items() if why == each)} ({each})" for each in reasons]
        count = len(self.missing)
        cells = "1 cell of the workbook depends" if count == 1 else f"{count_text(count)} cells of the workbook depend"
        them = "it shows" if count == 1 else "they show"
        faults = "; ".join(listed)
        return f"{cells} on the run and cannot be computed, so that {them} #N/A in the result workbook: {faults}"


def filled_sheets(workbook: Workbook, shown: ShownResults) -> dict[str, bytes]:
    """Return the parts of the sheets that hold these cells, with their values: name -> bytes."""
    by_sheet: dict[str, dict[tuple[int, int], CellValue]] = {}
    for cell, value in shown.cells.items():
        by_sheet.setdefault(cell.sheet, {})[cell.row, cell.column] = value
    parts = {name: workbook.sheets[name].part for name in by_sheet}
    return {parts[name]: with_values(workbook.parts[parts[name]], parts[name], by_sheet[name]) for name in by_sheet}


def shown_results(
    workbook: Workbook,
    formulas: Mapping[Cell, ir.Expression],
    unavailable: Mapping[Cell, str],
    answers: Answers,
    at_base: Mapping[Cell, ir.Expression | FormulaError],
) -> ShownResults:
    """Return the values of the cells that show results, and of those that depend on them.

    Args:
        workbook: of the run.
        formulas: of the cells that show results.
        unavailable: those that should, and cannot -> why.
        answers: to the calls in them.
        at_base: the formulas of cells that draw or mark an answer, with base cases instead of draws; or why not.
    """
    showing = _Showing(workbook, formulas.keys() - unavailable.keys(), unavailable, at_base)
    showing.answer({cell: unfold(tree) for cell, tree in formulas.items() if cell not in unavailable}, answers)
    return showing.result()


def recalculated(workbook: Workbook, cells: Iterable[Cell]) -> ShownResults:
    """Compute the formulas that depend on cells which hold something else than when Excel saved the workbook.

    Args:
        workbook: with the new contents.
        cells: that have them; no formulas.
    """
    result = _Showing(workbook, frozenset(), {}, {}, frozenset(cells)).result()
    formulas = {cell: why for cell, why in result.missing.items() if workbook.content(cell).formula is not None}
    return ShownResults(result.values, formulas)


class _Showing:
    """The workbook's formulas, those that show results with numbers instead of the calls that ask for them."""

    def __init__(
        self,
        workbook: Workbook,
        shown: Collection[Cell],
        unavailable: Mapping[Cell, str],
        at_base: Mapping[Cell, ir.Expression | FormulaError],
        constants: frozenset[Cell] = frozenset(),
    ) -> None:
        self._workbook, self._trees = workbook, dict(at_base)
        self._missing, self._constants = dict(unavailable), constants
        self._start = constants | frozenset(shown)
        self._formulas = frozenset(workbook.formula_cells())
        inputs = self._start | unavailable.keys()
        whole = build_graph(Resolver(workbook, strict=False), self._formulas, inputs, strict=False)
        self._users: dict[Cell, set[Cell]] = {}
        self._add_needs(whole.needs)
        among = self._formulas | self._missing.keys()
        self._add_needs({cell: mentioned_cells(workbook, cell, among) for cell in whole.faults})
        looking = [cell for cell in whole.formulas if cell in self._formulas and _ANYWHERE.search(self._text(cell))]
        self._add_needs(self._looked_at(frozenset(looking)))

    def answer(self, formulas: Mapping[Cell, ir.Expression], answers: Answers) -> None:
        """Put results instead of the calls that ask for them; what one is asked by may depend on others.

        Args:
            formulas: of the cells that show results.
            answers: to the calls in them.
        """
        waiting = dict(formulas)
        while True:
            self._trees |= {cell: tree for cell, tree in waiting.items() if not _innermost(tree)}
            done = self._trees.keys() | self._missing.keys()
            waiting = {cell: tree for cell, tree in waiting.items() if cell not in done}
            blocked = self._downstream(waiting)
            ready = {cell: self._known(tree, blocked) for cell, tree in waiting.items()}
            asked = [(cell, call) for cell, calls in ready.items() for call in calls]
            if not asked:
                break
            numbers = self._numbers(asked, blocked)
            for cell, calls in ready.items():
                waiting[cell] = self._answered(cell, waiting[cell], calls, answers, numbers)
        self._missing |= dict.fromkeys(waiting, "asks for a result by a number that depends on itself")

    def _known(self, tree: ir.Expression, blocked: frozenset[Cell]) -> list[ir.Call]:
        """Return the calls in a formula whose arguments do not wait for other results."""
        return [call for call in _innermost(tree) if blocked.isdisjoint(self._cells_of(result_call(call).arguments))]

    def _cells_of(self, trees: Iterable[ir.Expression]) -> Iterator[Cell]:
        """Return the formula cells that arguments read."""
        for part in (part for tree in trees for part in references(tree)):
            if isinstance(part, Cell):
                yield part
            else:
                yield from (cell for cell in self._formulas if cell in part)

    def _numbers(
        self, asked: Iterable[tuple[Cell, ir.Call]], blocked: frozenset[Cell]
    ) -> dict[tuple[Cell, ir.Expression], float | None]:
        """Return what the arguments of calls are; None if one is no number."""
        trees = [(cell, tree) for cell, call in asked for tree in result_call(call).arguments]
        result = {each: number_of(each[1]) for each in trees}
        open_ = [each for each, number in result.items() if number is None]
        sites = {InFormula.of(cell, f"argument {k}"): (cell, tree) for k, (cell, tree) in enumerate(open_, start=1)}
        if not sites:
            return result
        self._trees |= {site: tree for site, (_, tree) in sites.items()}
        for cell, tree in sites.values():
            self._add_needs({cell: self._cells_of([tree])})
        changed = self._downstream(self._start - blocked) - self._downstream(self._missing) - blocked - self._constants
        lowering, faults = self._lowered(changed | sites.keys())
        for site, (cell, tree) in sites.items():
            if site in faults:
                self._missing[cell] = faults[site]
            else:
                value = _value(lowering, site)
                result[cell, tree] = (
                    None if isinstance(value, bool | str | ErrorCode) or value is None else float(value)
                )
        return result

    def _answered(
        self,
        cell: Cell,
        tree: ir.Expression,
        calls: Collection[ir.Call],
        answers: Answers,
        numbers: Mapping[tuple[Cell, ir.Expression], float | None],
    ) -> ir.Expression:
        """Write a formula with the results that these calls ask for."""

        def change(part: ir.Expression) -> ir.Expression | None:
            if not isinstance(part, ir.Call) or part not in calls:
                return None
            return answers.answer(result_call(part), lambda each: numbers[cell, each])

        try:
            return substitute(tree, change)
        except FormulaError as error:
            self._missing[cell] = error.message
            return tree

    def result(self) -> ShownResults:
        """Compute until no further cell turns out to depend on a result, or to be one that cannot be computed."""
        missing, changed = self._split()
        while True:
            before = missing, changed
            lowering, faults = self._lowered(changed)
            self._add_needs(lowering.graph.needs)
            self._missing |= {
                cell: reason for cell, reason in faults.items() if cell in changed or self._is_uncalculated(cell)
            }
            missing, changed = self._split()
            if (missing, changed) == before:
                break
        values = {cell: _value(lowering, cell) for cell in sorted(changed & lowering.graph.formulas.keys())}
        reasons = {cell: self._missing.get(cell, _DEPENDS) for cell in sorted(missing)}
        return ShownResults({cell: value for cell, value in values.items() if value is not None}, reasons)

    def _split(self) -> tuple[frozenset[Cell], frozenset[Cell]]:
        """Return the cells that have no value, and those that change and have one."""
        missing = self._downstream(self._missing)
        return missing, self._downstream(self._start) - missing - self._constants

    def _add_needs(self, needs: Mapping[Cell, Iterable[Cell]]) -> None:
        for cell, needed in needs.items():
            for need in needed:
                self._users.setdefault(need, set()).add(cell)

    def _text(self, cell: Cell) -> str:
        formula = self._workbook.content(cell).formula
        return "" if formula is None else formula.text

    def _looked_at(self, cells: frozenset[Cell]) -> dict[Cell, set[Cell]]:
        """Return the cells that OFFSET and INDIRECT lead to in these formulas, by the values that Excel saved."""
        if not cells:
            return {}
        resolver = Resolver(self._workbook, strict=False)

        def lower(more: Mapping[Cell, set[Cell]]) -> _Watching:
            graph = build_graph(resolver, cells, frozenset(), self._formulas - cells, more=more, strict=False)
            return _Watching(graph, self._saved(graph))

        return lower_until_complete(lower).looked_at

    def _saved(self, graph: Graph) -> dict[Cell, float]:
        """Return what Excel saved in the formula cells that a graph takes as given; any value, whatever the
        type says.
        """
        return {cell: self._workbook.content(cell).value for cell in graph.reached}  # type: ignore[misc]

    def _downstream(self, start: Iterable[Cell]) -> frozenset[Cell]:
        """Return these cells, what array formulas in them fill, and all that depends on either."""
        return frozenset(reached(start, lambda cell: (*self._users.get(cell, ()), *array_of(self._workbook, cell))))

    def _lowered(self, targets: frozenset[Cell]) -> tuple[Lowering, dict[Cell, str]]:
        """Compute the cells from the results and from what Excel saved in all others; and say why some cannot be."""
        stuck: dict[Cell, str] = {}
        resolver = Resolver(self._workbook, strict=False, rewritten=self._trees)

        def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
            given = self._given(targets) | stuck.keys()
            graph = build_graph(resolver, targets - stuck.keys(), frozenset(), given, more=more, strict=False)
            return Lowering(graph, {}, self._saved(graph))

        while True:
            try:
                lowering = lower_until_complete(lower)
            except FormulaError as error:  # Excel has saved no value that could stand in for it
                cells = [cell for cell in (self._formulas | targets) - stuck.keys() if str(cell) == error.where]
                if not cells:
                    raise
                stuck |= dict.fromkeys(cells, error.message)
            else:
                return lowering, stuck | faults_of(lowering, "cannot be computed from the results")

    def _given(self, targets: frozenset[Cell]) -> frozenset[Cell]:
        """Return the other formulas that were calculated, whose values are those that Excel saved."""
        return frozenset(cell for cell in self._formulas - targets if not self._is_uncalculated(cell))

    def _is_uncalculated(self, cell: Cell) -> bool:
        """Whether a formula has no saved value, as in books that openpyxl or XlsxWriter wrote: it is computed, too."""
        return self._workbook.content(cell).value is None


def _innermost(tree: ir.Expression) -> list[ir.Call]:
    """Return the calls for results in a formula, those left out that hold others."""
    calls: list[ir.Call] = []

    def look(part: ir.Expression) -> None:
        if isinstance(part, ir.Call) and is_result(part) and not any(map(_innermost, part.arguments)):
            calls.append(part)

    substitute(tree, look)
    return calls


class _Watching(Lowering):
    """A lowering that remembers which cells each formula asked for while it was lowered."""

    def __init__(self, graph: Graph, frozen: Mapping[Cell, float]) -> None:
        self.looked_at: dict[Cell, set[Cell]] = {}
        self._asking: set[Cell] = set()
        super().__init__(graph, {}, frozen, audit=True)

    def awaits(self, cell: Cell) -> bool:
        self._asking.add(cell)
        return super().awaits(cell)

    def lower_cell(self, cell: Cell, tree: ir.Expression) -> int:
        self._asking = self.looked_at.setdefault(cell, set())
        return super().lower_cell(cell, tree)


def _value(lowering: Lowering, cell: Cell) -> CellValue:
    value = lowering.value(cell)
    return None if value is None else value.objects().ravel()[0]
