"""How result sheets look: colours, each kind of cell, and what all charts have in common.

A text of the workbook that a chart shows is a reference to a cell, or goes through `no_reference`, so that XlsxWriter
takes none for a formula.
"""

from __future__ import annotations

import math
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

from xlmc.outputs.document.colours import GRID, INK

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart
    from xlsxwriter.format import Format
    from xlsxwriter.workbook import Workbook

__all__ = [
    "AXIS",
    "COLOURS",
    "CREATED",
    "FONT",
    "SIZE",
    "Reference",
    "Styles",
    "across",
    "axis_format",
    "bounds",
    "finish",
    "no_reference",
    "straight",
    "upwards",
]


CREATED = datetime(2000, 1, 1)
"""The date of creation of every workbook: XlsxWriter would write today's, and no two files would be the same."""

COLOURS: Final = ("#2F6DA8", "#D1662B", "#4D8B4A", "#8659A5", "#B5912B", "#3B9C9C", "#B04A66", "#5B6470")
"""Colours of curves in one chart; most people who do not see red and green can tell them apart."""

AXIS: Final[dict[str, Any]] = {"color": "#8994A1", "width": 0.75}

FONT: Final[dict[str, Any]] = {"size": 11, "color": INK}
"""Of the texts in charts: as large as those in cells, so that they can be read on paper."""

SIZE: Final = (560, 380)
"""The size of a chart in pixels."""

_MOST_STEPS = 10

_GRIDLINES: Final = {"visible": True, "line": {"color": GRID, "width": 0.5}}

Reference = list[str | int]
"""A cell, or the cells of a column: sheet, row, column, or sheet and the first and last of each, from 0."""

_GREY = "#52606D"

_CELL: dict[str, Any] = {"valign": "vcenter", "border": 1, "border_color": GRID}

_TEXT: dict[str, Any] = _CELL | {"align": "left", "indent": 1}

_NUMBER: dict[str, Any] = _CELL | {"align": "right", "shrink": True}

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
    "range": _NUMBER | {"bold": True, "bg_color": "#BBDDF7"},
    "typed": _NUMBER | {"font_color": "#0B3D91", "bg_color": "#FFFBE0"},
    "quote": {"text_wrap": True, "valign": "vcenter", "align": "left", "indent": 1, "font_color": INK},
    "error": _NUMBER | {"font_color": _GREY},
    "second": _TEXT | _SECOND | {"text_wrap": True},
    "second number": _NUMBER | _SECOND,
    "second error": _NUMBER | _SECOND | {"font_color": _GREY},
    "moved": _NUMBER | {"bg_color": "#FCE4B6", "bold": True},
    "trial": _NUMBER | {"font_color": _GREY},
    "caption": {"text_wrap": True, "valign": "top", "font_color": INK},
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
        """Return the format of a look (`header`, `number`, …) that shows numbers in this way.

        Raises:
            KeyError: there is no such look.
        """
        key = look, number_format
        if key not in self._made:
            self._made[key] = self._workbook.add_format(_LOOKS[look] | {"num_format": number_format})
        return self._made[key]


def axis_format(number_format: str) -> str:
    """Return the format of an axis's numbers, with a minus sign (U+2212) that no program parts from its number.

    LibreOffice breaks a label after the hyphen that stands for a minus, and shows 80 for -80 with the hyphen above.

    >>> axis_format("0%")
    '0%;"−"0%'
    """
    return f'{number_format};"−"{number_format}'


def no_reference(text: str) -> str:
    r"""Return the text of a title or an axis so that it stays text, whatever it says.

    XlsxWriter takes words that hold `Sheet!A1`, say as units, for a reference, and writes one that does not exist. An
    invisible word joiner (U+2060) behind the exclamation mark keeps them words.

    >>> ascii(no_reference("Change (Model!D50)"))
    "'Change (Model!\\u2060D50)'"
    """
    return text.replace("!", "!\u2060")


def straight(chart: Any) -> Any:
    """Return the chart with lines that run straight from point to point, set for every series.

    The standard takes a series that says nothing for a smooth one (ECMA-376, 21.2.2.194), and XlsxWriter says nothing.
    """

    def write(smooth: object) -> None:
        chart._xml_empty_tag("c:smooth", [("val", int(bool(smooth)))])

    chart._write_c_smooth = write
    return chart


def finish(chart: Chart, title: Reference, *, legend: bool = True) -> None:
    """Give it its title, legend and size."""
    chart.set_title({"name": title, "name_font": {"size": 12, "bold": True, "color": INK}})
    chart.set_legend({"position": "bottom", "font": FONT} if legend else {"none": True})
    chart.set_size({"width": SIZE[0], "height": SIZE[1]})
    chart.set_chartarea({"border": {"color": GRID}})


def across(name: Reference | None = None, **more: Any) -> dict[str, Any]:
    """Return the options of the horizontal axis."""
    named: dict[str, Any] = {} if name is None else {"name": name, "name_font": {**FONT, "bold": False}}
    return {
        **named,
        "num_font": FONT,
        "label_position": "low",
        "line": AXIS,
        "major_tick_mark": "outside",
        "major_gridlines": {"visible": False},
        **more,
    }


def upwards(name: str | Reference, number_format: str = "#,##0", **more: Any) -> dict[str, Any]:
    """Return the options of the vertical axis."""
    return {
        "name": no_reference(name) if isinstance(name, str) else name,
        "name_font": {**FONT, "bold": False, "rotation": -90},
        "num_font": FONT,
        "num_format": axis_format(number_format),
        "label_position": "low",
        "line": {"none": True},
        "major_gridlines": _GRIDLINES,
        **more,
    }


def bounds(lowest: float, highest: float) -> dict[str, float]:
    """Return an axis's limits about these numbers, in four to ten round steps; nothing for numbers without a spread.

    >>> bounds(18.9, 26.6)
    {'min': 18.0, 'max': 27.0, 'major_unit': 1.0}
    """
    span = highest - lowest
    if not 1e-9 * max(abs(lowest), abs(highest)) < span < 1e300 or span < 1e-300:
        return {}
    step = 10.0 ** math.floor(math.log10(span))
    step *= next(part for part in (0.1, 0.2, 0.5, 1.0) if span / (part * step) <= _MOST_STEPS)
    ends = (math.floor(lowest / step) * step, math.ceil(highest / step) * step)
    low, high, step = (float(f"{number:.12g}") for number in (*ends, step))
    return {"min": low, "max": high, "major_unit": step}
