"""Books whose answers are known, and two rungs of the ladder on the paper's case.

In the linear books `a` and `b` are uniform on (0, 1): mean 1/2, variance 1/12.
"""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest
import xlsxwriter

from xlmc.analysis.studies.comparison import Verdict, compare
from xlmc.analysis.studies.comparison.verdicts import book_names, inputs_text, verdict_text
from xlmc.errors import SimulationError
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

SIZE = {"trials": 20_000, "seed": 1}


@pytest.fixture
def linear(book):
    """`linear("=A1+B1", name="x.xlsx")` with `a` in A1 and `b` in B1; definitions may be changed."""

    def make(formula="=A1+B1", name="x.xlsx", units="", a=(0, 1), b=(0, 1), filters=None, frozen=(), more=None):
        given = {"a": {"cell": "A1", "low": a[0], "high": a[1]}, "b": {"cell": "B1", "low": b[0], "high": b[1]}}
        for key in frozen:
            given[key]["frozen"] = True
        forecasts = {"y": "D1", **{key: address for key, (address, _) in (more or {}).items()}}
        cells = {"A1": 0.5, "B1": 0.5, "D1": formula, **dict((more or {}).values())}
        made = book(cells, given, forecasts, filters or {})
        forecasts = tuple(replace(f, units=units) for f in made.forecasts)
        return CompiledModel(made.workbook, replace(made.definitions, forecasts=forecasts), Path(name))

    return make


def only(result):
    (single,) = result.forecasts
    return single


def test_a_book_agrees_with_itself_exactly(linear):
    result = compare(linear(), linear(name="y.xlsx"), "1e-9", **SIZE)
    assert result.simpler is None
    assert result.acceptance.both == 20_000
    assert only(result).judgement.verdict is Verdict.WITHIN
    assert only(result).difference.wasserstein.value == 0.0
    assert only(result).same_in_every_trial
    assert verdict_text(result) == ["The two books agree for y to 1e-09."]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        pytest.param("=10+A1", "=11-A1", id="mirrored"),
        pytest.param("=A1+B1", "=1+A1-B1", id="one of two mirrored"),
        pytest.param("=A1+2*B1", "=2*A1+B1", id="exchanged"),
    ],
)
def test_distributions_that_agree_where_trials_do_not(linear, first, second):
    result = compare(linear(first), linear(second, "y.xlsx"), "0.1", **SIZE)
    assert only(result).judgement.verdict is Verdict.WITHIN
    assert only(result).only_distributions_agree
    message = verdict_text(result)
    assert message[0] == "The two books agree for y to 0.1."
    assert message[1].startswith("Of y only the distributions agree, and the trials do not")


def test_the_size_of_differences_in_one_trial(linear):
    """a − (1 − a) is uniform on (−1, 1): root mean square 1/√3."""
    result = only(compare(linear("=A1"), linear("=1-A1", "y.xlsx"), "0.1", **SIZE)).difference
    assert result.typical == pytest.approx(1 / math.sqrt(3), rel=0.02)
    assert result.largest == pytest.approx(1.0, abs=1e-3)


def test_small_differences_in_every_trial_are_agreement(linear):
    result = compare(linear("=A1+B1"), linear("=A1+B1+0.01*SIN(40*A1)", "y.xlsx"), "0.1", **SIZE)
    assert not only(result).only_distributions_agree
    assert len(verdict_text(result)) == 1


def test_a_shift_in_the_formulas_is_exact_and_nothing_else_accounts_for_it(linear):
    result = compare(linear(), linear("=A1+B1+0.25", "y.xlsx"), "0.2", **SIZE)
    assert only(result).difference.mean.difference.value == pytest.approx(0.25, abs=1e-12)
    assert only(result).difference.mean.difference.error < 1e-12
    assert only(result).judgement.verdict is Verdict.BEYOND
    assert only(result).cause.steps == ()
    assert "the cause is in the formulas or in values that are held" in verdict_text(result)[0]


