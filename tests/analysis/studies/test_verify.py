"""What counts as the value that Excel saved."""

from __future__ import annotations

import math

import pytest

from xlmc.analysis.studies.verify import Status, verify
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import CellContent, Formula

SHORT_SINE, SHORT_COSINE = 1.22514845490862e-16, 6.1257422745431e-17  # saved by 32-bit Excel


@pytest.mark.parametrize(
    ("formula", "saved", "status"),
    [
        ("=SIN(RADIANS(A1))", SHORT_SINE, Status.MATCHED),
        ("=SIN(A2)", SHORT_SINE, Status.MATCHED),
        ("=SIN(A2)", math.sin(math.pi), Status.MATCHED),
        ("=COS(A2/2)", SHORT_COSINE, Status.MATCHED),
        ("=TAN(A2)", -SHORT_SINE, Status.MATCHED),
        ("=SIN(A2)", 2 * SHORT_SINE, Status.DIFFERING),
        ("=SIN(A2)", -SHORT_SINE, Status.DIFFERING),
        ("=SIN(1)", math.sin(1) * (1 + 2e-9), Status.DIFFERING),
        ("=1*SIN(A2)*1E20", SHORT_SINE * 1e20, Status.DIFFERING),
        ("=A2*1E-20", math.pi * 1e-20 + 2e-20, Status.DIFFERING),
        ("=SIN(A2)", "text", Status.DIFFERING),
    ],
)
def test_a_sine_of_32_bit_excel_is_excels_too(workbook, formula, saved, status):
    book = workbook({"A1": 180.0, "A2": math.pi, "B1": (formula, saved)})
    (check,) = verify(book).cells
    assert check.status is status


def array_in_b1(workbook, text, saved, dynamic=False):
    """An array formula that fills B1:C2, over A1 = 2, with what Excel saved there."""
    formula = Formula(text, 1, 2, array=Area("S", 1, 2, 2, 3), dynamic=dynamic)
    cells = {"B1": CellContent(saved[0], formula), "C1": saved[1], "B2": saved[2], "C2": saved[3]}
    return workbook({"A1": 2.0, **{cell: value for cell, value in cells.items() if value is not None}})


@pytest.mark.parametrize("dynamic", [False, True])
@pytest.mark.parametrize(
    ("text", "saved", "cell", "got"),
    [
        ("A1*{1,2;3,4}", (2.0, 4.0, 6.0, 8.0), "B1", 2.0),
        ("A1*{1,2;3,4}", (2.0, 4.0, 6.0, 8.5), "C2", 8.0),
        ("A1*{1,2;3,4}", (2.0, 4.5, 6.0, 8.5), "C1", 4.0),
        ("A1*{1,2;3,4}", (2.5, 4.5, 6.0, 8.5), "B1", 2.0),
        ("A1*{1,2;3,4}", (2.0, None, 6.0, "x"), "C2", 8.0),
    ],
)
def test_every_cell_of_an_array_is_compared(workbook, text, saved, cell, got, dynamic):
    (check,) = verify(array_in_b1(workbook, text, saved, dynamic)).cells
    assert (check.cell.a1, check.got) == (cell, got)
    assert check.status is (Status.MATCHED if cell == "B1" and saved[0] == got else Status.DIFFERING)
    assert check.anchor in (None, Cell("S", 1, 2))


@pytest.mark.parametrize(
    ("text", "saved", "cell", "got"),
    [
        ("A1*{1,2}", (2.0, 4.0, 2.0, 4.0), "B1", 2.0),
        ("A1*{1,2}", (2.0, 4.0, 2.0, 5.0), "C2", 4.0),
        ('A1*{1;2}&""', ("2", "2", "4", "5"), "C2", "4"),
    ],
)
def test_a_row_or_column_repeats_in_an_array_of_fixed_size_alone(workbook, text, saved, cell, got):
    (fixed,) = verify(array_in_b1(workbook, text, saved)).cells
    assert (fixed.cell.a1, fixed.got) == (cell, got)
    (spilled,) = verify(array_in_b1(workbook, text, saved, dynamic=True)).cells
    assert (spilled.status, spilled.got) == (Status.DIFFERING, None)


def test_an_array_that_is_larger_than_its_area(workbook):
    (check,) = verify(array_in_b1(workbook, "A1*{1,2,3;4,5,6;7,8,9}", (2.0, 4.0, 8.0, 10.0))).cells
    assert check.status is Status.MATCHED
