"""What a result workbook shows of its run, beside what the repeated run gives."""

from __future__ import annotations

import math
import re
import subprocess
import zipfile
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import xlsxwriter
from fewer_sheets import FEW, SHORT, keep_sheets
from needed_programs import missing
from simulated import simulated

import xlmc
from xlmc.api import Simulation
from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.replay import replay
from xlmc.outputs.sheets.save import save

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def numbers(sheet, after=3):
    """The cells below the title that hold a number and no formula."""
    rows = sheet.iter_rows(min_row=after)
    return (cell for row in rows for cell in row if type(cell.value) is float and cell.column > 1)


SHEETS = ("Results", "Statistics", "Certainty", "Assumptions", "Trials", "Bins", "Curves")


def test_an_edited_number_is_named_with_what_the_run_gives(edited, drawn):
    """Two on each sheet, one by a tenth and one by a little; curves are written for charts."""
    was, factors = {}, {}

    def change(book):
        for sheet in SHEETS:
            for cell, factor in zip(numbers(book[sheet]), (1.1, 1 + 1e-9), strict=False):
                where = f"{sheet}!{cell.coordinate}"
                was[where], factors[where] = cell.value, factor
                cell.value *= factor

    result = replay(edited(change, drawn))
    assert len(was) == 2 * len(SHEETS)
    assert {str(each.where): each.gives for each in result.shown.differences} == was
    assert len(result.shown.differences) == len(was)
    for each in result.shown.differences:
        assert each.says == pytest.approx(each.gives * factors[str(each.where)], rel=1e-15)
    assert result.same_bits
    assert not result.identical


EDITS = {
    "a sentence": ("Results", "A1", "Results of another simulation", "Results of the simulation"),
    "a cell that was added": ("Statistics", "Z99", 5, None),
    "a logical in place of a number": ("Trials", "A5", True, float),
    "a formula in place of a number": ("Trials", "B5", "=1+1", float),
    "a number that was taken out": ("Trials", "B6", None, float),
    "a text in place of a number": ("Trials", "B7", "2", float),
}
RECORD = ["sampling.seed", "end.most_trials", "end.reached", "run.repeat", "conventions.mode", "counts.acceptance"]


def typed_ranges(book):
    """The cells From, to, Certainty, ±, Trials of each line for a person's own range."""
    return [row[2:7] for row in book["Certainty"].iter_rows() if str(row[4].value).startswith("=SUMPRODUCT")]


def test_any_other_edit_is_named(edited):
    """Of shown results, of entries of the record, and of formulas, beside a range that somebody typed or without."""
    says, gives = {}, {}

    def change(book):
        for sheet, address, value, was in EDITS.values():
            book[sheet][address] = value
            says[f"{sheet}!{address}"], gives[f"{sheet}!{address}"] = value, was
        for cell in (row[2] for row in book["Record"].iter_rows() if row[0].value in RECORD):
            cell.value = cell.value + 1 if isinstance(cell.value, int | float) else f"{cell.value} or so"
            says[f"Record!{cell.coordinate}"] = cell.value
        (_, _, without, *_), (low, _, beside, *_) = typed_ranges(book)
        low.value = 12
        for cell, forged in ((without, "=1-0.01"), (beside, "95 %")):
            says[f"Certainty!{cell.coordinate}"] = cell.value = forged

    result = replay(edited(change))
    assert {str(each.where): each.says for each in result.shown.differences} == says
    assert len(result.shown.differences) == len(says) == len(EDITS) + len(RECORD) + 2
    given = {str(each.where): each.gives for each in result.shown.differences if str(each.where) in gives}
    assert {where: float if isinstance(value, float) else value for where, value in given.items()} == gives
    assert not result.identical


def test_the_smallest_edit_of_a_file_that_no_program_has_saved(results, tmp_path):
    """The last bit of a number, put into the file by hand."""
    parts = read_parts(results.read_bytes())
    book = openpyxl.load_workbook(results)
    value = book["Trials"]["B5"].value
    name = next(name for name, xml in parts.items() if "worksheets/sheet" in name and repr(value).encode() in xml)
    old, new = (f"<v>{number!r}</v>".encode() for number in (value, value * (1 + 1e-13)))
    assert old in parts[name]
    path = tmp_path / "edited.xlsx"
    with zipfile.ZipFile(path, "w") as package:
        for each, content in {**parts, name: parts[name].replace(old, new)}.items():
            package.writestr(each, content)
    assert replay(path).shown.differences[0].gives == value