def test_an_assumption_that_only_one_book_draws(linear):
    """a + b against a: the SD falls from √(2/12) to √(1/12), and with b held both are a + 0.5."""
    result = compare(linear(), linear(name="y.xlsx", frozen=["b"]), "0.01", **SIZE)
    assert result.simpler == 1
    change = only(result).difference.standard_deviation.difference
    assert abs(change.value - (math.sqrt(1 / 12) - math.sqrt(2 / 12))) < 4 * change.error
    (step,) = only(result).cause.steps
    assert (step.kind, step.side, step.name) == ("assumption", 0, "b")
    assert only(result).cause.left.value == 0.0
    assert [u.name for u in result.inputs.frozen_differently] == ["b"]
    assert "because only x.xlsx draws 'b'; with it held at the base value" in verdict_text(result)[0]


def test_a_filter_that_only_one_book_has(linear):
    """y = a + b where a > 1/2: the mean rises by 1/4."""
    filters = {"fast": {"cell": "A1", "above": 0.5}, "idle": {"cell": "B1", "above": -1}}
    result = compare(linear(filters=filters), linear(name="y.xlsx"), "0.1", **SIZE)
    change = only(result).difference.mean.difference
    assert abs(change.value + 0.25) < 4 * change.error
    (step,) = only(result).cause.steps
    assert (step.kind, step.side, step.name) == ("filter", 0, "fast")
    assert result.inputs.filters == (("fast", "idle"), ())
    (sentence,) = verdict_text(result)
    assert "because the filter 'fast' of x.xlsx moves it; without it the mean differs by 0" in sentence
    assert "they give the same number: they differ only in which trials they accept" in sentence


def test_two_filters_that_are_both_needed_are_both_named(linear):
    """a > 1/2 and b > 1/2 raise the mean by 1/4 each; b > 0.05 only by 0.025, which the tolerance allows."""
    filters = {"one": {"cell": "A1", "above": 0.5}, "two": {"cell": "B1", "above": 0.5}}
    filters["small"] = {"cell": "B1", "above": 0.05}
    result = compare(linear(), linear(name="y.xlsx", filters=filters), "0.1", **SIZE)
    assert {step.name for step in only(result).cause.steps} == {"one", "two"}


def test_filters_of_one_name_with_other_limits_are_not_the_same(linear):
    limits = [{"fast": {"cell": "A1", "above": limit}} for limit in (0.2, 0.6)]
    result = compare(linear(filters=limits[0]), linear(name="y.xlsx", filters=limits[1]), "0.01", **SIZE)
    assert result.inputs.filters == (("fast",), ("fast",))
    assert {step.side for step in only(result).cause.steps} == {0, 1}


def test_distributions_that_differ_are_said_and_can_be_the_cause(linear):
    """b uniform on (0, 2): the same uniforms, so y differs by b in every trial, 1/2 in the mean."""
    result = compare(linear(), linear(name="y.xlsx", b=(0, 2)), "0.1", **SIZE)
    assert [u.name for u in result.inputs.unlike] == ["b"]
    assert result.inputs.alike == ("a",)
    change = only(result).difference.mean.difference
    assert abs(change.value - 0.5) < 4 * change.error
    assert change.error == pytest.approx(math.sqrt(1 / 12 / 20_000), rel=0.05)  # of b alone: a cancels
    (step,) = only(result).cause.steps
    assert (step.kind, step.name) == ("distribution", "b")
    assert "'b' is not the same: Uniform: Low 0, High 1 | Uniform: Low 0, High 2." in inputs_text(result)


def test_units_are_converted(linear):
    result = compare(linear(units="mph"), linear("=(A1+B1)*1.609344", "y.xlsx", "km/h"), "1e-9 mph", **SIZE)
    assert only(result).judgement.verdict is Verdict.WITHIN
    assert only(result).factor == pytest.approx(1 / 1.609344)


@pytest.mark.parametrize(("mine", "theirs"), [("mph", "deg"), ("mph", ""), ("mph", "furlongs")])
def test_units_that_cannot_be_converted_are_refused(linear, mine, theirs):
    with pytest.raises(SimulationError, match=r"S!D1: .*cannot be converted"):
        compare(linear(units=mine), linear(units=theirs), **SIZE)


