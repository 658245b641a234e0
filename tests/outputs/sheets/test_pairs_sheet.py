from __future__ import annotations

import io
import re
import zipfile

import numpy as np
import openpyxl
import pytest
from packed_sheets import packed_sheets

from xlmc.analysis.results.statements.pairs import pairs_of
from xlmc.outputs.sheets.styles import bounds

DRAWN = ("Pairs", "Trials", "Curves")


def test_a_pair_stands_in_a_row_with_all_its_numbers(run, book, row_of):
    (pair,) = pairs_of(run)
    row = row_of(book["Pairs"], "area, threshold 16 ft")
    shown = [value for value in row if value is not None]
    estimates = (pair.both_above, pair.either_above, pair.first_greater, pair.correlation)
    both, either, greater, correlation = ([each.value, each.error] for each in estimates)
    assert shown[1] == f"difference, median {pair.limits[1]:.6g} ft"
    assert shown[2:] == [
        *both,
        *pair.both_above.interval,
        *either,
        *greater,
        *correlation,
        *pair.correlation.interval,
    ]


def scatter_columns(packed):
    """The references of x and y of every scatter chart of trials."""
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        charts = [package.read(name).decode() for name in package.namelist() if "/charts/chart" in name]
    result = [
        re.findall(r"<c:[xy]Val><c:numRef><c:f>([^<]*)", chart) for chart in charts if "<c:scatterChart>" in chart
    ]
    return [each for each in result if len(each) == 2 and "Filter limits" not in each[0]]


def test_scatter_charts_draw_the_first_trials_of_the_sheet(run, package_of, book):
    assert scatter_columns(package_of(run)) == [["Trials!$D$5:$D$1004", "Trials!$E$5:$E$1004"]]
    for letter, name in (("D", "area"), ("E", "difference")):
        drawn = [cell.value for (cell,) in book["Trials"][f"{letter}5:{letter}1004"]]
        np.testing.assert_array_equal(drawn, run.forecasts[name][:1000])


def test_trials_without_a_number_are_left_out_of_scatter_charts(make):
    run = make.simulate(
        {"A1": 0.5, "B1": "=SQRT(A1-0.5)", "B2": "=A1"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("root", "B1"), make.forecast("all", "B2")],
        trials=300,
    )
    packed = packed_sheets(run, *DRAWN)
    ((across, _),) = scatter_columns(packed)
    book = openpyxl.load_workbook(io.BytesIO(packed))
    sheet, _, cells = across.partition("!")
    drawn = [cell.value for (cell,) in book[sheet][cells.replace("$", "")]]
    assert sheet == "Curves"
    np.testing.assert_array_equal(drawn, run["root"].values)


def test_one_forecast_has_no_pairs_and_many_have_the_first_ones(make, opened, one_accepted):
    sheet = opened(one_accepted, *DRAWN)["Pairs"]
    assert "There are no two forecasts" in str([cell.value for cell in sheet["A"]])
    forecasts = [make.forecast(f"f{n}", f"B{n}") for n in range(1, 8)]
    cells = {"A1": 0.5} | {f"B{n}": f"=A1*{n}" for n in range(1, 8)}
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=50)
    book = opened(run, *DRAWN)
    messages = [str(cell.value) for cell in book["Pairs"]["A"]]
    assert "At most 15 pairs of forecasts are here, the first ones of the workbook." in messages
    assert len(book["Pairs"]._charts) == 15


@pytest.mark.parametrize(
    ("lowest", "highest"), [(18.9, 26.6), (-3.0, 4.0), (1e-9, 3e-9), (1.2e6, 3.8e6), (0.0, 1.0), (99.99, 100.01)]
)
def test_axes_have_round_limits_about_what_they_show(lowest, highest):
    result = bounds(lowest, highest)
    step = result["major_unit"]
    steps = (result["max"] - result["min"]) / step
    assert result["min"] <= lowest < highest <= result["max"]
    assert 4 <= round(steps) <= 12
    assert steps == pytest.approx(round(steps), abs=1e-6)
    assert float(f"{step:.6e}"[0]) in (1.0, 2.0, 5.0)


@pytest.mark.parametrize("ends", [(3.0, 3.0), (1e9, 1e9 + 1e-7)])
def test_without_a_spread_an_axis_is_left_to_the_program(ends):
    assert bounds(*ends) == {}
