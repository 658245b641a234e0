"""What a result workbook shows of its run, beside what the repeated run gives."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import zipfile

import numpy as np
import openpyxl
import pytest
import xlsxwriter
from fewer_sheets import FEW
from needed_programs import missing

import xlmc
from xlmc.errors import ErrorCode, WorkbookError
from xlmc.replay import replay
from xlmc.report.sheets.save import save
from xlmc.workbook.package import read_parts


def numbers(sheet, after=3):
    """The cells below the title that hold a number and no formula."""
    rows = sheet.iter_rows(min_row=after)
    return (cell for row in rows for cell in row if type(cell.value) is float and cell.column > 1)


def first_number(sheet):
    return next(numbers(sheet))


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

    found = replay(edited(change, drawn))
    assert len(was) == 2 * len(SHEETS)
    assert {str(each.where): each.gives for each in found.shown.differences} == was
    assert len(found.shown.differences) == len(was)
    for each in found.shown.differences:
        assert each.says == pytest.approx(each.gives * factors[str(each.where)], rel=1e-15)
    assert found.same_bits
    assert not found.identical


def test_one_edited_number_is_enough(edited):
    def change(book):
        first_number(book["Assumptions"]).value *= 1 + 1e-9

    found = replay(edited(change))
    assert len(found.shown.differences) == 1
    assert not found.identical


def put(sheet, address, value):
    def change(book):
        book[sheet][address] = value

    return change


EDITS = {
    "a sentence": ("Results", "A1", "Results of another simulation", "Results of the simulation"),
    "a cell that was added": ("Statistics", "Z99", 5, None),
    "a logical in place of a number": ("Trials", "A5", True, float),
    "a formula in place of a number": ("Trials", "B5", "=1+1", float),
    "a number that was taken out": ("Trials", "B6", None, float),
    "a text in place of a number": ("Trials", "B7", "2", float),
}


def test_any_other_edit_is_named(edited):
    def change(book):
        for sheet, address, value, _ in EDITS.values():
            book[sheet][address] = value

    found = replay(edited(change))
    gives = {str(each.where): each.gives for each in found.shown.differences}
    assert len(found.shown.differences) == len(gives)
    shown = {where: float if isinstance(value, float) else value for where, value in gives.items()}
    assert shown == {f"{sheet}!{address}": was for sheet, address, _, was in EDITS.values()}
    assert not found.identical


def test_an_edited_formula_is_named(edited):
    def change(book):
        cell = next(c for row in book["Certainty"].iter_rows() for c in row if str(c.value).startswith("=SUMPRODUCT"))
        cell.value = "=1-0.01"

    [difference] = replay(edited(change)).shown.differences
    assert difference.says == "=1-0.01"


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


def test_a_sheet_that_was_deleted_is_named(edited):
    found = replay(edited(lambda book: book.remove(book["Statistics"])))
    assert found.shown.missing == ("Statistics",)
    assert not found.identical


def test_sheets_are_known_again_by_another_name(edited):
    def change(book):
        for sheet in list(book):
            if sheet.title in ("Results", "Statistics", "Trials", "Bins"):
                sheet.title = f"Old {sheet.title}"
        book.move_sheet("Old Trials", -5)
        book["Old Statistics"]["D8"] = 1e9

    found = replay(edited(change))
    assert [str(each.where) for each in found.shown.differences] == ["'Old Statistics'!D8"]
    assert {"Old Results", "Old Statistics", "Old Trials", "Old Bins"} <= set(found.shown.sheets)


def test_a_range_that_somebody_typed_is_said_and_no_edit(edited):
    def change(book):
        row = next(row for row in book["Certainty"].iter_rows() if str(row[4].value).startswith("=SUMPRODUCT"))
        row[2].value = 1.25

    found = replay(edited(change))
    assert found.identical
    [said] = found.shown.left_out
    assert "holds a range that a person typed" in said


def typed_ranges(book):
    """The cells From, to, Certainty, ±, Trials of each line for a person's own range."""
    return [row[2:7] for row in book["Certainty"].iter_rows() if str(row[4].value).startswith("=SUMPRODUCT")]


@pytest.mark.parametrize("forged", [[0.95, "=0.95"], ["95 %"]])
def test_a_certainty_that_somebody_typed_beside_a_range_of_their_own_is_named(edited, forged):
    def change(book):
        for value, (low, _, certainty, *_) in zip(forged, typed_ranges(book), strict=False):
            low.value, certainty.value = 12, value

    found = replay(edited(change))
    assert {each.where.sheet for each in found.shown.differences} == {"Certainty"}
    assert [each.says for each in found.shown.differences] == forged
    assert not found.identical


def test_what_a_program_counts_in_a_range_of_ones_own_is_recounted(results, tmp_path):
    """The value that stands with the formula, as Excel saves it, must be the share in that range."""
    book = openpyxl.load_workbook(results)
    low, high, certainty, error, _ = typed_ranges(book)[0]
    where = certainty.coordinate, error.coordinate
    values = replay(results).repeated.forecasts["area"]
    values = values[~np.isnan(values)][:FEW]  # the rows of the sheet Trials
    share = np.mean((values >= 12) & (values <= high.value))
    shown = {low.coordinate: 12, where[0]: share, where[1]: math.sqrt(share * (1 - share) / values.size)}
    found = replay(with_numbers(results, tmp_path, shown))
    assert (found.identical, found.shown.differences) == (True, ())
    assert "holds a range that a person typed" in found.shown.left_out[0]
    found = replay(with_numbers(results, tmp_path, {**shown, where[0]: share + 0.01}))
    assert [str(each.where) for each in found.shown.differences] == [f"Certainty!{where[0]}"]


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


