"""The best decisions against known optima: a newsvendor, a portfolio, a knapsack; and what is said of them."""

from __future__ import annotations

import math
import re
import signal
import sys
from itertools import product

import numpy as np
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.analysis.studies.optimising.candidates import Axis
from xlmc.analysis.studies.optimising.goal_text import Reader
from xlmc.analysis.studies.optimising.measures import apart
from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.loop.candidates import CandidateTrials

HEADS = ["Name", "Cell", "Low", "High", "Step", "Values"]
ORDER = ["Order", "=Inputs!B6", 0, 100, 1, None]
PRICE = ["Price", "=Inputs!B7", None, None, None, "5; 6"]


@pytest.fixture
def book(tmp_path):
    """A newsvendor: demand uniform from 0 to 100, a cost of 3 and a price of 5; its colour is what sells."""

    def make(*rows, demand=(0, 100), filters=(), free=None, profit="=Inputs!B7*MIN(Inputs!B6,Inputs!B2)-3*Inputs!B6"):
        rows = rows or (ORDER,)
        sheets = {
            "Inputs": [
                ["Name", "Value", "Low", "High"],
                ["Demand", 50, *demand],
                [],
                [],
                ["What", "Value"],
                ["Order", 50],
                ["Price", 5],
            ],
            "Model": [
                ["Name", "Value", "Threshold", "Units"],
                ["Profit", profit, 0, "$"],
                ["Sold out", "=Inputs!B2>=Inputs!B6", None, None],
                ["Verdict", '=IF(B2>0,"good","bad")', None, None],
            ],
            "Decisions": [HEADS, *rows],
            "Free": [[free]],
            "Filters": [["Name", "Cell", "At least"], *filters],
        }
        tables = {
            "xlmc_assumptions": "Inputs!A1:D2",
            "xlmc_forecasts": "Model!A1:D4",
            "xlmc_decisions": f"Decisions!A1:F{1 + len(rows)}",
            **({"xlmc_filters": f"Filters!A1:C{1 + len(filters)}"} if filters else {}),
        }
        path = tmp_path / "newsvendor.xlsx"
        workbook_of(sheets, tables).save(path)
        return path

    return make


def test_what_is_told_of_the_best_is_a_run_of_the_workbook_with_its_values(book):
    model = xlmc.load(book())
    result = model.optimise(maximise="mean of Profit", trials=2_000, seed=7)
    again = xlmc.load(book()).simulate(2_000, seed=7, keep_inputs=None).inputs["Demand"]
    order = result.values["Order"]
    profit = 5 * np.minimum(order, again) - 3 * order
    assert np.allclose(result.run.forecasts["Profit"], profit, rtol=1e-12)
    assert result.estimate.value == pytest.approx(profit.mean())
    assert result.run.model.workbook.content(result.decisions[0].cell).value == order
    assert result.search_seed != result.run.settings.seed


def test_requirements_hold_and_more_is_not_asked_than_that(book):
    """P5 of demand is 5, so that P5 of profit is 25 − 3·order: at least −70 allows 31 whole pieces."""
    result = xlmc.load(book()).optimise(
        maximise="mean of Profit", subject_to=["P5 of Profit >= -70", "2*Order <= 90"], trials=40_000
    )
    assert result.values["Order"] in (31, 30)
    asked, exact = result.requirements
    assert asked.chance > 0.95
    assert abs(asked.estimate.value - (25 - 3 * result.best[0])) < 4 * asked.estimate.error
    assert exact.exact
    assert exact.estimate.value == 2 * result.best[0]
    assert result.meets


def test_a_requirement_that_none_meets_is_told(book):
    result = xlmc.load(book()).optimise(maximise="mean of Profit", subject_to=["P5 of Profit >= 100"], trials=500)
    assert not result.meets
    assert result.requirements[0].chance < 0.01
    with pytest.raises(SimulationError, match="No combination of the decisions meets"):
        xlmc.load(book()).optimise(maximise="mean of Profit", subject_to=["Order >= 101"], trials=500)


