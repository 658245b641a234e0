"""The colours of all outputs."""

from __future__ import annotations

from typing import Final

__all__ = ["DARK", "GRID", "INK", "LIGHT"]

INK: Final = "#1F3044"

GRID: Final = "#D5DBE3"

DARK: Final = "#2F6DA8"
"""Bars inside the central range."""

LIGHT: Final = "#BCD3E8"
"""Bars outside it."""
