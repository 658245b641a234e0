from __future__ import annotations

import pytest

from xlmc.outputs.summary import error_sentence


def test_table_2_holds_the_simulations_numbers(run, book, row_of):
    sheet = book["Results"]
    header = row_of(sheet, "Forecast")
    assert header[:12] == [
        "Forecast",
        "Units",
        "Accepted trials",
        "Mean",
        "±",
        "Standard deviation",
        "±",
        "51 % range from",
        "±",
        "to",
        "±",
        "Base case",
    ]
    result = run["area"].statistics
    low, high = result.central
    above = result.probability_above
    assert row_of(sheet, "area") == [
        "area",
        "ft",
        run.accepted,
        result.mean.value,
        result.mean.error,
        result.standard_deviation.value,
        result.standard_deviation.error,
        low.value,
        low.error,
        high.value,
        high.error,
        16.0,
    ]
    assert row_of(sheet, "difference")[11:] == [-1.0]
    heading = next(cell.row for cell in sheet["A"] if cell.value == "Values above a threshold")
    thresholds = [cell.value for cell in sheet[heading + 2]][:7]
    assert thresholds == ["area", "ft", 16.0, above.value, above.error, *above.interval]
    assert sheet.cell(heading + 3, 1).value is None  # a forecast without a threshold has no row


def test_formats_show_the_digits_the_errors_support(run, book):
    sheet = book["Results"]
    row = next(cell.row for cell in sheet["A"] if cell.value == "area")
    mean = run["area"].mean
    assert 0.01 < mean.error < 0.1
    assert [sheet.cell(row, column).number_format for column in (4, 5, 12)] == ["#,##0.000"] * 3


def test_each_filter_says_what_it_asks_and_why(book, row_of):
    sheet = book["Results"]
    assert row_of(sheet, "1. root") == ["1. root", "S!C1", None, "at most 1.2", None, "seen"]
    assert row_of(sheet, "2. narrow")[3:] == ["above 1.1 and below 2.5", None, "=measured"]


def test_errors_are_listed_by_cell_and_code(run, book, row_of):
    count = run.tally.errors[0]["#NUM!"]
    assert row_of(book["Results"], "root")[:5] == ["root", "filter", "S!C1", "#NUM!", count]


def test_too_many_errors_are_a_red_warning(run, book):
    assert run.error_trials > 5
    warning = book["Results"]["A3"]
    assert warning.value.startswith("Do not use these results as they are: ")
    assert "lost to errors" in warning.value
    assert warning.font.color.rgb == "FF9C0006"
    assert book["Results"]["A4"].value.startswith("S!")  # then the cell that they were lost in


def test_notices_and_sentences_stand_on_the_sheet(run, book, rows_of):
    texts = [row[0] for row in rows_of(book["Results"]) if row]
    assert error_sentence(run.model.workbook) in texts
    assert "The 51 % range is central: 24.5 % of the accepted trials lie below it, 24.5 % above." in texts
    assert "The base case has every assumption at the value in its cell." in texts
    assert "S!A3: No forecast or filter needs the assumption 'idle'" in texts


@pytest.mark.parametrize("text", ["The workbook has no filters: every trial is accepted."])
def test_a_run_without_filters_says_so(one_accepted, opened, row_of, text):
    assert row_of(opened(one_accepted, "Results")["Results"], text)


def test_the_base_case_says_which_filter_would_reject_it(none_accepted, opened, rows_of):
    texts = [row[0] for row in rows_of(opened(none_accepted, "Results")["Results"]) if row]
    assert (
        "The base case has every assumption at the value in its cell. As a trial it would be rejected by: never."
        in texts
    )


def test_without_an_accepted_trial_the_warning_stands_first_and_no_number_is_made_up(none_accepted, opened, row_of):
    sheet = opened(none_accepted, "Results")["Results"]
    assert "no trial was accepted: the filters contradict the assumptions" in sheet["A3"].value
    assert row_of(sheet, "x") == ["x", None, 0, *["–"] * 8, 1.0]
    assert row_of(sheet, "Accepted")[2:4] == [0, 0]
