"""What-if data tables in every trial, against books in which they are written out as formulas."""

from __future__ import annotations

import numpy as np
import openpyxl
import pytest
from openpyxl.worksheet.formula import DataTableFormula
from openpyxl.worksheet.table import Table

import xlmc
from xlmc.analysis.results.record.errors_met import lost_sentences
from xlmc.analysis.results.record.needed_cells import needed_contents
from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.montecarlo.model.loading import load, model_with_values
from xlmc.montecarlo.simulation.simulate import simulate

INPUTS = [
    ["Name", "Value", "Distribution", "Low", "High"],
    ["x", 0.5, "Uniform", 0, 1],
    ["z", 2, "Uniform", 1, 3],
]
RANGE = "=SUM(B1:B3)*Table!J2"
"""The answer: of cells on the way, in a range with one that is not."""


def written(path, table, answers):
    """Write a book: on Model the way from k and c to B4, on Table these two and what is given, on Answers forecasts."""
    book = openpyxl.Workbook()
    inputs = book.active
    inputs.title = "Inputs"
    for row in INPUTS:
        inputs.append(row)
    inputs.add_table(Table(displayName="xlmc_assumptions", ref="A1:E3"))
    model = book.create_sheet("Model")
    for row in (["power", "=Inputs!B2^Table!J1"], ["z", "=Inputs!B3"], ["k", "=Table!J1*2"], ["answer", RANGE]):
        model.append(row)
    sheet = book.create_sheet("Table")
    filled = {f"{column}{row}": 0 for column in "BCDG" for row in (3, 4, 5)}  # as Excel saves what it calculated
    for address, content in {"J1": 2, "J2": 10, **filled, **table}.items():
        sheet[address] = content
    forecasts = book.create_sheet("Answers")
    forecasts.append(["Name", "Value"])
    for name, formula in answers.items():
        forecasts.append([name, formula])
    forecasts.add_table(Table(displayName="xlmc_forecasts", ref=f"A1:B{1 + len(answers)}"))
    book.save(path)
    return path


def by_formula(k, c, x="Inputs!B2"):
    return f"({x}^({k})+Inputs!B3+({k})*2)*({c})"


KS = (1, 2.5, 4)
COLUMN = {"A3": 1, "A4": 2.5, "A5": "=Inputs!B3+1", "B2": "=Model!B4", "C2": "=Model!B4+1"}
ROW = {"B2": 1, "C2": 2.5, "D2": "=Inputs!B3+1", "A3": "=Model!B4", "A4": "=Model!B4+1"}
TWO = {"A2": "=Model!B4", "B2": 1, "C2": "=Inputs!B3+1", "A3": 5, "A4": -7}

TABLES = {
    "one input, in a column": (
        {**COLUMN, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)},
        {"B3": ("Table!A3", 0), "B5": ("Table!A5", 0), "C4": ("Table!A4", 1), "C5": ("Table!A5", 1)},
    ),
    "one input, in a row": (
        {**ROW, "B3": DataTableFormula(ref="B3:D4", r1="J1", dt2D=False, dtr=True)},
        {"B3": ("Table!B2", 0), "D3": ("Table!D2", 0), "C4": ("Table!C2", 1), "D4": ("Table!D2", 1)},
    ),
}
"""Name -> the table, and what is expected of its cells: the value of k and what is added."""


