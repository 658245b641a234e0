"""`xlmc prepare` and `xlmc new blank`: tables for a model of one's own, and nothing else changed."""

from __future__ import annotations

import json
import re
import zipfile
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.excel.workbook.reader import read_workbook

ROOT = Path(__file__).resolve().parents[3]
SHARED = ROOT.parent / "shared" / "conformance" / "workbooks"

MODEL = {
    "Beam": [
        ["Load (kN)", 12.0],
        ["Span", 4.0, "m"],
        ["Width", "mm", 100],
        ["Note", "as built"],
        ["Moment", "=B1*B2/4", "kN*m"],
        ["Stress", "=B5/C3*1000", "MPa"],
        ["Twice", "=B6*2"],
        ["Unused", 7],
    ]
}


def write(rows, path, tables=None):
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, lines in rows.items():
        sheet = made.create_sheet(name)
        for line in lines:
            sheet.append(line)
    for name, place in (tables or {}).items():
        sheet, area = place.split("!")
        made[sheet].add_table(Table(displayName=name, ref=area))
    made.save(path)
    return path


def parts(path):
    with zipfile.ZipFile(path) as package:
        return {name: package.read(name) for name in package.namelist() if not name.endswith("/")}


@pytest.mark.skipif(not SHARED.exists(), reason="the Excel-saved workbooks are not beside the project")
def test_an_answer_that_cannot_be_computed_has_no_row_and_is_named(xlmc, tmp_path):
    """A formula with a decimal comma, as `clone_sheet.xlsx` of Apache POI has them beside a saved value."""
    outcome = xlmc("prepare", SHARED / "apache__clone_sheet.xlsx", "-o", tmp_path / "ready.xlsx")
    assert outcome.code == 0
    assert "Arkusz1!M6 cannot be computed (one value is needed here" in outcome.err
    assert "Arkusz1!M6" not in outcome.out
    assert xlmc("simulate", tmp_path / "ready.xlsx", "-n", "100").code == 0


@pytest.fixture
def book(tmp_path):
    return write(MODEL, tmp_path / "beam.xlsx")


def edit(path, cells, sheet="xlmc"):
    """Type into a sheet, by default that of the tables, as a person would."""
    book = openpyxl.load_workbook(path)
    for place, value in cells.items():
        book[sheet][place] = value
    book.save(path)


def test_numbers_become_assumptions_and_last_formulas_forecasts(xlmc, book):
    outcome = xlmc("prepare", book)
    assert outcome.code == 0
    sheet = openpyxl.load_workbook("beam-prepared.xlsx")["xlmc"]
    result = {sheet.cell(row, 1).value: (sheet.cell(row, 2).value, sheet.cell(row, 11).value) for row in (7, 8, 9)}
    assert result == {"Load": ("=Beam!B1", "kN"), "Span": ("=Beam!B2", "m"), "Width": ("=Beam!C3", "mm")}
    assert [sheet.cell(7, column).value for column in (15, 16)] == ["Twice", "=Beam!B7"]
    assert "Unused" not in outcome.out
    assert xlmc("check", "beam-prepared.xlsx").code == 0


def test_years_above_a_table_are_no_inputs(xlmc, tmp_path):
    rows = [
        ["Plan", 2026, "=B1+1", "=C1+1"],
        ["Weight", 2000, "lb"],
        ["Sales", 100, "=B3*(1+(C1-B1)*0.05)", "=C3*(1+(D1-C1)*0.05)"],
        ["Total", "=SUM(B3:D3)*B2"],
    ]
    outcome = xlmc("prepare", write({"Plan": rows}, tmp_path / "plan.xlsx"), "--assumption", "Plan!B1")
    assert outcome.code == 0, outcome.err  # where it is asked for, it is one
    made = write({"Plan": rows}, tmp_path / "again.xlsx")
    outcome = xlmc("prepare", made)
    assert outcome.code == 0, outcome.err
    assert "Plan!B3" in outcome.out
    assert "Plan!B2" in outcome.out
    assert "Plan!B1" not in outcome.out


