from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.outputs.sheets import trials_sheet
from xlmc.outputs.sheets.trials_sheet import HEADER

FIRST = HEADER + 2  # as Excel counts


def test_every_accepted_trial_is_there_bit_for_bit(run, book):
    rows = list(book["Trials"].iter_rows(min_row=FIRST, values_only=True))
    assert len(rows) == run.accepted
    np.testing.assert_array_equal(np.array(rows), run.frame().reset_index().to_numpy())


def test_columns_are_named_with_units(book):
    names = [cell.value for cell in book["Trials"][HEADER + 1]]
    assert names == ["Trial", "width (ft)", "length (ft)", "area (ft)", "difference (ft)"]


def test_a_trial_can_be_keyed_in_again(run, book):
    trial, width, length, area, difference = (cell.value for cell in book["Trials"][FIRST + 3])
    assert trial == run.trial_index[3]
    assert (area, difference) == (width * length + 10.0, width - length)


@pytest.fixture(scope="module")
def few(run):
    """300 trials of `run`."""
    return simulated(run.model, 300)


@pytest.mark.parametrize(("rows", "shown"), [(7, 7), (0, 0), (-1, 0), (10**9, None)])
def test_rows_are_capped_and_the_sheet_says_so(few, opened, rows, shown):
    sheet = opened(few, "Trials", rows=rows)["Trials"]
    expected = few.accepted if shown is None else shown
    assert sheet.max_row == FIRST - 1 + expected
    if shown is None:
        assert sheet["A3"].value == f"All {few.accepted:,} accepted trials."
    else:
        assert sheet["A3"].value == f"Only the first {shown:,} of {few.accepted:,} accepted trials stand here."
        assert sheet["A3"].font.color.rgb == "FF9C0006"


def test_a_book_of_many_columns_shows_fewer_trials_unless_asked(run, opened, monkeypatch):
    monkeypatch.setattr(trials_sheet, "NUMBERS", 4 * 50 + 3)
    assert opened(run, "Trials")["Trials"].max_row == FIRST - 1 + 50
    assert opened(run, "Trials", rows=60)["Trials"].max_row == FIRST - 1 + 60


def test_the_header_is_frozen_repeated_and_filters(run, book):
    sheet = book["Trials"]
    assert sheet.freeze_panes == f"B{FIRST}"
    assert sheet.print_title_rows == f"${HEADER + 1}:${HEADER + 1}"
    assert sheet.auto_filter.ref == f"A{HEADER + 1}:E{HEADER + 1 + run.accepted}"


def test_a_forecast_that_is_no_number_says_so(make, opened):
    run = make.simulate(
        {"A1": 0.5, "B1": "=SQRT(A1-0.5)"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("root", "B1")],
        trials=50,
    )
    shown = [row[2] for row in opened(run, "Trials")["Trials"].iter_rows(min_row=FIRST, values_only=True)]
    assert shown.count("–") == run.faults["root"]["#NUM!"] > 0


def test_an_assumption_and_a_forecast_may_share_a_name(make, opened):
    run = make.simulate(
        {"A1": 0.5, "B1": "=A1"}, [make.uniform("v", "A1", 0.0, 1.0, base=0.5)], [make.forecast("v", "B1")], trials=5
    )
    assert [cell.value for cell in opened(run, "Trials")["Trials"][HEADER + 1]] == ["Trial", "v", "v"]


@pytest.mark.parametrize("name", ["Bins", "Curves"])
def test_sheets_of_numbers_that_charts_draw_open_hidden(book, name):
    assert book[name].sheet_state == "hidden"
    assert str(book[name]["A2"].value).endswith("This sheet opens hidden; hidden sheets are not printed.")


def test_the_trials_are_not_printed_and_say_so(book):
    sheet = book["Trials"]
    assert sheet.print_area == "'Trials'!$XFD$1048576"
    assert str(sheet["A2"].value).endswith("This sheet is not printed, unless you clear its print area, a blank cell.")
