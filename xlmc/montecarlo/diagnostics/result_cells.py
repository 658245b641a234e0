"""Cells that show results of a run, `=CB.GetForeStatFN(B9,2)`, and the cells that depend on them: their values.

A draw cell and all else keeps the value that Excel saved: the base case. A cell that should show a result and cannot,
and all that depends on it, shows #N/A: what Excel happened to hold there belongs to another run.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from xlmc.engine.graph.arrays import size_of
from xlmc.engine.graph.lower import Lowering, lower_until_complete
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell, host_of
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.formula.precedents import mentioned
from xlmc.excel.formula.substitute import substitute
from xlmc.excel.workbook.injection.formula_values import with_values
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.in_cells.call_arguments import number_of
from xlmc.montecarlo.definitions.in_cells.result_functions import (
    CRYSTAL_BALL_STATISTICS,
    Limits,
    ResultCall,
    is_result,
    result_call,
)
from xlmc.montecarlo.definitions.unavailable import areas_text
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.sampling.draws import Draw
from xlmc.montecarlo.statistics import rank_correlation

__all__ = ["RunFacts", "ShownResults", "filled_sheets", "recalculated", "shown_results"]

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
        """The values of all these cells; #N/A where there is none."""
        return {**self.values, **dict.fromkeys(self.missing, ErrorCode.NA)}

    @property
    def warning(self) -> str:
        """Which cells show #N/A, in one sentence; empty where none does."""
        if not self.missing:
            return ""
        reasons = dict.fromkeys(self.missing.values())
        told = [f"{areas_text(c for c, why in self.missing.items() if why == each)} ({each})" for each in reasons]
        count = len(self.missing)
        cells = "1 cell of the workbook depends" if count == 1 else f"{count:,} cells of the workbook depend"
        them = "it shows" if count == 1 else "they show"
        return (
            f"{cells} on the run and cannot be computed, so that {them} #N/A in the result workbook: {'; '.join(told)}"
        )


def filled_sheets(workbook: Workbook, shown: ShownResults) -> dict[str, bytes]:
    """The parts of the sheets that hold these cells, with their values: name -> bytes."""
    by_sheet: dict[str, dict[tuple[int, int], CellValue]] = {}
    for cell, value in shown.cells.items():
        by_sheet.setdefault(cell.sheet, {})[cell.row, cell.column] = value
    parts = {name: workbook.sheets[name].part for name in by_sheet}
    return {parts[name]: with_values(workbook.parts[parts[name]], parts[name], by_sheet[name]) for name in by_sheet}


@dataclass(frozen=True, slots=True)
class RunFacts:
    """What of a run cells may ask for beside its forecasts.

    Attributes:
        trials: that were run.
        most: that were asked for.
        assumptions: of the workbook.
        draws: name of an assumption -> how it is drawn, as far as it is.
    """

    trials: int
    most: int
    assumptions: Sequence[Assumption]
    draws: Mapping[str, Draw]


def shown_results(
    workbook: Workbook,
    formulas: Mapping[Cell, ir.Expression],
    unavailable: Mapping[Cell, str],
    results: Iterable[ForecastResult],
    run: RunFacts,
    at_base: Mapping[Cell, ir.Expression | FormulaError],
) -> ShownResults:
    """The values of the cells that show results, and of those that depend on them.

    Args:
        workbook: of the run.
        formulas: of the cells that show results.
        unavailable: those that should, and cannot -> why.
        results: of the forecasts.
        run: whose results they are.
        at_base: the formulas of cells that draw or mark an answer, with base cases instead of draws; or why not.
    """
    answers = _Answers(workbook, tuple(results), run)
    trees = {cell: answers.formula(tree) for cell, tree in formulas.items() if cell not in unavailable}
    return _Showing(workbook, trees, unavailable, at_base).found()


def recalculated(workbook: Workbook, cells: Iterable[Cell]) -> ShownResults:
    """The values of the formulas that depend on cells which hold something else than when Excel saved the workbook.

    Args:
        workbook: with the new contents.
        cells: that have them; no formulas.
    """
    found = _Showing(workbook, {}, {}, {}, frozenset(cells)).found()
    formulas = {cell: why for cell, why in found.missing.items() if workbook.content(cell).formula is not None}
    return ShownResults(found.values, formulas)


