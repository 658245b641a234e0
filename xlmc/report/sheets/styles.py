"""How each kind of cell looks."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from xlsxwriter.format import Format
    from xlsxwriter.workbook import Workbook

__all__ = ["CREATED", "DARK", "GRID", "INK", "LIGHT", "Styles"]

CREATED = datetime(2000, 1, 1)
"""Of every workbook: no clock. XlsxWriter would write today's date."""

INK = "#1F3044"
GRID = "#D5DBE3"
DARK = "#2F6DA8"
"""Bars inside the central range."""
LIGHT = "#BCD3E8"
"""Bars outside it."""

_GREY = "#52606D"
_CELL: dict[str, Any] = {"valign": "vcenter", "border": 1, "border_color": GRID}
_TEXT: dict[str, Any] = _CELL | {"align": "left", "indent": 1}
_NUMBER: dict[str, Any] = _CELL | {"align": "right"}
_SECOND: dict[str, Any] = {"bg_color": "#EEF4FA"}
_HEADER: dict[str, Any] = _CELL | {"bold": True, "font_color": INK, "align": "center", "text_wrap": True}
_PARAGRAPH: dict[str, Any] = {"text_wrap": True, "valign": "top", "align": "left"}

_LOOKS: dict[str, dict[str, Any]] = {
    "title": {"bold": True, "font_size": 16, "font_color": INK},
    "subtitle": {"font_color": _GREY},
    "heading": {"bold": True, "font_size": 12, "font_color": INK},
    "header": _CELL | {"bold": True, "font_color": "#FFFFFF", "bg_color": INK, "align": "center", "text_wrap": True},
    "header left": _TEXT | {"bold": True, "font_color": "#FFFFFF", "bg_color": INK, "text_wrap": True},
    "header assumption": _HEADER | {"bg_color": "#C6E7B5"},
    "header forecast": _HEADER | {"bg_color": "#BBDDF7"},
    "name": _TEXT | {"bold": True, "font_color": INK, "text_wrap": True},
    "text": _TEXT | {"text_wrap": True},
    "label": _TEXT | {"font_color": _GREY, "text_wrap": True},
    "code": _TEXT | {"font_name": "Consolas", "font_size": 10, "text_wrap": True},
    "key": {"font_name": "Consolas", "font_size": 8, "font_color": _GREY, "valign": "vcenter"},
    "listed": {"font_name": "Consolas", "font_size": 9, "valign": "vcenter"},
    "number": _NUMBER,
    "answer": _NUMBER | {"bold": True, "bg_color": "#BBDDF7"},
    "typed": _NUMBER | {"font_color": "#0B3D91", "bg_color": "#FFFBE0"},
    "quote": {"text_wrap": True, "valign": "vcenter", "align": "left", "indent": 1, "font_color": INK},
    "error": _NUMBER | {"font_color": _GREY},
    "second": _TEXT | _SECOND | {"text_wrap": True},
    "second number": _NUMBER | _SECOND,
    "second error": _NUMBER | _SECOND | {"font_color": _GREY},
    "moved": _NUMBER | {"bg_color": "#FCE4B6", "bold": True},
    "trial": _NUMBER | {"font_color": _GREY},
    "caption": {"text_wrap": True, "valign": "top", "font_size": 10, "font_color": INK},
    "alarm": {"bold": True, "font_color": "#9C0006"},
    "paragraph": _PARAGRAPH,
    "remark": _PARAGRAPH | {"font_color": _GREY, "italic": True},
    "notice": _PARAGRAPH | {"bg_color": "#FFF6DD", "indent": 1, "valign": "vcenter"},
    "warning": _PARAGRAPH
    | {"bold": True, "font_color": "#9C0006", "bg_color": "#FBD9D5", "indent": 1, "valign": "vcenter"},
}


class Styles:
    """The formats of one workbook, made when first asked for."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._made: dict[tuple[str, str], Format] = {}

    def __call__(self, look: str, number_format: str = "General") -> Format:
        """The format of a look (`header`, `number`, …) that shows numbers in this way.

        Raises:
            KeyError: there is no such look.
        """
        key = look, number_format
        if key not in self._made:
            self._made[key] = self._workbook.add_format(_LOOKS[look] | {"num_format": number_format})
        return self._made[key]