@pytest.mark.parametrize("rows", [(ORDER, PRICE), (["Order", "=Inputs!B6", 0, 100, None, None], PRICE)])
def test_jobs_and_repetition_change_no_bit(book, rows):
    model = xlmc.load(book(*rows))
    first, other = (
        model.optimise(maximise="median of Profit", trials=2_000, seed=3, jobs=jobs, runs=30) for jobs in (1, 2)
    )
    assert first.best == other.best
    assert first.rivals == other.rivals
    assert (first.confidence, first.tried, first.trials) == (other.confidence, other.tried, other.trials)
    assert np.array_equal(first.run.forecasts["Profit"], other.run.forecasts["Profit"])


def test_candidates_that_give_the_same_are_not_told_apart(book):
    """Demand is 200 at least, so that every order of the two is sold: the price decides alone."""
    rows = (["Order", "=Inputs!B6", None, None, None, "10; 10.001"], PRICE)
    result = xlmc.load(book(*rows, demand=(200, 300))).optimise(
        maximise="mean of Profit", trials=500, indifference=0.01
    )
    assert result.values["Price"] == 6
    near = [each for each in result.rivals if each.candidate[1] == 6]
    assert [each.candidate[0] for each in near] == [10.001 if result.best[0] == 10 else 10]
    assert result.confidence > 0.99


def test_filters_that_leave_few_trials_need_more_of_them(book):
    """One of 500 trials has such a demand, 99.8 or more: all that is ordered is sold."""
    path = book(["Order", "=Inputs!B6", 0, 100, 25, None], filters=(["Great demand", "=Inputs!B2", 99.8],))
    result = xlmc.load(path).optimise(maximise="mean of Profit", trials=20_000)
    assert result.values == {"Order": 100}
    assert result.confidence > 0.99
    nothing = book(["Order", "=Inputs!B6", 0, 100, 25, None], filters=(["Never", "=Inputs!B2", 101],))
    result = xlmc.load(nothing).optimise(maximise="mean of Profit", trials=500)
    assert math.isnan(result.estimate.value)
    assert not result.meets
    assert not result.rivals


LOSING = "=2*Inputs!B6+0*SQRT(Inputs!B2-Inputs!B6)"
"""Profit of a firm that fails where less is asked for than it ordered; the formula then is an error."""


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_a_candidate_that_loses_trials_to_errors_cannot_be_the_best(book, engine):
    """An order of x loses x % of the trials; by those that are left the largest order is the best."""
    model = xlmc.load(book(["Order", "=Inputs!B6", 0, 100, 10, None], profit=LOSING))
    result = model.optimise(maximise="mean of Profit", trials=5_000, engine=engine)
    assert result.values == {"Order": 0}
    assert result.lost == 0
    assert result.meets
    assert result.lost_as_it_is == pytest.approx(0.5, abs=0.03)
    shares = {each.candidate[0]: each.lost for each in result.excluded}
    assert [*sorted(shares)] == [*range(10, 101, 10)]
    assert all(shares[order] == pytest.approx(order / 100, abs=0.15) for order in shares)
    looking = {each.candidate[0] for each in result.excluded if each.looks_better}
    assert {50, 60, 70} <= looking
    assert not any(each.meets for each in result.rivals)
    text = str(result)
    assert "10 candidates lose more than 0.1 % of the trials to errors in cells, and cannot be the best" in text
    assert "would be better" in text


def test_trials_that_may_be_lost_are_allowed(book):
    """Of whole orders, those up to 30 % are allowed; that is stated of the best, which loses so many."""
    model = xlmc.load(book(["Order", "=Inputs!B6", 0, 100, 10, None], profit=LOSING))
    result = model.optimise(maximise="mean of Profit", trials=20_000, allow_lost=33)
    assert result.values == {"Order": 30}
    assert result.lost == pytest.approx(0.3, abs=0.015)
    assert result.meets
    with pytest.raises(SimulationError, match="101 % of the trials cannot be lost"):
        model.optimise(maximise="mean of Profit", trials=100, allow_lost=101)


