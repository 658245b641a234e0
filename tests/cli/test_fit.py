from __future__ import annotations

import json

import numpy as np
import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from workbook_files import workbook_of

pytestmark = pytest.mark.usefixtures("fitted_once")

FRICTION = np.random.default_rng(999).normal(0.75, 0.06, 40).round(3)


@pytest.fixture
def measured(tmp_path):
    """Friction in Tests!A2:A41 (a table) with two blanks below, counts in Tests!C2:C21, and a second sheet."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Tests"
    for row, value in enumerate(["Friction", *FRICTION.tolist()], start=1):
        sheet.cell(row, 1, value)
    for row, value in enumerate(["Crashes", *np.random.default_rng(1).poisson(4, 20).tolist()], start=1):
        sheet.cell(row, 3, value)
    sheet["E1"], sheet["E2"] = "=A2*2", "text"
    sheet.add_table(Table(displayName="Skids", ref="A1:A41"))
    book.create_sheet("My notes")["A1"] = 5
    book.save(tmp_path / "data.xlsx")
    return tmp_path / "data.xlsx"


@pytest.fixture
def alone(tmp_path):
    """One sheet with six values."""
    book = openpyxl.Workbook()
    for value in FRICTION[:6].tolist():
        book.active.append([value])
    book.save(tmp_path / "alone.xlsx")
    return tmp_path / "alone.xlsx"


def test_ranks_and_prints_the_row_to_paste(xlmc, measured):
    outcome = xlmc("fit", f"{measured}!Tests!A2:A43", "--name", "Friction")
    assert outcome.code == 0, outcome.err
    assert "data.xlsx Tests!A2:A43: 40 values as continuous; 2 blank cells left out; the best by AIC" in outcome.out
    normal = next(line for line in outcome.out.splitlines() if line.strip().startswith("Normal"))
    assert f"Mean {FRICTION.mean():.2f}" in normal
    assert " ± " in normal
    assert "no p-values are given" in outcome.out
    headings, row = (line.split("\t") for line in outcome.out.splitlines() if "\t" in line)
    assert headings[:2] == ["Name", "Distribution"]
    assert headings[-1] == "Source"
    assert row[0] == "Friction"
    assert row[-1] == "fitted by maximum likelihood to data.xlsx Tests!A2:A43, n = 40"
    assert len(row) == len(headings)


def test_the_row_can_be_pasted(xlmc, measured, tmp_path):
    """A normal's row, in a workbook of its own, is read as it was printed."""
    outcome = xlmc("fit", measured, "Tests!A2:A41", "--json")
    normal = next(each for each in json.loads(outcome.out)["fits"] if each["distribution"] == "Normal")
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Name", "Value", "Distribution", *normal["parameters"]])
    sheet.append(["Friction", 0.75, "Normal", *normal["parameters"].values()])
    sheet.append([])
    sheet.append(["Name", "Cell"])
    sheet.append(["Twice", "=C8"])
    sheet["C8"] = "=B2*2"
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:E2"))
    sheet.add_table(Table(displayName="xlmc_forecasts", ref="A4:B5"))
    book.save(tmp_path / "pasted.xlsx")
    checked = xlmc("check", tmp_path / "pasted.xlsx")
    assert checked.code == 0, checked.err
    assert f"Normal: Mean {normal['parameters']['Mean']!r}"[:24] in checked.out


WAYS = ["!Tests!A2:A41", "!Skids[Friction]", "!Skids", "!'Tests'!$A$2:$A$41"]


@pytest.mark.parametrize("way", WAYS)
def test_ways_to_name_the_range(xlmc, measured, way):
    joined = xlmc("fit", f"{measured}{way}", "--json")
    apart = xlmc("fit", measured, way[1:], "--json")
    assert joined.code == apart.code == 0, joined.err
    assert joined.out == apart.out
    assert json.loads(joined.out)["values"] == 40


