"""Every workbook of the conformance folder, where that folder is at hand."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import openpyxl
import pytest

from xlmc.errors import WorkbookError
from xlmc.workbook.inject import inject, original_hash, remove_result_sheets
from xlmc.workbook.injection.content_types import roles
from xlmc.workbook.injection.splice import as_utf8, parse_spans
from xlmc.workbook.package import read_parts
from xlmc.workbook.structure import read_structure
from xlmc.workbook.writer import package_bytes

FOLDER = Path(__file__).parents[4] / "shared" / "conformance" / "workbooks"
BOOKS = sorted(FOLDER.glob("*.xls?")) if FOLDER.is_dir() else []
LARGE = 1 << 20
BROKEN = {"apache__clusterfuzz-testcase-minimized-POIXSSFFuzzer-5937385319563264.xlsx"}

pytestmark = pytest.mark.skipif(not BOOKS, reason="the conformance workbooks are not at hand")


def said(parts, name):
    return parse_spans(as_utf8(parts[name], name), name).canonical()


def sheet_names(data):
    """The sheets as openpyxl reads them; None where it cannot. What it warns of losing does not matter here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return openpyxl.load_workbook(io.BytesIO(data)).sheetnames
        except Exception:  # openpyxl has no common error; any means that it cannot read the file
            return None


PORTIONS = 4
"""Every fourth workbook is a test, so that processes share them."""


@pytest.fixture(params=range(PORTIONS))
def hosts(request):
    """The name and the parts of each."""
    whole = [book for book in BOOKS if book.name not in BROKEN]
    return ((book.name, read_parts(book.read_bytes())) for book in whole[request.param :: PORTIONS])


def test_only_the_five_change_and_removal_undoes_it(hosts, results, other_results, subtests):
    for name, host in hosts:
        with subtests.test(name):
            _inject_and_remove(host, results, other_results)


def _inject_and_remove(host, results, other_results):
    once = inject(host, results)
    changing = roles(once).changing
    assert len(changing) <= 5
    assert {name for name in host if once[name] != host[name]} <= changing
    back = remove_result_sheets(once)
    assert back.keys() == host.keys()
    for name in changing - {roles(once).styles}:
        assert said(back, name) == said(host, name)
    assert original_hash(once) == original_hash(host)
    assert list(inject(inject(once, other_results), results).items()) == list(once.items())


def test_openpyxl_reads_the_result_where_it_read_the_workbook(hosts, results, subtests):
    """But the largest, for which openpyxl takes seconds."""
    for name, host in hosts:
        if sum(map(len, host.values())) <= LARGE:
            with subtests.test(name):
                _inject_and_open(host, results)


def _inject_and_open(host, results):
    names = sheet_names(package_bytes(inject(host, results)))
    if names is None:
        assert sheet_names(package_bytes(host)) is None
    else:
        assert names[-3:] == ["Results", "Chevy's chart", "Trials"]
        assert len(names) == 3 + len(read_structure(host).sheets)


@pytest.mark.parametrize("name", sorted(BROKEN))
def test_a_damaged_workbook_says_so(name):
    with pytest.raises(WorkbookError, match="damaged"):
        read_parts((FOLDER / name).read_bytes())
