"""Books of XLRisk, as its sheet says: outputs, seed, iterations, Latin hypercube, and its functions."""

from __future__ import annotations

import math

import openpyxl
import pytest
from openpyxl.workbook.defined_name import DefinedName
from simulated import simulated

from xlmc.errors import XlmcError
from xlmc.montecarlo.model.loading import load

MODEL = {
    "B1": "=[1]!RiskLogNorm(2,0.5)",
    "B2": "=RiskTriang(80,100,130)",
    "B3": "=B1*B2",
    "B4": "=B3-RiskBeta(2,6,10,50)",
    "B5": 7,
}
SHEET = {
    "A1": "Simulation Settings",
    "A2": "Seed",
    "B2": 42,
    "A3": "Update Screen",
    "B3": False,
    "A4": "Iterations",
    "B4": 2000,
    "A5": "Latin Hypercube",
    "B5": True,
    "A6": "Calculate data dables during simulation",
    "B6": True,
    "A10": "Macro to run before each iteration",
    "A11": "Macro to run after each iteration",
    "B11": None,
    "D1": "Simulation Inputs",
    "D3": "Range",
    "E3": "Formula",
    "D4": "Model!$B$1",
    "E4": "RiskLogNorm(2,0.5)",
    "G1": "Simulation Outputs",
    "G3": "Range",
    "H3": "Name",
    "G4": "=[1]!AddressWithSheet(Model!$B$3)",
    "H4": "Revenue",
    "G5": "'Model'!$B$4",
    "H5": "Profit",
}
NAMES = {"Seed": "$B$2", "Iterations": "$B$4", "LatinHypercube": "$B$5", "RiskOutputs": "$G$3"}


@pytest.fixture
def book(tmp_path):
    """Writes a book of XLRisk's layout, with other contents in some cells: `S!A1` of a sheet, `A1` of its own."""

    def made(changes=None, *, model="Model", names=True):
        result = openpyxl.Workbook()
        result.active.title = model
        sheet = result.create_sheet("XLRisk")
        for address, content in {**SHEET, **{f"{model}!{at}": v for at, v in MODEL.items()}, **(changes or {})}.items():
            where, _, at = address.rpartition("!")
            (result[where] if where else sheet)[at] = content
        for name, at in NAMES.items() if names else ():
            sheet.defined_names[name] = DefinedName(name, attr_text=f"XLRisk!{at}")
        result.save(tmp_path / "book.xlsx")
        return tmp_path / "book.xlsx"

    return made


@pytest.mark.parametrize("names", [True, False], ids=["with its names", "by its labels"])
def test_a_book_runs_as_it_is(book, names):
    """The mean of a product of independent draws, by the logarithm's mean 2 and standard deviation 0.5."""
    model = load(book(names=names))
    settings = model.definitions.settings
    assert (settings.trials, settings.seed, settings.sampling, settings.lognorm) == (2000, 42, "lhs", "XLRisk")
    assert {each.name: str(each.cell) for each in model.forecasts} == {"Revenue": "Model!B3", "Profit": "Model!B4"}
    assert not any("set Lognorm to XLRisk" in notice.message for notice in model.notices)
    run = simulated(model)
    assert 2000 <= run.trials < 2100
    revenue = math.exp(2 + 0.125) * 310 / 3
    for name, mean in (("Revenue", revenue), ("Profit", revenue - 20)):
        assert abs(run[name].mean.value - mean) < 5 * run[name].mean.error
    assert run.warnings == []


def test_a_table_of_settings_and_the_command_win(book, tmp_path):
    from openpyxl.worksheet.table import Table

    path = book({"Model!D1": "Setting", "Model!E1": "Value", "Model!D2": "Seed", "Model!E2": 5})
    result = openpyxl.load_workbook(path)
    result["Model"].add_table(Table(displayName="xlmc_settings", ref="D1:E2"))
    result.save(path)
    model = load(path)
    assert (model.definitions.settings.seed, model.definitions.settings.trials) == (5, 2000)
    assert simulated(model, trials=100, seed=9, sampling="mc").trials == 100


