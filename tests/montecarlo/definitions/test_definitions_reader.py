from __future__ import annotations

from types import MappingProxyType

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from xlmc.engine.engines import ENGINES
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Filter, Forecast, Settings
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

NONE = MappingProxyType(
    dict.fromkeys(["xlmc_assumptions", "xlmc_forecasts", "xlmc_filters", "xlmc_correlations", "xlmc_settings"])
)


def test_a_workbook_without_mistakes(read):
    result = read()
    assert [str(problem) for problem in result.problems] == []
    assert [str(notice) for notice in result.notices] == []
    assert result.assumptions[0] == Assumption(
        name="Weight",
        cell=Cell("Inputs", 2, 2),
        distribution="Uniform",
        given={"low": 6661.0, "high": 6861.0},
        row=Cell("Inputs", 2, 1),
        base=6761.0,
        units="lb",
        source="scale ticket",
    )
    assert result.assumptions[1].notes == {"Witness": "Officer Lee"}
    reaction, friction, gravity = result.assumptions[2:]
    assert (reaction.distribution, reaction.parameters) == ("Normal", {"mean": 1.25, "std_dev": 0.46})
    assert reaction.cutoffs == {"lower_cutoff": 0.5, "upper_cutoff": 2.5}
    assert friction.parameters == {"low": 0.6, "low_likeliest": 0.7, "high_likeliest": 0.85, "high": 0.95}
    assert (gravity.distribution, gravity.frozen, gravity.base) == ("Triangular", True, 32.174)
    assert result.forecasts == (Forecast("Speed", Cell("Model", 1, 2), Cell("Answers", 2, 1), units="mph"),)
    assert result.filters == (
        Filter("e", Cell("Model", 2, 2), Cell("Answers", 11, 1), at_least=0.0, below=1.0, because="engagement"),
        Filter("Positive", Cell("Model", 3, 2), Cell("Answers", 12, 1), because="rest positions"),
    )
    assert result.correlations == (Correlation("Weight", "Friction", 0.5, Cell("Answers", 21, 1)),)
    assert result.settings == Settings(trials=5000, seed=7)


def test_no_table_at_all(only_problem):
    only_problem("case.xlsx", "no xlmc tables", "xlmc prepare case.xlsx", tables=dict(NONE))
    only_problem("case.xlsx", "no xlmc tables", "xlmc new", tables=dict(NONE))


@pytest.mark.parametrize("kind", ["assumption", "forecast"])
def test_a_kind_that_is_missing(read, kind):
    result = read(tables={f"xlmc_{kind}s": None, "xlmc_correlations": None})
    assert [(problem.where, problem.message, problem.hint) for problem in result.problems] == [
        (
            "case.xlsx",
            f"The workbook defines no {kind}",
            f"xlmc prepare case.xlsx adds a table xlmc_{kind}s with rows to choose from",
        )
    ]


def test_a_table_without_rows(only_problem):
    blank = dict.fromkeys(["Answers!A2", "Answers!B2", "Answers!C2"])
    only_problem("Answers!A1", "The table xlmc_forecasts holds no forecast", "Fill in a row", blank)


def test_filters_correlations_and_settings_are_optional(read):
    result = read(tables=dict.fromkeys(["xlmc_filters", "xlmc_correlations", "xlmc_settings"]))
    assert result.problems == ()
    assert (result.filters, result.correlations, result.settings) == ((), (), Settings())
    assert Settings() == Settings(trials=200_000, seed=999, sampling="mc", engine="numpy")


def test_all_mistakes_are_collected(read):
    result = read({"Inputs!D2": 7000, "Inputs!C3": "Unifrom", "Answers!B2": None, "Answers!C21": 2, "Answers!B31": 0})
    assert [problem.where for problem in result.problems] == [
        "Answers!B31",
        "Inputs!D2",
        "Inputs!C3",
        "Answers!A2",
        "Answers!C21",
    ]
    assert [each.name for each in result.assumptions] == ["Reaction", "Friction", "Gravity"]


def test_definitions_are_read_from_any_sheet_and_from_copies(read, blocks):
    copy = blocks("Copy!C5", [["Name", "Value", "Low", "High"], ["Second weight", 3460, 3410, 3510]])
    result = read(copy, tables={"xlmc_assumptions3": "Copy!C5:F6"})
    assert result.problems == ()
    assert result.assumptions[-1].cell == Cell("Copy", 6, 4)


def test_an_empty_workbook(make_book):
    result = read_definitions(make_book({}), ENGINES)
    assert len(result.problems) == 1
    assert "nothing to run" in str(result.problems[0])


ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.floats(-1e300, 1e300),
    st.sampled_from(list(ErrorCode)),
    st.text("ABby17!$:='[]() .,#\\", max_size=8),
    st.sampled_from(["Weight", "Normal", "=Model!B1", "=Inputs!B2", "Model!B1", "=Low", "yes", "Low", "Seed", "mc"]),
)
PLACES = [f"Inputs!{column}{row}" for column in "ABCDEFGHIJKLMNOP" for row in range(1, 7)] + [
    f"Answers!{column}{row}" for column in "ABCDEFG" for row in (1, 2, 10, 11, 12, 20, 21, 30, 31, 32)
]


@given(changes=st.dictionaries(st.sampled_from(PLACES), ANYTHING, max_size=6))
@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_whatever_the_cells_hold_it_ends_in_definitions_or_in_words(read, changes):
    result = read(changes)
    for problem in result.problems:
        assert problem.where
        assert problem.hint
        assert "None" not in problem.message
    assert result.problems or (result.assumptions and result.forecasts)
    for kind in (result.assumptions, result.forecasts, result.filters):
        assert len({each.cell for each in kind}) == len({each.name.casefold() for each in kind}) == len(kind)
