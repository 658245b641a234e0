"""Rows of counts, as people write them."""

from __future__ import annotations

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

HEADINGS = [
    "Name",
    "Value",
    "Distribution",
    "Probability",
    "Trials",
    "Success",
    "Population",
    "Shape",
    "Rate",
    "Min",
    "Max",
]
PLACES = dict(zip(HEADINGS, "ABCDEFGHIJK", strict=True))
ROWS = {
    "Binomial": {"Probability": 0.3, "Trials": 20},
    "Discrete Uniform": {"Min": 1, "Max": 6},
    "Geometric": {"Probability": 0.25},
    "Geomet": {"Probability": 0.25},
    "Hypergeometric": {"Success": 20, "Trials": 10, "Population": 50},
    "Negative Binomial": {"Probability": 0.25, "Shape": 3},
    "Negbin": {"Probability": 0.25, "Shape": 3},
    "Poisson": {"Rate": 4},
    "Yes-No": {"Probability": 0.25},
}


@pytest.fixture
def read(make_book, blocks):
    def definitions(distribution, given):
        filled = {**given, "Name": "Count", "Value": 5 if "Shape" in given else 1, "Distribution": distribution}
        cells = {
            **blocks("Inputs!A1", [HEADINGS, [filled.get(heading) for heading in HEADINGS]]),
            **blocks("Inputs!A9", [["Name", "Cell"], ["Twice", ("=Inputs!$B$2", 1.0)]]),
        }
        tables = [("xlmc_assumptions", "Inputs!A1:K2"), ("xlmc_forecasts", "Inputs!A9:B10")]
        return read_definitions(make_book(cells, tables), ENGINES)

    return definitions


@pytest.mark.parametrize("name", ROWS)
def test_a_row_of_each(read, name):
    result = read(name.casefold(), ROWS[name])
    assert result.problems == (), [str(problem) for problem in result.problems]
    assert result.notices == ()
    assert result.assumptions[0].distribution == name
    assert sorted(result.assumptions[0].parameters.values()) == sorted(ROWS[name].values())


@pytest.mark.parametrize(
    ("name", "changes", "heading", "message"),
    [
        ("Binomial", {"Trials": 2.5}, "Trials", "Trials (2.5) must be a whole number"),
        ("Binomial", {"Probability": 30}, "Probability", "Probability (30) must be from 0 to 1"),
        ("Geometric", {"Probability": 0}, "Probability", "Probability (0) must be above 0"),
        ("Hypergeometric", {"Success": 60}, "Success", "Success (60) is above Population (50)"),
        ("Negative Binomial", {"Shape": 0}, "Shape", "Shape (0) must be a whole number from 1"),
        ("Poisson", {"Rate": -1}, "Rate", "Rate (-1) must be from 0"),
        ("Poisson", {"Rate": None}, "Rate", "Poisson needs Rate, and this cell is blank"),
        ("Poisson", {"Trials": 5}, "Trials", "Poisson has no Trials"),
        ("Discrete Uniform", {"Min": 9}, "Min", "Low (9) is above High (6)"),
        ("Discrete Uniform", {"Max": 6.5}, "Max", "High (6.5) must be a whole number"),
    ],
)
def test_mistakes_are_told_with_their_cell(read, name, changes, heading, message):
    (problem,) = read(name, {**ROWS[name], **changes}).problems
    assert problem.where == f"Inputs!{PLACES[heading]}2"
    assert problem.message.startswith(message)


def test_a_count_that_does_not_vary_is_pointed_out(read):
    (notice,) = read("Yes-No", {"Probability": 1}).notices
    assert notice.message == "Every draw is 1: the assumption does not vary"