def test_forecasts_are_paired_by_name_and_by_hand(linear):
    first = linear(more={"z": ("E1", "=A1")})
    second = linear(name="y.xlsx", more={"w": ("E1", "=A1")})
    result = compare(first, second, "0.1", **SIZE)
    assert [each.first.name for each in result.forecasts] == ["y"]
    assert result.unpaired == (("z",), ("w",))
    result = compare(first, second, "0.1", pairs={"Z": "w"}, **SIZE)
    assert [(each.first.name, each.second.name) for each in result.forecasts] == [("y", "y"), ("z", "w")]
    assert "z (w) to 0.1" in verdict_text(result)[0]
    crossed = compare(first, second, "5", pairs={"y": "w"}, **SIZE)
    assert crossed.unpaired == (("z",), ("y",))


def test_pairs_that_are_not_there(linear):
    with pytest.raises(SimulationError, match=r"x\.xlsx: There is no forecast 'Q'"):
        compare(linear(), linear(name="y.xlsx"), pairs={"Q": "y"})
    second = linear(name="y.xlsx")
    renamed = replace(second.definitions, forecasts=(replace(second.forecasts[0], name="q"),))
    with pytest.raises(SimulationError, match="No forecast has the same name in both books"):
        compare(linear(), CompiledModel(second.workbook, renamed, second.path))


def test_undecided_and_decided_by_as_many_trials_as_it_asks_for(linear):
    """a + b with and without b > 0.05: the mean differs by 0.025. The number of trials asked for is an estimate from
    few of them, so four times as many are given.
    """
    filters = {"small": {"cell": "B1", "above": 0.05}}
    first, second = linear(), linear(name="y.xlsx", filters=filters)
    short = compare(first, second, "0.06", trials=200, seed=1)
    assert only(short).judgement.verdict is Verdict.UNDECIDED
    assert only(short).cause is None
    assert short.trials_needed > 200
    assert "trials would decide" in verdict_text(short)[0]
    long = compare(first, second, "0.06", trials=4 * short.trials_needed, seed=1)
    assert only(long).judgement.verdict is Verdict.WITHIN


def test_nothing_accepted_is_undecided(linear):
    impossible = linear(name="y.xlsx", filters={"never": {"cell": "A1", "above": 2}})
    result = compare(linear(), impossible, "0.1", **SIZE)
    assert only(result).judgement.verdict is Verdict.UNDECIDED
    assert result.trials_needed is None
    assert "too few of them are accepted" in verdict_text(result)[0]


def test_a_forecast_without_numbers_is_not_called_a_want_of_accepted_trials(book):
    model = book({"A1": 0.5, "B1": "=SQRT(-1-A1)"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"y": "B1"})
    result = compare(model, model, "1", **SIZE)
    assert "it is a number in none of the 20,000 trials that" in verdict_text(result)[0]
    assert inputs_text(result) == ["1 assumption is drawn alike in both books."]


def test_books_of_one_file_name_go_by_their_paths(linear):
    result = compare(linear(name="one/x.xlsx"), linear(name="two/x.xlsx"), "1", **SIZE)
    assert book_names(result) == (str(Path("one/x.xlsx")), str(Path("two/x.xlsx")))


def test_the_ladder_on_the_case_study(planar, momentum):
    """`momentum` and `planar-impact` give the same number in every trial; only the restitution filters part them.

    Converged values (2e9 trials): without filters the means are 12.1658, 23.7710, 33.6923, 8.8974 mph, with them
    11.80333, 23.06344, 33.16317, 4.74205. `momentum` has the filters V2 > 0 and its own, which reject next to nothing
    more: P(V2 > 0) = .991, and its mean of V2 rises by less than 0.1.

    Of what must be within, the lower end of Chevrolet's impact speed differs most: by 0.63, with an error of 0.06 at
    60,000 trials. A verdict clears the accuracy by three errors: 0.81.
    """
    result = compare(planar, momentum, ["0.9 mph", "Nissan delta-V=1.5 mph"], trials=60_000)
    assert result.simpler == 1
    verdicts = {each.first.name: each.judgement.verdict for each in result.forecasts}
    assert verdicts == {
        "Chevrolet delta-V": Verdict.WITHIN,
        "Nissan delta-V": Verdict.WITHIN,
        "Chevrolet impact speed": Verdict.WITHIN,
        "Nissan impact speed": Verdict.BEYOND,
    }
    expected = {"Chevrolet delta-V": 0.3625, "Nissan delta-V": 0.7076, "Chevrolet impact speed": 0.5291}
    for each in result.forecasts:
        assert each.same_in_every_trial
        if each.first.name in expected:
            change = each.difference.mean.difference
            assert abs(change.value - expected[each.first.name]) < 4 * change.error + 0.02
    assert result.acceptance.first_only == 0
    cause = next(each.cause for each in result.forecasts if each.cause)
    assert [(step.kind, step.name) for step in cause.steps] == [("filter", "Restitution, tangential")]
    assert len(result.inputs.alike) == 10
    assert len(result.inputs.drawn[0]) == 7