@pytest.mark.parametrize(
    ("changes", "cells", "expected"),
    [
        ({"G4": "Model!$B$3:$B$5"}, {"Revenue (Model!B3)", "Revenue (Model!B4)"}, "Model!B5"),
        ({"G4": "Model!$B$3,$B$4", "G5": None}, {"Revenue (Model!B3)", "Revenue (Model!B4)"}, ""),
        ({"G4": "=AddressWithSheet(Model!B3:B4)", "G5": None}, {"Revenue (Model!B3)", "Revenue (Model!B4)"}, ""),
        ({"H4": None, "H5": "Profit"}, {"Model!B3", "Profit"}, ""),
        ({"H5": "revenue"}, {"Revenue", "revenue (Model!B4)"}, ""),
        ({"G3": "Model!$B$3", "H3": "Revenue", "G2": "Cells", "H2": "Name", "G4": None, "H4": None}, {"Revenue"}, ""),
        ({"G5": None, "G6": "Model!$B$4", "H6": "Late"}, {"Revenue", "Late"}, ""),
        ({"B2": 0}, {"Revenue", "Profit"}, "XLRisk's seed 0 is another one in each run"),
        ({"B2": -3.5}, {"Revenue", "Profit"}, "-3.5 is no seed of xlmc"),
        ({"Model!B3": '=RiskOutput("R")+B1*B2'}, {"R", "Profit"}, ""),
    ],
)
def test_what_the_list_of_outputs_may_hold(book, changes, cells, expected):
    if "Model!B3" in changes:  # marked in the cell, too
        changes = {**changes, "G4": "Model!$B$3", "H4": "R"}
    model = load(book(changes))
    assert {each.name for each in model.forecasts} == cells
    assert any(expected in str(notice) for notice in model.notices)


def test_a_sheet_with_an_apostrophe_is_found_whatever_its_address_quotes(book):
    changes = {"G4": "My model's!$B$3", "G5": "'My model''s'!$B$4"}
    assert len(load(book(changes, model="My model's")).forecasts) == 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"B4": 0}, "XLRisk!B4: Iterations must be a whole number from 1 up, not 0"),
        ({"B4": "many"}, "XLRisk!B4"),
        ({"B5": "maybe"}, "XLRisk!B5: Latin Hypercube is 'maybe'"),
        ({"B10": "Solve"}, "XLRisk!B10: XLRisk runs the macro 'Solve' in each iteration"),
        ({"G4": "Elsewhere!$B$3"}, "XLRisk!G4: The output lies on a sheet 'Elsewhere' that is not there"),
        ({"G5": "somewhere"}, "XLRisk!G5: 'somewhere' is no address of an output"),
        ({"G4": None, "G5": None}, "marks no cell as an answer"),
        ({"Model!B4": "=B3-RiskBeta(2,6,10,50,4)"}, "RiskBeta has 5 arguments"),
    ],
)
def test_what_is_refused_names_its_cell(book, changes, message):
    with pytest.raises(XlmcError) as refused:
        load(book(changes))
    assert message in str(refused.value)
    assert refused.value.hint


@pytest.mark.parametrize(
    ("call", "mean"),
    [("2,6,10,50", 20.0), ("2,6,,4", 1.0), ("2,6", 0.25), ("2,6,0.2", 0.4)],
)
def test_risk_beta_takes_limits(book, call, mean):
    model = load(book({"Model!B4": f"=RiskBeta({call})"}))
    assert model.bases["Model!B4#1"] == pytest.approx(mean)


def test_a_corrected_matrix_is_read_as_excel_saved_it(book):
    """Cells that correct or judge a matrix are none of the run; the numbers of the matrix hold."""
    matrix = {"Model!B1": "=RiskLogNorm(2,0.5,RiskCorrmat(F1:G2,1))"}
    matrix |= {"Model!B2": "=RiskTriang(80,100,130,RiskCorrmat(F1:G2,2))"}
    matrix |= {"Model!F1": 1, "Model!F2": 0.8, "Model!G2": 1, "Model!I1": "=RiskIsValidCorrmat(F1:G2)"}
    run = simulated(load(book(matrix)))
    assert run.warnings == []
    assert run.model.definitions.correlations[0].value == 0.8


def test_a_sheet_of_that_name_without_its_labels_is_a_sheet_like_others(book):
    blank = dict.fromkeys(SHEET) | {"A1": "Notes", "Model!B3": "=B1*B2+RiskOutput()"}
    model = load(book(blank, names=False))
    assert model.definitions.settings.trials == 200_000
    assert any("set Lognorm to XLRisk" in notice.message for notice in model.notices)