ORDER = {
    "Out": [["Last", "=In!B2*2"], ["First", "=In!B1+1"]],
    "In": [["a", 1], ["b", 2], ["Late", "=B1*3", "=B2*4"], ["Later", "=B1-B2"]],
}


def forecasts_of(outcome):
    return list(dict.fromkeys(re.findall(r"(?:Out|In)![A-Z]\d", outcome.out.split("Forecasts")[1])))


def test_answers_stand_in_the_order_of_the_sheets_or_as_they_are_asked_for(xlmc, tmp_path):
    made = write(ORDER, tmp_path / "order.xlsx")
    assert forecasts_of(xlmc("prepare", made)) == ["Out!B1", "Out!B2", "In!B3", "In!C3", "In!B4"]
    asked = ("--forecast", "In!B4", "--forecast", "Out!B1:B2", "--forecast", "In!B4")
    assert forecasts_of(xlmc("prepare", made, *asked, "-o", "asked.xlsx")) == ["In!B4", "Out!B1", "Out!B2"]
    done = xlmc("simulate", "order-prepared.xlsx", "-n", 100, "-o", "run.json")
    assert done.code == 0, done.err
    names = [each["cell"] for each in json.loads(Path("run.json").read_text(encoding="utf-8"))["forecasts"]]
    assert names == ["Out!B1", "Out!B2", "In!B3", "In!C3", "In!B4"]


def test_code_of_vba_points_to_the_option_and_is_computed_with_it(xlmc, tmp_path):
    rows = {"Pump": [["Flow", 0.04, "m3/s"], ["Head", 20, "m"], ["Power", "=Power.Of(B1,B2)", "kW"]]}
    made = write(rows, tmp_path / "pump.xlsx")
    (tmp_path / "mine.py").write_text("def Power_Of(flow, head):\n    return 9.81 * flow * head / 0.7\n", "utf-8")
    alone = xlmc("prepare", made)
    assert "the function POWER.OF is not known to xlmc" in alone.err
    assert "--functions my_functions.py" in alone.err
    assert "name an answer" not in alone.err
    outcome = xlmc("prepare", made, "--functions", "mine.py", "--overwrite")
    assert "Pump!B3" in outcome.out.split("Forecasts")[1]
    assert "--functions mine.py" in outcome.out
    (tmp_path / "link.xlsx").hardlink_to(tmp_path / "mine.py")
    refused = xlmc("prepare", made, "--functions", "mine.py", "--overwrite", "-o", "link.xlsx")
    assert "This is the file that is read" in refused.err


def test_years_that_a_table_repeats_are_no_answers(xlmc, tmp_path):
    rows = [
        ["Emissions", 2013, 2014, 2015],
        ["Power", 1150, "=B2*0.98", "=C2*0.98"],
        ["Price", 2013, 2014, 2015],
        ["Allowance", 25, "=B4*1.05", "=C4*1.05"],
    ]
    made = write({"Plan": rows}, tmp_path / "plan.xlsx")
    edit(made, {f"{column}3": f"={column}1" for column in "BCD"}, "Plan")
    xlmc("calculate", made, "-o", "saved.xlsx")  # Excel saves values
    outcome = xlmc("prepare", "saved.xlsx")
    assert outcome.code == 0, outcome.err
    assert "Power, 2013" in outcome.out
    assert "Allowance, 2015" in outcome.out
    assert not re.search(r"Plan![BCD][13]\b", outcome.out)


def test_a_poisson_distribution_takes_its_rate_as_mean(xlmc, book):
    xlmc("prepare", book)
    edit("beam-prepared.xlsx", {"C7": "Poisson", "G7": 3})
    outcome = xlmc("check", "beam-prepared.xlsx")
    assert outcome.code == 0, outcome.err
    assert "Poisson: Rate 3" in outcome.out


