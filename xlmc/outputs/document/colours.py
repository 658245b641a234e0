"""The colours of all outputs."""

from __future__ import annotations

from typing import Final

__all__ = ["COLOURS", "DARK", "GRID", "INK", "LIGHT"]

INK: Final = "#1F3044"

COLOURS: Final = (INK, "#2F6DA8", "#C8553D", "#4F8A5B", "#8E5EA2", "#D99A2B", "#52606D", "#3AA6A6", "#A23B5B")
"""Of lines; of many that are alike those from the second on."""

GRID: Final = "#D5DBE3"

DARK: Final = "#2F6DA8"
"""Bars inside the central range."""

LIGHT: Final = "#BCD3E8"
"""Bars outside it."""
