from __future__ import annotations

import os

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import sealed_text
from xlmc.excel.workbook.target import Target, free_target, refuse_same_file, same_name
from xlmc.excel.workbook.writer import TakenError, check_folder, write_workbook

OURS = sealed_text(b"<html>", ".html", "case.xlsx")


def page(path, content=OURS):
    path.write_bytes(content)
    return path


def test_a_new_file_and_our_own_may_be_written(tmp_path):
    Target(tmp_path / "new.html", "case.xlsx").check()
    Target(page(tmp_path / "ours.html"), "CASE.xlsx").check()


def test_a_copy_of_what_xlmc_hands_out_may_be_replaced_until_it_is_edited(tmp_path):
    handed_out = [page(tmp_path / "one.xlsx", b"template one"), page(tmp_path / "two.xlsx", b"template two")]
    copy = page(tmp_path / "copy.xlsx", b"template two")
    assert Target(copy, "copy.xlsx", untouched=handed_out).foreign is None
    assert Target(copy, "copy.xlsx").foreign is not None
    copy.write_bytes(b"template two, edited")
    assert Target(copy, "copy.xlsx", untouched=handed_out).foreign is not None


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.html", b"<html>my notes</html>", "xlmc did not write it, or another program has saved it since"),
        (
            "a.html",
            sealed_text(b"<html>", ".html", "other.xlsx"),
            "it holds results of 'other.xlsx', not of 'case.xlsx'",
        ),
        ("a.html", b" " + OURS, "it was changed since xlmc wrote it"),
        ("a.csv", b"1", "xlmc cannot tell who wrote a .csv"),
        ("a", b"1", "xlmc cannot tell who wrote a file without ending"),
        ("a.xlsx", b"text", "xlmc did not write it"),
    ],
)
def test_what_others_wrote_is_replaced_only_when_asked_for(tmp_path, name, content, reason):
    path = page(tmp_path / name, content)
    with pytest.raises(TakenError, match=f"The file exists already, and {reason}.*--overwrite") as caught:
        Target(path, "case.xlsx").check()
    assert caught.value.where == str(path)
    Target(path, "case.xlsx", overwrite=True).check()


def test_a_file_that_is_read_is_spared_whatever_is_asked_for(tmp_path):
    book, page = tmp_path / "book.xlsx", tmp_path / "page.html"
    book.write_bytes(b"mine")
    page.symlink_to(book)
    for path in (book, page):
        with pytest.raises(TakenError, match="This is the file that is read"):
            Target(path, "", overwrite=True, read=[tmp_path / "none.xlsx", book]).check()


def test_a_file_that_cannot_be_read_is_not_ours(tmp_path, monkeypatch):
    path = page(tmp_path / "a.html")

    def fail(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr("xlmc.excel.workbook.target.read_seal", fail)
    with pytest.raises(TakenError, match="cannot be read"):
        Target(path, "case.xlsx").check()


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda path: path.mkdir(), "This is a folder, not a file"),
        (lambda path: path.symlink_to("nowhere.html"), r"This is a link to '.*nowhere\.html', which is not there"),
        (os.mkfifo, "This is a device or a pipe"),
        (lambda path: page(path).chmod(0o444), "read-only"),
    ],
)
def test_what_is_no_file_is_refused_whatever_is_asked_for(tmp_path, make, message, overwrite):
    path = tmp_path / "a.html"
    make(path)
    before = sorted((left.name, left.lstat().st_mode) for left in tmp_path.iterdir())
    target = Target(path, "case.xlsx", overwrite)
    for attempt in (target.check, lambda: write_workbook(path, b"new", target.check), lambda: check_folder(path)):
        with pytest.raises(TakenError, match=message) as caught:
            attempt()
        assert caught.value.where == str(path)
    assert sorted((left.name, left.lstat().st_mode) for left in tmp_path.iterdir()) == before


def test_the_first_free_number_or_our_own_is_found(tmp_path):
    wanted = tmp_path / "a.html"
    assert free_target(wanted, "case.xlsx") == (wanted, None)
    page(wanted, b"mine")
    result, reason = free_target(wanted, "case.xlsx")
    assert result == tmp_path / "a-2.html"
    assert "xlmc did not write it" in reason
    (tmp_path / "a-2.html").mkdir()
    (tmp_path / "a-3.html").symlink_to("nowhere")
    assert free_target(wanted, "case.xlsx")[0] == tmp_path / "a-4.html"
    page(tmp_path / "a-4.html")
    assert free_target(wanted, "case.xlsx")[0] == tmp_path / "a-4.html"
    assert free_target(wanted, "case.xlsx", after=tmp_path / "a-4.html")[0] == tmp_path / "a-5.html"


def test_a_file_that_appears_while_ours_is_written_is_not_replaced(tmp_path):
    path = tmp_path / "a.html"
    target = Target(path, "case.xlsx")
    target.check()
    page(path, b"mine")
    with pytest.raises(TakenError, match="xlmc did not write it"):
        write_workbook(path, OURS, target.check)
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("a.html", b"mine")]


def test_a_file_that_appears_at_the_last_moment_is_not_replaced(tmp_path):
    """Between the last check and the name."""
    path = tmp_path / "a.html"
    target = Target(path, "case.xlsx")
    seen = []

    def check():
        seen.append(path.exists())
        target.check()
        if not path.exists():
            page(path, b"mine")

    with pytest.raises(TakenError, match="xlmc did not write it"):
        write_workbook(path, OURS, check)
    assert seen == [False, True]
    assert path.read_bytes() == b"mine"
    assert [left.name for left in tmp_path.iterdir()] == ["a.html"]


@pytest.mark.parametrize("second", ["a.csv", "./a.csv", "A.CSV", "b/../a.csv", "link.csv", "hard.csv"])
def test_two_outputs_in_one_file_are_refused(tmp_path, monkeypatch, second):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "b").mkdir()
    first = page(tmp_path / "a.csv")
    (tmp_path / "link.csv").symlink_to("a.csv")
    (tmp_path / "hard.csv").hardlink_to(first)
    with pytest.raises(WorkbookError, match="Two outputs would be written to this file"):
        refuse_same_file([first, tmp_path / "c.csv", type(first)(second)])


def test_outputs_of_other_names_are_not_one(tmp_path):
    refuse_same_file([tmp_path / "a.csv", tmp_path / "a.json", tmp_path / "b.csv"])


def test_names_that_are_one_where_case_does_not_count():
    assert same_name("Book.xlsx", "book.XLSX")
    assert same_name("\u00fc.xlsx", "u\u0308.xlsx")
    assert same_name("\u00fc.xlsx", "\udcc3\udcbc.xlsx")  # as Python reads it where the settings speak of ASCII
    assert not same_name("book.xlsx", "book2.xlsx")
