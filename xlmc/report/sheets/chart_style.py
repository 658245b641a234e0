"""What all charts have in common: fonts, axes, size. Texts of the workbook: references to cells, or `no_reference`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from xlmc.report.sheets.styles import GRID, INK

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart

__all__ = [
    "AXIS",
    "COLOURS",
    "FONT",
    "SIZE",
    "Reference",
    "across",
    "axis_format",
    "bounds",
    "finish",
    "no_reference",
    "straight",
    "upwards",
]

SIZE: Final = (560, 360)
"""In pixels."""

AXIS: Final[dict[str, Any]] = {"color": "#8994A1", "width": 0.75}
FONT: Final[dict[str, Any]] = {"size": 9, "color": INK}

COLOURS: Final = ("#2F6DA8", "#D1662B", "#4D8B4A", "#8659A5", "#B5912B", "#3B9C9C", "#B04A66", "#5B6470")
"""Of curves in one chart; apart also for most of those who do not see red and green."""

_MOST_STEPS = 10

_GRIDLINES: Final = {"visible": True, "line": {"color": GRID, "width": 0.5}}

Reference = list[str | int]
"""A cell, or the cells of a column: sheet, row, column, or sheet and the first and last of each, from 0."""


def axis_format(number_format: str) -> str:
    """The format of an axis's numbers, with a minus sign (U+2212) that no program parts from its number.

    LibreOffice breaks a label after the hyphen that stands for a minus, and shows 80 for -80 with the hyphen above.

    >>> axis_format("0%")
    '0%;"−"0%'
    """
    return f'{number_format};"−"{number_format}'


def no_reference(text: str) -> str:
    r"""The text of a title or an axis so that it stays text, whatever it says.

    XlsxWriter takes words that hold `Sheet!A1`, say as units, for a reference, and writes one that does not exist. An
    invisible word joiner (U+2060) behind the exclamation mark keeps them words.

    >>> ascii(no_reference("Change (Model!D50)"))
    "'Change (Model!\\u2060D50)'"
    """
    return text.replace("!", "!\u2060")


def straight(chart: Any) -> Any:
    """The chart, with lines that run straight from point to point, said of every series.

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
    """The horizontal axis."""
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
    """The vertical axis."""
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
    """An axis's limits about such numbers, in four to ten round steps; nothing for numbers without a spread.

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