def test_where_all_candidates_lose_trials_none_is_sound(book):
    model = xlmc.load(book(["Order", "=Inputs!B6", 20, 100, 10, None], profit=LOSING))
    result = model.optimise(maximise="mean of Profit", trials=5_000)
    assert result.values == {"Order": 20}  # it loses the least
    assert not result.is_whole
    assert not result.meets
    assert re.search(r"Errors in cells take (19|20|21) % of the trials of these decisions, and 0.1 %", str(result))


def test_errors_in_filters_count_and_rejected_trials_do_not(book):
    """An order of 60 has a filter that is an error where demand is less; a filter that is FALSE loses nothing."""
    rows = (["Order", "=Inputs!B6", None, None, None, "40; 60"],)
    profit, limits = "=2*Inputs!B6", [["Free", "=Free!A1", 0]]
    undecided = "=IF(Inputs!B6>50,SQRT(Inputs!B2-Inputs!B6),1)"
    path = book(*rows, filters=limits, free=undecided, profit=profit)
    result = xlmc.load(path).optimise(maximise="mean of Profit", trials=5_000)
    assert result.values == {"Order": 40}
    (excluded,) = result.excluded
    assert excluded.lost == pytest.approx(0.6, abs=0.15)
    path = book(*rows, filters=limits, free="=Inputs!B2-Inputs!B6", profit=profit)
    result = xlmc.load(path).optimise(maximise="mean of Profit", trials=5_000)
    assert result.values == {"Order": 60}
    assert not result.excluded


def test_the_smallest_is_found_too(book):
    result = xlmc.load(book()).optimise(
        minimise="SD of Profit", subject_to=["mean of Profit >= 30"], trials=40_000, seed=2
    )
    least = min(order for order in range(101) if 5 * (order - order**2 / 200) - 3 * order >= 30)  # 20
    assert result.values["Order"] in (least, least + 1)


def test_a_decision_that_a_row_of_a_table_reads_is_typed_in(book):
    """No formula sees it, so that inputs of one compiled model would not do."""
    path = book(["Greatest demand", "=Inputs!D2", None, None, None, "60; 100; 140"])
    model = xlmc.load(path)
    decisions = model._compiled.definitions.decisions
    assert CandidateTrials(model._compiled, decisions, "numpy", 1, [(0, None)]).by_typing
    result = model.optimise(maximise="mean of Profit", trials=1_000)
    assert result.values == {"Greatest demand": 140}


