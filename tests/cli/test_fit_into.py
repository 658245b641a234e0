"""`xlmc fit --into`: the row is written, nothing else of the workbook changes, and what cannot be right is refused."""

from __future__ import annotations

import zipfile

import numpy as np
import openpyxl
import pytest
from openpyxl.styles import Font
from openpyxl.utils.escape import unescape
from openpyxl.worksheet.table import Table

from xlmc.cli import fit_into

pytestmark = pytest.mark.usefixtures("fitted_once")

VALUES = np.random.default_rng(999).normal(0.75, 0.06, 40).round(3)


@pytest.fixture
def data(tmp_path):
    book = openpyxl.Workbook()
    for value in VALUES.tolist():
        book.active.append([value])
    book.save(tmp_path / "data.xlsx")
    return tmp_path / "data.xlsx"


@pytest.fixture
def book(tmp_path):
    """Assumptions in A1:I3 of the sheet Inputs, the second between cutoffs; a note far below; a forecast."""
    made = openpyxl.Workbook()
    sheet = made.active
    sheet.title = "Inputs"
    heads = ["Name", "Value", "Distribution", "Low", "High", "Mean", "Std dev", "Upper cutoff", "Source"]
    for row in (heads, ["drag & co", 0.7, "Uniform", 0.6, 0.8], ["cut", 0.2, "Uniform", 0.1, 0.3, None, None, 0.25]):
        sheet.append(row)
    sheet["A3"].font = Font(bold=True)
    sheet["A9"] = "a note"
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:I3"))
    answers = made.create_sheet("Answers")
    for row in (["Name", "Cell"], ["sum", "=C1"]):
        answers.append(row)
    answers["C1"] = "=Inputs!B2+Inputs!B3"
    answers.add_table(Table(displayName="xlmc_forecasts", ref="A1:B2"))
    made.save(tmp_path / "book.xlsx")
    return tmp_path / "book.xlsx"


def parts(path):
    with zipfile.ZipFile(path) as package:
        return {name: package.read(name) for name in package.namelist()}


def changed(before, path):
    after = parts(path)
    assert before.keys() == after.keys()
    return {name for name in after if after[name] != before[name]}


def test_the_row_of_that_name_is_replaced_and_nothing_else(xlmc, data, book):
    before = parts(book)
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "Drag & CO", "--distribution", "normal", "--into", book)
    assert outcome.code == 0, outcome.err
    assert "Normal for Drag & CO, its row in" in outcome.out
    assert "Inputs!A2" in outcome.out
    assert changed(before, book) == {"xl/worksheets/sheet1.xml"}
    row = [cell.value for cell in openpyxl.load_workbook(book)["Inputs"][2]]
    assert row[:5] == ["drag & co", 0.7, "Normal", None, None]
    assert row[5:7] == pytest.approx([VALUES.mean(), VALUES.std()], rel=1e-5)
    assert row[8] == "fitted by maximum likelihood to data.xlsx Sheet!A1:A40, n = 40"
    assert xlmc("check", book).code == 0


def test_a_new_row_stands_below_the_table_which_reaches_to_it(xlmc, data, book):
    before = parts(book)
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "<new>", "--distribution", "Uniform", "--into", book)
    assert outcome.code == 0, outcome.err
    assert "a new row in" in outcome.out
    assert changed(before, book) == {"xl/worksheets/sheet1.xml", "xl/tables/table1.xml"}
    sheet = openpyxl.load_workbook(book)["Inputs"]
    assert sheet.tables["xlmc_assumptions"].ref == sheet.tables["xlmc_assumptions"].autoFilter.ref == "A1:I4"
    assert [sheet.cell(4, column).value for column in (1, 2, 3)] == [
        "<new>",
        float(f"{np.median(VALUES):.6g}"),
        "Uniform",
    ]
    assert [sheet["D4"].value, sheet["E4"].value] == [VALUES.min(), VALUES.max()]
    assert sheet["A4"].font.bold
    assert sheet["A9"].value == "a note"
    again = xlmc("fit", f"{data}!A1:A40", "--name", "<new>", "--distribution", "Normal", "--into", book)
    assert "its row in" in again.out
    assert openpyxl.load_workbook(book)["Inputs"]["D4"].value is None


def test_an_empty_row_of_the_table_is_filled_first(xlmc, data, book):
    made = openpyxl.load_workbook(book)
    made["Inputs"].tables["xlmc_assumptions"].ref = "A1:I5"
    made["Inputs"].tables["xlmc_assumptions"].autoFilter.ref = "A1:I5"
    made.save(book)
    before = parts(book)
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "new", "--distribution", "Normal", "--into", book)
    assert outcome.code == 0, outcome.err
    assert "a new row in" in outcome.out
    assert changed(before, book) == {"xl/worksheets/sheet1.xml"}
    assert openpyxl.load_workbook(book)["Inputs"]["A4"].value == "new"


