from __future__ import annotations

import io

import numpy as np
import openpyxl
import pytest
from packed_sheets import packed_sheets
from simulated import simulated

from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.montecarlo import statistics

SHEETS = ("Certainty", "Trials")  # the second of which the first counts in


@pytest.fixture(scope="module")
def sheets(run):
    """The sheet Certainty twice: its formulas, and the values they are saved with; 400 trials are written out."""
    packed = packed_sheets(run, *SHEETS, rows=400)
    return [openpyxl.load_workbook(io.BytesIO(packed), data_only=values)["Certainty"] for values in (False, True)]


def lines(sheet, heading):
    """The rows of the table below a heading, by what stands in the first column."""
    rows = list(sheet.iter_rows(values_only=True))
    start = next(number for number, row in enumerate(rows) if row[0] == heading)
    first = next(number for number, row in enumerate(rows[start:], start) if row[0] == "Forecast") + 1
    result = []
    for row in rows[first:]:
        if row[0] is None:
            break
        result.append(row)
    return result


def test_every_sentence_stands_there(run, sheets):
    shown = [row[0] for row in sheets[0].iter_rows(values_only=True)]
    for statement in statements(run):
        assert f"{statement.text}." in shown


def test_ranges_have_their_counts_shares_and_wilson_intervals(run, sheets):
    shown = lines(sheets[0], "Certainty of ranges")
    expected = [(name, each) for name, result in run.results.items() for each in certainties(result)]
    assert len(shown) == len(expected) == 5 + 3
    for row, (name, certainty) in zip(shown, expected, strict=True):
        values = run[name].values
        inside = {
            "below": values < certainty.high,
            "between": (values >= certainty.low) & (values <= certainty.high),
            "above": values > certainty.low,
            "at most": values <= certainty.high,
            "over": values > certainty.low,
        }[certainty.kind]
        share = statistics.proportion(int(inside.sum()), values.size)
        assert row == (name, certainty.words, inside.sum(), share.value, share.error, *share.interval)


def test_own_ranges_count_the_trials_on_the_sheet(run, sheets):
    formulas, values = (lines(sheet, "Certainty of a range of your own") for sheet in sheets)
    for name, formula, row in zip(run.results, formulas, values, strict=True):
        low, high, certainty, error, count = row[2:]
        drawn = run[name].values[:400]
        assert row[:2] == (name, "ft")
        assert count == 400
        share = statistics.proportion(int(np.sum((drawn >= low) & (drawn <= high))), 400)
        assert certainty == share.value
        assert error == pytest.approx(share.error, rel=1e-4)  # 1.96 for the normal distribution's quantile
        assert all(str(each).startswith("=") for each in formula[4:])
        assert "Trials!$" in formula[4]


def test_nothing_is_offered_without_trials_to_count(run, none_accepted, opened):
    for book in (opened(run, *SHEETS, rows=0), opened(none_accepted, *SHEETS)):
        assert "Certainty of a range of your own" not in [cell.value for cell in book["Certainty"]["A"]]


def test_replicates_get_no_error_of_independent_trials(run, opened):
    again = simulated(run.model, trials=4000, sampling="lhs")
    sheet = opened(again, *SHEETS)["Certainty"]
    texts = [str(cell.value) for cell in sheet["A"]]
    assert any("no error is given" in text for text in texts)
    heading = next(row for row in sheet.iter_rows(values_only=True) if row[:4] == ("Forecast", "Units", "From", "to"))
    assert heading[4:6] == ("Certainty", "Trials")