def test_candidates_as_inputs_give_what_typing_them_gives(book):
    model = xlmc.load(book(ORDER, PRICE, filters=(["Some profit", "=Model!B2", -40],)))
    compiled = model._compiled
    trials = CandidateTrials(compiled, compiled.definitions.decisions, "numpy", 5, [(0, None), (2, "good")])
    assert not trials.by_typing
    held = trials.forecasts([(30.0, 6.0)], 0, 4_000)[0].columns
    trials.by_typing = True
    typed = trials.forecasts([(30.0, 6.0)], 0, 4_000)[0].columns
    assert np.array_equal(held, typed, equal_nan=True)
    assert 0 < np.isnan(held[0]).mean() < 0.5
    assert set(np.unique(held[1][~np.isnan(held[1])])) == {0.0, 1.0}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("mean of Profit", lambda x: x.mean()),
        ("  the  median of profit ", lambda x: np.median(x)),
        ("SD of Profit", lambda x: x.std(ddof=1)),
        ("P5 of Profit", lambda x: np.percentile(x, 5)),
        ("22.5th percentile of Profit", lambda x: np.percentile(x, 22.5)),
        ("probability of Profit above 10", lambda x: (x > 10).mean()),
        ("probability that Profit <= -1,0.5", lambda x: (x <= -10.5).mean()),
        ("certainty of Profit between -10 and 20", lambda x: ((x >= -10) & (x <= 20)).mean()),
        ("probability of Profit", lambda x: (x > 0).mean()),  # its threshold
        ("probability of Profit at least 10%", lambda x: (x >= 0.1).mean()),
        ("chance of 'Sold out'", lambda x: (x <= -50).mean() * np.nan),
        ("probability of Verdict is good", lambda x: (x > 0).mean()),
        ("mean of Profit - 2*SD of Profit + 3*Order - 1", lambda x: x.mean() - 2 * x.std(ddof=1) + 3 * 70 - 1),
        ("-P10 of Profit", lambda x: -np.percentile(x, 10)),
    ],
)
def test_goals_are_read_and_measured(book, text, value):
    model = xlmc.load(book())._compiled
    reader = Reader(model, model.definitions.decisions)
    goal = reader.goal(text, maximise=True)
    trials = CandidateTrials(model, model.definitions.decisions, "numpy", 1, [(0, None), *reader.columns])
    profit, *rest = trials.forecasts([(70.0,)], 0, 5_000)[0].columns
    measured = goal.measure.of(np.array(rest), (70.0,))
    expected = value(profit)
    if math.isnan(expected):
        expected = (profit == 5 * 70 - 3 * 70).mean()
    assert measured.value == pytest.approx(expected)
    assert 0.0 < measured.error < 20.0


def test_errors_are_what_other_seeds_show(book):
    model = xlmc.load(book(ORDER))._compiled
    decisions = model.definitions.decisions
    texts = ("mean of Profit", "SD of Profit", "P65 of Profit", "probability of Profit above 20")
    result = {text: [] for text in texts}
    for seed in range(60):
        reader = Reader(model, decisions)
        goals = [reader.goal(text, maximise=True) for text in texts]
        trials = CandidateTrials(model, decisions, "numpy", seed, reader.columns)
        first, second = (each.columns for each in trials.forecasts([(60.0,), (70.0,)], 0, 2_000))
        for goal, text in zip(goals, texts, strict=True):
            result[text].append(apart(goal.measure.of(first, (60.0,)), goal.measure.of(second, (70.0,))))
    for text, pairs in result.items():
        differences, errors = np.array(pairs).T
        assert 0.7 < differences.std(ddof=1) / errors.mean() < 1.4, text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("mean of Porfit", "Did you mean Profit"),
        ("mean of Order", "'Order' is a decision"),
        ("maximum of Profit", "ask for a percentile, such as P99"),
        ("Cpk of Profit", "no statistic 'Cpk'. There are mean"),
        ("mean Profit", 'Write "mean of Profit"'),
        ("Profit", "a statistic of it is asked for"),
        ("mean of Verdict", "are texts"),
        ("probability of Verdict", "are texts"),
        ("P0 of Profit", "0 is no percentile"),
        ("mean of Profit >= 3", "this is not understood"),
        ("7", "is a number"),
        ("probability of Profit between 1", "a range has two ends"),
        ("probability of 'Sold out' is yes", "are no texts"),
    ],
)
def test_goals_that_are_none_are_refused_with_the_cure(book, text, message):
    model = xlmc.load(book())
    with pytest.raises(SimulationError, match=message):
        model.optimise(maximise=text, trials=100)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("mean of Profit", "a requirement is a comparison"),
        ("mean of Profit = 3", "Give two requirements"),
        ("probability of Profit above 0 >= 90", "Write 90%"),
        ("1 >= 0", "asks for nothing"),
    ],
)
def test_requirements_that_are_none_are_refused(book, text, message):
    model = xlmc.load(book())
    with pytest.raises(SimulationError, match=message):
        model.optimise(maximise="mean of Profit", subject_to=[text], trials=100)


