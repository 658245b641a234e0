"""All result sheets as one workbook, built in memory."""

from __future__ import annotations

import io
from datetime import datetime
from typing import TYPE_CHECKING, Final

from xlmc.report.results import WIDTHS, write_results
from xlmc.report.page import Page
from xlmc.report.styles import Styles

if TYPE_CHECKING:
    from xlmc.simulation import Simulation


def build_sheets(simulation: Simulation, *, command: str | None = None, rows: int = 10000) -> bytes:
    from xlsxwriter import Workbook

    buffer = io.BytesIO()
    with Workbook(buffer, {"in_memory": True}) as book:
        book.set_properties({"created": datetime(2000, 1, 1)})
        styles = Styles(book)
        write_results(Page(book.add_worksheet("Results"), styles, WIDTHS), simulation)
    return buffer.getvalue()
