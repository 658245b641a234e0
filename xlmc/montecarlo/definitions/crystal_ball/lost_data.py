"""Workbooks that Crystal Ball has been in, and whose definitions are no longer there, or not where they are read.

Another program that saves the workbook keeps the names and the hidden sheet, and drops the data. Crystal Ball up to
2000.x kept all in defined names that begin with Z: `ZA0` its version, `ZA100`, … an assumption each.
"""

from __future__ import annotations

import re
from typing import Final

from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.crystal_ball.object_names import ObjectNames
from xlmc.montecarlo.definitions.problems import Findings

__all__ = ["remark_on_lost_data"]

_SHEET: Final = "cb_data_"
_OLD: Final = re.compile(r"_?Z[ACDF]\d+[A-Z]{0,2}", re.IGNORECASE)
_OLD_VERSION: Final = re.compile(r"_?ZA0", re.IGNORECASE)
"""A conversion puts an underscore before a name that would be a cell's address."""


def remark_on_lost_data(workbook: Workbook, otherwise_defined: bool, findings: Findings) -> None:
    """Tell of definitions of Crystal Ball that are lost, or of a generation that is not read.

    It is a mistake where nothing else says what to run, and a remark else.

    Args:
        workbook: without Crystal Ball's data.
        otherwise_defined: whether tables or calls say what to run.
        findings: takes it.
    """
    result = _lost(workbook) or _older(workbook)
    if result is None:
        return
    where, message, hint = result
    if otherwise_defined:
        findings.notice(f"{message}; what the tables and the cells define is run without them", where)
    else:
        findings.problem(message, where, hint)


def _lost(workbook: Workbook) -> tuple[str, str, str] | None:
    mark = next((name for name in workbook.sheets if name.casefold().startswith(_SHEET)), None)
    if mark is None and not ObjectNames(workbook).any:
        return None
    message = "the definitions of Crystal Ball's dialogs are lost: another program has saved the workbook"
    hint = (
        "Open the original workbook in Excel with Crystal Ball and save it as .xlsx, or write the definitions as rows "
        "of the tables xlmc_assumptions and xlmc_forecasts"
    )
    return mark or workbook.name, f"{message}, and its data are gone", hint


def _older(workbook: Workbook) -> tuple[str, str, str] | None:
    names = [each.name for each in workbook.names if _OLD.fullmatch(each.name)]
    if not any(map(_OLD_VERSION.fullmatch, names)):
        return None
    message = (
        "the workbook was made with Crystal Ball 2000 or older, which kept its definitions in defined names "
        f"({', '.join(names[:3])}…); they are not read"
    )
    hint = (
        "Open it once with Crystal Ball 7 or later and save it as .xlsx, or write the definitions as rows of the "
        "tables xlmc_assumptions and xlmc_forecasts"
    )
    return workbook.name, message, hint
