from __future__ import annotations

import hashlib
import io
import shutil
from pathlib import Path

import openpyxl
import pytest
from fewer_sheets import CHARTS, FEW, SENSITIVITY, SHORT, fill_sheets, keep_few_trials, leave_out
from simulated import simulated

from xlmc.api import Simulation
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.loading import load
from xlmc.outputs import save
from xlmc.outputs.sheets.book import SHEETS

EXAMPLE = Path(__file__).resolve().parents[3] / "examples/intersection.xlsx"
MAY_CHANGE = {
    "[Content_Types].xml",
    "xl/workbook.xml",
    "xl/_rels/workbook.xml.rels",
    "xl/styles.xml",
    "docProps/app.xml",
}


@pytest.fixture
def book(small_book, tmp_path):
    return Path(shutil.copy(small_book, tmp_path / "scene.xlsx"))


@pytest.fixture
def case(book):
    return simulated(load(book))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A workbook, a run of it, and the file that this was saved in with all its sheets, most of them empty."""
    folder = tmp_path_factory.mktemp("whole")
    book = Path(shutil.copy(EXAMPLE, folder / "scene.xlsx"))
    run = simulated(load(book), trials=5_000)
    with pytest.MonkeyPatch.context() as patch:
        fill_sheets(patch, *SHORT)
        return book, run, save(run, folder / "out.xlsx", rows=FEW)


@pytest.fixture
def short_books(monkeypatch):
    """Without what takes longest to write."""
    leave_out(monkeypatch, *CHARTS, *SENSITIVITY)
    keep_few_trials(monkeypatch)


def sheets(path):
    return list(read_workbook(path).sheets)


def rows(path, sheet):
    """The values of a sheet's rows."""
    return openpyxl.load_workbook(io.BytesIO(path.read_bytes()), read_only=True)[sheet].iter_rows(values_only=True)


def test_results_stand_behind_the_users_sheets(whole):
    book, _, path = whole
    wanted = [sheet.name for sheet in SHEETS if sheet.name not in ("Evidence results", "Scenarios")]
    assert sheets(path) == [*sheets(book), *wanted]
    assert book.read_bytes() == EXAMPLE.read_bytes()


def test_all_other_parts_stay_byte_for_byte(whole):
    own, saved = (read_parts(path.read_bytes()) for path in (whole[0], whole[2]))
    assert {name for name in own if saved[name] != own[name]} <= MAY_CHANGE


def test_the_sheets_show_what_the_simulation_says(case, short_books, tmp_path):
    written = rows(save(case, tmp_path / "out.xlsx"), "Results")
    first_of = reversed([row for row in written if row and row[0] in case.forecasts])
    shown_of = {row[0]: row for row in first_of}  # a later table has the names, too
    for name, result in case.results.items():
        low, high = result.central()
        shown = (result.mean, result.standard_deviation, low, high)
        assert list(shown_of[name][3:11]) == [number for each in shown for number in (each.value, each.error)]


def test_saving_twice_gives_the_same_file(case, short_books, tmp_path):
    path = save(case, tmp_path / "out.xlsx")
    first = path.read_bytes()
    assert save(case, path).read_bytes() == first


def test_a_run_of_a_result_workbook_replaces_its_sheets(case, short_books, tmp_path):
    path = save(case, tmp_path / "out.xlsx")
    again = simulated(load(path))
    assert sheets(save(again, tmp_path / "again.xlsx")) == sheets(path)


def test_writing_into_the_workbook_itself_must_be_asked_for(case, short_books, book):
    before = book.read_bytes()
    with pytest.raises(WorkbookError, match=r"This is the file that is read\. .*--in-place"):
        save(case, book)
    assert book.read_bytes() == before
    save(case, book, overwrite=True)
    assert "Results" in sheets(book)


def test_a_workbook_that_has_changed_since_is_not_overwritten(case, book):
    changed = book.read_bytes() + b"\0"
    book.write_bytes(changed)
    with pytest.raises(WorkbookError, match=r"changed since it was read\. Run again"):
        save(case, book, overwrite=True)
    assert book.read_bytes() == changed


def test_a_workbook_that_is_gone_does_not_matter(case, short_books, book, tmp_path):
    book.unlink()
    assert save(case, tmp_path / "out.xlsx").stat().st_size > 1000


def test_the_ending_must_be_the_workbooks_own(case, tmp_path):
    with pytest.raises(WorkbookError, match=r"must end in \.xlsx\. Name it 'out\.xlsx'"):
        save(case, tmp_path / "out.xlsm")
    assert not (tmp_path / "out.xlsm").exists()


def test_a_file_that_is_open_is_refused(case, tmp_path):
    (tmp_path / "out.xlsx").write_bytes(b"old")
    (tmp_path / "~$out.xlsx").write_bytes(b"")
    with pytest.raises(WorkbookError, match="holds the workbook open"):
        save(case, tmp_path / "out.xlsx")


def test_the_record_names_the_file_the_run_came_from(case, short_books, book, tmp_path):
    record = rows(save(case, tmp_path / "out.xlsx", command="xlmc simulate scene.xlsx"), "Record")
    result = {row[0]: row[2] for row in record if len(row) > 2 and row[0]}
    assert result["file.sha256"] == hashlib.sha256(book.read_bytes()).hexdigest()
    assert result["run.command"] == "xlmc simulate scene.xlsx"
    assert result["run.repeat"] == "xlmc simulate scene.xlsx --trials 400 --seed 7"


def test_a_simulation_saves_itself(case, short_books, tmp_path):
    Simulation(case).save(tmp_path / "out.xlsx")
    assert "Record" in sheets(tmp_path / "out.xlsx")