class _Showing:
    """The workbook's formulas, those that show results with numbers instead of the calls that ask for them."""

    def __init__(
        self,
        workbook: Workbook,
        trees: Mapping[Cell, ir.Expression],
        unavailable: Mapping[Cell, str],
        at_base: Mapping[Cell, ir.Expression | FormulaError],
        constants: frozenset[Cell] = frozenset(),
    ) -> None:
        self._workbook, self._trees = workbook, {**at_base, **trees}
        self._missing, self._constants = dict(unavailable), constants
        self._start = constants | trees.keys()
        self._formulas = frozenset(_formulas(workbook))
        inputs = self._start | unavailable.keys()
        whole = build_graph(Resolver(workbook, strict=False), self._formulas, inputs, strict=False)
        self._needs: dict[Cell, set[Cell]] = {cell: set(needs) for cell, needs in whole.needs.items()}
        for cell in whole.faults:
            self._needs.setdefault(cell, set()).update(self._mentioned(cell))
        looking = [cell for cell in whole.formulas if cell in self._formulas and _ANYWHERE.search(self._text(cell))]
        for cell, found in self._looked_at(frozenset(looking)).items():
            self._needs.setdefault(cell, set()).update(found)

    def found(self) -> ShownResults:
        """Compute until no further cell turns out to depend on a result, or to be one that cannot be computed."""
        while True:
            missing = self._downstream(self._missing)
            changed = self._downstream(self._start) - missing - self._constants
            lowering, faults = self._lowered(changed)
            for cell, needs in lowering.graph.needs.items():
                self._needs.setdefault(cell, set()).update(needs)
            self._missing |= {
                cell: reason for cell, reason in faults.items() if cell in changed or self._is_uncalculated(cell)
            }
            now = self._downstream(self._missing), self._downstream(self._start)
            if now[0] == missing and now[1] - missing - self._constants == changed:
                break
        values = {cell: _value(lowering, cell) for cell in sorted(changed & lowering.graph.formulas.keys())}
        reasons = {cell: self._missing.get(cell, _DEPENDS) for cell in sorted(missing)}
        return ShownResults({cell: value for cell, value in values.items() if value is not None}, reasons)

    def _text(self, cell: Cell) -> str:
        formula = self._workbook.content(cell).formula
        return "" if formula is None else formula.text

    def _mentioned(self, cell: Cell) -> Iterator[Cell]:
        """The cells that a formula mentions that cannot be read."""
        formula = self._workbook.content(cell).formula
        for area in () if formula is None else mentioned(formula, cell, self._workbook):
            if area.rows * area.columns <= len(self._formulas):
                yield from area.cells()
            else:
                yield from (each for each in self._formulas | self._missing.keys() if each in area)

    def _looked_at(self, cells: frozenset[Cell]) -> dict[Cell, set[Cell]]:
        """The cells that OFFSET and INDIRECT lead to in these formulas, by the values that Excel saved."""
        if not cells:
            return {}
        resolver = Resolver(self._workbook, strict=False)

        def lower(more: Mapping[Cell, set[Cell]]) -> _Watching:
            graph = build_graph(resolver, cells, frozenset(), self._formulas - cells, more=more, strict=False)
            return _Watching(graph, self._saved(graph))

        return lower_until_complete(lower).looked_at

    def _saved(self, graph: Graph) -> dict[Cell, float]:
        """What Excel saved in the formula cells that a graph takes as given; any value, whatever the type says."""
        return {cell: self._workbook.content(cell).value for cell in graph.reached}  # type: ignore[misc]

    def _downstream(self, start: Iterable[Cell]) -> frozenset[Cell]:
        """These cells, what array formulas in them fill, and all that depends on either."""
        users: dict[Cell, list[Cell]] = {}
        for cell, needs in self._needs.items():
            for need in needs:
                users.setdefault(need, []).append(cell)
        seen: set[Cell] = set()
        open_ = list(start)
        while open_:
            cell = open_.pop()
            if cell not in seen:
                seen.add(cell)
                open_ += users.get(cell, ())
                open_ += self._filled(cell)
        return frozenset(seen)

    def _filled(self, cell: Cell) -> Iterable[Cell]:
        formula = self._workbook.content(cell).formula
        return () if formula is None or formula.array is None else formula.array.cells()

    def _lowered(self, targets: frozenset[Cell]) -> tuple[Lowering, dict[Cell, str]]:
        """The cells, computed from the results and from what Excel saved in all others; and why some cannot be."""
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
                found = [cell for cell in self._formulas - stuck.keys() if str(cell) == error.where]
                if not found:
                    raise
                stuck |= dict.fromkeys(found, error.message)
            else:
                return lowering, stuck | _faults(lowering)

    def _given(self, targets: frozenset[Cell]) -> frozenset[Cell]:
        """The other formulas that were calculated, whose values are those that Excel saved."""
        return frozenset(cell for cell in self._formulas - targets if not self._is_uncalculated(cell))

    def _is_uncalculated(self, cell: Cell) -> bool:
        """Whether a formula has no saved value, as in books that openpyxl or XlsxWriter wrote: it is computed, too."""
        return self._workbook.content(cell).value is None


