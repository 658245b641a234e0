"""What is written of a changed state: results that say so and can be repeated, copies, the workbook itself."""

from __future__ import annotations

import json

import openpyxl
import pytest
from fewer_sheets import SHORT, keep_few_trials, keep_sheets, leave_out_fits
from live_books import change, settle, simple, small
from old_format_book import plain_book

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.saved import open_run
from xlmc.errors import DefinitionError, WorkbookError, XlmcError
from xlmc.excel.workbook.other_formats import joined_package
from xlmc.excel.workbook.package import read_parts
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live import hand_over
from xlmc.outputs.live.hand_over import save_result, write_changes
from xlmc.outputs.live.protocol import PageMessage
from xlmc.outputs.live.session import Session
from xlmc.outputs.replay import recorded_run, replay


@pytest.fixture
def book(tmp_path):
    return small(tmp_path / "case.xlsx")


@pytest.fixture
def state(book):
    """The window of a workbook, at rest, with one number moved."""
    return moved(book)


def moved(book):
    session = Session(load(book))
    name, mean = first(session.own)
    session.receive(change(name, "mean", mean * 0.98))
    settle(session)
    return session.at_rest()


def first(model):
    """The first assumption that is drawn and has a mean, and the mean."""
    result = next(each for each in model.live if "mean" in each.parameters)
    return result.name, result.parameters["mean"]


