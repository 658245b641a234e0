"""Paths that cannot be read or written are refused in one line, with the file and what to do; nothing is touched."""

from __future__ import annotations

import os
import shutil

import pytest

import xlmc as package
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import read_seal

pytestmark = pytest.mark.usefixtures("short_books")

LONG = "x" * 300


@pytest.fixture
def book(small_book, tmp_path):
    return shutil.copy(small_book, tmp_path / "book.xlsx")


def refuse_looking(monkeypatch, folder):
    """A folder that may not be entered, which root could enter all the same."""
    looked_at = os.stat

    def look(path, *arguments, **options):
        if isinstance(path, str | os.PathLike) and os.fspath(path).startswith(f"{folder}{os.sep}"):
            raise PermissionError(13, "Permission denied", os.fspath(path))
        return looked_at(path, *arguments, **options)

    monkeypatch.setattr(os, "stat", look)


@pytest.mark.parametrize(
    "option",
    [
        ("-o", ".xlsx"),
        ("--html", ".html"),
        ("--json", ".json"),
        ("--extract", ".csv"),
        ("--save-run", ".xlmcrun"),
        ("--pdf", ".pdf"),
    ],
    ids=lambda option: option[0],
)
def test_names_that_are_too_long(xlmc, book, tmp_path, option):
    outcome = xlmc("simulate", book, "-n", 50, option[0], tmp_path / (LONG + option[1]))
    assert outcome.code == 2
    assert outcome.err.endswith("The file cannot be written (File name too long). Name another file.\n")
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]


def test_results_whose_default_name_is_too_long(xlmc, book, tmp_path):
    long = shutil.move(book, tmp_path / f"{'x' * 245}.xlsx")
    outcome = xlmc("simulate", long, "-n", 50)
    assert outcome.code == 2
    assert "File name too long). Name another file." in outcome.err
    assert "Results are in" in xlmc("simulate", long, "-n", 50, "-o", tmp_path / "a.xlsx").out


def test_a_folder_that_may_not_be_entered(xlmc, book, tmp_path, monkeypatch):
    closed = tmp_path / "closed"
    closed.mkdir()
    refuse_looking(monkeypatch, closed)
    outcome = xlmc("simulate", book, "-n", 50, "-o", closed / "a.xlsx")
    assert (outcome.code, outcome.err.count("\n")) == (2, 1)
    assert "a.xlsx: The file is in use or may not be written. Close it" in outcome.err
    with pytest.raises(WorkbookError, match="may not be written"):
        package.load(book).simulate(50).save(closed / "a.xlsx")


def test_a_read_only_folder_is_named(xlmc, book, tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    for command in (("simulate", book, "-n", 50), ("new", "skid", tmp_path / "a.xlsx")):
        outcome = xlmc(*command)
        assert outcome.code == 2
        assert f"The folder {str(tmp_path)!r} may not be written to. Name a file in another folder" in outcome.err


@pytest.mark.skipif(os.name == "nt", reason="Windows allows no such names")
@pytest.mark.parametrize("name", ["esc\x1b[31m.xlsx", os.fsdecode(b"l\xe9on.xlsx")], ids=ascii)
def test_a_saved_run_of_a_book_with_a_hostile_name_is_its_own(xlmc, book, tmp_path, name):
    odd = shutil.move(book, tmp_path / name)
    for _ in range(2):
        outcome = xlmc("simulate", odd, "-n", 50, "--save-run", tmp_path / "a.xlmcrun", "--html", tmp_path / "a.html")
        assert outcome.code != 2, outcome.err
        assert "results go to" not in outcome.err


@pytest.mark.parametrize("name", ["book", ".xlsx"])
def test_a_book_without_an_ending_has_no_results(xlmc, book, tmp_path, name):
    bare = shutil.move(book, tmp_path / name)
    outcome = xlmc("simulate", bare, "-n", 50)
    assert outcome.code == 2
    assert f"{name}: The name of the workbook has no ending. Rename it, such as" in outcome.err
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_new_says_whose_results_are_in_the_way(xlmc, book, tmp_path):
    xlmc("simulate", book, "-n", 50)
    outcome = xlmc("new", "skid", tmp_path / "book-results.xlsx")
    assert outcome.code == 2
    assert "it holds results of 'book.xlsx'. Name another file" in outcome.err
    assert read_seal(tmp_path / "book-results.xlsx").whole


def test_a_folder_is_no_saved_run(xlmc, tmp_path):
    outcome = xlmc("report", tmp_path)
    assert outcome.code == 2
    assert "The file cannot be read (Is a directory). Name a saved run, which ends in .xlmcrun" in outcome.err