def test_a_row_is_frozen_until_a_distribution_is_typed(xlmc, book):
    xlmc("prepare", book)
    assert xlmc("check", "beam-prepared.xlsx").out.count("frozen") == 3
    edit("beam-prepared.xlsx", {"C7": "Uniform", "D7": 10, "F7": 14})
    outcome = xlmc("check", "beam-prepared.xlsx")
    assert outcome.code == 0
    assert outcome.out.count("frozen") == 2
    assert "Uniform: Low 10, High 14" in outcome.out
    assert xlmc("simulate", "beam-prepared.xlsx", "-n", 20_000, "-o", "run.json").code == 0
    forecast = json.loads(Path("run.json").read_text(encoding="utf-8"))["forecasts"][0]
    stress = 4.0 / 4 / 100 * 1000 * 2  # of one kN, twice
    result = forecast["statistics"]["mean"]
    assert result["value"] == pytest.approx(12 * stress, abs=4 * result["error"])


def test_everything_else_stays_byte_for_byte(xlmc, book):
    xlmc("prepare", book)
    before, after = parts(book), parts("beam-prepared.xlsx")
    changed = {name for name in before if before[name] != after[name]}
    allowed = {
        "[Content_Types].xml",
        "xl/workbook.xml",
        "xl/_rels/workbook.xml.rels",
        "xl/styles.xml",
        "docProps/app.xml",
    }
    assert changed <= allowed
    assert "xl/worksheets/sheet1.xml" not in changed


@pytest.mark.skipif(not SHARED.exists(), reason="the Excel-saved workbooks are not beside the project")
@pytest.mark.parametrize(
    "name", ["apache__WithThreeCharts.xlsx", "apache__testNames.xlsm", "apache__simple-monthly-budget.xlsx"]
)
def test_charts_macros_and_names_of_excel_stay(xlmc, name):
    source = SHARED / name
    target = f"copy{source.suffix}"
    assert xlmc("prepare", source, "-o", target).code == 0
    before, after = parts(source), parts(target)
    changed = {each for each in before if before[each] != after[each]}
    assert changed <= {
        "[Content_Types].xml",
        "xl/workbook.xml",
        "xl/_rels/workbook.xml.rels",
        "xl/styles.xml",
        "docProps/app.xml",
    }
    one, other = read_workbook(source), read_workbook(target)
    assert other.names[: len(one.names)] == one.names
    assert [*other.sheets][: len(one.sheets)] == [*one.sheets]
    assert xlmc("check", target).code == 0


def test_a_second_time_it_adds_what_is_new_and_keeps_what_was_typed(xlmc, book):
    xlmc("prepare", book, "--in-place")
    edit(book, {"C7": "Uniform", "D7": 10, "F7": 14})
    result = openpyxl.load_workbook(book)
    result["Beam"]["D1"], result["Beam"]["D2"], result["Beam"]["C8"] = "Factor", "=B7*E2", "kN"
    result["Beam"]["E2"] = 1.5
    result.save(book)
    outcome = xlmc("prepare", book, "--in-place")
    assert outcome.code == 0
    assert "Beam!E2" in outcome.out
    assert "Beam!B1" not in outcome.out
    outcome = xlmc("check", book)
    assert outcome.code == 0, outcome.err
    assert "Uniform: Low 10, High 14" in outcome.out
    assert "Beam!E2" in outcome.out
    assert "Beam!D2" in outcome.out
    before = book.read_bytes()
    assert "nothing was written" in xlmc("prepare", book, "--in-place").out
    assert book.read_bytes() == before


