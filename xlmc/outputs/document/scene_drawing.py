"""The scene as the workbook draws it: the chart of points and lines on its sheet Scene, or Drawing.

The points are those that the program that saved the workbook stored in the chart, so they are those of its base case.
Axes of the same units have the same scale, so that angles and lengths are right.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final
from xml.etree.ElementTree import Element

from xlmc.excel.workbook.safe_xml import tree
from xlmc.excel.workbook.workbook import Workbook
from xlmc.outputs.document.colours import GRID, INK
from xlmc.outputs.document.drawings import Scale, drawing, line_to, path_of, scale_of, text_at
from xlmc.outputs.document.parts import Drawing

__all__ = ["SceneLine", "scene_drawing", "scenes"]

_CHART: Final = re.compile(r"xl/charts/chart\d+\.xml")
_SHEET: Final = re.compile(r"'?(scene|drawing|restitution)'?!", re.IGNORECASE)
_COLOUR: Final = re.compile("[0-9A-Fa-f]{6}")
_MOST_SERIES, _MOST_POINTS = 40, 2_000
"""What a scene has at most; a chart with more is another kind of picture, and is not drawn."""
_WIDTH, _HIGHEST, _LOWEST = 400.0, 330.0, 90.0
_LEFT, _TOP = 44.0, 10.0

_Points = list[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class SceneLine:
    """A named line of the chart, or marks.

    Attributes:
        marks: the points are marked, and no line joins them.
        where: the references of x and of y.
    """

    name: str
    points: _Points
    colour: str
    dashed: bool
    marks: bool
    where: tuple[str, str]


def scene_drawing(workbook: Workbook) -> Drawing | None:
    """Draw the first chart of the sheet Scene, or Drawing; return None if the workbook has none.

    Raises:
        WorkbookError: the part of a chart is no XML.
    """
    return next((_drawn(*result) for result in scenes(workbook)), None)


def scenes(workbook: Workbook) -> Iterator[tuple[list[SceneLine], list[str]]]:
    """Iterate over such charts, each as its lines and the titles of its axes.

    Raises:
        WorkbookError: the part of a chart is no XML.
    """
    for part in sorted(name for name in workbook.parts if _CHART.fullmatch(name)):
        root = tree(workbook.parts[part], part)
        lines = [line for line in map(_line, root.iterfind(".//{*}scatterChart/{*}ser")) if line is not None]
        if lines and len(lines) <= _MOST_SERIES:
            yield lines, [_words(axis) for axis in root.iterfind(".//{*}valAx/{*}title")]


def _line(series: Element) -> SceneLine | None:
    """Return a series of points on the sheet; None if it is on another sheet, is too long, or is not shown."""
    where = [formula.text or "" for formula in series.iterfind("./*/{*}numRef/{*}f")]
    if len(where) != 2 or not all(map(_SHEET.match, where)):
        return None
    x, y = (_numbers(series.find(f"{{*}}{axis}")) for axis in ("xVal", "yVal"))
    shown = series.find("{*}spPr")
    outline = None if shown is None else shown.find("{*}ln")
    marker = series.find("{*}marker")
    marks = outline is not None and outline.find("{*}noFill") is not None
    if marks and (marker is None or marker.find("{*}symbol[@val='none']") is not None):
        return None
    coloured = marker.find("{*}spPr") if marks and marker is not None else outline
    points = [(x[index], y[index]) for index in sorted(x.keys() & y.keys())]
    if not points or len(points) > _MOST_POINTS:
        return None
    colour = None if coloured is None else coloured.find("{*}solidFill/{*}srgbClr")
    value = "" if colour is None else colour.get("val", "")
    dashed = outline is not None and outline.find("{*}prstDash") is not None
    name = series.find("{*}tx")
    return SceneLine(
        "" if name is None else _words(name),
        points,
        f"#{value}" if _COLOUR.fullmatch(value) else INK,
        dashed,
        marks or len(points) == 1,
        (where[0], where[1]),
    )


def _words(element: Element) -> str:
    """Return the text of a title or of a name; of a reference, the text that the program has stored."""
    return " ".join(part.text.strip() for tag in ("t", "v") for part in element.iterfind(f".//{{*}}{tag}") if part.text)


def _numbers(axis: Element | None) -> dict[int, float]:
    """Return the stored numbers by their index; texts and blanks are left out."""
    result = {}
    for point in () if axis is None else axis.iterfind(".//{*}numCache/{*}pt"):
        written = point.find("{*}v")
        try:
            index, value = int(point.get("idx", "")), float((written.text if written is not None else None) or "")
        except ValueError:
            continue
        if math.isfinite(value) and abs(value) < 1e9:
            result[index] = value
    return result


def _widened(scale: Scale, least: float) -> Scale:
    """Return the scale widened on both sides until it spans `least` or more."""
    room = (least - (scale.high - scale.low)) / 2
    return scale if room <= 0 else scale_of([scale.low - room, scale.high + room], 0.0, 1.0, most=4)


def _with_step(scale: Scale, step: float) -> Scale:
    """Return the scale with a coarser step if that leaves it two ticks, else unchanged."""
    coarser = replace(scale, step=step)
    return coarser if len(coarser.ticks) > 1 else scale


def _drawn(lines: list[SceneLine], axes: list[str]) -> Drawing:
    points = [point for line in lines for point in line.points]
    across = scale_of([x for x, _ in points], 0.0, 1.0)
    up = scale_of([y for _, y in points], 0.0, 1.0)
    wide, high = (_WIDTH - _LEFT) / (across.high - across.low), _HIGHEST / (up.high - up.low)
    if len({title.rpartition(",")[2].strip() for title in axes}) == 1:
        wide = high = min(wide, high)
        up = _widened(up, _LOWEST / high)
        step = max(across.step, up.step)
        across, up = _with_step(across, step), _with_step(up, step)
    right, bottom = _LEFT + wide * (across.high - across.low), _TOP + high * (up.high - up.low)
    x = Scale(across.low, across.high, _LEFT, right, across.step)
    y = Scale(up.low, up.high, bottom, _TOP, up.step)
    result = []
    result += [line_to(x(tick), _TOP, x(tick), bottom, GRID) for tick in x.ticks]
    result += [text_at(x(tick), bottom + 14, text) for tick, text in x.apart]
    for tick, text in y.marks:
        result += [line_to(_LEFT, y(tick), right, y(tick), GRID)]
        result.append(text_at(_LEFT - 6, y(tick) + 4, text, anchor="end"))
    for number, line in enumerate(lines):
        drawn = [(x(a), y(b)) for a, b in line.points]
        row = _TOP + 8 + 16 * number
        if line.marks:
            places = [*drawn, (right + 25, row)]
            result += [f'<circle cx="{a:.2f}" cy="{b:.2f}" r="3" fill="{line.colour}"/>' for a, b in places]
        else:
            result.append(path_of(drawn, line.colour, 1.8, dashed=line.dashed))
            result.append(line_to(right + 14, row, right + 36, row, line.colour, 1.8, dashed=line.dashed))
        result.append(text_at(right + 42, row + 4, line.name[:40], anchor="start"))
    if len(axes) == 2:
        result.append(text_at((_LEFT + right) / 2, bottom + 30, axes[0]))
        result.append(text_at(10, (_TOP + bottom) / 2, axes[1], turned=True))
    height = max(bottom + 38, _TOP + 16 * len(lines) + 10)
    message = f"The drawing, with {', '.join(line.name for line in lines)}"
    return drawing(result, right + 220, height, message, 160.0)
