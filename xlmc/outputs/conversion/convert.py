"""A workbook with its definitions as tables, written beside it; the same accepted trials, bit for bit.

All parts of the workbook stay as they are, but for those that any new sheet extends. Before the file is written it is
read again and run beside the old one: what would give other trials is never written.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from xlmc.errors import DefinitionError, FormulaError, WorkbookError
from xlmc.excel.address import Cell, InFormula, host_of
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.host import remove_result_sheets
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.structure import free_sheet_name
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.workbook import Workbook
from xlmc.excel.workbook.writer import write_workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.new_tables import NewTable, new_tables
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.cell_forms import forms_of
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.outputs.conversion.converted_sheet import SHEET, Left, built_sheet

__all__ = ["Converted", "convert"]

_TRIALS: Final = 4_096
"""Trials that both workbooks are run for."""


@dataclass(frozen=True, slots=True)
class Converted:
    """What was written.

    Attributes:
        path: where.
        tables: on the new sheet.
        left: what could not be converted.
    """

    path: Path
    tables: tuple[NewTable, ...]
    left: tuple[Left, ...]


def convert(model: CompiledModel, path: Path, *, overwrite: bool = False) -> Converted:
    """Write the workbook with its definitions as tables.

    Args:
        model: of the workbook.
        path: where to.
        overwrite: replace any file that is there.

    Raises:
        TakenError: the file is not ours to replace, or is the workbook itself.
        WorkbookError: there is nothing to convert, or the file cannot be written.
        DefinitionError: the new workbook would not be right.
    """
    target = Target(path, "", overwrite, read=model.files)
    target.check()
    workbook, definitions = model.workbook, model.definitions
    tables = tuple(new_tables(workbook, definitions))
    left = tuple(_left(workbook, definitions, tables))
    if not tables:
        hint = "It can be run as it is"
        raise WorkbookError("all that the workbook defines is in xlmc's tables already", where=model.path, hint=hint)
    parts = inject(
        remove_result_sheets(workbook.parts),
        built_sheet(tables, left, free_sheet_name(workbook.parts, SHEET), _formats(workbook, tables)),
        replace=False,
        marked=False,
    )
    data = checked_bytes(parts, workbook.parts)
    _compare(model, build_model(read_workbook(data, path.name, workbook.functions), path))
    write_workbook(path, data, target.check)
    return Converted(path, tables, left)


def _formats(workbook: Workbook, tables: tuple[NewTable, ...]) -> dict[Cell, str]:
    """Return the number formats of calls whose cells show dates, percentages or money."""
    calls = [row.call for table in tables for row in table.rows if row.call is not None]
    forms = forms_of(workbook, [host_of(call) for call in calls])
    return {call: form.code for call, form in zip(calls, forms, strict=True) if form.kind is not Kind.NUMBER}


def _left(workbook: Workbook, definitions: Definitions, tables: tuple[NewTable, ...]) -> Iterator[Left]:
    """Say what stays where it is, and is read from there or refused."""
    done = {row.call for table in tables for row in table.rows if row.call is not None}
    for each in definitions.assumptions:
        if isinstance(each.cell, InFormula) and each.cell not in done:
            was = each.notes.get("Call", "")
            yield Left("assumption", each.name, str(each.cell), was, "its call, as before: no row can say it")
    for cell, why in definitions.rewritten.items():
        if isinstance(why, FormulaError) and not isinstance(cell, InFormula) and cell not in definitions.results:
            constant = workbook.content(cell).formula is None
            yield Left("cell", "", str(cell), "", why.message, cell if constant else None)
    settings = [row.name for table in tables if table.kind == "xlmc_settings" for row in table.rows]
    if settings and definitions.settings.stopping.has_goal and "Precision of" not in settings:
        yield Left("setting", "Precision", "", "precision control", "nothing: no row can say it; --precision can")
    for refused in definitions.refused:
        yield Left("refused", "", str(refused.where or ""), "", refused.message)


def _compare(old: CompiledModel, new: CompiledModel) -> None:
    """Run both.

    Raises:
        DefinitionError: a trial differs.
    """
    one, other = (simulate(each, trials=_TRIALS, sampling="mc", engine="numpy") for each in (old, new))
    different = _difference(one, other)
    if different:
        hint = "Leave the workbook as it is, which runs, and tell the authors of xlmc"
        raise DefinitionError(f"the converted workbook would draw {different} otherwise", where=old.path, hint=hint)


def _difference(one: RunResult, other: RunResult) -> str:
    """Return the first thing that differs between two runs; empty where they are the same to the last bit."""
    if not np.array_equal(one.trial_index, other.trial_index):
        return "the accepted trials"
    for columns, others in ((one.inputs, other.inputs), (one.forecasts, other.forecasts)):
        if columns.keys() != others.keys():
            return ", ".join(sorted(columns.keys() ^ others.keys()))
        for name, values in columns.items():
            if not np.array_equal(values, others[name], equal_nan=True):
                return repr(name)
    return "" if one.discards == other.discards else "what filters discard"