def test_the_probability_of_being_above_the_threshold_is_compared(book):
    given = {"a": {"cell": "A1", "low": 0, "high": 1}}
    first, second = (book({"A1": 0.5, "D1": f"=A1+IF(A1>0.98,{more},0)"}, given, {"y": "D1"}) for more in (0, 3))
    asked = replace(first.definitions.forecasts[0], threshold=2.0)
    first = CompiledModel(first.workbook, replace(first.definitions, forecasts=(asked,)), first.path)
    result = compare(first, second, "1", trials=20_000, seed=1)
    (each,) = result.forecasts
    assert each.judgement.verdict is Verdict.BEYOND
    assert each.judgement.largest == "P(> 2)"
    assert each.difference.above.second.value == pytest.approx(0.02, abs=0.004)
    (message,) = verdict_text(result)
    assert "y to 1 and P(> 2) to 0.1 points: P(> 2) differs by " in message
    assert "points" in message.partition("differs by")[2]
    assert compare(first, second, "1", chance=5, trials=20_000, seed=1).forecasts[0].judgement.verdict is Verdict.WITHIN


def test_trials_that_errors_take_from_one_book_are_told(linear):
    """The second book's answer is the first's where a is 1/2 or more, and else an error."""
    result = compare(linear(), linear("=A1+B1+0*SQRT(A1-0.5)", name="y.xlsx"), "1", causes=False, **SIZE)
    (sentence,) = (text for text in verdict_text(result) if "errors" in text)
    assert sentence.startswith("In y.xlsx errors in cells take up to 5")
    assert not any("errors" in text for text in verdict_text(compare(linear(), linear(name="y.xlsx"), "1", **SIZE)))


def test_books_whose_dates_count_from_different_days_are_refused(tmp_path):
    """They were said to differ by 1,462 days, and the dates of the second were written four years early."""

    def dated(name, date1904, code):
        with xlsxwriter.Workbook(tmp_path / name, {"date_1904": date1904}) as made:
            sheet, form = made.add_worksheet("S"), made.add_format({"num_format": code})
            sheet.add_table(0, 0, 1, 3, {"name": "xlmc_assumptions", "columns": heads("Name", "Value", "Low", "High")})
            sheet.write(1, 0, "start")
            for column, day in enumerate([date(2024, 3, 1), date(2024, 2, 1), date(2024, 4, 1)], 1):
                sheet.write_datetime(1, column, day, form)
            sheet.add_table(3, 0, 4, 1, {"name": "xlmc_forecasts", "columns": heads("Name", "Value")})
            sheet.write(4, 0, "end")
            sheet.write_formula(4, 1, "=B2+10", form)
        return load(tmp_path / name)

    first, second = dated("first.xlsx", False, "yyyy-mm-dd"), dated("second.xlsx", True, "yyyy-mm-dd")
    with pytest.raises(
        SimulationError, match=r"Dates of first\.xlsx and of second\.xlsx do not count from the same day"
    ):
        compare(first, second, **SIZE)
    with pytest.raises(SimulationError, match="do not count from the same day"):
        compare(first, second, feeds={"start": "end"}, **SIZE)
    assert only(compare(first, first, **SIZE)).judgement.verdict is Verdict.WITHIN
    plain = dated("third.xlsx", False, "0.0"), dated("fourth.xlsx", True, "0.0")
    assert only(compare(*plain, **SIZE)).judgement.verdict is Verdict.BEYOND  # numbers, as far as their formats say


def heads(*names):
    return [{"header": name} for name in names]