HAND = {
    "a row in a comment": lambda row: b"<!--" + row + b"-->",
    "another style": lambda row: re.sub(rb' s="\d+"><v>[^<]*</v></c></row>', b' s="0"><v>7</v></c></row>', row),
    "a row that is not there": lambda row: b"",
}


@pytest.mark.parametrize("edit", HAND.values(), ids=HAND)
def test_rows_of_trials_that_were_changed_by_hand_in_a_way_that_no_program_would(results, tmp_path, edit):
    parts = read_parts(results.read_bytes())
    name = read_workbook(results).sheets["Trials"].part
    row = re.search(rb'<row r="40".*?</row>', parts[name])[0]
    path = tmp_path / "edited.xlsx"
    with zipfile.ZipFile(path, "w") as package:
        for each, content in {**parts, name: parts[name].replace(row, edit(row))}.items():
            package.writestr(each, content)
    assert {(each.where.sheet, each.where.row) for each in replay(path).shown.differences} == {("Trials", 40)}


def test_an_untouched_sheet_of_trials_is_not_parsed(results, monkeypatch):
    from xlmc.excel.workbook import lazy_sheets

    parsed = []

    def counted(xml, entry, context):
        result = parse_sheet(xml, entry, context)
        parsed.append((entry.name, len(result.cells)))
        return result

    parse_sheet = lazy_sheets.parse_sheet
    monkeypatch.setattr(lazy_sheets, "parse_sheet", counted)
    answer = replay(results)
    assert answer.identical
    assert "Trials" in answer.shown.sheets
    assert max(cells for name, cells in parsed if name == "Trials") < 60


def test_sheets_are_known_again_by_another_name_and_one_that_was_deleted_is_named(edited):
    """The values of two certainties beside typed ranges are forged besides."""

    def change(book):
        for sheet in list(book):
            if sheet.title in ("Results", "Statistics", "Trials", "Bins"):
                sheet.title = f"Old {sheet.title}"
        book.move_sheet("Old Trials", -5)
        book.remove(book["Assumptions"])
        book["Old Statistics"]["D8"] = 1e9
        for value, (low, _, certainty, *_) in zip([0.95, "=0.95"], typed_ranges(book), strict=True):
            low.value, certainty.value = 12, value

    result = replay(edited(change))
    differences = {(each.where.sheet, each.says) for each in result.shown.differences}
    assert differences == {("Old Statistics", 1e9), ("Certainty", 0.95), ("Certainty", "=0.95")}
    assert "'Old Statistics'!D8" in {str(each.where) for each in result.shown.differences}
    assert len(result.shown.differences) == len(differences)
    assert {"Old Results", "Old Statistics", "Old Trials", "Old Bins"} <= set(result.shown.sheets)
    assert result.shown.missing == ("Assumptions",)
    assert not result.identical


def test_a_range_that_somebody_typed_is_said_and_no_edit(edited):
    def change(book):
        row = next(row for row in book["Certainty"].iter_rows() if str(row[4].value).startswith("=SUMPRODUCT"))
        row[2].value = 1.25

    result = replay(edited(change))
    assert result.identical
    [message] = result.shown.left_out
    assert "holds a range that a person typed" in message


def test_what_a_program_counts_in_a_range_of_ones_own_is_recounted(results, run, tmp_path):
    """The value that stands with the formula, as Excel saves it, must be the share in that range."""
    book = openpyxl.load_workbook(results)
    low, high, certainty, error, _ = typed_ranges(book)[0]
    where = certainty.coordinate, error.coordinate
    values = run.forecasts["area"]
    values = values[~np.isnan(values)][:FEW]  # the rows of the sheet Trials
    share = np.mean((values >= 11) & (values <= high.value))
    shown = {low.coordinate: 11, where[0]: share, where[1]: math.sqrt(share * (1 - share) / values.size)}
    result = replay(with_numbers(results, tmp_path, shown))
    assert (result.identical, result.shown.differences) == (True, ())
    assert "holds a range that a person typed" in result.shown.left_out[0]
    result = replay(with_numbers(results, tmp_path, {**shown, where[0]: share + 0.01}))
    assert [str(each.where) for each in result.shown.differences] == [f"Certainty!{where[0]}"]


