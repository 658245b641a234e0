"""Result workbooks without the sheets that take longest, for tests that do not look at them."""

from __future__ import annotations

import pytest

from xlmc.report.sheets import book

__all__ = ["CHARTS", "SENSITIVITY", "leave_out"]

CHARTS = ("Charts", "Pairs")
SENSITIVITY = ("Sensitivity", "Filter limits")


def leave_out(patch: pytest.MonkeyPatch, *names: str) -> None:
    """Have result workbooks written without the sheets of these names, as long as the patch lasts."""
    patch.setattr(book, "SHEETS", tuple(sheet for sheet in book.SHEETS if sheet.name not in names))
