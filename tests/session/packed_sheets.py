"""Result sheets alone, as a file would hold them."""

from __future__ import annotations

from typing import Any

import pytest
from fewer_sheets import keep_sheets

from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.outputs.sheets.book import build_sheets

__all__ = ["packed_sheets"]


def packed_sheets(simulation: RunResult, *names: str, **options: Any) -> bytes:
    """A workbook of the result sheets of a run, as `build_sheets` makes its parts: those of these names, or all."""
    with pytest.MonkeyPatch.context() as patch:
        if names:
            keep_sheets(patch, *names)
        return package_bytes(build_sheets(simulation, **options))
