"""A scenario typed into a workbook: into the very cells that it changes, with the values that Excel would show then.

Every other byte of the file stays as it was. Formulas that depend on the changed cells get the values that they compute
to. Where one cannot be computed, it keeps the value that Excel saved, and Excel is asked to calculate all formulas when
it opens the file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from xlmc.analysis.studies.scenario_answers import model_of, scenario_named
from xlmc.errors import DefinitionError, ErrorCode, WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.formats import other_format
from xlmc.excel.workbook.injection.cell_edit import Content, with_calculation_on_load, with_contents
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.host import result_sheets
from xlmc.excel.workbook.lazy_sheets import with_values
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.target import (
    Target,
    is_same_file,
    refuse_into_source,
    refuse_other_copy,
    refuse_read,
)
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.excel.workbook.writer import write_workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Assumption, Filter, Forecast
from xlmc.montecarlo.definitions.scenarios import Scenario
from xlmc.montecarlo.definitions.tables.changed_cells import NO_TABLE
from xlmc.montecarlo.diagnostics.result_cells import ShownResults, filled_sheets, recalculated
from xlmc.montecarlo.model.applied_changes import edits
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["EditedWorkbook", "edited_workbook", "write_edited"]


@dataclass(frozen=True, slots=True)
class EditedWorkbook:
    """A workbook with a scenario typed into it, not written yet.

    Attributes:
        path: of the workbook.
        scenario: what was typed.
        cells: cell -> what it held, and what it holds now; None for nothing.
        computed: how many formulas have other values now.
        left: the formulas that depend on these cells and could not be computed -> why.
        has_results: it holds result sheets of a run, which are not of this scenario.
        data: the file.
        sha256: of the file as it was read.
        read: the files that the model was read from.
    """

    path: Path
    scenario: Scenario
    cells: Mapping[Cell, tuple[CellValue, CellValue]]
    computed: int
    left: Mapping[Cell, str]
    has_results: bool
    data: bytes = field(repr=False)
    sha256: str = ""
    read: tuple[Path, ...] = ()

    @property
    def calculates(self) -> bool:
        """Whether Excel calculates all formulas when it opens the file."""
        return bool(self.left)


def edited_workbook(model: CompiledModel, scenario: Scenario | str) -> EditedWorkbook:
    """Type a scenario into the workbook of a model.

    Args:
        model: of the workbook as it is.
        scenario: itself, or its name in the table `xlmc_scenarios`.

    Raises:
        SimulationError: there is no scenario of this name.
        DefinitionError: it is not possible, or the table lacks a column for it.
        WorkbookError: one of the cells holds a formula.
    """
    result = scenario_named(model, scenario)
    wanted = model_of(model, result)
    cells, lacking = edits(model, result.changes)
    _refuse_lacking(result, lacking, model)
    book = model.workbook
    cells = {cell: value for cell, value in cells.items() if not _holds(book, cell, value)}
    _refuse_formulas(book, cells)
    shown = recalculated(with_values(book, cells), cells)
    left = {**dict.fromkeys(_of_what_if_tables(book), "Excel's what-if table"), **shown.missing} if cells else {}
    parts = {**book.parts, **_typed(book, cells)}
    parts |= filled_sheets(replace(book, parts=parts), ShownResults(shown.values))
    if left:
        part = roles(parts).workbook
        parts[part] = with_calculation_on_load(parts[part], part)
    data = checked_bytes(parts, book.parts) if cells or other_format(book.data) is not None else book.data
    _refuse_difference(
        wanted,
        build_model(read_workbook(data, book.name, book.functions), model.path, python=model.definitions.python),
        result,
    )
    typed = {cell: (book.content(cell).value, value) for cell, value in sorted(cells.items())}
    results = bool(result_sheets(book.parts))
    return EditedWorkbook(model.path, result, typed, len(shown.values), left, results, data, book.sha256, model.files)


def write_edited(edited: EditedWorkbook, path: Path, *, overwrite: bool = False) -> Path:
    """Write the file: a copy, or, where the path is the workbook's own and `overwrite` says so, the workbook itself.

    Raises:
        TakenError: the file is there already, has changed since it was read, or a program has it open.
        WorkbookError: it cannot be written, or has another ending than the workbook.
    """
    refuse_other_copy(path, edited.path)

    def check() -> None:
        if overwrite and is_same_file(path, edited.path):
            refuse_into_source(path, edited.sha256, "Try again")
            return
        refuse_read(path, edited.read, "Name another file, or type the scenario into the workbook with --in-place")
        Target(path, "", overwrite).check()

    check()
    write_workbook(path, edited.data, check)
    return path


def _holds(book: Workbook, cell: Cell, value: CellValue) -> bool:
    """Whether a cell holds the value already."""
    content = book.content(cell)
    return content.formula is None and type(content.value) is type(value) and content.value == value


def _refuse_lacking(scenario: Scenario, lacking: Mapping[str, list[str]], model: CompiledModel) -> None:
    for name, headings in lacking.items():
        filters = (*model.filters, *model.forecast_filters)
        rows: tuple[Assumption | Filter | Forecast, ...] = (*model.assumptions, *filters, *model.forecasts)
        named = {f"{each.first} and {each.second}": each.row for each in model.definitions.correlations}
        named |= {each.name: each.row for each in reversed(rows)}
        where = named.get(name) or model.definitions.switches[name][0]
        if NO_TABLE in headings:
            message = f"The scenario {scenario.name!r} changes {name!r}, which stands in no table"
            hint = "Change its formula or its dialog in Excel, or let xlmc convert write tables first"
            raise DefinitionError(message, where=where, hint=hint)
        message = f"The scenario {scenario.name!r} needs a column {headings[0]} for {name!r}, and the table has none"
        hint = f"Type {headings[0]} into the cell behind its last heading: Excel makes a column of it"
        raise DefinitionError(message, where=where, hint=hint)


def _refuse_formulas(book: Workbook, cells: Mapping[Cell, CellValue]) -> None:
    computed = Computed(book, frozenset())
    for cell in cells:
        if computed.by_formula(cell):
            hint = "Put a number into it in Excel, or leave the scenario in the table"
            raise WorkbookError("the cell holds a formula, which would be lost", where=cell, hint=hint)


def _typed(book: Workbook, cells: Mapping[Cell, CellValue]) -> dict[str, bytes]:
    """Return the parts of the sheets with these contents in their cells."""
    by_sheet: dict[str, dict[tuple[int, int], Content]] = {}
    for cell, value in cells.items():
        assert not isinstance(value, ErrorCode), "no scenario has an error typed in"
        by_sheet.setdefault(cell.sheet, {})[cell.row, cell.column] = value
    parts = {name: book.sheets[name].part for name in by_sheet}
    return {part: with_contents(book.parts[part], part, name, by_sheet[name]) for name, part in parts.items()}


def _of_what_if_tables(book: Workbook) -> list[Cell]:
    """Return the first cell of each what-if table: Excel alone fills them."""
    return [Cell(table.area.sheet, table.area.top, table.area.left) for table in book.data_tables]


def _refuse_difference(wanted: CompiledModel, model: CompiledModel, scenario: Scenario) -> None:
    """Refuse a file that would say something else than the scenario, for whatever reason.

    Raises:
        WorkbookError: it does.
    """
    if _definitions(wanted) != _definitions(model):
        message = f"the workbook would not hold the changes of the scenario {scenario.name!r}"
        raise WorkbookError(message, where=wanted.path, hint="Nothing was written; please report this")


def _definitions(model: CompiledModel) -> list[object]:
    assumptions = [
        (a.name, a.frozen, a.base, a.distribution, a.parameters, a.cutoffs, a.units, a.source)
        for a in model.assumptions
    ]
    filters = [(f.name, f.at_least, f.at_most, f.above, f.below) for f in (*model.filters, *model.forecast_filters)]
    evidence = [(each.name, each.reading, each.sizes) for each in model.evidence if each.used]
    frozen = {a.name for a in model.assumptions if a.frozen}  # whose correlations have no effect, and are not read
    rows = [c for c in model.definitions.correlations if frozen.isdisjoint((c.first, c.second))]
    correlations = [(c.first, c.second, c.value) for c in rows if c.value]  # one of 0 is none
    return [assumptions, filters, evidence, correlations, model.forecasts]
