"""Lines over one axis in the report of a study: as a drawing, and as a chart of Excel's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.outputs.sheets.cells import Shown, spread_format
from xlmc.outputs.sheets.styles import GRID, INK, SIZE, across, bounds, straight, upwards

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.document.parts import Drawing
    from xlmc.outputs.sheets.page import Page

__all__ = ["Curves", "Line", "drawing_of", "write_chart"]

_COLOURS: Final = ("#1F3044", "#2F6DA8", "#C8553D", "#4F8A5B", "#8E5EA2", "#D99A2B")
_CHART_ROWS: Final = 17
_PRINTED: Final = 150.0
"""The width of a drawing in millimetres."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line through points `(x, y)`."""

    name: str
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Curves:
    """Lines over one axis; the first, which the others are compared with, is the thickest.

    Attributes:
        title: above them.
        across: the name of the horizontal axis.
        upwards: that of the vertical one, which runs from 0 to 1.
        lines: at most six.
    """

    title: str
    across: str
    upwards: str
    lines: tuple[Line, ...]

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest x."""
        found = [x for line in self.lines for x, _ in line.points]
        return min(found), max(found)


def drawing_of(curves: Curves) -> Drawing:
    """Draw the lines as SVG, with their names beside them."""
    from xlmc.outputs.document.drawings import drawing, line_to, path_of, text_at
    from xlmc.outputs.page.svg import scale_of

    left, right, top, bottom = 60.0, 420.0, 10.0, 250.0
    x, y = scale_of(list(curves.ends), left, right), scale_of([0.0, 1.0], bottom, top)
    found = []
    for tick in y.ticks:
        found += [
            line_to(left, y(tick), right, y(tick), GRID),
            text_at(left - 6, y(tick) + 4, y.text(tick), anchor="end"),
        ]
    found += [text_at(x(tick), bottom + 15, x.text(tick)) for tick in x.ticks]
    found.append(line_to(left, bottom, right, bottom, INK))
    for index, line in enumerate(curves.lines):
        colour, at = _COLOURS[index], top + 14 + 18 * index
        width = 1.4 if index else 2.2
        found.append(path_of([(x(a), y(b)) for a, b in line.points], colour, width))
        found += [
            line_to(right + 12, at, right + 34, at, colour, width),
            text_at(right + 40, at + 4, line.name, anchor="start"),
        ]
    found.append(text_at((left + right) / 2, bottom + 34, curves.across))
    found.append(text_at(14, (top + bottom) / 2, curves.upwards, turned=True))
    label = f"{curves.title}: {', '.join(line.name for line in curves.lines)}"
    return drawing(found, 570.0, bottom + 42, label, _PRINTED)


def write_chart(page: Page, book: Workbook, curves: Curves, numbers: Page) -> None:
    """Write the lines as a chart, and go to the row behind it; `numbers` takes what they are drawn from."""
    chart = straight(book.add_chart({"type": "scatter", "subtype": "straight"}))
    sheet = numbers.sheet.get_name()
    for index, line in enumerate(curves.lines):
        column = 3 * index
        _write_points(numbers, column, line)
        last = len(line.points)
        chart.add_series(
            {
                "name": [sheet, 0, column],
                "categories": [sheet, 1, column, last, column],
                "values": [sheet, 1, column + 1, last, column + 1],
                "line": {"color": _COLOURS[index], "width": 1.5 if index else 2.25},
                "marker": {"type": "none"},
            }
        )
    low, high = curves.ends
    chart.set_title({"name": curves.title, "name_font": {"size": 12, "bold": True, "color": INK}})
    chart.set_x_axis({**across(), "name": curves.across, **bounds(low, high)})
    chart.set_y_axis({**upwards(curves.upwards, "0%"), "min": 0, "max": 1})
    chart.set_legend({"position": "right"})
    chart.set_size({"width": SIZE[0], "height": SIZE[1]})
    page.sheet.insert_chart(page.row, 0, chart, {"object_position": 1, "description": curves.title})
    page.row += _CHART_ROWS


def _write_points(numbers: Page, column: int, line: Line) -> None:
    numbers.sheet.set_column(column, column + 1, 16)
    for offset, head in enumerate((line.name, "Share at most")):
        numbers.put(0, column + offset, Shown(head, look="header left"))
    formats: Sequence[str] = (spread_format(line.points[-1][0] - line.points[0][0]), "0.00%")
    for offset, form in enumerate(formats):
        numbers.numbers(1, column + offset, [point[offset] for point in line.points], form)
