from __future__ import annotations

import openpyxl
import pytest

import xlmc


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """The sheets on sensitivity take longest to write, and no test here looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("xlmc.report.book.write_dependence", lambda *_: None)
        yield


@pytest.fixture(scope="module")
def results(small_book, tmp_path_factory):
    """A result workbook as xlmc wrote it."""
    path = tmp_path_factory.mktemp("results") / "small-results.xlsx"
    xlmc.load(small_book).simulate().save(path)
    return path


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
