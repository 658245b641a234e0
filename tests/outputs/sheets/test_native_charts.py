"""A chart that Excel draws has the numbers of its description, the errors among them."""

from __future__ import annotations

import io

import openpyxl
import pytest
import xlsxwriter
from openpyxl.utils import range_boundaries

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.outputs.document.charts import limit_chart_of_ranges
from xlmc.outputs.document.parts import Bar, Bars, Chart, Figure, Line, Lines
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import Styles
from xlmc.outputs.sheets.xlsx_writer import Charting, write_blocks

SHARE = Form(Kind.PERCENT)


def written(data):
    """The chart of a description as Excel's file has it, and what gives the values of a reference."""
    stream = io.BytesIO()
    with xlsxwriter.Workbook(stream) as made:
        page = Page(made.add_worksheet("Shown"), Styles(made), ())
        numbers = Page(made.add_worksheet("Numbers"), Styles(made), ())
        chart = Chart("Title", "across", data, "said")
        write_blocks(page, [Figure(chart, "caption")], Charting(made, lambda: numbers))
    book = openpyxl.load_workbook(stream)

    def values(reference):
        left, top, right, bottom = range_boundaries(reference.rpartition("!")[2].replace("$", ""))
        rows = book["Numbers"].iter_rows(top, bottom, left, right, values_only=True)
        return [value for row in rows for value in row]

    return book["Shown"]._charts[0], values


def test_bars_of_two_looks_are_two_series_that_a_legend_names():
    bars = tuple(Bar(name, ((0.0, -low, "light"), (0.0, low, "dark"))) for name, low in (("a", 2.0), ("b", 1.0)))
    chart, values = written(Bars(bars, looks=(("light", "below"), ("dark", "above"))))
    assert [values(each.val.numRef.f) for each in chart.series] == [[-2.0, -1.0], [2.0, 1.0]]
    assert [values(each.tx.strRef.f) for each in chart.series] == [["below"], ["above"]]
    assert chart.legend is not None


def test_bars_of_one_piece_are_one_series_with_whiskers_and_pale_ones():
    bars = (Bar("a", ((0.0, 0.5, "dark"),), (0.4, 0.6)), Bar("b", ((0.0, 0.1, "light"),)))
    chart, values = written(Bars(bars, SHARE))
    (series,) = chart.series
    assert values(series.val.numRef.f) == [0.5, 0.1]
    assert values(series.errBars.plus.numRef.f) == [pytest.approx(0.1), None]
    assert [each.spPr.solidFill.srgbClr for each in series.dPt] == ["2F6DA8", "BCD3E8"]
    assert chart.y_axis.numFmt.formatCode.startswith("0%")


def test_lines_have_the_errors_of_their_points_and_axes_that_reach_over_them():
    lines = (Line("a", ((10.0, 0.2, 0.1), (12.0, 0.9, 0.3))), Line("b", ((10.0, 0.5), (12.0, 0.6))))
    chart, values = written(Lines(lines, "share", dots=True, form_upwards=SHARE))
    first, second = chart.series
    assert values(first.xVal.numRef.f) == [10.0, 12.0]
    assert values(first.yVal.numRef.f) == [0.2, 0.9]
    assert values(first.errBars.plus.numRef.f) == [0.1, 0.3]
    assert second.errBars is None
    assert (chart.x_axis.scaling.min, chart.x_axis.scaling.max) == (10.0, 12.0)
    assert (chart.y_axis.scaling.min, chart.y_axis.scaling.max) == (0.0, 1.0)


def test_an_axis_across_0_is_left_to_the_program():
    """LibreOffice writes 1E-17 there otherwise."""
    chart, _ = written(Lines((Line("a", ((-0.15, 1.0), (0.15, 2.0))),), "y"))
    assert chart.x_axis.scaling.min is None


def test_a_change_of_an_answer_without_a_range_is_no_part_of_it(make):
    run = make.simulate(
        {"A1": 0.5, "B1": "=IF(A1<0.99,3,2)", "C1": "=A1"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1")],
        [make.filter("f", "C1", at_most=0.7)],
    )
    from xlmc.analysis.studies.sensitivity import sensitivities

    result = sensitivities(run)
    forecasts = {each.forecast: each for each in result.forecasts}
    chart = limit_chart_of_ranges(*result.filter_limits, forecasts, [0])
    assert all(point[1] != point[1] for point in chart.data.lines[0].points)
    drawn, _ = written(chart.data)
    assert len(drawn.series) == 1


@pytest.mark.parametrize(
    ("form", "shown"),
    [
        (Form(Kind.DATE, "d-mmm-yy"), "d-mmm-yy"),
        (Form(Kind.CURRENCY, '"$"#,##0'), '"$"#,##0.00;"−""$"#,##0.00'),
        (PLAIN, 'General;"−"General'),
    ],
)
def test_numbers_below_points_are_written_as_their_cells(form, shown):
    cloud = Line("a", ((46102.0, 1.0), (46120.0, 2.0)))
    chart, _ = written(Lines((), "y", form_across=form, cloud=cloud))
    assert chart.x_axis.number_format.formatCode == shown