def with_numbers(results, folder, values):
    """A copy whose sheet Certainty holds other numbers, each with the formula that stands with it."""
    parts = read_parts(results.read_bytes())
    name = next(name for name, xml in parts.items() if "worksheets/sheet" in name and b"SUMPRODUCT" in xml)
    xml = parts[name].decode()
    for address, value in values.items():
        xml, count = re.subn(rf'(<c r="{address}"[^>]*>(?:<f>[^<]*</f>)?<v>)[^<]*', rf"\g<1>{float(value)!r}", xml)
        assert count == 1
    path = folder / "edited.xlsx"
    with zipfile.ZipFile(path, "w") as package:
        for each, content in {**parts, name: xml.encode()}.items():
            package.writestr(each, content)
    return path


def test_a_warning_that_was_taken_off_the_record_is_named(tmp_path, edited, small_book, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    source = tmp_path / "warned.xlsx"
    Simulation(simulated(load(small_book), trials=100, until_accepted=90)).save(source)

    def change(book):
        row = next(row for row in book["Record"].iter_rows() if row[0].value == "warnings[0]")
        row[1].value = None

    result = replay(edited(change, source))
    assert "90" in result.shown.differences[0].gives
    assert not result.identical


@pytest.mark.parametrize("key", ["counts.accepted", "file.name", "end.by", "counts", "end"])
def test_a_record_that_lacks_an_entry_is_refused_by_name(typed, in_record, key):
    book = typed({("Record", in_record(key), 1): f"{key}x"})
    with pytest.raises(WorkbookError, match=f"The record lacks '{key}.*It was edited"):
        replay(book)


def test_results_in_the_workbook_itself_beside_a_sheet_of_their_name(small_book, tmp_path):
    path, book = tmp_path / "book.xlsx", openpyxl.load_workbook(small_book)
    book.create_sheet("Results")["A1"] = "mine"
    book.save(path)
    Simulation(simulated(load(path))).save(path, overwrite=True)
    result = replay(path)
    assert result.to_the_last_bit
    assert "Results (2)" in result.shown.sheets


@pytest.mark.parametrize("rows", [0, 20_000])
def test_any_number_of_trials_on_the_sheet_of_a_file_that_was_renamed(run, tmp_path, rows):
    path = save(run, tmp_path / f"{rows}.xlsx", rows=rows, command="xlmc simulate small.xlsx")
    result = replay(path.rename(tmp_path / f"another name {rows}.xlsx"))
    assert result.to_the_last_bit
    assert len(result.shown.sheets) >= 8


def test_of_another_model_no_sheet_is_compared(typed):
    result = replay(typed({("Inputs", 2, 3): 1.25}))
    assert result.shown.differences == ()
    assert "the model is no longer the one" in result.shown.left_out[0]
    assert not result.identical


def test_sheets_that_another_version_laid_out_otherwise_are_not_held_against_the_file(typed, monkeypatch):
    path = typed({("Results", 1, 1): "Results"})
    now = xlmc.__version__
    for module in ("repeat", "shown_results", "versions"):
        monkeypatch.setattr(f"xlmc.outputs.replay.{module}.__version__", "9.9.9")
    result = replay(path)
    assert result.identical
    assert result.shown.left_out == (f"the sheet Results, which xlmc {now} wrote differently from 9.9.9",)


def test_numbers_that_differ_from_those_of_another_version_are_named(typed, results, monkeypatch):
    cells = read_workbook(results).sheets["Results"].cells
    at = next(at for at, cell in sorted(cells.items()) if at[0] > 2 and at[1] > 1 and isinstance(cell.value, float))
    path = typed({("Results", *at): 12.5})
    for module in ("repeat", "shown_results", "versions"):
        monkeypatch.setattr(f"xlmc.outputs.replay.{module}.__version__", "9.9.9")
    result = replay(path)
    assert not result.identical
    assert [(each.where.sheet, each.says) for each in result.shown.differences] == [("Results", 12.5)]
    assert result.shown.left_out == ()


@pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))
def test_a_result_that_another_program_has_saved_with_fewer_digits(results, tmp_path):
    profile = f"-env:UserInstallation=file://{tmp_path}/profile"
    command = ["soffice", "--headless", profile, "--convert-to", "xlsx", "--outdir", str(tmp_path), str(results)]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    result = replay(tmp_path / results.name)
    assert (result.changes, result.shown.differences, result.shown.missing) == ((), (), ())
    assert result.identical


