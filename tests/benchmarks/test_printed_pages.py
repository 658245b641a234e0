from __future__ import annotations

import subprocess
from collections import Counter

import printed_pages
import pytest
from committed_books import BOOKS
from printed_pages import Pages, beyond, table


def test_every_book_is_counted():
    assert BOOKS == printed_pages.BOOKS


@pytest.mark.parametrize(
    ("name", "workbooks", "report", "expected"),
    [
        ("skid", (25, 25), 5, []),
        ("skid", (25, 26), 10, ["skid prints on 26 pages, of 25 at most"]),
        ("intersection", (15,), 10, []),
        ("intersection", (16,), 10, ["intersection prints on 16 pages, of 15 at most"]),
        ("skid", (9,), 4, ["the report of skid has 4 pages, not 5 to 10"]),
        ("skid", (9,), 11, ["the report of skid has 11 pages, not 5 to 10"]),
    ],
)
def test_what_is_beyond_a_bar_is_said(name, workbooks, report, expected):
    pages = Pages(tuple(Counter({"Results": 2, "of the book": count - 2}) for count in workbooks), report)
    assert beyond(name, pages) == expected


def test_the_table_has_the_pages_of_each_font_and_sheet():
    result = {
        "skid": Pages((Counter({"of the book": 4, "Results": 1}), Counter({"of the book": 5, "Results": 1})), 6, 7)
    }
    assert table(result).splitlines()[2:] == ["| skid | 5 | 6 | 6 | 7 |"]
    assert table(result, sheets=True).splitlines()[3:] == ["| … of the book | 4 | 5 | | |", "| … Results | 1 | 1 | | |"]


def test_feet_say_whose_sheet_a_page_is(monkeypatch, tmp_path):
    feet = "skid.xlsx          Page 1 of 3      11/29/2026\n\n text\n skid.xlsx      Filter limits      Page 2 of 3\n"
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: subprocess.CompletedProcess([], 0, stdout=feet))
    assert printed_pages._by_sheet(tmp_path) == Counter({"of the book": 1, "Filter limits": 1})