def test_the_measurements_may_stand_in_the_same_workbook(xlmc, book):
    made = openpyxl.load_workbook(book)
    for row, value in enumerate(VALUES.tolist(), 1):
        made["Answers"].cell(row, 6, value)
    made.save(book)
    outcome = xlmc("fit", f"{book}!Answers!F1:F40", "--name", "cut", "--distribution", "uniform", "--into", book)
    assert outcome.code == 2  # the cutoff is 0.25
    outcome = xlmc("fit", f"{book}!Answers!F1:F40", "--name", "drag & co", "--distribution", "normal", "--into", book)
    assert outcome.code == 0, outcome.err


REFUSED = {
    "no column": (
        lambda book: None,
        ("drag & co", "beta"),
        "Inputs!A1: The table xlmc_assumptions has no column Alpha",
    ),
    "cutoffs": (lambda book: None, ("cut", "uniform"), "Inputs!H3: "),
    "a formula": (
        lambda book: book["Inputs"].__setitem__("G2", "=0.1/2"),
        ("drag & co", "normal"),
        "Inputs!G2: The cell holds a formula",
    ),
    "no room": (
        lambda book: book["Inputs"].__setitem__("C4", "taken"),
        ("new", "normal"),
        "Inputs!C4: There is no free row below the table xlmc_assumptions",
    ),
    "no table": (
        lambda book: book["Inputs"].tables.__delitem__("xlmc_assumptions"),
        ("new", "normal"),
        "book.xlsx has no table xlmc_assumptions",
    ),
    "not fitted": (lambda book: None, ("new", "poisson"), "Poisson was not fitted: continuous values"),
    "no distribution": (lambda book: None, ("new", "norml"), "'norml' is not a distribution"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_right_is_refused_and_the_file_stays(xlmc, data, book, case):
    change, (name, distribution), message = REFUSED[case]
    made = openpyxl.load_workbook(book)
    change(made)
    made.save(book)
    before = book.read_bytes()
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", name, "--distribution", distribution, "--into", book)
    assert outcome.code == 2
    assert message in outcome.err
    assert book.read_bytes() == before


def test_a_name_that_looks_like_an_escape_or_steers_a_terminal_is_written_as_it_is_printed(xlmc, data, book):
    name = "a_x0041_\x1b[31m"
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", name, "--distribution", "Normal", "--into", book)
    assert outcome.code == 0, outcome.err
    sheet = openpyxl.load_workbook(book)["Inputs"]
    assert unescape(sheet["A4"].value).startswith("a_x0041_")
    assert xlmc("check", book).code == 0


def test_the_workbook_is_no_output(xlmc, data, book):
    before = book.read_bytes()
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "new", "--into", book, "-o", book, "--overwrite")
    assert outcome.code == 2
    assert "This is the file that is read" in outcome.err
    assert book.read_bytes() == before


def test_a_name_is_needed(xlmc, data, book):
    outcome = xlmc("fit", f"{data}!A1:A40", "--into", book)
    assert outcome.code == 2
    assert "--into needs --name" in outcome.err


def test_a_workbook_that_excel_holds_open_is_left_alone(xlmc, data, book):
    book.with_name("~$book.xlsx").touch()
    before = book.read_bytes()
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "new", "--distribution", "normal", "--into", book)
    assert outcome.code == 2
    assert "Excel holds the workbook open" in outcome.err
    assert book.read_bytes() == before


def test_a_workbook_that_has_changed_meanwhile_is_left_alone(xlmc, data, book, monkeypatch):
    written = fit_into.write

    def late(edited):
        made = openpyxl.load_workbook(book)
        made["Inputs"]["A9"] = "another note"
        made.save(book)
        written(edited)

    monkeypatch.setattr(fit_into, "write", late)
    outcome = xlmc("fit", f"{data}!A1:A40", "--name", "new", "--distribution", "normal", "--into", book)
    assert outcome.code == 2
    assert "The workbook has changed since it was read" in outcome.err
    assert openpyxl.load_workbook(book)["Inputs"]["A9"].value == "another note"


@pytest.mark.parametrize("distribution", ["Normal", "Uniform"])
def test_values_far_from_0_are_written_as_they_are(xlmc, book, tmp_path, distribution):
    """Coordinates in meters: six digits would leave a mean beside all values, or a range of width 0."""
    values = 1_234_567.0 + np.random.default_rng(1).normal(0.0, 0.05, 40).round(4)
    made = openpyxl.Workbook()
    for value in values.tolist():
        made.active.append([value])
    made.save(tmp_path / "far.xlsx")
    source = f"{tmp_path / 'far.xlsx'}!A1:A40"
    outcome = xlmc("fit", source, "--name", "East", "--distribution", distribution, "--into", book)
    assert outcome.code == 0, outcome.err
    _, base, _, low, high, mean, std_dev, *_ = (cell.value for cell in openpyxl.load_workbook(book)["Inputs"][4])
    assert base == pytest.approx(np.median(values), abs=1e-3)
    if distribution == "Uniform":
        assert (low, high) == pytest.approx((values.min(), values.max()), abs=1e-4)
        assert outcome.out.replace(",", "").count(f"{low!r}") >= 2  # in the ranking, and in the row to paste
    else:
        assert mean == pytest.approx(values.mean(), abs=1e-4)
        assert std_dev == pytest.approx(values.std(), rel=1e-4)
