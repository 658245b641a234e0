"""How each kind of cell looks, and the legend that says so."""

from __future__ import annotations

from typing import Any

from xlsxwriter.format import Format
from xlsxwriter.workbook import Workbook

__all__ = ["Styles", "legend"]

_INK = "#1F3044"
_RULE = "#BFC7D1"
_CELL: dict[str, Any] = {"valign": "vcenter", "border": 1, "border_color": _RULE}
_NUMBER: dict[str, Any] = _CELL | {"align": "right", "indent": 1}
_WRAPPED: dict[str, Any] = _CELL | {"text_wrap": True, "align": "left"}

_LOOKS: dict[str, dict[str, Any]] = {
    "title": {"bold": True, "font_size": 16, "font_color": _INK},
    "subtitle": {"italic": True, "font_color": "#52606D"},
    "status": {"bold": True, "font_color": "#2E6B34"},
    "heading": {"bold": True, "font_size": 12, "font_color": _INK},
    "remark": {"font_color": "#52606D", "valign": "vcenter"},
    "band": {"indent": 1, "bold": True, "font_color": _INK, "bg_color": "#DCE3EB", "valign": "vcenter"},
    "header": _WRAPPED | {"bold": True, "font_color": "#FFFFFF", "bg_color": _INK, "align": "center"},
    "text": _WRAPPED | {"indent": 1},
    "centred": _CELL | {"align": "center"},
    "number": _NUMBER | {"locked": False},
    "assumption": _NUMBER | {"bg_color": "#C6E7B5", "locked": False},
    "name": _CELL | {"align": "center", "shrink": True, "bg_color": "#FFF2C2", "locked": False},
    "fixed": _NUMBER | {"bg_color": "#FFF2C2", "locked": False},
    "open text": _WRAPPED | {"indent": 1, "locked": False},
    "overflowing": {"indent": 1, "valign": "vcenter", "locked": False},
    "open centred": _CELL | {"align": "center", "locked": False},
    "step": _NUMBER | {"bg_color": "#F0F0F0"},
    "answer": _NUMBER | {"bg_color": "#BBDDF7", "bold": True},
    "check": _CELL | {"bg_color": "#F0F0F0", "align": "center"},
    "wrong": {"bg_color": "#F4B6B0", "font_color": "#9C0006", "bold": True},
    "as it is": {},
    "margin": {"bold": True, "font_color": _INK, "valign": "top", "text_wrap": True},
    "paragraph": {"text_wrap": True, "valign": "top"},
}

_GREY = "A formula, locked: change it only to change the model (Review, Unprotect Sheet; no password)"


def legend(check: str) -> tuple[tuple[str, str, str], ...]:
    """Look, colour and meaning of each kind of cell, where a check is called so."""
    return (
        ("assumption", "Green", "An assumption: an uncertain input, varied from trial to trial"),
        ("fixed", "Yellow", "A fixed input: yours to change, the same in every trial"),
        ("step", "Grey", _GREY),
        ("answer", "Blue", "A forecast: an answer, collected in every accepted trial"),
        ("wrong", "Red", f"A {check} that fails, a base value outside its range, or one that a filter rejects"),
    )


class Styles:
    """The formats of one workbook, made when first asked for."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._made: dict[tuple[str, str, bool], Format] = {}

    def __call__(self, look: str, number_format: str = "General", *, centred: bool = False) -> Format:
        """The format of a look (`assumption`, `header`, …), centred where its own alignment would not do.

        Raises:
            KeyError: there is no such look.
        """
        key = look, number_format, centred
        if key not in self._made:
            changes = {"num_format": number_format} | ({"align": "center", "indent": 0} if centred else {})
            self._made[key] = self._workbook.add_format(_LOOKS[look] | changes)
        return self._made[key]
