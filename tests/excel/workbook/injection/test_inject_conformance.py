"""Workbooks of the conformance folder, where that folder is at hand: one of each make.

Two are of one make if their workbook parts hold the same elements, their styles parts the same lists, and their
packages the same of the parts that result sheets bring along, and the same of those that may change.
"""

from __future__ import annotations

import io
import re
import warnings
from pathlib import Path

import openpyxl
import pytest
from openpyxl.reader import excel
from openpyxl.worksheet._reader import WorksheetReader

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.inject import inject, original_hash
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.host import remove_result_sheets
from xlmc.excel.workbook.injection.splice import as_utf8, parse_spans
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.structure import read_structure
from xlmc.excel.workbook.writer import package_bytes

FOLDER = Path(__file__).parents[5] / "shared" / "conformance" / "workbooks"
BOOKS = sorted(FOLDER.glob("*.xls?")) if FOLDER.is_dir() else []
BROKEN = {"apache__clusterfuzz-testcase-minimized-POIXSSFFuzzer-5937385319563264.xlsx"}

pytestmark = pytest.mark.skipif(not BOOKS, reason="the conformance workbooks are not at hand")


def make(parts):
    """What is alike in the parts that injection reads, in workbooks of one make."""
    role = roles(parts)
    lists = re.findall(rb"<([\w:]*(?:s|Xfs|extLst)) (?:count|uniqueCount)=", parts.get(role.styles, b""))
    kinds = {kind for kind in ("chart", "drawing", "media", "table") if any(f"/{kind}" in name for name in parts)}
    return (
        frozenset(re.findall(rb"<([\w:]+)", parts[role.workbook])),
        frozenset(lists),
        frozenset(kinds | role.changing),
    )


@pytest.fixture(scope="module")
def makes():
    """The makes that were looked at so far."""
    return set()


def text_of(parts, name):
    return parse_spans(as_utf8(parts[name], name), name).canonical()


RESULT_SHEETS = ["Results", "Chevy's chart", "Trials"]


class ReadsResultSheets(WorksheetReader):
    """Passes over the cells of other sheets, whose parts have the same bytes as before."""

    def bind_all(self):
        if self.ws.title in RESULT_SHEETS:
            super().bind_all()


def sheet_names(data):
    """The sheets as openpyxl reads them; None where it cannot. What it warns of losing does not matter here."""
    with warnings.catch_warnings(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(excel, "WorksheetReader", ReadsResultSheets)
        warnings.simplefilter("ignore")
        try:
            return openpyxl.load_workbook(io.BytesIO(data)).sheetnames
        except Exception:  # openpyxl has no common error; any means that it cannot read the file
            return None


@pytest.mark.parametrize("path", [path for path in BOOKS if path.name not in BROKEN] or [None])
def test_only_the_five_change_removal_undoes_it_and_openpyxl_reads_the_result(path, makes, results, other_results):
    """openpyxl reads every fifth workbook; in every sixth the sheets are put in again, which leaves nothing behind.

    Every third has the same hash with them.
    """
    host = read_parts(path.read_bytes())
    if make(host) in makes:
        return
    number = len(makes)
    makes.add(make(host))
    once = inject(host, results)
    role = roles(once)
    changing = role.changing
    assert len(changing) <= 5
    assert {name for name in host if once[name] != host[name]} <= changing
    back = remove_result_sheets(once)
    assert back.keys() == host.keys()
    for name in changing - {role.styles}:
        assert text_of(back, name) == text_of(host, name)
    if number % 3 == 0:
        assert original_hash(once) == original_hash(host)
    if number % 6 == 1:
        assert list(inject(inject(once, other_results), results).items()) == list(once.items())
    if number % 5 == 2:
        _check_reading(once, host)


def _check_reading(once, host):
    names = sheet_names(package_bytes(once))
    if names is None:
        assert sheet_names(package_bytes(host)) is None
    else:
        assert names[-3:] == RESULT_SHEETS
        assert len(names) == 3 + len(read_structure(host).sheets)


def test_there_are_many_makes():
    hosts = [read_parts(path.read_bytes()) for path in BOOKS if path.name not in BROKEN]
    assert len({make(host) for host in hosts}) > 50


@pytest.mark.parametrize("name", sorted(BROKEN))
def test_a_damaged_workbook_says_so(name):
    with pytest.raises(WorkbookError, match="damaged"):
        read_parts((FOLDER / name).read_bytes())