class _Watching(Lowering):
    """A lowering that remembers which cells each formula asked for while it was lowered."""

    def __init__(self, graph: Graph, held: Mapping[Cell, float]) -> None:
        self.looked_at: dict[Cell, set[Cell]] = {}
        self._asking: set[Cell] = set()
        super().__init__(graph, {}, held, audit=True)

    def awaits(self, cell: Cell) -> bool:
        self._asking.add(cell)
        return super().awaits(cell)

    def lower_cell(self, cell: Cell, tree: ir.Expression) -> int:
        self._asking = self.looked_at.setdefault(cell, set())
        return super().lower_cell(cell, tree)


def _faults(lowering: Lowering) -> dict[Cell, str]:
    """The cells that have no value of their own, each with the reason."""
    found = {cell: error.message for cell, error in lowering.faults.items()}
    for cell in lowering.graph.formulas:
        formula = lowering.graph.workbook.content(cell).formula
        if cell not in found and lowering.value(cell) is None:
            found[cell] = "cannot be computed from the results"
        elif formula is not None and formula.dynamic and formula.array is not None and cell not in found:
            size = size_of(lowering.dag, lowering.array(cell)) or (1, 1)
            if size != (formula.array.rows, formula.array.columns):
                found[cell] = "spills into another area than when Excel saved it"
    return found


class _Answers:
    """What the calls that ask for results get."""

    def __init__(self, workbook: Workbook, results: Sequence[ForecastResult], run: RunFacts) -> None:
        self._workbook, self._results, self._run = workbook, results, run

    def formula(self, tree: ir.Expression) -> ir.Expression:
        """A formula with the results instead of the calls that ask for them."""
        return substitute(
            tree,
            lambda part: self._answer(result_call(part)) if isinstance(part, ir.Call) and is_result(part) else None,
        )

    def _answer(self, asked: ResultCall) -> ir.Expression:
        """What a call shows: a number or a text, or an error where there is none."""
        number = None
        if asked.number is not None:
            number = self._number(asked.number)
            if number is None:
                return ir.ErrorLiteral(ErrorCode.VALUE)
        if asked.what in ("assumption", "percent of the assumption"):
            return self._of_assumption(asked, number)
        if asked.of is None:
            if asked.what == "preference" and number != 1:
                return ir.ErrorLiteral(ErrorCode.NA)
            return ir.Number(float(self._run.trials if asked.what == "trials run" else self._run.most))
        result = self._result(asked.of)
        if result is not None and asked.limits is not None:
            result = self._between(result, asked.limits)
        other = None if asked.other is None else self._result(asked.other)
        if result is None or result.values.size == 0 or (asked.other is not None and other is None):
            return ir.ErrorLiteral(ErrorCode.NA)
        value = _statistic(result, asked, number) if other is None else _correlation(result, other, number)
        return ir.ErrorLiteral(ErrorCode.NUM) if value is None or not np.isfinite(value) else ir.Number(value)

    def _number(self, tree: ir.Expression) -> float | None:
        return number_of(tree, lambda cell: _saved_number(self._workbook, cell))

    def _result(self, of: Cell | str) -> ForecastResult | None:
        for result in self._results:
            definition = result.definition
            if definition.cell == of or (isinstance(of, str) and name_key(definition.name) == name_key(of)):
                return result
        return None

    def _between(self, result: ForecastResult, limits: Limits) -> ForecastResult | None:
        """The part of the values that a call asks about; None where its limits are no numbers."""
        ends = [None if end is None else self._number(end) for end in (limits.lower, limits.upper)]
        if any(end is None for end, tree in zip(ends, (limits.lower, limits.upper), strict=True) if tree is not None):
            return None
        if limits.percents:
            if not all(end is None or 0 <= end <= 1 for end in ends):
                return None
            ends = [None if end is None else _percentile(result, 100 * end) for end in ends]
        low, high = (given if given is not None else end for given, end in zip(ends, (-np.inf, np.inf), strict=True))
        return result.between(low, high)

    def _of_assumption(self, asked: ResultCall, number: float | None) -> ir.Expression:
        """A percentile of an assumption's distribution; its name (1), or its cutoffs (6 and 7)."""
        found = [
            a
            for a in self._run.assumptions
            if asked.of in (a.cell, host_of(a.cell))
            or (isinstance(asked.of, str) and name_key(asked.of) == name_key(a.name))
        ]
        if len(found) != 1 or number is None:
            return ir.ErrorLiteral(ErrorCode.NA)
        (assumption,) = found
        draw = self._run.draws.get(assumption.name) or assumption.checked
        if asked.what == "assumption":
            if number == 1:
                return ir.Text(assumption.name)
            cutoff = assumption.cutoffs.get({6: "lower_cutoff", 7: "upper_cutoff"}.get(int(number), ""))
            return ir.Number(cutoff) if isinstance(cutoff, float) else ir.ErrorLiteral(ErrorCode.NA)
        if draw is None or not draw.fixed or not 0 <= number <= 100:
            return ir.ErrorLiteral(ErrorCode.NUM)
        value = float(draw.percentiles(np.array([number / 100]), {})[0])
        return ir.Number(value) if np.isfinite(value) else ir.ErrorLiteral(ErrorCode.NUM)


