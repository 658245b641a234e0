"""What a workbook asks of a run: assumptions, forecasts, filters, correlations and settings, and their readers."""

from __future__ import annotations

from xlmc.definitions.model import (
    Assumption,
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
    "Correlation",
    "Definitions",
    "Filter",
    "Forecast",
    "Parameter",
    "Settings",
    "name_key",
    "read_definitions",
]