def test_json(xlmc, measured):
    outcome = xlmc("fit", measured, "Tests!C2:C21", "--json", "--by", "ks")
    result = json.loads(outcome.out)
    assert (result["values"], result["kind"], result["ranked_by"]) == (20, "counts", "ks")
    distances = [each["kolmogorov_smirnov"] for each in result["fits"]]
    assert distances == sorted(distances)
    assert result["fits"][0]["anderson_darling"] is None
    assert result["row"]["Distribution"] == result["fits"][0]["distribution"]
    assert "20 values tell families of distributions apart only roughly" in result["cautions"][0]
    assert "only roughly" in outcome.err


def test_counts_may_be_fitted_as_continuous(xlmc, measured):
    result = json.loads(xlmc("fit", measured, "Tests!C2:C21", "--json", "--kind", "continuous").out)
    assert "Normal" in {each["distribution"] for each in result["fits"]}


def test_too_few_values_are_exit_code_1(xlmc, alone):
    outcome = xlmc("fit", f"{alone}!A1:A6")
    assert outcome.code == 1
    assert "warning: 6 values cannot tell families of distributions apart" in outcome.err
    assert "a uniform range, wide enough for every value that is possible, claims less" in outcome.err


@pytest.mark.parametrize(("last", "code"), [(15, 1), (16, 0)])
def test_fifteen_values_are_enough(xlmc, measured, last, code):
    """Rows 2 to 15 are 14 values."""
    assert xlmc("fit", measured, f"Tests!A2:A{last}").code == code


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ("'My notes'!A1", "There is one value to fit. One measurement justifies a uniform range only"),
        ("Tests!E2", "Tests!E2: The data cell holds the text 'text', not a number. Type a number."),
        ("Tests!E1", "Tests!E1: The data cell has never been calculated"),
        ("A2:A41", "'A2:A41' names no sheet. Write the sheet, too, such as Tests!A2:A41."),
        ("Tets!A2:A41", "There is no worksheet 'Tets'. Did you mean Tests?"),
        ("Nowhere", "'Nowhere' is neither a range of cells nor the name of one"),
        ("Skids[Frction]", "The table Skids has no column 'Frction'. Did you mean Friction?"),
        ("Tests!Z1:Z9", "There is no value to fit"),
    ],
)
def test_mistakes(xlmc, measured, cells, message):
    outcome = xlmc("fit", measured, cells)
    assert outcome.code == 2
    assert message in outcome.err
    assert outcome.out == ""


def test_counts_are_refused_where_there_are_none(xlmc, measured):
    outcome = xlmc("fit", measured, "Tests!A2:A41", "--kind", "counts")
    assert outcome.code == 2
    assert "Not every value is a whole number" in outcome.err


def test_a_book_without_a_range(xlmc, measured):
    outcome = xlmc("fit", measured)
    assert outcome.code == 2
    assert "Name the range, too" in outcome.err


def test_two_ranges(xlmc, measured):
    outcome = xlmc("fit", f"{measured}!Tests!A2:A41", "Tests!C2:C9")
    assert outcome.code == 2
    assert "Two ranges are named" in outcome.err


def test_a_book_that_is_not_there(xlmc):
    outcome = xlmc("fit", "nowhere.xlsx!A1:A9")
    assert outcome.code == 2
    assert "There is no such file" in outcome.err


