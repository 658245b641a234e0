"""How `xlmc fit --into` writes a row into a person's workbook, after it was seen that the workbook is right with it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.fitting import Fitted
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.tables.new_row import RowEdit

__all__ = ["Edited", "prepare", "refuse_new_problems", "write"]


@dataclass(frozen=True, slots=True)
class Edited:
    """A workbook with its new row, not written yet; `sha256` is that of the file as it was read."""

    path: Path
    row: RowEdit
    data: bytes
    sha256: str


def prepare(path: Path, name: str, fitted: Fitted, base: float, source: str) -> Edited:
    """Read the workbook and put the row in.

    Args:
        path: of the workbook.
        name: of the assumption.
        fitted: its distribution.
        base: the value of a new row.
        source: where the distribution comes from.

    Raises:
        DefinitionError: the row has no place in the workbook, or the workbook would not be right with it.
        WorkbookError: the file cannot be read, a program has it open, or a cell of the row holds a formula.
    """
    from xlmc.analysis.studies.fitting import parameter_texts, rounded_value
    from xlmc.excel.workbook.package_check import checked_bytes
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.excel.workbook.target import refuse_into_other_format
    from xlmc.excel.workbook.writer import refuse_if_open
    from xlmc.montecarlo.definitions.tables.new_row import row_edit

    refuse_if_open(path)
    workbook = read_workbook(path)
    refuse_into_other_format(path)
    parameters = {heading: float(text) for heading, text in parameter_texts(fitted).items()}
    row = row_edit(workbook, name, fitted.name, parameters, rounded_value(fitted, base), source)
    data = checked_bytes(_parts(workbook, row), workbook.parts)
    refuse_new_problems(workbook, read_workbook(data, path.name))
    return Edited(path, row, data, workbook.sha256)


def write(edited: Edited) -> Path:
    """Replace the file, and give its path back.

    Raises:
        TakenError: it has changed since it was read, or a program has it open.
        WorkbookError: it cannot be written.
    """
    from xlmc.excel.workbook.target import refuse_into_source
    from xlmc.excel.workbook.writer import write_workbook

    write_workbook(edited.path, edited.data, lambda: refuse_into_source(edited.path, edited.sha256, "Fit again"))
    return edited.path


def _parts(workbook: Workbook, row: RowEdit) -> dict[str, bytes]:
    from xlmc.excel.workbook.injection.cell_edit import with_contents, with_last_row
    from xlmc.excel.workbook.structure import table_part

    parts = dict(workbook.parts)
    sheet = workbook.sheets[row.table.area.sheet]
    parts[sheet.part] = with_contents(parts[sheet.part], sheet.part, sheet.name, row.contents)
    if row.grows:
        part = table_part(parts, row.table.name)
        parts[part] = with_last_row(parts[part], part, row.row)
    return parts


def refuse_new_problems(before: Workbook, after: Workbook) -> None:
    """Return what the workbook did not have before: such as parameters outside the cutoffs in the row."""
    from xlmc.engine.engines import ENGINES
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels

    known = {str(each) for each in read_definitions(calculate_labels(before), ENGINES).problems}
    for problem in read_definitions(calculate_labels(after), ENGINES).problems:
        if str(problem) not in known:
            raise problem
