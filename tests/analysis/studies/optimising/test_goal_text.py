"""Goals and requirements as they are written: what is read, and what it is on columns of known numbers."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.studies.optimising.goal_text import Reader
from xlmc.analysis.studies.optimising.measures import Measured, apart
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Decision, Forecast
from xlmc.montecarlo.definitions.stating import Kind

AT = Cell("S", 1, 1)
FORECASTS = (
    Forecast("NPV", AT, AT, units="$", threshold=4.0),
    Forecast("NPV of all", AT, AT),
    Forecast("Won", AT, AT),
    Forecast("Verdict", AT, AT),
)
DECISIONS = (
    Decision("Order", AT, (1.0, 2.0), AT),
    Decision("Order size", AT, (1.0, 2.0), AT),
    Decision("Colour", AT, (0.0, 1.0), AT, contents=("red", "blue")),
)
MODEL = SimpleNamespace(
    forecasts=FORECASTS,
    definitions=SimpleNamespace(decisions=DECISIONS),
    categories={3: ("good", "bad")},
    formats={"NPV": "$#,##0", "NPV of all": "0.0", "Won": "General", "Verdict": "General"},
    two_valued={"Won"},
)
X = np.arange(-5.0, 11.0)  # -5, …, 10
COLUMNS = {
    (0, None): X,
    (1, None): X**2,
    (2, None): (X > 6) * 1.0,
    (3, "good"): (X > 7) * 1.0,
    (3, "not bad"): (X > 8) * 1.0,
}
VALUES = 7.0, 11.0, 1.0


def reader():
    return Reader(MODEL, DECISIONS)


def measured(measure, made):
    return measure.of(np.array([COLUMNS[each] for each in made.columns]).reshape(-1, X.size), VALUES)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("mean of NPV", X.mean()),
        ("the average of npv", X.mean()),
        ("Expected Value of 'NPV'", X.mean()),
        ('mean of "NPV of all"', (X**2).mean()),
        ("mean of NPV of all", (X**2).mean()),
        ("mean of “NPV of all”", (X**2).mean()),
        ("median of NPV", 2.5),
        ("P50 of NPV", 2.5),
        ("P20 of NPV", np.quantile(X, 0.2)),
        ("p2.5 of NPV", np.quantile(X, 0.025)),
        ("1st percentile of NPV", np.quantile(X, 0.01)),
        ("22nd percentile of NPV", np.quantile(X, 0.22)),
        ("33rd percentile of NPV", np.quantile(X, 0.33)),
        ("the 80th percentile of NPV", np.quantile(X, 0.8)),
        ("SD of NPV", X.std(ddof=1)),
        ("standard deviation of NPV", X.std(ddof=1)),
        ("variance of NPV", X.var(ddof=1)),
        ("CV of NPV", X.std(ddof=1) / X.mean()),
        ("coefficient of variation of NPV", X.std(ddof=1) / X.mean()),
        ("probability of NPV", 6 / 16),  # above its threshold of 4
        ("probability of NPV above 2", 8 / 16),
        ("probability of NPV over 2", 8 / 16),
        ("probability of NPV at least 2", 9 / 16),
        ("certainty of NPV below 2", 7 / 16),
        ("chance of NPV under 2", 7 / 16),
        ("probability of NPV at most 2", 8 / 16),
        ("probability of NPV AT  LEAST -2", 13 / 16),
        ("probability of NPV between -2 and 2", 5 / 16),
        ("probability of NPV between 2 to 3", 2 / 16),
        ("probability that NPV > 2", 8 / 16),
        ("probability that NPV >= 2", 9 / 16),
        ("probability that NPV => 2", 9 / 16),
        ("probability that NPV ≥ 2", 9 / 16),
        ("probability that NPV < -2", 3 / 16),
        ("probability that NPV <= −2", 4 / 16),
        ("probability that NPV =< -2", 4 / 16),
        ("probability that NPV ≤ -2", 4 / 16),
        ("probability that NPV above 250%", 8 / 16),
        ("probability of Won", 4 / 16),
        ("mean of Won", 4 / 16),
        ("probability of Verdict is good", 3 / 16),
        ("probability that Verdict = good", 3 / 16),
        ("probability that Verdict == 'not bad'", 2 / 16),
        ("Order", 7.0),
        ("Order size", 11.0),
        ("2*Order + 'Order size'", 25.0),
        ("-Order - 0.5 × Order size+1,000", -7 - 5.5 + 1000),
        ("50%·Order", 3.5),
        ("1.5e1*Order-.5", 104.5),
        ("mean of NPV - 2*SD of NPV + 3*Order − 1", X.mean() - 2 * X.std(ddof=1) + 21 - 1),
        ("- mean of NPV + mean of NPV of all", (X**2).mean() - X.mean()),
    ],
)
def test_goals(text, value):
    made = reader()
    goal = made.goal(text, maximise=True)
    assert measured(goal.measure, made).value == pytest.approx(value, rel=1e-12)
    assert goal.measure.text == " ".join(text.split())
    assert goal.measure.exact == (not made.columns)
    assert goal.words == f"largest {goal.measure.text}"
    assert (goal.sign, reader().goal(text, maximise=False).sign) == (1.0, -1.0)


@pytest.mark.parametrize(
    ("text", "kind", "spread", "units"),
    [
        ("mean of NPV", Kind.CURRENCY, False, "$"),
        ("P5 of NPV", Kind.CURRENCY, False, "$"),
        ("SD of NPV", Kind.CURRENCY, True, "$"),
        ("SD of NPV of all", Kind.NUMBER, True, ""),
        ("variance of NPV", Kind.NUMBER, False, ""),
        ("CV of NPV", Kind.NUMBER, False, ""),
        ("probability of NPV", Kind.YES_NO, False, ""),
        ("mean of Won", Kind.YES_NO, False, ""),
        ("Order", Kind.NUMBER, False, ""),
        ("2*mean of NPV", Kind.NUMBER, False, ""),
        ("mean of NPV + 1", Kind.NUMBER, False, ""),
        ("mean of NPV + P5 of NPV", Kind.NUMBER, False, ""),
    ],
)
def test_how_a_goal_is_written(text, kind, spread, units):
    result = reader().goal(text, maximise=True).measure
    assert (result.form.kind, result.spread, result.units) == (kind, spread, units)


def test_what_is_asked_twice_is_one_column():
    made = reader()
    made.goal("mean of NPV - SD of NPV + probability of Verdict is 'good' + P5 of NPV of all", maximise=True)
    made.requirement("probability of Verdict is good >= 5%")
    assert made.columns == [(0, None), (3, "good"), (1, None)]


@pytest.mark.parametrize(
    ("text", "slack", "strict", "equal"),
    [
        ("mean of NPV >= 2", X.mean() - 2, False, False),
        ("mean of NPV > 2", X.mean() - 2, True, False),
        ("mean of NPV => -2", X.mean() + 2, False, False),
        ("mean of NPV <= 2", 2 - X.mean(), False, False),
        ("mean of NPV =< 2", 2 - X.mean(), False, False),
        ("mean of NPV ≤ 2", 2 - X.mean(), False, False),
        ("mean of NPV < 2", 2 - X.mean(), True, False),
        ("2 <= mean of NPV", X.mean() - 2, False, False),
        ("mean of NPV + 1 >= 2*Order - 3", X.mean() + 1 - 14 + 3, False, False),
        ("mean of NPV - 1 < SD of NPV + Order", X.std(ddof=1) + 7 - X.mean() + 1, True, False),
        ("Order = 7", 0.0, False, True),
        ("Order == Order size", -4.0, False, True),
        ("probability of NPV above 2 >= 40%", 0.1, False, False),
        ("probability of NPV above 2 <= 1", 0.5, False, False),
        ("probability of NPV above 2 >= 0", 0.5, False, False),
    ],
)
def test_requirements(text, slack, strict, equal):
    made = reader()
    result = made.requirement(text)
    assert measured(result.slack, made).value == pytest.approx(slack)
    assert (result.strict, result.equal) == (strict, equal)
    assert result.text == text


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("Order >= 7", True),
        ("Order > 7", False),
        ("Order <= 7", True),
        ("Order < 7", False),
        ("Order = 7", True),
        ("Order = 7.001", False),
        ("0.1*Order = 0.7", True),  # but for rounding
        ("0.1*Order >= 0.7", True),
        ("0.1*Order > 0.7", False),
        ("Order >= 7.0001", False),
        ("Order + Order size <= 18", True),
        ("Order + Order size <= 17.9", False),
        ("mean of NPV >= 1000", True),  # which no decision alone decides
    ],
)
def test_what_decisions_alone_decide(text, holds):
    result = reader().requirement(text)
    assert result.holds_for(VALUES) is holds


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("7", "'7' is a number, and nothing to choose by", "Such as"),
        ("mean of NPV 2", "In 'mean of NPV ⟨2⟩': this is not understood", "Such as"),
        ("mean of NPVs", "no such statistic, forecast or decision", "NPV"),
        ("mean of 'Nothing'", "there is no forecast or decision 'Nothing'", "'NPV'"),
        ("mean of Order", "'Order' is a decision, and not a forecast", "Such as"),
        ("NPV", "'NPV' is a forecast, and a statistic of it is asked for", "Such as"),
        ("Colour", "the values of 'Colour' are texts", "Only decisions that are numbers"),
        ("mean of Verdict", "In 'mean of Verdict': the answers", "probability of Verdict is Yes"),
        ("probability of Verdict", "the answers of 'Verdict' are texts", "probability of Verdict is Yes"),
        ("probability of NPV is good", "the answers of 'NPV' are no texts", "Such as"),
        ("probability that NPV = 3", "the answers of 'NPV' are no texts", "Such as"),
        ("probability of Verdict is", "no such|a text is missing", ""),
        ("probability of NPV of all", "'NPV of all' is no yes or no, and has no Threshold", "above 0"),
        ("probability of NPV between 2", "a range has two ends", "between 0 and 10"),
        ("probability of NPV between 2 and x", "a number is missing", "Such as"),
        ("probability of NPV above x", "a number is missing", "Such as"),
        ("P0 of NPV", "0 is no percentile", "above 0 and below 100"),
        ("P100 of NPV", "100 is no percentile", "above 0 and below 100"),
        ("maximum of NPV", "the maximum has no error that trials could tell", "P99 or P1"),
        ("the smallest  value of NPV", "has no error that trials could tell", "P99 or P1"),
        ("Cpk of NPV", "there is no statistic 'Cpk'", "There are mean"),
        ("mean NPV", "a word is missing", 'Write "mean of NPV"'),
        ("P5 NPV", "a word is missing", 'Write "P5 of NPV"'),
        ("mean Profit", "no such statistic, forecast or decision", ""),
        ("", "no such statistic, forecast or decision", "There are 'NPV', 'NPV of all', 'Won'"),
    ],
)
def test_what_is_no_goal(text, message, hint):
    with pytest.raises(SimulationError, match=message) as caught:
        reader().goal(text, maximise=True)
    assert hint in caught.value.hint


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("mean of NPV", "a requirement is a comparison", "Write >= or <="),
        ("mean of NPV = 2", "is to be one number, which no trials can tell", "one by >= and one by <="),
        ("Order = mean of NPV", "is to be one number, which no trials can tell", "one by >= and one by <="),
        ("2 >= 1", "asks for nothing of the workbook", "Such as"),
        ("probability of NPV above 2 >= 40", "a probability is compared with 40", "Write 40%"),
        ("probability of NPV above 2 >= -0.1", "a probability is compared with -0.1", "Write -0.1%"),
        ("mean of NPV >= 2 >= 1", "this is not understood", "Such as"),
    ],
)
def test_what_is_no_requirement(text, message, hint):
    with pytest.raises(SimulationError, match=message) as caught:
        reader().requirement(text)
    assert hint in caught.value.hint


def test_trials_without_a_number_count_for_nothing():
    made = reader()
    goal = made.goal("2*mean of NPV + Order", maximise=True)
    column = X.copy()
    column[3:5] = np.nan
    result = goal.measure.of(column[None], VALUES)
    rest = column[~np.isnan(column)]
    assert result.value == pytest.approx(2 * rest.mean() + 7)
    assert result.error == pytest.approx(2 * rest.std(ddof=1) / np.sqrt(rest.size), rel=0.01)
    for few, known in ((1, False), (2, True)):
        column = np.full(X.size, np.nan)
        column[:few] = X[:few]
        assert np.isfinite(goal.measure.of(column[None], VALUES).value) == known


def test_how_far_two_candidates_lie_apart():
    pulls = np.array([1.0, -1.0, 2.0, -2.0])
    assert apart(Measured(3.0), Measured(5.0)) == (2.0, 0.0)
    assert apart(Measured(3.0), Measured(3.0 + 1e-13)) == (0.0, 0.0)
    assert apart(Measured(3.0, pulls), Measured(5.0, pulls)) == (2.0, 0.0)
    difference, error = apart(Measured(5.0, pulls), Measured(3.0, 2 * pulls))
    assert (difference, error) == (-2.0, pytest.approx(np.sqrt(10 * 4 / 3)))
    assert apart(Measured(5.0, pulls, 9.0), Measured(3.0, 2 * pulls, 8.0)) == (-2.0, 8.0)
    assert apart(Measured(5.0, pulls), Measured(3.0)) == (-2.0, pytest.approx(np.sqrt(10 * 4 / 3)))
    assert Measured(np.nan).error == np.inf
    assert Measured(1.0, pulls, 5.0).error == 5.0
