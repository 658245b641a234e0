"""What a workbook defines elsewhere, as rows of tables: here by reading tables, and taking them away."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.definitions import DIALOG, Decision, Filter
from xlmc.montecarlo.definitions.new_tables import Formula, new_tables, text_of
from xlmc.montecarlo.definitions.stopping import Precision


@pytest.fixture
def defined(read):
    return read()


@pytest.fixture
def bare(make_book, changed_book):
    """The same workbook without any table, so that every row is new."""
    return replace(changed_book(), tables=())


def rows(tables, kind):
    return [
        {heading: text_of(entry, {}) if isinstance(entry, Formula) else entry for heading, entry in row.cells.items()}
        for table in tables
        if table.kind == kind
        for row in table.rows
    ]


def test_what_stands_in_tables_is_not_new(changed_book, defined):
    assert new_tables(changed_book(), defined) == []


def test_every_row_is_written_out(bare, defined):
    result = new_tables(bare, defined)
    assert [table.kind for table in result] == [
        "xlmc_assumptions",
        "xlmc_forecasts",
        "xlmc_filters",
        "xlmc_correlations",
    ]
    assert [table.headings for table in result] == [
        (
            *("Name", "Cell", "Distribution", "Low", "High", "Mean", "Std dev", "Low likeliest", "High likeliest"),
            *("Likeliest", "Lower cutoff", "Upper cutoff", "Units", "Frozen", "Source"),
        ),
        ("Name", "Cell", "Units"),
        ("Name", "Cell", "At least", "Below", "Because"),
        ("First", "Second", "Correlation"),
    ]
    assumptions = rows(result, "xlmc_assumptions")
    assert [row["Cell"] for row in assumptions] == [f"=Inputs!B{row}" for row in range(2, 7)]
    weight, _, reaction, friction, gravity = assumptions
    assert (weight["Distribution"], weight["Low"], weight["High"]) == ("Uniform", 6661.0, 6861.0)
    assert (weight["Units"], weight["Source"]) == ("lb", "scale ticket")
    assert (reaction["Lower cutoff"], reaction["Upper cutoff"]) == (0.5, 2.5)
    assert (friction["Distribution"], friction["High likeliest"]) == ("Trapezoid", 0.85)
    assert gravity["Frozen"] is True
    assert "Frozen" not in weight
    assert rows(result, "xlmc_forecasts") == [{"Name": "Speed", "Cell": "=Model!B1", "Units": "mph"}]
    assert rows(result, "xlmc_filters") == [
        {"Name": "e", "Cell": "=Model!B2", "At least": 0.0, "Below": 1.0, "Only for": "", "Because": "engagement"},
        {"Name": "Positive", "Cell": "=Model!B3", "Only for": "", "Because": "rest positions"},
    ]
    assert rows(result, "xlmc_correlations") == [{"First": "Weight", "Second": "Friction", "Correlation": 0.5}]
    saved = [row.cells["Cell"].value for row in result[0].rows]
    assert saved == [6761.0, 186.0, 1.25, 0.78, 32.174]


def test_rows_of_one_table_that_is_there_are_left_out(changed_book, defined):
    book = changed_book()
    kept = replace(book, tables=tuple(each for each in book.tables if each.name == "xlmc_assumptions"))
    assert [table.kind for table in new_tables(kept, defined)] == [
        "xlmc_forecasts",
        "xlmc_filters",
        "xlmc_correlations",
    ]
    renamed = replace(book, tables=tuple(replace(each, name=f"my_{each.name}") for each in book.tables))
    assert len(new_tables(renamed, defined)) == 4


@pytest.mark.parametrize(
    ("changed", "written"),
    [
        ({"threshold": 0.0}, {"Threshold": 0.0}),
        ({"asked": (1.0, float("inf"))}, {"Certainty from": 1.0}),
        ({"asked": (1.0, 2.0)}, {"Certainty from": 1.0, "Certainty to": 2.0}),
        ({"report_to": 0.5}, {"Report to": 0.5}),
    ],
)
def test_what_is_asked_of_a_forecast(bare, defined, changed, written):
    forecast = replace(defined.forecasts[0], **changed)
    result = new_tables(bare, replace(defined, forecasts=(forecast,)))
    assert rows(result, "xlmc_forecasts") == [{"Name": "Speed", "Cell": "=Model!B1", "Units": "mph", **written}]


def test_a_filter_of_some_forecasts(bare, defined):
    own = Filter("own", Cell("Model", 1, 2), Cell("Model", 1, 2), at_most=0.0, only_for=("Speed", "x"))
    result = rows(new_tables(bare, replace(defined, forecast_filters=(own,))), "xlmc_filters")
    assert result[-1] == {"Name": "own", "Cell": "=Model!B1", "At most": 0.0, "Only for": "Speed; x", "Because": ""}
    twice = replace(defined, forecast_filters=(own,), left_out=(replace(own, only_for=("gone",)),))
    assert rows(new_tables(bare, twice), "xlmc_filters")[-1]["Only for"] == "Speed; x; gone"
    alone = replace(defined, left_out=(own,))
    assert len(rows(new_tables(bare, alone), "xlmc_filters")) == 3


def test_a_test_of_its_own_stands_under_value(bare, defined):
    site = InFormula.of(Cell("Model", 1, 2), "filter")
    test = ir.Call("OR", (ir.Binary("<", Cell("Model", 1, 2), ir.Number(3.0)),))
    given = replace(defined, filters=(Filter("f", site, Cell("Model", 1, 2)),), rewritten={site: test})
    assert rows(new_tables(bare, given), "xlmc_filters")[0]["Value"] == "=OR((Model!B1<3.0))"


def test_decisions_a_step_apart(bare, defined):
    decision = Decision("Size", Cell("Model", 9, 4), (0.1, 0.4, 0.7), Cell("Model", 9, 4))
    (row,) = rows(new_tables(bare, replace(defined, decisions=(decision,))), "xlmc_decisions")
    assert row == {"Name": "Size", "Cell": "=Model!D9", "Low": 0.1, "High": 0.7, "Step": 0.3}


def test_a_run_of_dialogs_has_its_settings(bare, changed_book, defined):
    drawn = replace(defined, assumptions=tuple(replace(each, source=DIALOG) for each in defined.assumptions))
    result = rows(new_tables(bare, drawn), "xlmc_settings")
    assert result == [
        {"Setting": "Trials", "Value": 5000.0},
        {"Setting": "Seed", "Value": 7.0},
        {"Setting": "Sampling", "Value": "mc"},
    ]
    assert rows(new_tables(bare, defined), "xlmc_settings") == []  # nothing comes from a dialog
    assert rows(new_tables(changed_book(), drawn), "xlmc_settings") == []  # it has such a table


@pytest.mark.parametrize(
    ("tolerance", "relative", "names", "written"),
    [
        (0.01, True, ("Speed", "x"), {"Precision %": 1.0, "Look at": "Speed; x"}),
        (0.5, False, (), {"Precision": 0.5}),
        (1e-6, True, (), {}),  # so small a share looks like a mistake
        (0.5, False, ("a;b",), {}),
    ],
)
def test_the_precision_that_dialogs_ask_for(bare, defined, tolerance, relative, names, written):
    goal = Precision(tolerance, relative=relative, numbers=("mean", "sd"), confidence=0.9)
    stopping = replace(defined.settings.stopping, goal=goal, forecasts=names)
    drawn = tuple(replace(each, source=DIALOG) for each in defined.assumptions)
    given = replace(defined, assumptions=drawn, settings=replace(defined.settings, stopping=stopping))
    result = {row["Setting"]: row["Value"] for row in rows(new_tables(bare, given), "xlmc_settings")}
    more = {"Precision of": "mean, sd", "Confidence %": 90.0} if written else {}
    assert result == {"Seed": 7.0, "Sampling": "mc", **written, **more}