def _statistic(result: ForecastResult, asked: ResultCall, number: float | None) -> float | None:
    """One number of a result; None where there is no such percentile, trial or statistic."""
    what = asked.what
    if what == "mean_absolute_deviation":
        return float(np.mean(np.abs(result.values - result.values.mean())))
    if number is None:
        return _by_name(result, what)
    match what:
        case "statistic":
            known = number.is_integer() and 1 <= number <= len(CRYSTAL_BALL_STATISTICS)
            return _by_name(result, CRYSTAL_BALL_STATISTICS[int(number) - 1]) if known else None
        case "percent" | "share" | "share from above":
            percent = number if what == "percent" else 100 * (number if what == "share" else 1 - number)
            return _percentile(result, percent) if 0 <= percent <= 100 else None
        case "certainty":
            return 1 - result.probability_above(number).value
        case "certainty in percent":
            return 100 * (1 - result.probability_above(number).value)
        case "certainty from above":
            return result.probability_above(number).value
        case "trial":
            held = number.is_integer() and 1 <= number <= result.values.size
            return float(result.values[int(number) - 1]) if held else None
        case "confidence":
            ends = result.mean_interval(number) if 0 < number < 1 else None
            return None if ends is None else ends[asked.upper]
        case _:
            raise ValueError(what)


def _percentile(result: ForecastResult, percent: float) -> float:
    """A percentile; where values repeat, as counts do, the add-ins show one of them: see `Sample.reaching`."""
    found, sample = result.percentile(percent).value, result.sample
    repeats = bool((sample.x[1:] == sample.x[:-1]).any())
    return sample.reaching(percent / 100) if repeats and not np.isnan(found) else found


def _correlation(first: ForecastResult, second: ForecastResult, kind: float | None) -> float | None:
    """Pearson's (1) or Spearman's (2) of the trials in which both are numbers; None for any other kind."""
    x, y = first.column, second.column
    both = ~(np.isnan(x) | np.isnan(y))
    if both.sum() < 2 or kind not in (1, 2):
        return None
    if kind == 2:
        return rank_correlation(x[both], y[both]).value
    with np.errstate(all="ignore"):
        return float(np.corrcoef(x[both], y[both])[0, 1])


def _by_name(result: ForecastResult, what: str) -> float:
    found = getattr(result.statistics, what)
    return float(found) if what == "trials" else float(found.value)


def _saved_number(workbook: Workbook, cell: Cell) -> float | None:
    value = workbook.content(cell).value
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) else None


def _formulas(workbook: Workbook) -> Iterator[Cell]:
    for sheet in workbook.sheets.values():
        for (row, column), content in sheet.cells.items():
            if content.formula is not None:
                yield Cell(sheet.name, row, column)


def _value(lowering: Lowering, cell: Cell) -> CellValue:
    value = lowering.value(cell)
    return None if value is None else value.objects().ravel()[0]