def test_what_cannot_be_asked_is_refused(book):
    model = xlmc.load(book())
    with pytest.raises(SimulationError, match="largest, or smallest"):
        model.optimise(trials=100)
    with pytest.raises(SimulationError, match="No decision has the name 'Size'"):
        model.optimise(maximise="mean of Profit", decisions=["Size"])
    with pytest.raises(SimulationError, match="A search of 0 runs"):
        model.optimise(maximise="mean of Profit", runs=0)
    function = xlmc.model(lambda x: {"y": x}, {"x": xlmc.Uniform(0, 1)}, ["y"])
    with pytest.raises(DefinitionError, match="defines no decision"):
        function.optimise(maximise="mean of y")


def test_few_trials_end_the_search_with_the_best_so_far(book):
    result = xlmc.load(book(["Order", "=Inputs!B6", 0, 100, None, None])).optimise(
        maximise="mean of Profit", trials=20_000, runs=1
    )
    assert result.ended == "its trials were spent"
    assert abs(result.values["Order"] - 40) < 15


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_ctrl_c_ends_the_search_with_the_best_so_far(book):
    """Whoever is told of the second step presses it."""
    steps = []

    def press(what):
        steps.append(what)
        if what.startswith("searching step by step"):
            signal.raise_signal(signal.SIGINT)

    model = xlmc.load(book(["Order", "=Inputs!B6", 0, 100, None, None]))
    result = model.optimise(maximise="mean of Profit", trials=4_000, tell=press)
    assert result.ended == "it was interrupted"
    assert len([each for each in steps if each.startswith("searching step by step")]) == 1
    assert abs(result.values["Order"] - 40) < 15


