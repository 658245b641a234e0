"""The sheet of fitted distributions: its tables, and that a workbook with it runs."""

from __future__ import annotations

import io

import numpy as np
import openpyxl
import pytest

import xlmc
from xlmc.analysis.studies.fitting.columns import fit_columns
from xlmc.excel.workbook.reader import read_workbook
from xlmc.outputs.prepared.fitted_sheet import with_fits


def measured(n=200, seed=3):
    rng = np.random.default_rng(seed)
    friction = rng.normal(0.7, 0.05, n)
    speed = 30 + 60 * (friction - 0.7) + rng.normal(0, 2, n)
    return {"Friction": friction.tolist(), "Speed": speed.tolist(), "Surface": rng.choice(["dry", "wet"], n).tolist()}


@pytest.fixture(scope="module")
def fits():
    return fit_columns(measured(60), bootstraps=100)


def rows_of(sheet, name):
    heads, *rows = [[cell.value for cell in row] for row in sheet[sheet.tables[name].ref]]
    return [dict(zip(heads, row, strict=True)) for row in rows]


def test_parameters_are_assumptions_and_rows_point_to_them(fits):
    book = openpyxl.load_workbook(io.BytesIO(with_fits(None, fits, "data.csv")))
    sheet = book["Fitted"]
    assert sheet["A1"].value == "Distributions fitted to measurements"
    assert sheet["A2"].value.startswith("From data.csv. ")
    assert [sheet["A4"].value, sheet["A5"].value] == ["Assumptions", "Name"]
    rows = rows_of(sheet, "xlmc_assumptions")
    best = {each.name: each.best for each in fits.columns if each.best is not None}
    repeated = {each.name: each.repeated for each in fits.columns}
    assert [each.name for each in best.values()] == ["Hyperbolic secant", "Normal"]
    assert [row["Name"] for row in rows] == [
        "Friction: Mean", "Friction: Std dev", "Speed: Mean", "Speed: Std dev", "Friction", "Speed"
    ]  # fmt: skip
    assert [row["Kind of uncertainty"] for row in rows] == [
        *["Uncertain"] * 4,
        *["Variable"] * 2,
    ]
    for row in rows[:4]:
        column, heading = row["Name"].split(": ")
        assert row["Value"] == row["Mean"] == float(f"{best[column].parameters[heading]:.8g}")
        assert row["Std dev"] == float(f"{repeated[column][heading].std(ddof=1):.4g}")
        assert row["Distribution"] == ("Lognormal" if heading == "Std dev" else "Normal")
        assert row["Source"] == f"bootstrap of {repeated[column][heading].size} samples of data.csv, {column}"
    assert [(row["Mean"], row["Std dev"]) for row in rows[4:]] == [("=B6", "=B7"), ("=B8", "=B9")]
    values = openpyxl.load_workbook(io.BytesIO(with_fits(None, fits, "data.csv")), data_only=True)["Fitted"]
    assert [row["Mean"] for row in rows_of(values, "xlmc_assumptions")[4:]] == [rows[0]["Value"], rows[2]["Value"]]
    assert rows[4]["Source"] == "fitted by maximum likelihood to data.csv, Friction, n = 60"
    assert rows[4]["Value"] == pytest.approx(np.median(measured(60)["Friction"]), abs=0.01)
    widths = [round(sheet.column_dimensions[column].width) for column in ("A", "B", "G")]
    assert widths == [35, 15, 61]
    green = [cell.coordinate for row in sheet["A6:G11"] for cell in row if cell.fill.fgColor.rgb == "FFE6F4E6"]
    assert green == [f"B{row}" for row in range(6, 12)]


