from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.document.scene_drawing import scene_drawing

TEMPLATES = Path(__file__).parents[3] / "templates"
CHART = (
    '<c:chartSpace xmlns:c="c" xmlns:a="a"><c:plotArea><c:scatterChart>{series}</c:scatterChart>'
    "<c:valAx><c:title><a:t>X, ft</a:t></c:title></c:valAx><c:valAx><c:title><a:t>{up}</a:t></c:title></c:valAx>"
    "</c:plotArea></c:chartSpace>"
)
AXIS = "<c:{axis}><c:numRef><c:f>{sheet}!$A$1</c:f><c:numCache>{points}</c:numCache></c:numRef></c:{axis}>"


def axis(name, values, sheet):
    points = "".join(f'<c:pt idx="{index}"><c:v>{value}</c:v></c:pt>' for index, value in enumerate(values))
    return AXIS.format(axis=name, sheet=sheet, points=points)


def series(x, y, *, name="car", sheet="Scene", line='<a:solidFill><a:srgbClr val="112233"/></a:solidFill>'):
    head = f"<c:tx><c:v>{name}</c:v></c:tx><c:spPr><a:ln>{line}</a:ln></c:spPr>"
    return f"<c:ser>{head}{axis('xVal', x, sheet)}{axis('yVal', y, sheet)}</c:ser>"


def book(*drawn, up="Y, ft"):
    chart = CHART.format(series="".join(drawn), up=up).encode()
    return Workbook("book.xlsx", {}, parts={"xl/charts/chart1.xml": chart})


def paths(drawing):
    """The points of every path."""
    root = ElementTree.fromstring(drawing.svg)
    result = [each.get("d") for each in root.iter("{http://www.w3.org/2000/svg}path")]
    return [[tuple(map(float, pair)) for pair in re.findall(r"[ML](-?[\d.]+) (-?[\d.]+)", path)] for path in result]


def test_a_square_stays_a_square_where_both_axes_have_the_same_units():
    ((a, b, c, _),) = paths(scene_drawing(book(series([0, 30, 30, 0], [0, 0, 30, 30]))))
    assert b[0] - a[0] == pytest.approx(b[1] - c[1], abs=0.02)
    ((a, b, c, _),) = paths(scene_drawing(book(series([0, 30, 30, 0], [0, 0, 30, 30]), up="Speed, mph")))
    assert b[0] - a[0] != pytest.approx(b[1] - c[1], abs=5.0)


def test_a_flat_scene_has_room_and_numbers_on_both_axes():
    drawn = scene_drawing(book(series([-30, 30], [0, 4])))
    root = ElementTree.fromstring(drawn.svg)
    marked = [each.text for each in root.iter("{http://www.w3.org/2000/svg}text") if each.text.lstrip("−").isdigit()]
    assert {"−20", "0", "20"} <= {*marked}
    assert 5 <= len(marked) <= 9  # those of the upright axis, too
    assert float(root.get("viewBox").split()[3]) > 120


def test_the_title_of_the_upright_axis_alone_is_turned():
    root = ElementTree.fromstring(scene_drawing(book(series([0, 10], [0, 10]))).svg)
    texts = {each.text: each for each in root.iter("{http://www.w3.org/2000/svg}text")}
    assert "rotate(-90" in texts["Y, ft"].get("transform")
    assert texts["X, ft"].get("transform") is None
    assert float(texts["Y, ft"].get("x")) < float(texts["X, ft"].get("x"))
    assert float(texts["Y, ft"].get("y")) < float(texts["X, ft"].get("y"))


def test_up_is_up_and_right_is_right():
    ((a, b),) = paths(scene_drawing(book(series([0, 10], [0, 10]))))
    assert b[0] > a[0]
    assert b[1] < a[1]


@pytest.mark.parametrize(
    "drawn",
    [
        series([0, 1], [0, 1], sheet="Other"),
        series([0, 1], [0, 1], line="<a:noFill/>"),
        series([], []),
        series(["x", "nan"], [0, 1]),
        series([0] * 3_000, [1] * 3_000),
    ],
    ids=["another sheet", "not shown", "empty", "no numbers", "too many"],
)
def test_what_is_no_scene_is_not_drawn(drawn):
    assert scene_drawing(book(drawn)) is None
    assert len(paths(scene_drawing(book(drawn, series([0, 1], [0, 1]))))) == 1


def test_marks_without_a_line_are_drawn_each():
    marker = '<c:marker><c:symbol val="circle"/><c:spPr><a:solidFill><a:srgbClr val="B3261E"/></a:solidFill></c:spPr>'
    marked = series([2, 5], [3, 4], name="marks", line="<a:noFill/>").replace(
        "</c:spPr>", f"</c:spPr>{marker}</c:marker>", 1
    )
    drawing = scene_drawing(book(series([0, 10], [0, 10]), marked))
    assert len(paths(drawing)) == 1
    assert drawing.svg.count('fill="#B3261E"') == 3  # two marks, and one beside their name


def test_names_and_colours_never_become_markup():
    evil = "&lt;script&gt; &amp; &quot;"
    drawing = scene_drawing(book(series([0, 1], [0, 1], name=evil, line='<a:srgbClr val="&quot; onload"/>')))
    texts = [each.text for each in ElementTree.fromstring(drawing.svg).iter("{http://www.w3.org/2000/svg}text")]
    assert '<script> & "' in texts
    assert "onload" not in drawing.svg


def test_a_chart_that_is_no_xml_is_refused():
    with pytest.raises(WorkbookError):
        scene_drawing(Workbook("book.xlsx", {}, parts={"xl/charts/chart1.xml": b"<!DOCTYPE x>"}))


@pytest.mark.parametrize(
    "name", ["planar-impact", "planar-forward-si", "skid", "critical-speed-yaw", "beam-si", "project"]
)
def test_the_scene_of_a_template_is_drawn(name):
    drawing = scene_drawing(load(TEMPLATES / f"{name}.xlsx").workbook)
    assert paths(drawing)
    assert drawing.description.startswith("The drawing, with ")