@pytest.mark.parametrize(
    ("row", "count", "second", "fine"),
    [
        (["Order", "=Inputs!B6", 0, 40, None, None], 4_001, 0.01, True),
        (["Order", "=Inputs!B6", 0, 0.3, None, None], 3_001, 0.0001, True),
        (["Order", "=Inputs!B6", 1, 100, 1, None], 100, 2.0, False),
        (["Order", "=Inputs!B6", None, None, None, "7; 3"], 2, 3.0, False),
    ],
)
def test_values_of_decisions(book, row, count, second, fine):
    (decision,) = xlmc.load(book(row)).optimise(maximise="mean of Profit", trials=200, runs=2).decisions
    axis = Axis.of(decision)
    assert (axis.count, axis.fine) == (count, fine)
    assert axis.value(1) == second
    assert axis.value(axis.count - 1) == decision.values[-1]
    assert all(axis.number(axis.value(each)) == each for each in (0, 1, count // 2, count - 1))
    assert axis.number(1e9) is None


def test_knapsacks_of_many_items_are_searched(tmp_path):
    """Sixteen of yes and no are too many to try all."""
    worth = [4, 9, 3, 7, 8, 2, 6, 5, 9, 1, 4, 7, 3, 8, 6, 2]
    weight = [3, 5, 2, 4, 6, 1, 4, 2, 7, 1, 3, 3, 2, 5, 3, 2]
    best = max(np.dot(t, worth) for t in product((0, 1), repeat=16) if np.dot(t, weight) <= 20)
    sheets = {
        "M": [[0] * 16, worth, [1], ["=SUMPRODUCT(A1:P1,A2:P2)*A3"]],
        "A": [["Name", "Cell", "Low", "High"], ["scale", "=M!A3", 0.5, 1.5]],
        "F": [["Name", "Cell"], ["worth", "=M!A4"]],
        "D": [["Name", "Cell", "Values"], *([f"x{n}", f"=M!{chr(65 + n)}1", "0; 1"] for n in range(16))],
    }
    tables = {"xlmc_assumptions": "A!A1:D2", "xlmc_forecasts": "F!A1:B2", "xlmc_decisions": "D!A1:C17"}
    path = tmp_path / "knapsack.xlsx"
    workbook_of(sheets, tables).save(path)
    carried = " + ".join(f"{w}*x{n}" for n, w in enumerate(weight)) + " <= 20"
    result = xlmc.load(path).optimise(maximise="mean of worth", subject_to=[carried], trials=2_000)
    assert np.dot(result.best, weight) <= 20
    assert np.dot(result.best, worth) >= best - 1


def test_an_equality_computes_a_decision_from_the_others(tmp_path):
    """Shares of three uncorrelated funds with SDs 1, 2, 4 add up to 1: the least variance is with 16 : 4 : 1."""
    sheets = {
        "Inputs": [
            ["Name", "Value", "Distribution", "Mean", "Std dev"],
            *([f"Fund {at}", 0, "Normal", 0, 2**at] for at in range(3)),
            ["What", "Value"],
            *([name, 0.5] for name in "ABC"),
        ],
        "Model": [["Name", "Value"], ["Return", "=Inputs!B2*Inputs!B6+Inputs!B3*Inputs!B7+Inputs!B4*Inputs!B8"]],
        "Decisions": [HEADS, *([name, f"=Inputs!B{6 + at}", 0, 1, None, None] for at, name in enumerate("ABC"))],
    }
    tables = {
        "xlmc_assumptions": "Inputs!A1:E4",
        "xlmc_forecasts": "Model!A1:B2",
        "xlmc_decisions": "Decisions!A1:F4",
    }
    path = tmp_path / "funds.xlsx"
    workbook_of(sheets, tables).save(path)
    result = xlmc.load(path).optimise(minimise="SD of Return", subject_to=["A + B + C = 1"], trials=20_000)
    assert sum(result.values.values()) == pytest.approx(1.0, abs=1e-12)
    least = math.sqrt(16 / 21)
    assert abs(result.estimate.value - least) < 3 * result.estimate.error + result.indifference
    assert [*result.values.values()] == pytest.approx([16 / 21, 4 / 21, 1 / 21], abs=0.03)
    assert result.requirements[0].exact
    assert result.meets
    assert "A + B + C = 1: met, 1." in str(result)
    two = ["A + B + C = 1", "A - 2*B = 0"]
    result = xlmc.load(path).optimise(minimise="SD of Return", subject_to=two, trials=5_000)
    a, b, c = result.values.values()
    assert (a + b + c, a - 2 * b) == pytest.approx((1.0, 0.0), abs=1e-9)
    # SD² = 4b² + 4b² + 16(1 - 3b)²: least at b = 48/152
    assert b == pytest.approx(48 / 152, abs=0.03)
    with pytest.raises(SimulationError, match="No combination"):
        xlmc.load(path).optimise(minimise="SD of Return", subject_to=["A + B + C = 4"], trials=500)


def test_an_equality_of_whole_numbers_leaves_those_that_meet_it(book):
    rows = (["Order", "=Inputs!B6", 0, 100, 10, None], ["Price", "=Inputs!B7", 1, 10, 1, None])
    result = xlmc.load(book(*rows)).optimise(
        maximise="mean of Profit", subject_to=["Order + 10*Price = 100"], trials=2_000
    )
    assert result.tried == 10  # Order 0 to 90
    assert result.values["Order"] + 10 * result.values["Price"] == 100


def test_rounding_of_decisions_is_no_miss(book):
    """In binary numbers .1 + .2 is a little more than .3."""
    rows = (["Order", "=Inputs!B6", None, None, None, "0.1"], ["Price", "=Inputs!B7", None, None, None, "0.2"])
    result = xlmc.load(book(*rows)).optimise(
        maximise="mean of Profit", subject_to=["Order + Price <= 0.3", "Order + Price = 0.3"], trials=500
    )
    assert result.meets
    assert all(each.chance == 1.0 for each in result.requirements)


@pytest.mark.parametrize("more", [(), (ORDER,)])
def test_categories_may_be_texts(book, more):
    """What sells is a colour: red is sold at 9, blue and green at 5; demand is uniform from 0 to 100."""
    rows = (["Colour", "=Free!A1", None, None, None, "blue; red; green"], *more)
    profit = '=IF(Free!A1="red",9,5)*MIN(Inputs!B6,Inputs!B2)-3*Inputs!B6'
    model = xlmc.load(book(*rows, free="green", profit=profit))
    result = model.optimise(maximise="mean of Profit", trials=20_000)
    assert result.values["Colour"] == "red"
    assert result.run.model.workbook.content(result.decisions[0].cell).value == "red"
    if more:
        assert result.values["Order"] == pytest.approx(200 / 3, abs=4)  # 9·(1 - x/100) = 3
    assert "with Colour = red" in str(result)
    order = result.values.get("Order", 50)
    assert abs(result.estimate.value - (9 * (order - order**2 / 200) - 3 * order)) < 4 * result.estimate.error
    own = result.as_it_is
    assert abs(own.value - (5 * (50 - 12.5) - 150)) < 4 * own.error
    with pytest.raises(SimulationError, match="the values of 'Colour' are texts"):
        model.optimise(maximise="mean of Profit", subject_to=["Colour <= 3"], trials=500)


def test_true_and_false_are_typed_as_such(book):
    rows = (["Open", "=Free!A1", None, None, None, "FALSE; TRUE"],)
    model = xlmc.load(book(*rows, free=False, profit="=IF(Free!A1,Inputs!B2,0)"))
    result = model.optimise(maximise="mean of Profit", trials=500)
    assert result.values == {"Open": True}
    assert result.as_it_is.value == 0


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("variance of Profit", lambda x: x.var(ddof=1)),
        ("CV of Profit", lambda x: x.std(ddof=1) / x.mean()),
        ("coefficient of variation of Profit", lambda x: x.std(ddof=1) / x.mean()),
    ],
)
def test_further_statistics_and_their_errors(book, text, value):
    model = xlmc.load(book())._compiled
    decisions, result = model.definitions.decisions, []
    for seed in range(80):
        reader = Reader(model, decisions)
        goal = reader.goal(text, maximise=True)
        trials = CandidateTrials(model, decisions, "numpy", seed, reader.columns)
        (columns,) = (each.columns for each in trials.forecasts([(30.0,)], 0, 2_000))
        measured = goal.measure.of(columns, (30.0,))
        assert measured.value == pytest.approx(value(columns[0]))
        result.append((measured.value, measured.error))
    values, errors = np.array(result).T
    assert 0.75 < values.std(ddof=1) / errors.mean() < 1.3