def test_the_values_and_the_best_families_are_drawn_in_every_kind_of_file(xlmc, measured, tmp_path):
    pypdf = pytest.importorskip("pypdf")
    pytest.importorskip("typst")
    files = [tmp_path / f"found.{ending}" for ending in ("xlsx", "html", "pdf")]
    outcome = xlmc("fit", measured, "Tests!A2:A41", "-o", files[0], "--html", files[1], "--pdf", files[2])
    assert outcome.code == 0, outcome.err
    assert outcome.out.count("Written: ") == 3
    best = [line.split()[0] for line in outcome.out.splitlines() if " ± " in line][1:5]
    assert outcome.out.startswith(f"{best[0]} describes the 40 values best by AIC.")
    book = openpyxl.load_workbook(files[0])
    (chart,) = book["Fit"]._charts
    assert [series.tx.strRef.f for series in chart.series] == [f"Numbers!${letter}$1" for letter in "ADGJM"]
    numbers = book["Numbers"]
    assert [numbers.cell(1, column).value for column in (1, 4, 7, 10, 13)] == ["Values", *best]
    drawn = [(x, y) for x, y in numbers.iter_rows(2, max_col=2, values_only=True) if x is not None]
    for value, share in drawn[1:-2:2]:  # the upper corner of each step
        assert share == pytest.approx(np.mean(value >= np.sort(FRICTION)), abs=1.5 / 40)
    family = [(x, y) for x, y in numbers.iter_rows(2, min_col=4, max_col=5, values_only=True) if x is not None]
    assert max(abs(y - np.mean(x >= FRICTION)) for x, y in family) < 0.15  # D at the 5 % level is 1.36 / sqrt(40)
    page = files[1].read_text(encoding="utf-8")
    text = "".join(each.extract_text() for each in pypdf.PdfReader(files[2]).pages)
    assert page.count("<svg") == 1
    for name in best:
        assert f">{name}</text>" in page
        assert name in text


def test_counts_are_drawn_as_steps(xlmc, measured, tmp_path):
    assert xlmc("fit", measured, "Tests!C2:C21", "-o", tmp_path / "found.xlsx").code == 0
    numbers = openpyxl.load_workbook(tmp_path / "found.xlsx")["Numbers"]
    points = [(x, y) for x, y in numbers.iter_rows(2, min_col=4, max_col=5, values_only=True) if x is not None]
    assert all(x == int(x) for x, _ in points)
    assert [x for x, _ in points[::2]] == [x for x, _ in points[1::2]]


def test_many_values_and_counts_far_apart_are_drawn_with_few_points(xlmc, tmp_path):
    book = openpyxl.Workbook()
    for value in [1, 2, 3, 5, 8, 10**9] * 350:
        book.active.append([value])
    book.save(tmp_path / "far.xlsx")
    outcome = xlmc("fit", tmp_path / "far.xlsx", "A1:A2100", "-o", tmp_path / "found.xlsx")
    assert outcome.code == 0, outcome.err
    assert openpyxl.load_workbook(tmp_path / "found.xlsx", read_only=True)["Numbers"].max_row <= 4_003


@pytest.mark.parametrize(
    ("cells", "columns"),
    [("Tests!A2:C21", "2 columns (A to C)"), ("Tests!A2:A41", ""), ("Tests!A2:B41", ""), ("Tests!C2:C21", "")],
    ids=["two", "one", "one and an empty one", "counts"],
)
def test_several_columns_are_not_pooled_in_silence(xlmc, measured, cells, columns):
    outcome = xlmc("fit", measured, cells)
    assert outcome.code == 0, outcome.err
    expected = f"the values of {columns} are fitted together" if columns else "are fitted together"
    assert (expected in outcome.err) == bool(columns)
    if columns:
        assert "such as Tests!A2:A21" in outcome.err
        assert expected in json.loads(xlmc("fit", measured, cells, "--json").out)["cautions"][0]


def test_a_row_of_values_is_one_quantity(xlmc, tmp_path):
    book = openpyxl.Workbook()
    book.active.append(FRICTION[:20].tolist())
    book.save(tmp_path / "row.xlsx")
    assert "fitted together" not in xlmc("fit", tmp_path / "row.xlsx", "A1:T1").err


def test_parameters_without_an_error_are_in_the_number_style(xlmc, tmp_path):
    rows = [["Days", "Uniform"], *([46_000 + 3 * row, row % 7 / 8.0] for row in range(40))]
    workbook_of({"Tests": rows}, {}).save(tmp_path / "days.xlsx")
    for words in (["Tests!A2:A41", "--kind", "counts"], ["Tests!A1:B41", "--columns"]):
        outcome = xlmc("fit", tmp_path / "days.xlsx", *words, "--number-style", "1.234,5")
        assert "Discrete Uniform" in outcome.out, outcome.err
        assert "Low 46.000, High 46.117" in outcome.out