def test_results_of_a_changed_state_say_so_first_and_can_be_repeated(state, book, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    keep_few_trials(monkeypatch)
    (message,) = state.changes
    path = save_result(state, book, "book")
    assert path.name == "case-changed-results.xlsx"
    sheet = openpyxl.load_workbook(path)["Results"]
    texts = [cell.value for row in sheet.iter_rows(max_row=8) for cell in row if isinstance(cell.value, str)]
    assert any(text.startswith("These are not results of case.xlsx as it is") and message in text for text in texts)
    again = replay(path)
    assert again.to_the_last_bit
    assert again.record["changed.name"] == "case.xlsx"
    assert again.record["changed.sha256"] == state.own.workbook.sha256 != again.record["file.sha256"]
    assert [row["change"] for row in again.record.rows("changed")] == [message]
    assert "COPY.xlsx" in again.record["run.repeat"]
    assert recorded_run(path).changed_from.changes == (message,)
    own = openpyxl.load_workbook(path)
    row = next(each for each in state.own.assumptions if each.name == first(state.own)[0]).row
    assert first(state.own)[1] * 0.98 in [cell.value for cell in own[row.sheet][row.row]]


def test_saved_runs_pages_and_json_carry_the_changes(state, book, monkeypatch):
    leave_out_fits(monkeypatch)
    (message,) = state.changes
    run = open_run(save_result(state, book, "run"))
    assert run.changed_from.changes == (message,)
    assert make_record(run).rows("changed") == [{"change": message}]
    assert run.forecasts.keys() == state.run.forecasts.keys()
    page = save_result(state, book, "page").read_text("utf-8")
    assert "These are not results of case.xlsx as it is" in page
    result = json.loads(save_result(state, book, "json").read_text("utf-8"))
    assert result["record"]["changed"]["rows"] == [{"change": message}]


def test_files_are_named_by_the_scenario(book):
    session = Session(load(book))
    name, mean = first(session.own)
    session.receive(change(name, "mean", mean * 0.98))
    session.receive(PageMessage("keep", {"name": "wet / cold..\\road"}))
    settle(session)
    assert save_result(session.at_rest(), book, "json").name == "case-wet _ cold.._road-results.json"
    session.receive(PageMessage("show", {"name": ""}))
    settle(session)
    assert save_result(session.at_rest(), book, "json").name == "case-results.json"


def test_a_state_whose_run_is_not_done_is_not_written(book):
    session = Session(load(book))
    with pytest.raises(XlmcError, match="not done yet"):
        session.at_rest()
    settle(session)
    name, mean = first(session.own)
    session.receive(change(name, "mean", mean * 0.98))
    with pytest.raises(XlmcError, match="not done yet"):
        session.at_rest()


def test_other_numbers_than_the_window_shows_are_never_written(state, book, monkeypatch):
    monkeypatch.setattr(hand_over, "run_model", lambda model, options: state_of(book))
    with pytest.raises(XlmcError, match="other numbers than the window shows"):
        save_result(state, book, "json")
    assert [each.name for each in book.parent.iterdir()] == ["case.xlsx"]


def state_of(book):
    """A run of the workbook without the changes."""
    session = Session(load(book))
    settle(session)
    return session.rest


def test_changes_are_typed_into_a_copy_or_into_the_workbook_of_which_a_copy_is_kept(tmp_path):
    book = simple(tmp_path / "case.xlsx")  # as Excel saved it
    state, before = moved(book), book.read_bytes()
    messages = write_changes(state, book, into=False)
    assert messages.startswith(f"Written: {book.with_name('case-changed.xlsx')}. 1 cell was typed into")
    assert book.read_bytes() == before
    name, mean = first(state.own)
    assert first(load(book.with_name("case-changed.xlsx"))) == (name, mean * 0.98)
    messages = write_changes(state, book, into=True)
    assert messages.startswith("Typed into case.xlsx. 1 cell was typed into")
    assert messages.endswith("The workbook as it was: case-before.xlsx")
    assert book.with_name("case-before.xlsx").read_bytes() == before
    assert first(load(book)) == (name, mean * 0.98)
    session = Session(state.own)
    session.receive(change(name, "mean", mean * 0.98))
    session.replace_book(load(book), [])
    assert not session.adjustments  # the workbook says it now


def test_the_workbook_is_not_written_while_excel_has_it_or_after_it_was_saved(state, book):
    before = book.read_bytes()
    lock = book.with_name("~$case.xlsx")
    lock.write_bytes(b"\x04Anna".ljust(165, b" "))
    with pytest.raises(WorkbookError):
        write_changes(state, book, into=True)
    lock.unlink()
    saved = openpyxl.load_workbook(book)
    saved.save(book)
    changed = book.read_bytes()
    with pytest.raises(WorkbookError, match="has changed since it was read"):
        write_changes(state, book, into=True)
    assert book.read_bytes() == changed != before
    assert [each.name for each in book.parent.iterdir()] == ["case.xlsx"]


def test_a_change_that_no_table_has_room_for_is_told_with_the_column(book):
    session = Session(load(book))
    name, _ = first(session.own)
    lacking = openpyxl.load_workbook(book)
    row = next(each for each in session.own.assumptions if each.name == name).row
    sheet = lacking[row.sheet]
    heading = next(cell for cells in sheet.iter_rows() for cell in cells if cell.value == "Frozen")
    table = next(each for each in sheet.tables.values() if each.name.startswith("xlmc_assumptions"))
    for column in table.tableColumns:
        if column.name == "Frozen":
            column.name = heading.value = "Remark"
    lacking.save(book)
    session = Session(load(book))
    session.receive(change(name, "frozen", value=True))
    settle(session)
    with pytest.raises(DefinitionError, match="needs a column Frozen"):
        save_result(session.at_rest(), book, "json")


def test_of_an_old_workbook_results_and_copies_are_new_ones_and_nothing_is_typed_into_it(tmp_path, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    keep_few_trials(monkeypatch)
    parts = read_parts(small(tmp_path / "source.xlsx").read_bytes())
    monkeypatch.setattr(joined_package, "parts_of_other_format", lambda *_: parts)
    book = tmp_path / "case.xls"
    book.write_bytes(plain_book({"S": b""}))
    before, session = book.read_bytes(), Session(load(book))
    settle(session)
    assert save_result(session.at_rest(), book, "book").name == "case-results.xlsx"
    name, mean = first(session.own)
    session.receive(change(name, "mean", mean * 0.98))
    settle(session)
    state = session.at_rest()
    assert save_result(state, book, "book").name == "case-changed-results.xlsx"
    assert "case-changed.xlsx." in write_changes(state, book, into=False)
    assert first(load(tmp_path / "case-changed.xlsx")) == (name, mean * 0.98)
    with pytest.raises(WorkbookError, match="does not write into it"):
        write_changes(state, book, into=True)
    assert book.read_bytes() == before
    assert not list(tmp_path.glob("*-before*"))
