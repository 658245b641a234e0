"""One run, told four times: sheets, JSON, Python object and saved run give the same numbers, to the last bit."""

from __future__ import annotations

import json

import openpyxl
import pytest
from fewer_sheets import CHARTS, SENSITIVITY, leave_out
from simulated import simulated

from xlmc.analysis.results.saved import open_run
from xlmc.api import Simulation
from xlmc.montecarlo.model.loading import load

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
"""The words of the sheet Statistics, and the keys of JSON and Python."""


@pytest.fixture(scope="module", params=[{}, {"sampling": "lhs"}, {"until_accepted": 150}], ids=["mc", "lhs", "until"])
def reports(request, small_book, tmp_path_factory):
    """The run, its document, its sheets, and the run after it was saved and opened."""
    folder = tmp_path_factory.mktemp("same")
    run = simulated(load(small_book), **request.param)
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        Simulation(run).save(folder / "run.xlsx")
    Simulation(run).save_json(folder / "run.json")
    Simulation(run).keep(folder / "run.xlmcrun")
    document = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    return run, document, openpyxl.load_workbook(folder / "run.xlsx"), open_run(folder / "run.xlmcrun")


def plain(value):
    return None if value == "–" else value


def block(sheet, name):
    """The columns of a forecast on Statistics: label -> (value, ±, from, to)."""
    top, first = next(
        (cell.row, cell.column) for row in sheet for cell in row if str(cell.value).partition(" (")[0] == name
    )
    return {
        row[0].value: tuple(plain(cell.value) for cell in row[first - 1 : first + 3])
        for row in sheet.iter_rows(min_row=top + 1)
        if row[0].value is not None
    }


def of_json(reports):
    return reports["value"], reports["error"], reports["low"], reports["high"]


def of_python(estimate):
    return estimate.value, estimate.error, *(estimate.interval or (None, None))


def finite(numbers):
    """Without what a sheet shows as `∞` and JSON as null."""
    return tuple(n if isinstance(n, int | float) and abs(n) < float("inf") else None for n in numbers)


def test_statistics(reports):
    run, document, book, opened = reports
    for each in document["forecasts"]:
        name = each["name"]
        on_sheet, result = block(book["Statistics"], name), run[name].statistics
        again = opened[name].statistics
        for label, key in NAMES.items():
            expected = finite(of_python(getattr(result, key)))
            assert finite(on_sheet[label]) == of_json(each["statistics"][key]) == expected, (name, label)
            assert finite(of_python(getattr(again, key))) == expected
        for percentile, (percent, estimate) in zip(each["percentiles"], result.percentiles.items(), strict=True):
            expected = finite(of_python(estimate))
            assert finite(on_sheet[f"{percent:g} %"]) == of_json(percentile) == expected, (name, percent)
        for end, key, estimate in zip(("from", "to"), ("low", "high"), result.central, strict=True):
            expected = finite(of_python(estimate))
            assert finite(on_sheet[f"Central range {end}"]) == of_json(each["central_range"][key]) == expected
        assert on_sheet["Trials"][0] == each["trials"] == result.trials


def test_certainty(reports):
    run, document, book, _ = reports
    area = document["forecasts"][0]
    expected = of_python(run["area"].statistics.probability_above)
    assert of_json(area["certainty"]["probability_above"]) == expected
    assert block(book["Statistics"], "area")["Above threshold"] == expected


def test_answers_on_the_first_sheet(reports):
    run, document, book, _ = reports
    result = [row for row in book["Results"].iter_rows(values_only=True) if row[0] in run.forecasts]
    rows = {row[0]: row for row in reversed(result)}  # the first of each: the errors in cells come further down
    for each in document["forecasts"]:
        mean, spread, ends = each["statistics"]["mean"], each["statistics"]["standard_deviation"], each["central_range"]
        expected = [each["name"], each["units"] or None, each["trials"], mean["value"], mean["error"]]
        expected += [spread["value"], spread["error"], ends["low"]["value"], ends["low"]["error"]]
        expected += [ends["high"]["value"], ends["high"]["error"], each["base_case"]]
        assert list(rows[each["name"]][:12]) == expected


def test_filters(reports):
    run, document, book, _ = reports
    [row] = [r for r in book["Results"].iter_rows(values_only=True) if r[0] == "1. root" and isinstance(r[1], int)]
    [root] = document["filters"]
    expected = (run.tally.errors[0]["#NUM!"], int(run.tally.rejected[0]), int(run.tally.only[0]))
    assert (row[1], row[2], row[5]) == (root["errors"], root["rejected"], root["only"]) == expected
    assert (row[3], row[4]) == (root["share"]["value"], root["share"]["error"])


def test_trials(reports):
    run, document, book, _ = reports
    rows = {row[0]: row for row in book["Results"].iter_rows(values_only=True) if row[0] in ("Run", "Accepted")}
    assert rows["Run"][2] == document["trials"]["run"] == run.trials
    assert rows["Accepted"][2] == document["trials"]["accepted"] == run.accepted
    assert rows["Accepted"][3:7] == of_json(document["trials"]["acceptance"]) == of_python(run.acceptance)


def test_assumptions(reports):
    _, document, book, _ = reports
    rows = [row for row in book["Assumptions"].iter_rows(values_only=True) if row[3] in ("before", "accepted")]
    marginals = [each[kind] for each in document["assumptions"] for kind in ("prior", "accepted")]
    for row, marginal in zip(rows, marginals, strict=True):
        numbers = (marginal["mean"], marginal["standard_deviation"], *marginal["percentiles"])
        assert row[4] == marginal["trials"]
        assert list(row[5:15]) == [number[key] for number in numbers for key in ("value", "error")]


def test_accepted_trials(reports):
    run, _, book, _ = reports
    rows = [row for row in book["Trials"].iter_rows(min_row=5, values_only=True) if row[0] is not None]
    frame = run.frame()
    assert [row[0] for row in rows] == list(frame.index)
    for row, values in zip(rows, frame.itertuples(index=False), strict=True):
        assert [plain(value) for value in row[1:5]] == [None if v != v else v for v in values]