def test_correlations_are_those_of_columns_and_clear_ones_of_their_parameters(fits):
    sheet = openpyxl.load_workbook(io.BytesIO(with_fits(None, fits, "data.csv")))["Fitted"]
    assert sheet["A13"].value == "Rank correlations"
    assert sheet.tables["xlmc_correlations"].ref.startswith("A14:C")
    first, *others = rows_of(sheet, "xlmc_correlations")
    (pair,) = fits.pairs
    assert first == {"First": "Friction", "Second": "Speed", "Correlation": round(pair.correlation.value, 4)}
    assert pair.correlation.value == pytest.approx(0.82, abs=0.1)  # of 60·SD 0.05 beside SD 2: r = 0.83
    named = {(row["First"], row["Second"]): row["Correlation"] for row in others}
    assert named["Friction: Mean", "Speed: Mean"] > 0.5  # means of columns that vary together do so, too
    assert all(abs(value) > 3 * (1 - value**2) / 10 - 0.02 for value in named.values())  # 3 errors of 100 samples


def test_without_a_bootstrap_parameters_are_numbers():
    result = fit_columns({"Friction": measured()["Friction"]})
    sheet = openpyxl.load_workbook(io.BytesIO(with_fits(None, result, "data.csv")))["Fitted"]
    (row,) = rows_of(sheet, "xlmc_assumptions")
    assert list(row) == ["Name", "Value", "Distribution", "Mean", "Std dev", "Source"]
    assert (row["Mean"], row["Std dev"]) == (pytest.approx(0.7, abs=0.02), pytest.approx(0.05, abs=0.01))
    assert list(sheet.tables) == ["xlmc_assumptions"]


def test_a_probability_stays_between_0_and_1():
    result = fit_columns({"hit": [1.0] * 12 + [0.0] * 48, "x": measured(60)["Speed"]}, bootstraps=60)
    sheet = openpyxl.load_workbook(io.BytesIO(with_fits(None, result, "data.csv")))["Fitted"]
    rows = {row["Name"]: row for row in rows_of(sheet, "xlmc_assumptions")}
    probability = next((row for name, row in rows.items() if name.startswith("hit: ")), None)
    assert probability is not None
    assert (probability["Lower cutoff"], probability["Upper cutoff"]) == (0, 1)
    assert probability["Value"] == pytest.approx(0.2)


def test_a_book_of_fits_runs_and_its_parameters_are_uncertain(tmp_path, fits):
    path = tmp_path / "fitted.xlsx"
    path.write_bytes(with_fits(None, fits, "data.csv"))
    book = openpyxl.load_workbook(path)
    sheet = book["Fitted"]
    cells = {row[0].value: row[1].coordinate for row in sheet.iter_rows(min_row=6, max_row=11)}
    answers = book.create_sheet("Answers")
    formula = f"=Fitted!{cells['Speed']}^2/Fitted!{cells['Friction']}"
    for row in (["Name", "Value"], ["Distance", formula]):
        answers.append(row)
    answers.add_table(openpyxl.worksheet.table.Table(displayName="xlmc_forecasts", ref="A1:B2"))
    book.save(path)
    model = xlmc.load(path)
    bands = xlmc.uncertainty(model, outer=60, inner=100, seed=5)
    assert set(bands.variable) == {"Friction", "Speed"}
    assert all(": " in name for name in bands.uncertain)
    assert len(bands.uncertain) == 4
    run = model.simulate(20_000, keep_inputs=None)
    friction = np.array(measured(60)["Friction"])
    assert run.inputs["Friction"].mean() == pytest.approx(friction.mean(), abs=0.01)
    assert np.corrcoef(run.inputs["Friction"], run.inputs["Speed"])[0, 1] > 0.6


def test_a_sheet_is_added_to_a_book_that_has_tables(tmp_path):
    path = tmp_path / "first.xlsx"
    path.write_bytes(with_fits(None, fit_columns({"a": measured()["Friction"]}), "one"))
    book = read_workbook(path)
    path.write_bytes(with_fits(book, fit_columns({"b": measured()["Speed"]}), "two"))
    tables = [table.name for table in read_workbook(path).tables]
    assert len(tables) == 2
    assert all(name.startswith("xlmc_assumptions") for name in tables)