def test_cells_that_are_named_are_the_ones(xlmc, book):
    outcome = xlmc("prepare", book, "--assumption", "B1:C3", "--forecast", "Beam!B5")
    assert outcome.code == 0
    sheet = openpyxl.load_workbook("beam-prepared.xlsx")["xlmc"]
    assert [sheet.cell(row, 2).value for row in (7, 8, 9)] == ["=Beam!B1", "=Beam!B2", "=Beam!C3"]
    assert sheet.cell(7, 16).value == "=Beam!B5"
    assert "Beam!C2 holds no number" in outcome.err


MISTAKES = {
    "a formula as an input": (["--assumption", "B5"], ["Beam!B5", "holds a formula", "--forecast"]),
    "a text as an input": (["--assumption", "B4"], ["Beam!B4", "holds no number"]),
    "a blank cell as an input": (["--assumption", "H9"], ["Beam!H9", "is blank"]),
    "a number as an answer": (["--forecast", "B1"], ["Beam!B1", "holds no formula", "--assumption"]),
    "no such sheet": (["--forecast", "Bean!B1"], ["There is no sheet 'Bean'", "Beam"]),
    "no such name": (["--forecast", "speed"], ["'speed' is no cell"]),
    "both places": (["--in-place", "-o", "x.xlsx"], ["--in-place and --output"]),
    "another ending": (["-o", "x.xlsm"], [".xlsx"]),
}


@pytest.mark.parametrize(("arguments", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_one_message_and_nothing_is_written(xlmc, book, tmp_path, arguments, message):
    outcome = xlmc("prepare", book, *arguments)
    assert outcome.code == 2
    assert all(each in outcome.err for each in message), outcome.err
    assert outcome.err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["beam.xlsx"]


def test_a_book_without_formulas_and_one_of_another_program_are_told(xlmc, tmp_path):
    plain = write({"S": [["a", 1.0]]}, tmp_path / "plain.xlsx")
    assert "has no formula" in xlmc("prepare", plain).err
    risk = write({"S": [["=RiskNormal(1,2)"], ["=RiskOutput()+A1*2"]]}, tmp_path / "risk.xlsx")
    outcome = xlmc("prepare", risk)
    assert outcome.code == 2
    assert "xlmc convert risk.xlsx" in outcome.err
    assert "xlmc prepare plain.xlsx" in xlmc("check", plain).err


def test_a_table_that_only_lacks_its_name_is_one_line_with_the_cure(xlmc, tmp_path):
    rows = {"S": [["Name", "Value", "Low", "High"], ["a", 1.0, 0.0, 2.0], [], ["Name", "Cell"], ["y", "=S!F1"]]}
    rows["S"][0] += [None, "=B2*2"]
    path = write(rows, tmp_path / "case.xlsx", {"Table1": "S!A1:D2", "xlmc_forecasts": "S!A4:B5"})
    outcome = xlmc("check", path)
    assert outcome.code == 2
    assert "S!A1: The table Table1 has the headings of xlmc_assumptions" in outcome.err
    assert "Rename it xlmc_assumptions" in outcome.err


def test_plain_ranges_with_the_name_of_a_table_are_read(xlmc, tmp_path):
    rows = {
        "xlmc_assumptions": [
            ["Name", "Value", "Low", "High"],
            ["a", 1.0, 0.0, 2.0],
            ["b", 5.0, 4.0, 6.0],
            [],
            ["notes"],
        ],
        "S": [["=xlmc_assumptions!B2+xlmc_assumptions!B3"], [], ["Name", "Cell"], ["y", "=S!A1"]],
    }
    path = write(rows, tmp_path / "case.xlsx")
    book = openpyxl.load_workbook(path)
    book.defined_names["xlmc_forecasts"] = openpyxl.workbook.defined_name.DefinedName(
        "xlmc_forecasts", attr_text="S!$A$3:$B$4"
    )
    book.save(path)
    outcome = xlmc("check", path)
    assert outcome.code == 0, outcome.err
    assert "Uniform: Low 4, High 6" in outcome.out
    assert "is read as the table xlmc_assumptions" in outcome.err
    assert "S!A1" in outcome.out