@pytest.mark.parametrize("engine", ["numpy", "jit"])
@pytest.mark.parametrize(("table", "cells"), TABLES.values(), ids=TABLES)
def test_a_table_of_one_input_is_computed_in_every_trial(tmp_path, table, cells, engine):
    answers = {cell: f"=Table!{cell}" for cell in cells} | {"all": "=SUM(Table!B3:C4)"}
    out = {cell: f"={by_formula(k, 'Table!J2')}+{more}" for cell, (k, more) in cells.items()}
    margins = {cell: content for cell, content in table.items() if cell != "B3"}
    of_table = xlmc.load(written(tmp_path / "table.xlsx", table, answers)).simulate(3_000, engine=engine)
    formulas = xlmc.load(written(tmp_path / "formulas.xlsx", margins, out)).simulate(3_000, engine=engine)
    for cell in cells:
        assert np.allclose(of_table.forecasts[cell], formulas.forecasts[cell], rtol=1e-13), cell
        assert np.ptp(of_table.forecasts[cell]) > 1


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_a_table_of_two_inputs_is_computed_in_every_trial(tmp_path, engine):
    table = {**TWO, "B3": DataTableFormula(ref="B3:C4", r1="J1", r2="J2", dt2D=True, dtr=True)}
    cells = {"B3": ("Table!B2", "Table!A3"), "C3": ("Table!C2", "Table!A3"), "C4": ("Table!C2", "Table!A4")}
    answers = {cell: f"=Table!{cell}" for cell in cells}
    out = {cell: f"={by_formula(k, c)}" for cell, (k, c) in cells.items()}
    of_table = xlmc.load(written(tmp_path / "table.xlsx", table, answers)).simulate(3_000, engine=engine)
    formulas = xlmc.load(written(tmp_path / "formulas.xlsx", TWO, out)).simulate(3_000, engine=engine)
    for cell in cells:
        assert np.allclose(of_table.forecasts[cell], formulas.forecasts[cell], rtol=1e-13), cell


