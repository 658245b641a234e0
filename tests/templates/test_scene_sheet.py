"""The diagram: a native chart over cells that follow the inputs."""

from __future__ import annotations

import math
import re
import zipfile

import numpy as np
import pytest
from committed_books import TEMPLATES as BOOKS

from templates.build import TEMPLATES
from templates.description import Look
from templates.vehicles import FIRST, SECOND, shown_label

DRAWN = [name for name, template in TEMPLATES.items() if template.diagram is not None]
PLANS = [name for name in DRAWN if TEMPLATES[name].diagram.plan]


def points(book):
    """Curve -> its points as the cells show them, (n, 2); the points are checked to stand in one block."""
    cells, result = book.sheets["Scene"].cells, {}
    for row, column in cells:
        if column == 2 and isinstance(cells[row, 2].value, int | float):
            result.setdefault(cells[row, 1].value, []).append((cells[row, 2].value, cells[row, 3].value))
    return {name: np.array(rows) for name, rows in result.items()}


def test_the_templates_with_something_to_draw_are_drawn():
    assert set(TEMPLATES) - set(DRAWN) == {"mass-calibration"}
    assert PLANS == ["momentum", "planar-impact", "planar-forward", "momentum-energy"]


@pytest.mark.parametrize("name", [name for name in BOOKS if name.removesuffix("-si") in DRAWN])
def test_the_chart_has_a_series_for_every_curve_over_its_own_cells(name, book_path, described, read):
    template = described[name]
    diagrams = {"Drawing" if template.group else "Scene": template.diagram}
    diagrams |= {} if template.curve is None else {"Restitution": template.curve}
    with zipfile.ZipFile(book_path[name]) as book:
        charts = [book.read(part).decode() for part in book.namelist() if part.startswith("xl/charts/chart")]
    for xml, (sheet, diagram) in zip(charts, diagrams.items(), strict=True):
        areas = re.findall(rf"<c:xVal>.*?<c:f>{sheet}!\$B\$(\d+)(?::\$B\$(\d+))?</c:f>", xml, re.DOTALL)
        cells = read(name).sheets[sheet].cells
        names = [[cells[row, 1].value for row in range(int(top), int(end or top) + 1)] for top, end in areas]
        for curve, labels in zip(diagram.curves, names, strict=False):
            assert labels == [shown_label(curve.name, template.vehicles)] * len(curve.points)
        assert len(areas) == len(diagram.curves) + diagram.plan


@pytest.mark.parametrize("name", PLANS)
def test_a_plan_has_one_scale(name, book_path, read):
    """Unseen corners, the same to every side of the origin and beyond every point, on a square plot."""
    drawn = points(read(name))
    [frame] = [rows for curve, rows in drawn.items() if curve.startswith("Frame")]
    reach = frame[1, 0]
    np.testing.assert_array_equal(frame, [[-reach, -reach], [reach, reach]])
    assert all(np.abs(rows).max() < reach for curve, rows in drawn.items() if not curve.startswith("Frame"))
    with zipfile.ZipFile(book_path[name]) as book:
        chart, drawing = (book.read(part).decode() for part in ("xl/charts/chart1.xml", "xl/drawings/drawing1.xml"))
    width, height = (float(re.search(rf'<c:{side} val="([\d.]+)"/>', chart)[1]) for side in "wh")
    [size] = re.findall(r'</xdr:from><xdr:ext cx="(\d+)" cy="(\d+)"/>', drawing)  # told, not left to column widths
    assert width * int(size[0]) == pytest.approx(height * int(size[1]))


@pytest.mark.parametrize("name", PLANS)
def test_vehicles_are_drawn_where_they_are_and_as_they_head(name, read, shown):
    drawn, base = points(read(name)), shown(name)
    for j in (1, 2):
        corners, approach = drawn[f"Vehicle {j}"], drawn[f"Vehicle {j} approach"]
        heading = np.array([math.cos(math.radians(base[f"alpha_{j}"])), math.sin(math.radians(base[f"alpha_{j}"]))])
        assert np.linalg.norm(corners[1] - corners[0]) == pytest.approx(base[f"width_{j}"])
        assert (corners[3] - (corners[0] + corners[1]) / 2) @ heading == pytest.approx(base[f"length_{j}"])
        np.testing.assert_allclose(approach[1], (corners[0] + corners[1]) / 2, atol=1e-12)
        assert (approach[1] - approach[0]) @ heading == pytest.approx(0.9 * base[f"length_{j}"])
        tail, tip = drawn[f"Vehicle {j} departure, to rest"][:2]
        direction = math.radians(base[f"beta_{j}"])
        np.testing.assert_allclose(tip - tail, base[f"s_{j}"] * np.array([math.cos(direction), math.sin(direction)]))
        np.testing.assert_allclose(drawn["Rest"][j - 1], tip)
        if not name.startswith("momentum"):
            np.testing.assert_allclose(tail, [base[f"a_{j}"], base[f"b_{j}"]])


def test_the_skid_is_drawn_from_the_answer_to_the_end(shown, read):
    drawn, base = points(read("skid"))["Speed"], shown("skid")
    np.testing.assert_allclose(drawn[0], [0, base["v_mph"]])
    np.testing.assert_allclose(drawn[-1], [base["d_skid"], base["v_end"]])
    assert (np.diff(drawn[:, 1]) <= 0).all()


def test_looks_of_the_two_vehicles_differ():
    for name in PLANS:
        looks = {curve.name: curve.look for curve in TEMPLATES[name].diagram.curves}
        assert (looks[FIRST], looks[SECOND]) == (Look.FIRST, Look.SECOND)
