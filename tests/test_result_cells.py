"""Cells that show results of a run, filled in on writing: their values, their dependants', and nothing else."""

from __future__ import annotations

import math
import re
import zipfile

import openpyxl
import pytest
import xlsxwriter

import xlmc
from xlmc.errors import ErrorCode
from xlmc.result_cells import result_values
from xlmc.workbook import read_workbook
from xlmc.workbook.inject import original_hash
from xlmc.workbook.package import read_parts

FORMULAS = {
    "A1": ("=_xll.RiskNormal(5,1)", 5.25),
    "A2": ('=RiskOutput("x")+A1*2', 10.5),
    "A3": ("=A1+1", 6.25),
    "B1": ("=_xll.RiskMean(A2)", 0),
    "B2": ("=B1*2+A1", 0),
    "B3": ('=IF(B1>5,"a<b","")', ""),
    "B4": ("=[1]!CB.GetForeStatFN(A2,5)", 0),
    "B5": ("=RiskPercentile(A2,$D$1)", 0),
    "B6": ("=RiskTarget(A2,10)", 0),
    "B7": ("=CB.GetForeStatFN(A2,14)", 0),
    "B8": ('=ROUND(RiskMax("X")-RiskMin("x")-RiskRange(A2),9)', 1),
    "B9": ("=CB.GetForePercentFN(A2,90)-B5", 1),
    "B10": ("=CB.GetCertaintyFN(A2,10)-100*B6", 1),
    "B11": ("=RiskData(A2,3)", 0),
    "B12": ('=RiskMean("no such")', 7),
    "B13": ("=ISERROR(B12)", False),
    "B14": ("=RiskStdDev(A2)^2-RiskVariance(A2)", 1),
    "B15": ("=RiskPercentileD(A2,1-$D$1)-B5", 1),
    "B16": ("=RiskTargetD(A2,10)+B6", 0),
    "B17": ("=Unknown(B1)", 3),
    "B18": ("=CB.GetForeStatFN(A2,1)", 0),
    "B19": ("=_xll.CB.GetCertaintyFN(A2,10)", 0),
}


def build(path, formulas, extra=()):
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        other = book.add_worksheet("Other")
        sheet.write("D1", 0.9)
        for address, (formula, value) in formulas.items():
            sheet.write_formula(address, formula, None, value)
        other.write_formula("A1", "=S!B1+1", None, 0)
        other.write_formula("A2", "=S!A1", None, 5.25)
        for row, (formula, value) in enumerate(extra, start=3):
            other.write_formula(row, 0, formula, None, value)
    return path


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    folder = tmp_path_factory.mktemp("books")
    source = build(folder / "book.xlsx", FORMULAS)
    run = xlmc.load(source).simulate(trials=20_000, seed=999)
    run.save(folder / "out.xlsx")
    return source, folder / "out.xlsx", run


def test_values(filled):
    _, target, run = filled
    x = run["x"]
    expected = {
        "B1": x.mean.value,
        "B2": 2 * x.mean.value + 5.25,
        "B3": "a<b",
        "B4": x.standard_deviation.value,
        "B5": x.percentile(90).value,
        "B6": 1 - x.probability_above(10).value,
        "B7": "#NUM!",
        "B8": 0,
        "B9": 0,
        "B10": 0,
        "B11": x.values[2],
        "B12": "#N/A",
        "B13": True,
        "B14": 0,
        "B15": 0,
        "B16": 1,
        "B18": 20_000,
        "B19": 100 * (1 - x.probability_above(10).value),
    }
    sheet = openpyxl.load_workbook(target, data_only=True)["S"]
    for address, value in expected.items():
        found = sheet[address].value
        assert found == (value if isinstance(value, str | bool) else pytest.approx(value, rel=1e-12, abs=1e-12)), (
            address
        )
    assert abs(sheet["B1"].value - 10) < 5 * 2 / math.sqrt(20_000)


