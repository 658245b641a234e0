"""The report on the values that a cell is to have, of a parabola whose roots are known."""

from __future__ import annotations

import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.outputs.document.parts import Figure, Paragraph, Table
from xlmc.outputs.studies.seek import seek_report


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """B3 = B1² + B2, with B1 = 3 and B2 = -4."""
    path = tmp_path_factory.mktemp("seek") / "plain.xlsx"
    workbook_of({"Model": [["x", 3], ["c", -4], ["y", "=B1^2+B2"]]}, {}).save(path)
    return path


def of(report, kind):
    return [each for each in report.blocks if isinstance(each, kind)]


def test_every_value_has_a_row_below_the_workbooks_own(path):
    report = seek_report(xlmc.seek(path, "Model!B3", 0, "Model!B1", low=-10, high=10))
    assert [each.text for each in of(report, Paragraph)] == [
        "2 values of Model!B1 from -10 to 10 make Model!B3 equal to 0."
    ]
    (table,) = of(report, Table)
    assert (table.heads, tuple(table.right)) == (("", "Model!B1", "Model!B3"), (1, 2))
    assert [row[0] for row in table.rows] == ["In the workbook", "Value 1", "Value 2"]
    assert [tuple(map(float, row[1:])) for row in table.rows] == [(3, 5), (-2, 0), (2, 0)]


def test_the_curve_and_the_value_wanted_are_drawn(path):
    (figure,) = of(seek_report(xlmc.seek(path, "Model!B3", 5, "Model!B1", low=0, high=10)), Figure)
    curve, wanted = figure.drawing.data.lines
    assert {y for _, y in wanted.points} == {5.0}
    assert [x for x, _ in wanted.points] == [curve.points[0][0], curve.points[-1][0]] == [0.0, 10.0]
    assert all(y == pytest.approx(x * x - 4) for x, y in curve.points)


def test_no_value_is_said_with_the_range_that_was_searched(path):
    report = seek_report(xlmc.seek(path, "Model!B3", -5, "Model!B1", low=-10, high=10))
    assert [each.text for each in of(report, Paragraph)] == [
        "No value of Model!B1 from -10 to 10 makes Model!B3 equal to -5."
    ]
