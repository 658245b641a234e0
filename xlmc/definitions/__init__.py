"""What a workbook asks of a run (assumptions, forecasts, filters, checks, correlations, settings), and its readers."""

from __future__ import annotations

from xlmc.definitions.model import (
    Assumption,
    Check,
    Correlation,
    Definitions,
    Filter,
    Forecast,
    Parameter,
    Settings,
    name_key,
)
from xlmc.definitions.reader import read_definitions

__all__ = [
    "Assumption",
    "Check",
    "Correlation",
    "Definitions",
    "Filter",
    "Forecast",
    "Parameter",
    "Settings",
    "name_key",
    "read_definitions",
]