def test_an_assumption_may_be_the_input(tmp_path):
    """In the table it has the value of the margin, and everything else is drawn."""
    draw = {"J1": "=RiskUniform(1,3)"}
    table = {**COLUMN, **draw, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    out = {"held": f"={by_formula('Table!A4', 'Table!J2')}", "drawn": "=Model!B4"}
    first = xlmc.load(written(tmp_path / "a.xlsx", table, {"held": "=Table!B4", "drawn": "=Model!B4"})).simulate(2_000)
    second = xlmc.load(written(tmp_path / "b.xlsx", COLUMN | draw, out)).simulate(2_000)
    for name in out:
        assert np.allclose(first.forecasts[name], second.forecasts[name], rtol=1e-13)


def test_a_table_may_need_another_one(tmp_path):
    table = {**COLUMN, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    table |= {"F3": 5, "F4": -7, "G2": "=Table!B4*J5+1", "J5": 1}
    table |= {"G3": DataTableFormula(ref="G3:G4", r1="J5", dt2D=False, dtr=False)}
    result = xlmc.load(written(tmp_path / "a.xlsx", table, {"y": "=Table!G4"})).simulate(1_000, keep_inputs=None)
    x, z = result.inputs["x"], result.inputs["z"]
    assert np.allclose(result.forecasts["y"], (x**2.5 + z + 5) * 10 * -7 + 1, rtol=1e-13)


def test_an_error_in_the_table_loses_the_trial(tmp_path):
    table = {**COLUMN, "A3": -1, "B2": "=SQRT(Table!J1-Inputs!B2)"}
    table |= {"B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    run = xlmc.load(written(tmp_path / "a.xlsx", table, {"lost": "=Table!B3", "y": "=Table!B4"})).simulate(500)
    assert np.isnan(run.forecasts["lost"]).all()
    assert np.isfinite(run.forecasts["y"]).all()


@pytest.mark.parametrize(
    "more",
    [
        {"A4": "text"},
        {"B2": '=INDIRECT("Model!B"&ROUND(Table!J1,0))'},
        {"B2": "=Table!G4*J1", "F4": 3, "G2": "=Model!B4", "G3": DataTableFormula(ref="G3:G4", r1="J2")},
        {"B3": DataTableFormula(ref="B3:C5", r1="J1", del1=True, dt2D=False, dtr=False)},
    ],
    ids=[
        "a text on its left",
        "a formula that cannot be computed",
        "another table that needs its input",
        "an input that was deleted",
    ],
)
def test_a_table_that_cannot_be_computed_is_refused(tmp_path, more):
    table = {**COLUMN, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False), **more}
    with pytest.raises(FormulaError, match="What-if data tables that depend on the run are not computed"):
        xlmc.load(written(tmp_path / "a.xlsx", table, {"y": "=Table!B4"}))


CONSTANT = {
    "A3": 1,
    "A4": 2.5,
    "B2": "=Table!J1*Table!J3",
    "J1": 3,
    "J3": 2,
    "B3": DataTableFormula(ref="B3:B4", r1="J1", dt2D=False, dtr=False),
    "B4": 5,  # 2.5 * 2, as Excel saves it
    "C3": None,
    "D3": "=Table!B4+Inputs!B2",
}
"""A table that no assumption reaches, and an answer beside it."""


@pytest.fixture
def constant(tmp_path):
    """A book whose answer is x plus 2.5 times J3, by a table that holds what J3 = 2 gives."""
    return written(tmp_path / "constant.xlsx", CONSTANT, {"y": "=Table!D3"})


def test_a_table_follows_a_decision_that_no_assumption_reaches(constant):
    """A run with another J3 used what Excel had saved for the old one."""
    model = load(constant)
    for value in (2.0, 4.0):
        result = model_with_values(model, {Cell("Table", 3, 10): value})
        run = simulate(result, trials=200, seed=1)
        assert np.allclose(run.forecasts["y"], run.inputs["x"] + 2.5 * value, rtol=1e-14), value


def test_what_another_program_left_in_a_table_is_not_used(constant, tmp_path):
    """openpyxl writes another input, and keeps what Excel had calculated from the one before."""
    book = openpyxl.load_workbook(constant)
    book["Table"]["J3"] = 4
    book["Table"]["B3"].value.ref = "B3:B4"
    book.save(tmp_path / "edited.xlsx")
    model = xlmc.load(tmp_path / "edited.xlsx")
    run = model.simulate(200, keep_inputs=None)
    assert np.allclose(run.forecasts["y"], run.inputs["x"] + 10.0, rtol=1e-14)
    assert any("not those that its formulas give" in str(notice) for notice in model.notices)


def test_goal_seek_goes_through_a_table(constant):
    result = xlmc.seek(constant, "Table!D3", 20.5, "Table!J3")
    assert result.values == pytest.approx([8.0], rel=1e-12)


def test_a_cell_of_a_table_is_no_constant(tmp_path):
    table = {**COLUMN, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    model = xlmc.load(written(tmp_path / "a.xlsx", table, {"y": "=0"}))
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    book["Answers"]["A1"], book["Answers"]["B1"] = "Name", "Cell"
    book["Answers"]["B2"] = "=Table!C4"
    book["Answers"].tables["xlmc_forecasts"].tableColumns[1].name = "Cell"
    book.save(tmp_path / "b.xlsx")
    model = xlmc.load(tmp_path / "b.xlsx")
    assert not any("is a constant" in str(notice) for notice in model.notices)
    assert np.ptp(model.simulate(100).forecasts["y"]) > 0


def test_the_record_holds_the_table_and_what_its_formulas_read(tmp_path):
    table = {**COLUMN, "B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    model = xlmc.load(written(tmp_path / "a.xlsx", table, {"y": "=Table!C5"}))
    cells = {str(cell): text for cell, text in needed_contents(load(tmp_path / "a.xlsx")).items()}
    assert cells["Table!C5"] == "{=TABLE(,J1)} in B3:C5"
    assert cells["Table!C2"] == "=Model!B4+1"  # the formula that it computes, and what that is computed from
    assert cells["Model!B1"] == "=Inputs!B2^Table!J1"
    assert "Table!J1" not in cells  # whose value is put in

    run = model.simulate(300, seed=1)
    run.save(tmp_path / "a-results.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a-results.xlsx")
    book["Table"]["C5"] = 77  # what Excel calculates there is not used
    book.save(tmp_path / "same.xlsx")
    assert xlmc.replay(tmp_path / "same.xlsx").identical
    book["Model"]["B3"] = "=Table!J1*3"
    book.save(tmp_path / "other.xlsx")
    changes = xlmc.replay(tmp_path / "other.xlsx").changes
    assert [(each.where, each.old, each.new) for each in changes] == [("Model!B3", "=Table!J1*2", "=Table!J1*3")]


def test_an_error_comes_from_the_table(tmp_path):
    table = {**COLUMN, "B2": "=SQRT(0.5-Inputs!B2)"}
    table |= {"B3": DataTableFormula(ref="B3:C5", r1="J1", dt2D=False, dtr=False)}
    run = xlmc.load(written(tmp_path / "a.xlsx", table, {"y": "=Table!B3*2"})).simulate(500)
    assert any("from Table!B3 #NUM!: {=TABLE(,J1)} in B3:C5" in line for line in lost_sentences(run._run))
