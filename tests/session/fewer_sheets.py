"""Results without the sheets, trials and fits that take longest, for tests that do not look at them."""

from __future__ import annotations

from dataclasses import replace
from inspect import unwrap

import pytest

from xlmc import outputs
from xlmc.outputs.page import payload
from xlmc.outputs.replay import sheets as repeated_sheets
from xlmc.outputs.sheets import assumptions_sheet, book, save
from xlmc.outputs.sheets.exact_book import ExactSheet

__all__ = [
    "CHARTS",
    "FEW",
    "SENSITIVITY",
    "SHORT",
    "fill_sheets",
    "keep_few_trials",
    "keep_sheets",
    "leave_out",
    "leave_out_drawings",
    "leave_out_fits",
    "leave_out_shapes",
]

CHARTS = ("Charts", "Pairs")
FEW = 40
"""Rows of a short sheet Trials."""
SENSITIVITY = ("Sensitivity", "Filter limits")
SHORT = ("Results", "Evidence results", "Scenarios", "Trials", "Record")
"""Sheets of a short result workbook."""


def leave_out(patch: pytest.MonkeyPatch, *names: str) -> None:
    """Have result workbooks written without the sheets of these names, as long as the patch lasts."""
    patch.setattr(book, "SHEETS", tuple(sheet for sheet in book.SHEETS if sheet.name not in names))


def keep_sheets(patch: pytest.MonkeyPatch, *names: str) -> None:
    """Have result workbooks written with the sheets of these names alone, as long as the patch lasts."""
    patch.setattr(book, "SHEETS", tuple(sheet for sheet in book.SHEETS if sheet.name in names))


def fill_sheets(patch: pytest.MonkeyPatch, *names: str) -> None:
    """Have result workbooks written with all sheets and all but these empty, as long as the patch lasts."""
    patch.setattr(
        book,
        "SHEETS",
        tuple(each if each.name in names else replace(each, write=lambda *_: None) for each in book.SHEETS),
    )


def leave_out_drawings(patch: pytest.MonkeyPatch) -> None:
    """Have all sheets written, but no chart drawn on them, as long as the patch lasts."""
    patch.setattr(ExactSheet, "insert_chart", lambda *_: None)


def leave_out_fits(patch: pytest.MonkeyPatch) -> None:
    """Have pages without fitted distributions, as long as the patch lasts."""
    patch.setattr(payload, "fitted_curves", lambda x, bins: [])


def leave_out_shapes(patch: pytest.MonkeyPatch) -> None:
    """Have no shapes drawn beside the assumptions, as long as the patch lasts."""
    patch.setattr(assumptions_sheet, "DRAWN", 0)


def keep_few_trials(patch: pytest.MonkeyPatch, rows: int = FEW) -> None:
    """Have the sheet Trials hold so many rows where a caller does not say how many, as long as the patch lasts."""
    for write in (outputs.save, save.save):
        patch.setitem(write.__kwdefaults__, "rows", rows)
    patch.setitem(unwrap(book.build_sheets).__kwdefaults__, "rows", rows)
    patch.setattr(repeated_sheets, "TRIAL_ROWS", rows)
