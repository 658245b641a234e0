from __future__ import annotations

import math

import pytest
from committed_books import BOOKS

from xlmc.analysis.results.statements.sentences import statements
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.statistics import Estimate, format_estimate, proportion
from xlmc.outputs.document import SECTIONS
from xlmc.outputs.summary import (
    base_case,
    error_sentence,
    estimate_text,
    percent,
    question,
    range_heading,
    share_text,
    summarise,
    summary_text,
)


def test_rows_are_the_simulations_own_numbers(run):
    rows = summarise(run)
    assert [row.name for row in rows] == ["area", "difference"]
    area = rows[0]
    result = run["area"].statistics
    assert (area.mean, area.standard_deviation, (area.low, area.high)) == (
        result.mean,
        result.standard_deviation,
        result.central,
    )
    assert (area.units, area.trials, area.share, area.base, area.threshold) == ("ft", run.accepted, 0.51, 16.0, 16.0)
    assert area.above == run["area"].probability_above(16.0)
    assert rows[1].above is None


SWITCHED = {"A1": 0.5, "A2": 0, "A3": "=IF(A2=1,A1,0)", "A4": "=A1*2+1", "A5": "=1/(A1-0.4)", "A6": "=A1^2"}
ONE = {"x": {"cell": "A1", "low": 0, "high": 1}}


def asked(model, trials=4000, **options):
    return "".join(message.text for message in question(simulate(model, trials=trials, seed=3, **options)))


@pytest.mark.parametrize(
    ("filters", "message", "unsaid"),
    [
        ({"off": {"cell": "A3", "at_most": 0.95}, "low": {"cell": "A1", "below": 0.5}}, ["low below 0.5"], ["off"]),
        ({"sure": {"cell": "A4", "at_least": 1, "at_most": 3}, "low": {"cell": "A1", "below": 0.5}}, ["low"], ["sure"]),
        ({"may": {"cell": "A4", "at_least": 1, "below": 2.9}}, ["may at least 1 and below 2.9"], []),
        ({"error": {"cell": "A5", "at_least": -1e9}}, ["error at least"], []),
        ({"square": {"cell": "A6", "at_most": 0.5}}, ["square at most 0.5", "pass all filters"], ["evidence"]),
        ({"off": {"cell": "A3", "at_most": 0.95}}, ["no filter that a trial could break: every trial"], ["off"]),
        ({}, ["The workbook has no filters: every trial is accepted"], ["evidence"]),
    ],
    ids=str,
)
def test_what_no_trial_can_break_is_not_said_to_be_asked(model_of, filters, message, unsaid):
    text = asked(model_of(SWITCHED, ONE, {"y": "A1"}, filters))
    assert all(each in text for each in message), text
    assert not any(each in text.removeprefix("The workbook computes") for each in unsaid), text


@pytest.mark.parametrize(("options"), [{"evidence": "rejection"}, {"evidence": "weights"}], ids=str)
@pytest.mark.parametrize("filters", [{}, {"low": {"cell": "A1", "below": 0.9}}], ids=["no filter", "a filter"])
def test_evidence_is_the_table_of_that_name(model_of, filters, options):
    reading = {"EDR": {"cell": "A4", "reading": 2.0, "error": "normal", "std_dev": 0.2}}
    text = asked(model_of(SWITCHED, ONE, {"y": "A1"}, filters, evidence=reading), **options)
    assert "The evidence: EDR reads 2, normal (Std dev 0.2)" in text
    assert ("The filters ask: low below 0.9." in text) == bool(filters)
    assert ("pass all filters" in text) == bool(filters)
    assert ("counts with the chance" in text) == (options["evidence"] == "weights")


