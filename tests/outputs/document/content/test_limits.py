"""Charts and tables of moved limits, in the form of the filter's cell and of each forecast's."""

from __future__ import annotations

import openpyxl
import pytest
from workbook_files import add_tables

import xlmc
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.outputs.document.charts import limit_chart_of_ranges, tornado_chart
from xlmc.outputs.document.content.limits import limit_blocks
from xlmc.outputs.document.parts import Figure, Heading, Table, cell_text

FORECASTS = {
    "Large": ("=B1>0.2", "General"),
    "Day": ("=46000+10*B1", "yyyy-mm-dd"),
    "Clock": ("=B1/3", "h:mm AM/PM"),
    "Cost": ("=1000*B1", '"$"#,##0'),
}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """What moves with the limit of a filter, whose cell shows a percentage."""
    book = openpyxl.Workbook()
    model, tables = book.active, book.create_sheet("Tables")
    model.title, model["B1"], model["B1"].number_format = "Model", 0.3, "0%"
    rows = [["Name", "Cell"]]
    for row, (name, (formula, digits)) in enumerate(FORECASTS.items(), 2):
        model[f"B{row}"], model[f"B{row}"].number_format = formula, digits
        rows.append([name, f"=Model!B{row}"])
    filled = {
        "xlmc_assumptions": [["Name", "Cell", "Low", "High"], ["Share", "=Model!B1", 0.1, 0.5]],
        "xlmc_forecasts": rows,
        "xlmc_filters": [["Name", "Cell", "At least"], ["Limit", "=Model!B1", 0.15]],
    }
    add_tables(tables, filled)
    book.save(path := tmp_path_factory.mktemp("limits") / "book.xlsx")
    return sensitivities(xlmc.load(path).simulate(2_000, seed=1)._run)


def test_limits_are_written_as_their_cell(result):
    blocks = [*limit_blocks(result)]
    assert next(each.text for each in blocks if isinstance(each, Heading)) == "Limit: at least 15 % (Model!B1)"
    shares, _, answers = (each for each in blocks if isinstance(each, Table))
    assert "15 %" in [cell_text(row[1]) for row in shares.rows]
    assert {cell_text(row[1]) for row in answers.rows} == {cell_text(row[1]) for row in shares.rows}
    charts = [each.drawing.data for each in blocks if isinstance(each, Figure)]
    assert {each.form_across.kind for each in charts} == {Kind.PERCENT}


def test_changes_of_a_probability_are_drawn_in_percentage_points(result):
    charts = [each.drawing.data for each in limit_blocks(result) if isinstance(each, Figure)]
    by_name = {line.name: chart for chart in charts for line in chart.lines}
    drawn = by_name["Large"]
    assert (drawn.upwards, drawn.form_upwards.tick(-0.005, 4)) == ("Change of the mean, %", "-0.50 %")
    [limit] = result.filter_limits
    changes = [point.answers[0].change.value for point in limit.points]
    assert [point[1] for point in drawn.lines[0].points] == pytest.approx(changes)
    assert tornado_chart(result["Large"], 5).data.form.tick(-1.0, 0) == "-100 %"


def test_a_time_of_day_stands_on_no_axis_of_days(result):
    charts = [each.drawing.data for each in limit_blocks(result) if isinstance(each, Figure)]
    assert sorted([line.name for line in chart.lines] for chart in charts) == [["Clock"], ["Cost"], ["Day"], ["Large"]]
    assert next(each for each in charts if each.lines[0].name == "Cost").form_upwards != PLAIN


def test_a_probability_has_no_range(result):
    table = [each for each in limit_blocks(result) if isinstance(each, Table)][-1]
    rows = [row for row in table.rows if row[0] == "Large"]
    assert {(cell_text(row[4]), cell_text(row[5])) for row in rows} == {("–", "–")}
    [limit] = result.filter_limits
    forecasts = {each.forecast: each for each in result.forecasts}
    line = limit_chart_of_ranges(limit, forecasts, [*range(len(limit.slopes))]).data.lines[0]
    assert [point[1] for point in line.points] == [point.answers[0].change.value for point in limit.points]
