"""Every formula cell of the Excel-saved workbooks beside the project, recomputed and held against Excel's own value.

The folder is not part of the project; without it the test is skipped. What counts is in `benchmarks/conformance.py`,
which prints the same figures and lists what is refused and what differs.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median

import pytest

from xlmc.analysis.studies.verify import Status

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT.parent / "shared" / "conformance"
sys.path.append(str(ROOT / "benchmarks"))

# Book, sheet -> why they differ. A book or sheet that is not here must not differ.
EXPLAINED = {
    ("apache__61495-test.xlsm", "TEST"): "saved where a comma is the decimal sign: TEXT's format means something else",
    ("tamc__string.xlsx", "Sheet1"): "Excel's saved text has carriage returns that the cell it copies no longer has",
}

pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason="the Excel-saved workbooks are not beside the project")


@pytest.fixture(scope="module")
def checked():
    from conformance import check_folder

    return check_folder(FOLDER)


def test_by_cell(checked):
    assert len(checked.cells()) > 27_000
    assert checked.cell_share() >= 0.998


def test_what_differs_is_explained(checked):
    for cell in checked.cells():
        if cell.status is Status.DIFFERING:
            check = cell.check
            assert (cell.book, check.cell.sheet) in EXPLAINED, f"{cell.book} {check.cell} ={check.formula}: {check.got}"
    assert checked.cell_share(Status.DIFFERING) <= 0.0002


def test_by_shape(checked):
    assert checked.shape_share() >= 0.99


def test_by_book(checked):
    shares = checked.book_shares()
    assert median(shares) == 1.0
    assert sum(share >= 0.9 for share in shares) >= 0.9 * len(shares)