def test_the_text_prints_each_number_with_its_error(run):
    headings, lines = summary_text(summarise(run))
    assert headings == ["Forecast", "Units", "Mean", "SD", "51 % range", "Base case", "Threshold", "Above threshold"]
    result = run["area"].statistics
    low, high = (format_estimate(end.value, end.error) for end in result.central)
    above = result.probability_above
    assert lines[0] == [
        "area",
        "ft",
        format_estimate(result.mean.value, result.mean.error),
        format_estimate(result.standard_deviation.value, result.standard_deviation.error),
        f"{low} to {high}",
        "16",
        "16",
        f"{format_estimate(100 * above.value, 100 * above.error)} %",
    ]
    assert lines[1][-2:] == ["", ""]


def test_columns_that_nothing_fills_are_left_out(none_accepted):
    headings, lines = summary_text(summarise(none_accepted))
    assert headings == ["Forecast", "Base case", "Threshold"]
    assert lines == [["x", "1", "1"]]


def test_different_ranges_are_told_apart(make):
    run = make.simulate(
        {"A1": 0.5, "B1": "=A1"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1"), make.forecast("y", "A1", central=0.95)],
    )
    headings, lines = summary_text(summarise(run))
    assert headings[-3:] == ["Central range", "Range", "Base case"]
    assert [line[-2] for line in lines] == ["51 %", "95 %"]
    assert range_heading(summarise(run)) == "Central range"


def test_a_range_of_yes_and_no_is_no_different_one(make):
    """A yes/no has no range, so that what its row asks for is not told beside those of numbers."""
    cells = {"A1": 0.5, "B1": "=A1>0.3"}
    drawn = [make.uniform("a", "A1", 0.0, 1.0, base=0.5)]
    both = [make.forecast("x", "A1", central=0.95), make.forecast("late", "B1")]
    run = make.simulate(cells, drawn, both)
    headings, lines = summary_text(summarise(run))
    assert "95 % range" in headings
    assert "Range" not in headings
    assert lines[1][headings.index("95 % range")] == ""
    three = make.simulate({**cells, "C1": "=A1"}, drawn, [*both, make.forecast("z", "C1", central=0.8)])
    headings, lines = summary_text(summarise(three))
    assert [line[headings.index("Range")] for line in lines] == ["95 %", "", "80 %"]


@pytest.mark.parametrize(
    ("share", "text"), [(0.51, "51 %"), (0.245, "24.5 %"), ((1 - 0.51) / 2, "24.5 %"), (1.0, "100 %")]
)
def test_shares_in_percent(share, text):
    assert percent(share) == text


@pytest.mark.parametrize(
    ("result", "text"),
    [
        (proportion(0, 5), "0 %, at most 46 %"),
        (proportion(5, 5), "100 %, at least 54 %"),
        (proportion(0, 30_000), "0 %, at most 0.013 %"),
        (proportion(1, 4), "25 ± 22 %"),
        (Estimate(0.0), ""),
    ],
)
def test_a_share_of_none_or_all_trials_says_how_far_off_it_may_be(result, text):
    assert share_text(result) == text


def test_no_number_is_no_text():
    assert estimate_text(Estimate(math.nan)) == ""
    assert estimate_text(Estimate(17.0213, 0.0023)) == "17.0213 ± 0.0023"


def test_words_for_crashes_stand_in_books_of_crash_templates_only():
    crash = error_sentence(read_workbook(BOOKS["skid"]))
    assert "not reconstruction error: it does not say whether the model fits the crash" in crash
    other = error_sentence(Workbook("beam.xlsx", {}))
    assert "not model error: it does not say whether the model is right" in other


@pytest.mark.parametrize(
    ("name", "headings"), [("skid", ("The scene", "Physics checks")), ("beam", ("The drawing", "Checks"))]
)
def test_headings_of_a_report_have_the_words_of_its_field(name, headings):
    words = vocabulary_of(read_workbook(BOOKS[name]))
    assert tuple(SECTIONS[section].title(words) for section in ("scene", "checks")) == headings


def test_the_base_case_is_computed_with_frozen_cells_held(run):
    result = base_case(run)
    assert result.forecasts == {"area": 2.0 * 3.0 + 10.0, "difference": -1.0}
    assert result.rejected_by == ()


@pytest.mark.parametrize(
    ("base", "rejected"),
    [(0.5, ()), (5.0, ("small",)), (-1.0, ("root",)), (11.0, ("small", "tiny"))],
)
def test_filters_that_would_reject_the_base_case_are_named(make, base, rejected):
    run = make.simulate(
        {"A1": base, "B1": "=A1", "C1": "=SQRT(A1)", "C2": "=A1<10"},
        [make.uniform("a", "A1", 0.0, 1.0, base=base)],
        [make.forecast("x", "B1")],
        [make.filter("small", "A1", at_most=2.0), make.filter("root", "C1"), make.filter("tiny", "C2")],
        trials=10,
    )
    assert base_case(run).rejected_by == rejected


def test_a_forecast_that_is_no_number_at_the_base_case_has_none(make):
    run = make.simulate(
        {"A1": 0.0, "B1": "=1/A1"}, [make.uniform("a", "A1", 0.0, 1.0, base=0.0)], [make.forecast("x", "B1")]
    )
    assert base_case(run).forecasts == {"x": None}


def test_without_a_base_value_there_is_no_base_case(make):
    run = make.simulate({"A1": None, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("x", "B1")])
    assert base_case(run) is None


def test_numbers_far_from_0_keep_the_digits_that_tell_them_apart(make):
    """Thresholds, the base case, ranges without an error and constants: a date with a time, a coordinate."""
    run = make.simulate(
        {"A1": 45321.75, "B1": "=A1+0", "C1": "=1234567.8"},
        [make.uniform("a", "A1", 45321.75, 45321.76, base=45321.75)],
        [
            make.forecast("x", "B1", central=0.9999999, threshold=45321.755, asked=(45321.7512, 45321.7588)),
            make.forecast("c", "C1"),
        ],
    )
    headings, (time, constant) = summary_text(summarise(run))
    result = dict(zip(headings, time, strict=True))
    assert result["Threshold"] == "45,321.755"
    assert result["Certainty of"] == "from 45,321.7512 to 45,321.7588"
    assert result["Base case"] == "45,321.75"
    low, high = (float(end.split(" ")[0].replace(",", "")) for end in result["Central range"].split(" to "))
    assert (low, high) == pytest.approx((45321.75, 45321.76), abs=2e-5)
    assert result["Range"] == "99.99999 %"
    assert dict(zip(headings, constant, strict=True))["Mean"] == "1,234,567.8"
    message = [each.text for each in statements(run)]
    assert any("P(x > 45,321.755)" in each for each in message)
    assert any("x from 45,321.7512 to 45,321.7588" in each for each in message)
    assert any(each.startswith("c: 1,234,567.8 in all") for each in message)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("=A1>1000", Kind.YES_NO),
        ("=IF(A1>1000,1,0)", Kind.YES_NO),
        ("=IF(A1>0.5,1,IF(A1>1000,0,1))", Kind.YES_NO),
        ("=(A1>0.5)*1", Kind.YES_NO),
        ("=A1*0", Kind.NUMBER),
        ("=MAX(0,A1-1000)", Kind.NUMBER),
        ("=IF(A1>1000,5,0)", Kind.NUMBER),
        ("=C1*3600", Kind.NUMBER),
        ("=IF(C1=2,A1,C1*3600)", Kind.NUMBER),
    ],
)
def test_a_number_that_happens_to_be_0_in_all_trials_is_no_answer_by_yes_or_no(make, formula, expected):
    cells = {"A1": 0.5, "B1": formula, "C1": 0.0}
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("x", "B1")], trials=50)
    assert run["x"].kind is expected


def test_one_trial_is_no_plural(make):
    run = make.simulate({"A1": 0.5, "B1": "=A1"}, [make.uniform("a", "A1", 0, 1)], [make.forecast("x", "B1")], trials=1)
    assert "1 combination of values from these ranges was tried. " in "".join(each.text for each in question(run))
