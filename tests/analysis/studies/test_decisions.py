"""Tables of decisions against the newsvendor, whose expected profit is known for every order."""

from __future__ import annotations

import math
import re
import signal

import numpy as np
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.errors import DefinitionError, DefinitionsError, SimulationError

HEADS = ["Name", "Cell", "Low", "High", "Step", "Values", "Units"]
ORDER = ["Order", "=Inputs!B5", 20, 60, 10, None, "pieces"]
PRICE = ["Price", "=Inputs!B6", None, None, None, "5; 6", None]


@pytest.fixture
def book(tmp_path):
    """A newsvendor: demand uniform from 0 to 100, a cost of 3 and a price of 5."""

    def make(*rows, formula="=Inputs!B6*MIN(Inputs!B5,Inputs!B2)-3*Inputs!B5"):
        rows = rows or (ORDER, PRICE)
        sheets = {
            "Inputs": [
                ["Name", "Value", "Low", "High"],
                ["Demand", 50, 0, 100],
                [],
                ["What", "Value"],
                ["Order", 50],
                ["Price", 5],
            ],
            "Model": [["Name", "Value", "Threshold"], ["Profit", formula, 0]],
            "Decisions": [HEADS, *rows],
        }
        tables = {
            "xlmc_assumptions": "Inputs!A1:D2",
            "xlmc_forecasts": "Model!A1:C2",
            "xlmc_decisions": f"Decisions!A1:G{1 + len(rows)}",
        }
        path = tmp_path / "newsvendor.xlsx"
        workbook_of(sheets, tables).save(path)
        return path

    return make


def expected_profit(order, price):
    return price * (order - order**2 / 200) - 3 * order


def test_means_and_differences_are_those_of_the_closed_form(book):
    result = xlmc.decide(xlmc.load(book()), trials=20_000)
    assert len(result.combinations) == 10
    assert [each.values for each in result.combinations[:3]] == [(20, 5), (20, 6), (30, 5)]
    base = expected_profit(50, 5)
    for each in result.combinations:
        (answer,) = each.answers.forecasts
        exact = expected_profit(*each.values)
        assert abs(answer.mean.value - exact) < 4 * answer.mean.error
        change = answer.differences["mean"]
        assert abs(change.value - (exact - base)) < 4 * change.error + 1e-12
        alone = math.hypot(answer.mean.error, result.base.forecasts[0].mean.error)
        assert change.error < alone  # paired
    same = next(each for each in result.combinations if each.values == (50, 5))
    assert same.answers.forecasts[0].differences["mean"].value == 0.0


def test_a_combination_that_loses_trials_to_errors_is_not_called_the_best(book):
    """An order of x loses x % of the trials; by those that are left its profit is 2·x."""
    path = book(
        ["Order", "=Inputs!B5", None, None, None, "-10; 0; 50", None],
        formula="=2*Inputs!B5+0*SQRT(Inputs!B2-Inputs!B5)",
    )
    result = xlmc.decide(xlmc.load(path), trials=2_000)
    best = result.best("Profit")
    assert best.combination.values == (0,)
    assert best.next.values == (-10,)
    (losing,) = result.losing("Profit")
    assert losing.answers.run.lost_share("Profit") == pytest.approx(0.5, abs=0.05)
    assert re.search(r"Left out of the largest and smallest of Profit.*: Order = 50 \((49|5\d) %\)\.", str(result))


def test_where_all_combinations_lose_trials_none_is_the_best(book):
    path = book(
        ["Order", "=Inputs!B5", None, None, None, "20; 50", None], formula="=2*Inputs!B5+0*SQRT(Inputs!B2-Inputs!B5)"
    )
    result = xlmc.decide(xlmc.load(path), trials=2_000)
    assert result.best("Profit") is None
    assert "The mean of Profit is" not in str(result)
    assert "Left out" in str(result)


def test_the_best_order_is_found_and_how_sure_that_is(book):
    result = xlmc.decide(xlmc.load(book()), ["Order"], trials=20_000)
    best = result.best("Profit")
    assert best.combination.values == (40,)
    assert best.is_sure
    exact = expected_profit(40, 5) - max(expected_profit(30, 5), expected_profit(50, 5))
    assert abs(best.ahead.value - exact) < 4 * best.ahead.error
    worst = result.best("Profit", least=True)
    assert worst.combination.values[0] in (20, 60)  # whose expected profits are equal
    assert not worst.is_sure


def test_a_combination_is_the_workbook_with_its_values_typed_in(book):
    model = xlmc.load(book())
    result = xlmc.decide(model, ["Order", "Price"], trials=2_000, seed=7)
    last = result.combinations[-1]
    drawn = model.simulate(2_000, seed=7, keep_inputs=None).inputs["Demand"]
    assert np.allclose(last.answers.run.forecasts["Profit"], 6 * np.minimum(60, drawn) - 180, rtol=1e-14)


