"""Result sheets alone, as a file would hold them."""

from __future__ import annotations

from typing import Any

from xlmc.report.sheets.book import build_sheets
from xlmc.run.simulation import Simulation
from xlmc.workbook.writer import package_bytes

__all__ = ["packed_sheets"]


def packed_sheets(simulation: Simulation, **options: Any) -> bytes:
    """A workbook of the result sheets of a run, as `build_sheets` makes its parts."""
    return package_bytes(build_sheets(simulation, **options))