def test_other_cells_keep_what_excel_saved(filled):
    _, target, _ = filled
    book = openpyxl.load_workbook(target, data_only=True)
    assert [book["S"][address].value for address in ("A1", "A2", "A3", "B17", "D1")] == [5.25, 10.5, 6.25, 3, 0.9]
    assert book["Other"]["A2"].value == 5.25
    assert book["Other"]["A1"].value == book["S"]["B1"].value + 1


def test_only_values_change(filled):
    """Without the cached values of the filled cells, both sheets are the same bytes; so are all parts but five more."""
    source, target, run = filled
    before, after = (read_parts(path.read_bytes()) for path in (source, target))
    kept = {"[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels", "xl/styles.xml", "docProps/app.xml"}
    sheets = {"xl/worksheets/sheet1.xml", "xl/worksheets/sheet2.xml"}
    assert {name for name in before if after[name] != before[name]} <= kept | sheets
    cells = {cell.a1 for cell in result_values(run)}
    for name in sheets:
        assert _blanked(before[name], cells) == _blanked(after[name], cells)


def _blanked(xml, cells):
    for address in cells:
        cell = rf'(<c r="{address}")(?: t="\w+")?(>.*?</f>)<v>.*?</v>'
        xml = re.sub(cell.encode(), rb"\1\2", xml)
    return xml


def test_the_result_workbook_is_known_as_made_from_the_book(filled):
    source, target, _ = filled
    hashes = [original_hash(read_parts(path.read_bytes())) for path in (source, target)]
    assert hashes[0] == hashes[1]


def test_another_formula_is_another_workbook(filled, tmp_path):
    source, _, _ = filled
    changed = build(tmp_path / "changed.xlsx", {**FORMULAS, "A3": ("=A1+2", 6.25)})
    assert original_hash(read_parts(changed.read_bytes())) != original_hash(read_parts(source.read_bytes()))


def test_a_run_of_the_result_workbook_gives_the_same(filled, tmp_path):
    _, target, run = filled
    again = xlmc.load(target).simulate(trials=20_000, seed=999)
    assert again["x"].mean == run["x"].mean
    again.save(tmp_path / "again.xlsx")
    with zipfile.ZipFile(tmp_path / "again.xlsx") as once, zipfile.ZipFile(target) as first:
        assert once.read("xl/worksheets/sheet1.xml") == first.read("xl/worksheets/sheet1.xml")


def test_results_of_a_run_without_accepted_trials_are_not_available(tmp_path):
    cells = {"A1": ("=RiskNormal(5,1)+RiskOutput()", 5), "A2": ("=RiskMean(A1)", 5), "A3": ("=A1/0+RiskOutput()", 0)}
    cells["A4"] = ("=RiskMean(A3)", 1)
    run = xlmc.load(build(tmp_path / "book.xlsx", cells)).simulate(trials=100)
    values = {cell.a1: value for cell, value in result_values(run).items()}
    assert values["A4"] is ErrorCode.NA
    assert values["A2"] == run["S!A1"].mean.value


def test_an_array_formula_of_results_fills_its_area(tmp_path):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", "=RiskNormal(5,1)+RiskOutput()", None, 5)
        sheet.write_array_formula("B1:B2", "{=RiskMean(A1)*{1;2}}", None, 0)
        sheet.write_number("B2", 0)
    run = xlmc.load(path).simulate(trials=1000)
    run.save(tmp_path / "out.xlsx")
    sheet = read_workbook(tmp_path / "out.xlsx").sheets["S"]
    mean = run["S!A1"].mean.value
    assert [sheet.cells[row, 2].value for row in (1, 2)] == pytest.approx([mean, 2 * mean], rel=1e-15)


def test_a_book_without_such_cells_is_not_touched(tmp_path):
    cells = {"A1": ("=RiskNormal(5,1)+RiskOutput()", 5)}
    run = xlmc.load(build(tmp_path / "book.xlsx", cells)).simulate(trials=100)
    assert result_values(run) == {}
