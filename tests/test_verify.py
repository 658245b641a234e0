"""What counts as the value that Excel saved."""

from __future__ import annotations

import math

import pytest

from xlmc.verify import Status, verify

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