def test_latin_hypercubes_are_compared_by_replicates(book):
    result = xlmc.decide(xlmc.load(book()), ["Order"], trials=20_000, sampling="lhs")
    answer = result.combinations[0].answers.forecasts[0]
    exact = expected_profit(20, 5) - expected_profit(50, 5)
    assert abs(answer.differences["mean"].value - exact) < 5 * answer.differences["mean"].error + 1e-9


def test_values_of_a_range_reach_its_end(book):
    path = book(["Order", "=Inputs!B5", 0, 1, 0.1, None, None], ["Price", "=Inputs!B6", 1, 9, None, None, None])
    order, price = xlmc.decide(xlmc.load(path), trials=100).decisions
    assert order.values == pytest.approx(np.linspace(0, 1, 11))
    assert order.values[-1] == 1.0
    assert price.values == (1, 3, 5, 7, 9)


def test_an_impossible_combination_does_not_stop_the_others(book, tmp_path):
    """With an order of 0 the assumption's range is a point above its end, so that no draw is possible."""
    path = book(["Order", "=Inputs!B5", None, None, None, "0; 50", None])
    import openpyxl

    made = openpyxl.load_workbook(path)
    made["Inputs"]["C2"] = "=60-Inputs!B5"
    made["Inputs"]["D2"] = 55
    made.save(path)
    result = xlmc.decide(xlmc.load(path), trials=500)
    assert [each.values for each in result.combinations] == [(50,)]
    assert list(result.impossible) == [(0,)]


@pytest.mark.parametrize(
    ("row", "message", "where"),
    [
        (["Order", "=Model!B2", 1, 2, 1, None, None], "holds a formula", "Decisions!A2"),
        (["Order", "=Inputs!B2", 1, 2, 1, None, None], "is drawn or solved for", "Decisions!A2"),
        (["Order", "=Inputs!B5", 2, 1, 1, None, None], "there are no values", "Decisions!C2"),
        (["Order", "=Inputs!B5", 1, 2, 1e-9, None, None], "are more than 100,000", "Decisions!E2"),
        (["Order", "=Inputs!B5", None, 2, None, None, None], "has no Low", "Decisions!C2"),
        (["Order", "=Inputs!B5", 1, None, None, "1; 2", None], "Values and Low are both given", "Decisions!C2"),
        (["Order", "=Inputs!B5", None, None, None, "one, two", None], "lists one value, 'one, two'", "Decisions!F2"),
    ],
)
def test_mistakes_are_named_with_their_cell(book, row, message, where):
    with pytest.raises((DefinitionError, DefinitionsError), match=message) as caught:
        xlmc.load(book(row))
    assert where in str(caught.value)


def test_what_cannot_be_asked_is_refused(book, tmp_path):
    model = xlmc.load(book())
    with pytest.raises(SimulationError, match="No decision has the name 'Size'"):
        xlmc.decide(model, ["Size"])
    many = xlmc.load(book(["Order", "=Inputs!B5", 1, 999, 1, None, None], PRICE))
    with pytest.raises(SimulationError, match="1,998 combinations"):
        xlmc.decide(many)
    function = xlmc.model(lambda x: {"y": x}, {"x": xlmc.Uniform(0, 1)}, ["y"])
    with pytest.raises(DefinitionError, match="defines no decision"):
        xlmc.decide(function)


def test_a_table_that_is_interrupted_tells_what_was_run(book):
    def tell(what):
        if what.startswith("Order = 40"):
            signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        result = xlmc.decide(xlmc.load(book(ORDER)), trials=500, tell=tell)
    finally:
        signal.signal(signal.SIGINT, before)
    assert [each.values for each in result.combinations] == [(20,), (30,), (40,)]
    assert result.ended == "it was interrupted after 4 of about 6 steps"
    assert "Combinations that are not in it were not run." in str(result)


@pytest.mark.parametrize("study", [xlmc.decide, xlmc.stress])
def test_a_share_is_not_in_the_units_of_its_forecast(tmp_path, study):
    sheets = {
        "Inputs": [["Name", "Value", "Low", "High"], ["Demand", 50, 0, 100], ["Stock", 40]],
        "Model": [["Name", "Value", "Units"], ["Short", "=Inputs!B2>Inputs!B3", "pieces"]],
        "Decisions": [HEADS, ["Stock", "=Inputs!B3", 20, 60, 20, None, "pieces"]],
    }
    tables = {
        "xlmc_assumptions": "Inputs!A1:D2",
        "xlmc_forecasts": "Model!A1:C2",
        "xlmc_decisions": "Decisions!A1:G2",
    }
    workbook_of(sheets, tables).save(tmp_path / "short.xlsx")
    message = repr(study(xlmc.load(tmp_path / "short.xlsx"), trials=2_000))
    assert "probability" in message
    assert "% pieces" not in message
