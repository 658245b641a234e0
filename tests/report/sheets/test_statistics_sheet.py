from __future__ import annotations

import pytest

from xlmc.report.sheets.statistics_sheet import WIDTHS

RIGHT = WIDTHS.index(2)  # the gap between the two tables

NAMES = {
    "Mean": "mean",
    "Median": "median",
    "Mode": "mode",
    "Standard deviation": "standard_deviation",
    "Variance": "variance",
    "Skewness": "skewness",
    "Kurtosis (normal 3)": "kurtosis",
    "Coefficient of variation": "coefficient_of_variation",
    "Minimum": "minimum",
    "Maximum": "maximum",
    "Range width": "range_width",
    "Mean standard error": "mean_standard_error",
}


def _expected(estimate):
    return [
        estimate.value,
        "–" if estimate.error is None else estimate.error,
        *(("–", "–") if estimate.interval is None else estimate.interval),
    ]


@pytest.mark.parametrize(("label", "attribute"), NAMES.items())
def test_every_statistic_has_its_error_and_interval(run, book, row_of, label, attribute):
    estimate = getattr(run["area"].statistics, attribute)
    assert row_of(book["Statistics"], label)[2:6] == _expected(estimate)


def test_units_are_those_of_the_statistic(book, row_of):
    sheet = book["Statistics"]
    assert row_of(sheet, "Mean")[1] == "ft"
    assert row_of(sheet, "Variance")[1] == "ft²"
    assert row_of(sheet, "Skewness")[1] is None


def test_percentiles_and_the_central_range_stand_beside(run, book, row_of):
    sheet, found = book["Statistics"], run["area"].statistics
    for percent, estimate in found.percentiles.items():
        assert row_of(sheet, f"{percent:g} %", RIGHT + 1)[RIGHT + 2 :] == _expected(estimate)
    for end, estimate in zip(("from", "to"), found.central, strict=True):
        assert row_of(sheet, f"51 % range {end}", RIGHT + 1)[RIGHT + 2 :] == _expected(estimate)
    assert row_of(sheet, "Above 16", RIGHT + 1)[RIGHT + 2 :] == _expected(found.probability_above)


def test_extremes_show_the_digits_of_the_mean(book):
    sheet = book["Statistics"]
    formats = {sheet.cell(row, 1).value: sheet.cell(row, 3).number_format for row in range(1, 20)}
    assert formats["Minimum"] == formats["Mean"] == "#,##0.000"


def test_every_third_forecast_begins_a_page(make, opened):
    forecasts = [make.forecast(f"f{n}", "B1" if n == 0 else f"D{n}") for n in range(7)]
    cells = {"A1": 0.5, "B1": "=A1*2"} | {f"D{n}": "=A1+1" for n in range(1, 7)}
    sheet = opened(make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts))["Statistics"]
    begins = [brk.id + 2 for brk in sheet.row_breaks.brk]  # the heading stands below an empty row
    assert [sheet.cell(row, 1).value for row in begins] == ["f3", "f6"]
