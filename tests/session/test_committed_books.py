from __future__ import annotations

import re

import pytest
from committed_books import BOOKS, ROOT

LEFT_BY_A_RUN = re.compile(r"^~\$|-results(-\d+)?$")
"""What a run of xlmc leaves beside a book, and Excel while it has one open."""


@pytest.mark.parametrize("name", BOOKS)
def test_every_book_of_the_list_exists(name):
    assert BOOKS[name].read_bytes().startswith(b"PK")


def test_every_book_is_in_the_list():
    lying = [path for folder in ("examples", "templates") for path in (ROOT / folder).rglob("*.xls[xm]")]
    assert sorted(path for path in lying if not LEFT_BY_A_RUN.search(path.stem)) == sorted(BOOKS.values())


def test_no_result_is_in_the_list():
    assert not [name for name in BOOKS if LEFT_BY_A_RUN.search(name)]


def test_no_other_test_takes_the_books_that_happen_to_lie_there():
    """A search through a folder of books finds what a run left there, too."""
    searches = re.compile(r"(examples|templates|EXAMPLES|TEMPLATES)\W.{0,20}(glob|iterdir|listdir|scandir)\(")
    tests = [path for path in (ROOT / "tests").rglob("*.py") if path.parent.name != "session"]
    scripts = [path for folder in ("benchmarks", "docs", "examples") for path in (ROOT / folder).rglob("*.py")]
    assert len(tests) > 300
    assert not [str(path) for path in (*tests, *scripts) if searches.search(path.read_text(encoding="utf-8"))]