def test_decisions_that_change_nothing_are_told(book):
    model = xlmc.load(book(PRICE, profit="=Inputs!B2"))
    assert "All candidates give the same" in str(model.optimise(maximise="mean of Profit", trials=500))
    result = xlmc.load(book(ORDER)).optimise(maximise="mean of Profit", trials=20_000)
    assert "All candidates give the same" not in str(result)


def test_workbooks_that_feed_each_other_are_optimised(book, tmp_path):
    """The demand is that of another workbook, uniform from 100 to 150: an order of 100 sells always, at 5 less 3."""
    sheets = {
        "In": [["Name", "Value", "Low", "High"], ["d", 50, 0, 50]],
        "Out": [["Name", "Value"], ["More", "=In!B2+100"]],
    }
    workbook_of(sheets, {"xlmc_assumptions": "In!A1:D2", "xlmc_forecasts": "Out!A1:B2"}).save(tmp_path / "more.xlsx")
    feeds = {"Demand": f"{tmp_path / 'more.xlsx'}!More"}
    model = xlmc.load(book(["Order", "=Inputs!B6", 0, 100, 25, None]), feeds=feeds)
    result = model.optimise(maximise="mean of Profit", trials=1_000)
    assert result.values == {"Order": 100}
    assert result.estimate.value == pytest.approx(200)
    assert result.save(tmp_path / "found.json").exists()
