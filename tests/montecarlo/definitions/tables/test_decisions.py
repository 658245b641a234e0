"""The values of decisions, as rows of `xlmc_decisions` say them."""

from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.tables.decisions import values_between

HEADINGS = ["Name", "Cell", "Low", "High", "Step", "Values", "Units"]
FREE = ("=Model!D9", None)
PLACE = {"xlmc_decisions": "Plan!A1:G2"}
AT = Cell("S", 1, 1)


def rows(blocks, *row, headings=HEADINGS):
    return {**blocks("Plan!A1", [headings, ["Size", FREE, *row]]), "Model!D9": 3.0}


@pytest.mark.parametrize(
    ("row", "values", "between", "listed"),
    [
        ((1, 2, 0.25), (1.0, 1.25, 1.5, 1.75, 2.0), None, False),
        ((0, 1, 0.3), (0.0, 0.3, 0.6, 0.9), None, False),
        ((0, 8), (0.0, 2.0, 4.0, 6.0, 8.0), (0.0, 8.0), False),
        ((-1, 1, 2), (-1.0, 1.0), None, False),
        ((None, None, None, "10; 20;50"), (10.0, 20.0, 50.0), None, True),
        ((None, None, None, "20; 10; 20; "), (20.0, 10.0), None, True),
        ((None, None, None, "7"), (7.0,), None, True),
        ((None, None, None, 7), (7.0,), None, True),
        ((None, None, None, "red; blue"), (0.0, 1.0), None, True),
    ],
)
def test_values(read, blocks, row, values, between, listed):
    result = read(rows(blocks, *row), PLACE)
    assert result.problems == ()
    (decision,) = result.decisions
    assert decision.values == pytest.approx(values)
    assert (decision.between, decision.listed) == (between, listed)
    assert (decision.name, decision.cell, decision.row) == ("Size", Cell("Model", 9, 4), Cell("Plan", 2, 1))


@pytest.mark.parametrize(
    ("text", "contents"),
    [("red; blue; red", ("red", "blue")), ("true; no", (True, "no")), ("TRUE;False", (True, False)), ("1; 2", ())],
)
def test_what_stands_in_the_cell_for_a_text(read, blocks, text, contents):
    (decision,) = read(rows(blocks, None, None, None, text, "m"), PLACE).decisions
    assert decision.contents == contents
    assert decision.units == "m"


@pytest.mark.parametrize(
    ("row", "where", "message", "hint"),
    [
        ((2, 1, 0.5), "Plan!C2", "From 2 to 1 in steps of 0.5 there are no values", "Low below High"),
        ((1, 1), "Plan!C2", "From 1 to 1 in steps of 0 there are no values", "Step above 0"),
        ((1, 2, 0), "Plan!C2", "in steps of 0 there are no values", "Step above 0"),
        ((1, 2, -1), "Plan!C2", "in steps of -1 there are no values", "Step above 0"),
        ((1, None, 1), "Plan!D2", "The decision has no High", "Fill in Low and High"),
        ((None, 2), "Plan!C2", "The decision has no Low", "Fill in Low and High"),
        ((None, None, 1), "Plan!A2", "The decision has no values", "or Values such as 10; 20; 50"),
        ((1, None, None, "2; 3"), "Plan!C2", "Values and Low are both given", "Clear one of them"),
        ((None, None, 1, "2; 3"), "Plan!E2", "Values and Step are both given", "Clear one of them"),
        ((None, None, None, "2; x"), "Plan!F2", "Values lists numbers and 'x'", "separated by semicolons"),
        ((None, None, None, "x"), "Plan!F2", "Values lists one value, 'x'", "separated by semicolons"),
        ((None, None, None, ";"), "Plan!F2", "Values lists nothing", "separated by semicolons"),
        ((0, 1, 1e-6), "Plan!E2", "1,000,001 values are more than 100,000", "larger Step"),
    ],
)
def test_mistakes(only_problem, blocks, row, where, message, hint):
    only_problem(where, message, hint, rows(blocks, *row), PLACE)


@pytest.mark.parametrize(
    ("heading", "where", "message"),
    [
        ("Valeus", "Plan!C1", "The column 'Valeus' is not read: did you mean Values?"),
        ("Hihg", "Plan!C1", "The column 'Hihg' is not read: did you mean High?"),
        ("Comment", "Plan!A2", "The decision has no values"),
    ],
)
def test_a_misspelt_heading_is_named(read, blocks, heading, where, message):
    changes = rows(blocks, 1, headings=["Name", "Cell", heading])
    (problem,) = read(changes, {"xlmc_decisions": "Plan!A1:C2"}).problems
    assert (problem.where, problem.message) == (where, message)


@pytest.mark.parametrize(
    ("cell", "what"),
    [
        ("=Model!B1", "holds a formula"),
        ("=Inputs!B2", "is drawn or solved for in each trial"),
    ],
)
def test_a_cell_that_is_computed_is_no_decision(only_problem, blocks, cell, what):
    changes = {**blocks("Plan!A1", [HEADINGS, ["Size", (cell, None), 1, 2, 1]])}
    only_problem("Plan!A2", what, "Decide on", changes, PLACE)


@pytest.mark.parametrize(
    ("low", "high", "step", "count", "last"),
    [
        (0.0, 1.0, 0.1, 11, 1.0),  # ten times 0.1 is a little less than 1
        (0.0, 0.3, 0.1, 4, 0.3),
        (0.0, 1.0, 0.4, 3, 0.8),
        (0.0, 99_999.0, 1.0, 100_000, 99_999.0),
    ],
)
def test_steps(low, high, step, count, last):
    result = values_between(low, high, step, AT)
    assert len(result) == count
    assert result[-1] == pytest.approx(last, abs=1e-15)
    assert max(result) <= high


def test_too_many_steps():
    with pytest.raises(DefinitionError, match="100,001 values are more than 100,000"):
        values_between(0.0, 100_000.0, 1.0, AT)