# Cells of the workbook itself.

CELLS = {
    "A1": ("=RiskNormal(5,1)", 5),
    "A2": ("=A1*2+RiskOutput()", 10),
    "B1": ("=RiskMean(A2)", 0),
    "B2": ("=B1*2", 0),
    "B3": ("=RiskCpk(A2,0.9)", 77),
}


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    folder = tmp_path_factory.mktemp("own")
    with xlsxwriter.Workbook(folder / "book.xlsx") as book:
        sheet = book.add_worksheet("S")
        for address, (formula, value) in CELLS.items():
            sheet.write_formula(address, formula, None, value)
    run = simulated(load(folder / "book.xlsx"), trials=500)
    Simulation(run).save(folder / "r.xlsx")
    return folder / "r.xlsx", run


def with_values(path, target, values):
    """The workbook with other saved values in formula cells of its first sheet."""
    parts = read_parts(path.read_bytes())
    xml = parts["xl/worksheets/sheet1.xml"].decode()
    for address, (kind, value) in values.items():
        xml, count = re.subn(
            rf'(<c r="{address}")[^>]*>(<f>.*?</f>)<v>.*?</v>', rf'\1 t="{kind}">\2<v>{value}</v>', xml
        )
        assert count == 1
    with zipfile.ZipFile(target, "w") as package:
        for name, content in {**parts, "xl/worksheets/sheet1.xml": xml.encode()}.items():
            package.writestr(name, content)
    return target


def test_untouched_cells_that_show_results(own):
    assert replay(own[0]).to_the_last_bit


def test_an_edited_result_in_a_cell_of_the_workbook_is_named(own, tmp_path):
    path, run = own
    result = replay(with_values(path, tmp_path / "edited.xlsx", {"B1": ("n", "12.5"), "B3": ("n", "77")}))
    mean = run["S!A2"].mean.value
    assert [(str(d.where), d.says, d.gives) for d in result.shown.differences] == [
        ("S!B1", 12.5, mean),
        ("S!B3", 77, ErrorCode.NA),
    ]


def test_what_a_program_without_the_add_in_shows_is_no_edit(own, tmp_path):
    names = dict.fromkeys(("B1", "B2", "B3"), ("e", "#NAME?"))
    result = replay(with_values(own[0], tmp_path / "saved.xlsx", names))
    assert result.identical
    assert "3 cells that show results of the run: a program without the add-in" in result.shown.left_out[0]


@pytest.mark.parametrize("name", ["collinear-head-on", "intersection"])
def test_a_shipped_book_that_openpyxl_has_saved_is_identical(tmp_path, name):
    """It leaves out texts without a character, and 0.775 stands for 0.7749999999999999 after LibreOffice."""
    path = tmp_path / f"{name}-results.xlsx"
    Simulation(simulated(load(EXAMPLES / f"{name}.xlsx"), 300)).save(path)
    book = openpyxl.load_workbook(path)
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row if isinstance(cell.value, float)]
    rounded = {cell: float(f"{cell.value:.15g}") for cell in cells}
    assert rounded != {cell: cell.value for cell in cells}
    for cell, value in rounded.items():
        cell.value = value
    book.save(path)
    result = replay(path)
    assert (result.changes, result.shown.differences, result.shown.missing) == ((), (), ())
    assert result.identical
