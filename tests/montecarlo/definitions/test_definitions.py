"""How the parts of definitions are named and written."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.montecarlo.definitions.definitions import (
    Assumption,
    Correlation,
    DataRange,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Solve,
    StatedNumber,
)
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind, Role
from xlmc.montecarlo.distributions import FAMILIES

HERE, B2, C3 = Cell("S", 1, 1), Cell("S", 2, 2), Cell("S", 3, 3)
MONEY, DAY, SPAN = Form(Kind.CURRENCY, '"$"#,##0'), Form(Kind.DATE, "yyyy-mm-dd"), Form(Kind.DATE, "[h]:mm:ss")


def assumption(given, distribution="Normal", **more):
    return Assumption("x", HERE, distribution, given, HERE, **more)


def test_parameters_and_cutoffs():
    made = assumption({"mean": 5.0, "std_dev": B2, "upper_cutoff": C3, "lower_cutoff": 1.0})
    assert made.parameters == {"mean": 5.0, "std_dev": B2}
    assert made.cutoffs == {"lower_cutoff": 1.0, "upper_cutoff": C3}
    assert list(made.cutoffs) == ["lower_cutoff", "upper_cutoff"]
    assert made.headings == {
        "mean": "Mean", "std_dev": "Std dev", "lower_cutoff": "Lower cutoff", "upper_cutoff": "Upper cutoff",
    }  # fmt: skip
    assert made.formulas == {"std_dev": B2, "upper_cutoff": C3}
    assert made.cells == (B2, C3)
    assert made.family is FAMILIES["Normal"]
    own = assumption(
        {"mean": 5.0}, own_family=FAMILIES["Uniform"], data=DataRange(Area("S", 1, 1, 2, 2), ((C3, None),))
    )
    assert own.family is FAMILIES["Uniform"]
    assert own.cells == (C3,)


def test_names():
    assert assumption({}).names == ("x",)
    assert assumption({}, stream="S!A1#1").names == ("x", "S!A1#1")
    assert Forecast("y", B2, HERE).names == ("y", "S!B2")


def test_other_numbers_take_the_place_of_formulas():
    stated = {"mean": StatedNumber(5.0, "=A1"), "std_dev": StatedNumber(1.0, "=A2")}
    made = assumption({"mean": B2, "std_dev": C3, "lower_cutoff": 0.0}, stated=stated)
    changed = made.with_numbers({"mean": 7.0, "lower_cutoff": None})
    assert changed.given == {"mean": 7.0, "std_dev": C3}
    assert changed.stated == {"std_dev": stated["std_dev"]}


@pytest.mark.parametrize(
    ("form", "key", "value", "used"),
    [
        (MONEY, "mean", 5.0, True), (MONEY, "std_dev", 5.0, True), (MONEY, "low", 5.0, True),
        (MONEY, "lower_cutoff", 5.0, True), (MONEY, "location", 5.0, True), (MONEY, "p90", 5.0, True),
        (MONEY, "p5", 5.0, True), (MONEY, "shape", 5.0, False), (MONEY, "rate", 5.0, False),
        (MONEY, "probability", 0.5, False), (MONEY, "population", 5.0, False), (MONEY, "base", 5.0, True),
        (DAY, "low", 45000.0, True), (DAY, "mean", 10_000.0, True), (DAY, "std_dev", 9_999.0, False),
        (DAY, "low", 3.0, False), (SPAN, "low", 3.0, True), (SPAN, "shape", 3.0, False),
    ],
)  # fmt: skip
def test_which_numbers_are_written_as_their_cell(form, key, value, used):
    assert (assumption({}, form=form).form_of(key, value) is form) == used


@pytest.mark.parametrize(
    ("given", "stated", "text"),
    [
        (5000.0, None, "$5,000"), (B2, None, "S!B2"), (B2, StatedNumber(5000.0, "=S!B2"), "$5,000 (=S!B2)"),
        (B2, StatedNumber(None, "=S!B2"), "=S!B2"),
    ],
)  # fmt: skip
def test_parameters_as_text(given, stated, text):
    made = assumption({"mean": given}, form=MONEY, stated={} if stated is None else {"mean": stated})
    assert made.text_of("mean") == text
    limit = Filter("f", HERE, HERE, at_least=given, form=MONEY, stated={} if stated is None else {"at_least": stated})
    assert limit.text_of("at_least") == text


def test_limits_that_formulas_compute():
    made = Filter("f", HERE, HERE, at_least=1.0, at_most=B2, below=C3)
    assert made.formulas == {"at_most": B2, "below": C3}
    assert (made.can_be_used, made.used, made.only_for) == (True, True, ())
    assert Filter("f", HERE, HERE).formulas == {}


def test_cells_of_data():
    data = DataRange(Area("S", 1, 1, 2, 2), ((1.0, B2), (None, C3)), bandwidth=HERE)
    assert list(data.cells) == [B2, C3, HERE]
    assert list(DataRange(Area("S", 1, 1, 2, 2), ((1.0, None),)).cells) == []
    assert not data.cumulative


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({}, False),
        ({"report_to": 0.5}, True),
        ({"kind": Kind.WHOLE}, True),
        ({"role": next(each for each in Role if each is not Role.ANSWER)}, True),
    ],
)
def test_whether_a_forecast_says_how_it_is_stated(more, says):
    made = Forecast("y", B2, HERE, **more)
    assert made.says_how == says
    assert made.central == 0.51


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (ErrorCode.NA, "no value from $0 to S!C3 makes S!B2 equal to 5"),
        (ErrorCode.NUM, "several values from $0 to S!C3 make S!B2 equal to 5"),
    ],
)
def test_why_a_trial_has_no_solution(code, words):
    solve = Solve("s", B2, 5.0, HERE, 0.0, C3, HERE, form_by=MONEY)
    assert solve.words(code) == words
    assert [solve.form_of(key) is MONEY for key in ("to", "low", "high")] == [False, True, True]


NUMBERS = Decision("n", B2, (20.0, 30.0, 40.0), HERE)
LISTED = Decision("t", B2, (0.0, 1.0, 2.0), HERE, contents=("steel", True, False), listed=True)
TEXTS = Decision("t", B2, (0.0, 1.0, 2.0), HERE, contents=("steel", True, False))


@pytest.mark.parametrize(
    ("decision", "value", "content", "shown"),
    [
        (NUMBERS, 30.0, 30.0, "30"), (TEXTS, 0.0, "steel", "steel"), (TEXTS, 1.0, True, "TRUE"),
        (TEXTS, 2.0, False, "FALSE"), (Decision("n", B2, (1000.0,), HERE, form=MONEY), 1000.0, 1000.0, "$1,000"),
    ],
)  # fmt: skip
def test_values_of_decisions(decision, value, content, shown):
    assert decision.content(value) is content or decision.content(value) == content
    assert decision.shown(value) == shown
    assert decision.value_of(content) == value


@pytest.mark.parametrize(
    ("decision", "content"),
    [(NUMBERS, "x"), (NUMBERS, None), (NUMBERS, ErrorCode.NA), (TEXTS, "wood"), (TEXTS, 1.0), (TEXTS, None)],
)
def test_contents_that_are_no_value(decision, content):
    assert decision.value_of(content) is None


@pytest.mark.parametrize(
    ("decision", "text"),
    [
        (NUMBERS, "20 to 40 in steps of 10"), (LISTED, "steel; TRUE; FALSE"),
        (Decision("n", B2, (5.0, 6.0), HERE), "5; 6"),
        (Decision("n", B2, (0.0, 0.5, 1.0), HERE, between=(0.0, 1.0)), "0 to 1"),
        (Decision("n", B2, (1.0, 5.0, 7.0), HERE, listed=True), "1; 5; 7"),
        (Decision("n", B2, (0.1, 0.1 + 0.2, 0.5), HERE), "0.1 to 0.5 in steps of 0.2"),
        (Decision("n", B2, (5.0,), HERE), "5"),
    ],
)  # fmt: skip
def test_values_in_words(decision, text):
    assert decision.values_text == text


def test_a_coefficient_is_a_number_once_a_model_is_made():
    assert Correlation("a", "b", 0.5, HERE).number == 0.5
    assert Correlation("a", "b", 0.5, HERE).weight == 0.0
    with pytest.raises(AssertionError, match="has not been computed"):
        Correlation("a", "b", B2, HERE).number  # noqa: B018 - reading it is what raises


def test_rows_that_are_switched_off():
    made = Definitions((), (), (), (), switches={"off": (HERE, False), "on": (HERE, True)})
    assert [made.is_used(row) for row in ("off", "on", "none")] == [False, True, True]


@pytest.mark.parametrize(
    "made",
    [
        assumption({"mean": 5.0}), Forecast("y", B2, HERE), Filter("f", HERE, HERE), NUMBERS,
        Solve("s", B2, 5.0, HERE, 0.0, C3, HERE),
    ],
    ids=lambda made: type(made).__name__,
)  # fmt: skip
def test_how_something_is_written_is_no_part_of_it(made):
    """Forms, and what formulas were seen to give, are neither compared nor shown."""
    others = {"form": MONEY, "form_by": MONEY, "stated": {"mean": StatedNumber(5.0, "=A1")}, "checked": "a draw"}
    own = {key: value for key, value in others.items() if key in type(made).__dataclass_fields__}
    for key, value in own.items():
        other = replace(made, **{key: value})
        assert other == made
        assert repr(other) == repr(made)
        assert f"{key}=" not in repr(made)
    assert replace(made, name="another") != made


def test_what_is_usual():
    made = assumption({"mean": 5.0})
    assert (made.frozen, made.uncertain, made.stream, made.base) == (False, False, "", None)
    assert (NUMBERS.listed, NUMBERS.contents, NUMBERS.between) == (False, (), None)