RECORD = ["sampling.seed", "end.most_trials", "end.reached", "run.repeat", "conventions.mode", "counts.acceptance"]


def test_an_edited_entry_of_the_record_is_named(edited):
    def change(book):
        for cell in (row[2] for row in book["Record"].iter_rows() if row[0].value in RECORD):
            cell.value = cell.value + 1 if isinstance(cell.value, int | float) else f"{cell.value} or so"
            where.append(f"Record!{cell.coordinate}")

    where = []
    found = replay(edited(change))
    assert len(where) == len(RECORD)
    assert where == [str(each.where) for each in found.shown.differences]
    assert not found.identical


def test_a_warning_that_was_taken_off_the_record_is_named(tmp_path, edited, small_book):
    source = tmp_path / "warned.xlsx"
    xlmc.load(small_book).simulate(trials=100, until_accepted=90).save(source)

    def change(book):
        row = next(row for row in book["Record"].iter_rows() if row[0].value == "warnings[0]")
        row[1].value = None

    found = replay(edited(change, source))
    assert "90" in found.shown.differences[0].gives
    assert not found.identical


@pytest.mark.parametrize("key", ["counts.accepted", "file.name", "end.by", "counts", "end"])
def test_a_record_that_lacks_an_entry_is_refused_by_name(edited, key):
    def change(book):
        cell = next(row[0] for row in book["Record"].iter_rows() if row[0].value == key)
        cell.value = f"{key}x"

    with pytest.raises(WorkbookError, match=f"the record lacks '{key}.*It was edited"):
        replay(edited(change))


def test_results_beside_a_sheet_of_their_name(small_book, tmp_path):
    book = openpyxl.load_workbook(small_book)
    book.create_sheet("Results")["A1"] = "mine"
    book.save(tmp_path / "book.xlsx")
    xlmc.load(tmp_path / "book.xlsx").simulate().save(tmp_path / "r.xlsx")
    found = replay(tmp_path / "r.xlsx")
    assert found.to_the_last_bit
    assert "Results (2)" in found.shown.sheets


@pytest.mark.parametrize("rows", [0, 3, 20_000])
def test_any_number_of_trials_on_the_sheet(small_book, tmp_path, rows):
    save(xlmc.load(small_book).simulate(), tmp_path / "r.xlsx", rows=rows, command="xlmc simulate small.xlsx")
    assert replay(tmp_path / "r.xlsx").to_the_last_bit


def test_a_file_that_was_renamed(results, tmp_path):
    found = replay(shutil.copy(results, tmp_path / "another name.xlsx"))
    assert found.to_the_last_bit
    assert len(found.shown.sheets) >= 8


def test_of_another_model_no_sheet_is_compared(edited):
    found = replay(edited(put("Inputs", "C2", 1.25)))
    assert found.shown.differences == ()
    assert "the model is no longer the one" in found.shown.left_out[0]
    assert not found.identical


def test_sheets_that_another_version_laid_out_otherwise_are_not_held_against_the_file(edited, monkeypatch):
    path = edited(put("Results", "A1", "Results"))
    now = xlmc.__version__
    for module in ("repeat", "shown_results", "versions"):
        monkeypatch.setattr(f"xlmc.replay.{module}.__version__", "9.9.9")
    found = replay(path)
    assert found.identical
    assert found.shown.left_out == (f"the sheet Results, which xlmc {now} wrote differently from 9.9.9",)


def test_numbers_that_differ_from_those_of_another_version_are_named(edited, monkeypatch):
    path = edited(lambda book: setattr(first_number(book["Results"]), "value", 12.5))
    for module in ("repeat", "shown_results", "versions"):
        monkeypatch.setattr(f"xlmc.replay.{module}.__version__", "9.9.9")
    found = replay(path)
    assert not found.identical
    assert [(each.where.sheet, each.says) for each in found.shown.differences] == [("Results", 12.5)]
    assert found.shown.left_out == ()


@pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))
def test_a_result_that_another_program_has_saved_with_fewer_digits(results, tmp_path):
    profile = f"-env:UserInstallation=file://{tmp_path}/profile"
    command = ["soffice", "--headless", profile, "--convert-to", "xlsx", "--outdir", str(tmp_path), str(results)]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    found = replay(tmp_path / results.name)
    assert (found.changes, found.shown.differences, found.shown.missing) == ((), (), ())
    assert found.identical


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
    run = xlmc.load(folder / "book.xlsx").simulate(trials=500)
    run.save(folder / "r.xlsx")
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
    found = replay(with_values(path, tmp_path / "edited.xlsx", {"B1": ("n", "12.5"), "B3": ("n", "77")}))
    mean = run["S!A2"].mean.value
    assert [(str(d.where), d.says, d.gives) for d in found.shown.differences] == [
        ("S!B1", 12.5, mean),
        ("S!B3", 77, ErrorCode.NA),
    ]


def test_what_a_program_without_the_add_in_shows_is_no_edit(own, tmp_path):
    names = dict.fromkeys(("B1", "B2", "B3"), ("e", "#NAME?"))
    found = replay(with_values(own[0], tmp_path / "saved.xlsx", names))
    assert found.identical
    assert "3 cells that show results of the run: a program without the add-in" in found.shown.left_out[0]
