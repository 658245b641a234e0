from __future__ import annotations

import pytest

from xlmc.montecarlo.definitions.definitions import Correlation

MISTAKES = [
    ({"Answers!A21": None}, "Answers!A21", "First is blank", "Fill in First"),
    ({"Answers!B21": None}, "Answers!B21", "Second is blank", "Fill in Second"),
    ({"Answers!A21": "Wieght"}, "Answers!A21", "There is no assumption 'Wieght'", "Did you mean Weight?"),
    ({"Answers!B21": "Quux"}, "Answers!B21", "There is no assumption 'Quux'", "Use one of Weight, Angle"),
    ({"Answers!B21": " weight"}, "Answers!B21", "'Weight' is correlated with itself", "two different"),
    ({"Answers!C21": None}, "Answers!C21", "Correlation is blank", "from -1 to 1"),
    ({"Answers!C21": 1.5}, "Answers!C21", "Correlation (1.5) must lie between -1 and 1", "from -1 to 1"),
    ({"Answers!C21": -1.01}, "Answers!C21", "Correlation (-1.01) must lie between -1 and 1", "from -1 to 1"),
    ({"Answers!C21": "strong"}, "Answers!C21", "Correlation holds the text 'strong'", "Type a number"),
]


@pytest.mark.parametrize(("changes", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, changes, where, message, hint):
    only_problem(where, message, hint, changes)


@pytest.mark.parametrize("pair", [["Weight", "Friction"], ["FRICTION", " weight "]])
def test_a_pair_may_stand_once_in_either_order(only_problem, blocks, pair):
    only_problem(
        "Answers!A22",
        "this one and Answers!A21",
        "Keep one of them",
        blocks("Answers!A22", [[*pair, 0.2]]),
        tables={"xlmc_correlations": "Answers!A20:C22"},
    )


@pytest.mark.parametrize("value", [-1, 0, 0.5, 1])
def test_names_are_given_as_defined(read, value):
    (result,) = read({"Answers!A21": " weight", "Answers!B21": "ANGLE", "Answers!C21": value}).correlations
    assert (result.first, result.second, result.value) == ("Weight", "Angle", value)


def test_a_frozen_assumption_does_not_correlate(read):
    result = read({"Answers!B21": "Gravity"})
    assert result.problems == ()
    assert [str(notice) for notice in result.notices] == [
        "Answers!A21: 'Gravity' is frozen, so this correlation has no effect"
    ]
    assert result.correlations == ()


def test_an_assumption_with_a_mistake_is_known_all_the_same(read):
    result = read({"Inputs!D2": 7000})
    assert [problem.where for problem in result.problems] == ["Inputs!D2"]
    assert isinstance(result.correlations[0], Correlation)


def test_without_assumptions(read):
    result = read(tables={"xlmc_assumptions": None})
    assert "Define the assumption" in result.problems[0].hint
