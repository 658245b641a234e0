from __future__ import annotations

import openpyxl
import pytest
from fewer_sheets import CHARTS, SENSITIVITY, keep_few_trials, leave_out, leave_out_drawings, leave_out_shapes

import xlmc
from xlmc.report.sheets import book as result_sheets

_WHOLE = result_sheets.SHEETS


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """What takes longest to write and to read, and no test here looks at: charts, shapes, sensitivity, many trials.

    `tests/cli/test_replay.py` has whole books.
    """
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        keep_few_trials(patch)
        leave_out_shapes(patch)
        yield


@pytest.fixture(scope="module")
def results(small_book, tmp_path_factory):
    """A result workbook as xlmc wrote it."""
    path = tmp_path_factory.mktemp("results") / "small-results.xlsx"
    xlmc.load(small_book).simulate().save(path)
    return path


@pytest.fixture
def drawn(small_book, tmp_path, monkeypatch):
    """As `results`, with the curves that are written for charts; the charts themselves are not looked at."""
    monkeypatch.setattr(result_sheets, "SHEETS", _WHOLE)
    leave_out_drawings(monkeypatch)
    return xlmc.load(small_book).simulate().save(tmp_path / "small-results.xlsx")


@pytest.fixture
def edited(results, tmp_path):
    """`edited(change)`: the result workbook after a person's change to it, saved by another program."""

    def edit(change, source=results):
        book = openpyxl.load_workbook(source)
        change(book)
        path = tmp_path / "edited.xlsx"
        book.save(path)
        return path

    return edit
