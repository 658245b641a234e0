"""Draws in cells are called by the labels beside them, and drawn by the names of their calls: both are understood."""

from __future__ import annotations

import csv
import io

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from workbook_files import add_tables

from xlmc.analysis.studies.screening import screen
from xlmc.api import load
from xlmc.cli import xlmc
from xlmc.montecarlo.definitions.scenarios import Frozen
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load as load_model

CELLS = {
    "A1": "Price (€)",
    "B1": "=RiskNormal(50,5)",
    "A2": "Units sold",
    "B2": "=1000+RiskUniform(0,100)*RiskTriang(1,2,3)",
    "A3": "Price",
    "B3": "=RiskNormal(40,5)",
    "B4": "=RAND()",
    "A5": "Share",
    "B5": '=RiskUniform(0.1,0.2,RiskName("margin"))',
    "A6": "Profit",
    "B6": "=RiskOutput()+(B1+B3)*B2*B5*(B4>0.1)",
}
NAMES = {
    "Price": "Inputs!B1#1",
    "Units sold #1": "Inputs!B2#1",
    "Units sold #2": "Inputs!B2#2",
    "Price (Inputs!B3)": "Inputs!B3#1",
    "Inputs!B4#1": "Inputs!B4#1",
    "margin": "margin",
}
"""What the draws are called -> by what they are drawn."""


def write(path, *, labels=True, tables=None):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Inputs"
    for place, value in CELLS.items():
        if labels or not place.startswith("A"):
            sheet[place] = value
    add_tables(book.create_sheet("Tables"), tables or {"xlmc_settings": [["Setting", "Value"], ["Trials", 500]]})
    book.save(path)
    return path


@pytest.fixture
def path(tmp_path):
    return write(tmp_path / "book.xlsx")


def test_draws_have_the_labels_beside_them_and_their_units(path):
    result = {a.name: a for a in load_model(path).assumptions}
    assert {name: a.names[-1] for name, a in result.items()} == NAMES
    assert result["Price"].units == "€"
    assert str(result["Price"].cell) == "Inputs!B1#1"
    assert [f.name for f in load_model(path).forecasts] == ["Profit"]


@pytest.mark.parametrize("sampling", ["mc", "lhs", "sobol"])
def test_a_label_moves_no_random_number(path, tmp_path, sampling):
    run = load(path).simulate(500, sampling=sampling)
    bare = load(write(tmp_path / "bare.xlsx", labels=False)).simulate(500, sampling=sampling)
    assert [*bare.inputs] == [*NAMES.values()]
    for name, stream in NAMES.items():
        assert run.inputs[name].tobytes() == bare.inputs[stream].tobytes()


def test_rows_and_options_understand_both_names(tmp_path):
    tables = {
        "xlmc_correlations": [["First", "Second", "Correlation"], ["Inputs!B1#1", "price (inputs!b3)", 0.5]],
        "xlmc_scenarios": [["Name", "Inputs!B1#1", "Units sold #2"], ["held", 50, 2]],
    }
    path = write(tmp_path / "book.xlsx", tables=tables)
    model = load_model(path)
    (row,) = model.definitions.correlations
    assert (row.first, row.second) == ("Price", "Price (Inputs!B3)")
    (scenario,) = model.definitions.scenarios
    assert [each.assumption for each in scenario.changes] == ["Price", "Units sold #2"]
    for name in ("Price", "Inputs!B1#1", "inputs!b1#1"):
        held = applied(load_model(write(tmp_path / "plain.xlsx")), [Frozen(name, 50.0)])
        assert [a.name for a in held.assumptions if a.frozen] == ["Price"]
    result = screen(load_model(write(tmp_path / "plain.xlsx")), sets=["Inputs!B1#1,Units sold #2"], trials=200)
    assert [each.names for each in result.sets] == [("Price", "Units sold #2")]
    point = dict.fromkeys(NAMES.values(), 0.5)
    assert load(path).function(point)["Profit"] == pytest.approx((0.5 + 0.5) * (1000 + 0.25) * 0.5)


def test_a_converted_book_draws_the_same_under_the_labels(path, tmp_path):
    result = CliRunner().invoke(xlmc, ["convert", str(path), "-o", str(tmp_path / "c.xlsx")])
    assert result.exit_code == 0, result.output
    before, after = load(path).simulate(500), load(tmp_path / "c.xlsx").simulate(500)
    assert {*after.inputs} == {*NAMES}
    for name in NAMES:
        assert after.inputs[name].tobytes() == before.inputs[name].tobytes()


def test_two_rows_may_not_share_a_stream(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "M"
    rows = [["Name", "Value", "Low", "High", "Random stream"], ["a", 1, 0, 2, "x"], ["b", 1, 0, 2, "X"]]
    tables = {"xlmc_assumptions": rows, "xlmc_forecasts": [["Name", "Value"], ["y", "=B2+B3"]]}
    add_tables(sheet, tables)
    book.save(tmp_path / "book.xlsx")
    result = CliRunner().invoke(xlmc, ["check", str(tmp_path / "book.xlsx")])
    assert result.exit_code == 2
    assert "is drawn by the stream 'X', too" in " ".join(result.output.split())


def test_a_row_may_keep_its_stream_under_another_name(tmp_path):
    columns = []
    for name, stream in (("a", None), ("renamed", "a"), ("renamed", None)):
        book = openpyxl.Workbook()
        sheet = book.active
        rows = [["Name", "Value", "Low", "High", "Random stream"], [name, 1, 0, 2, stream]]
        add_tables(sheet, {"xlmc_assumptions": rows, "xlmc_forecasts": [["Name", "Value"], ["y", "=B2*2"]]})
        book.save(tmp_path / "book.xlsx")
        columns.append(load(tmp_path / "book.xlsx").simulate(100).inputs[name])
    assert np.array_equal(columns[0], columns[1])
    assert not np.array_equal(columns[0], columns[2])


def test_outputs_have_the_labels(path, tmp_path):
    run = load(path).simulate(500)
    run.extract(tmp_path / "trials.csv")
    heads = next(csv.reader(io.StringIO((tmp_path / "trials.csv").read_text(encoding="utf-8"))))
    assert {*NAMES, "Profit"} < {*heads}
    run.save(tmp_path / "out.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "out.xlsx")["Assumptions"]
    message = {cell.value for row in sheet.iter_rows() for cell in row}
    assert {"Price (€)", "Inputs!B1#1", "Units sold #2", "Inputs!B2#2"} <= message
