"""Where an area goes on so far beyond what is filled that it is cut."""

from __future__ import annotations

import pytest

from xlmc.excel.address import MAX_ROW
from xlmc.excel.formula.areas import is_far


@pytest.mark.parametrize(
    ("end", "used", "far"),
    [
        (MAX_ROW, 10, True),
        (MAX_ROW, MAX_ROW - 1, True),
        (MAX_ROW, MAX_ROW, False),
        (10_010, 10, False),
        (10_011, 10, True),
        (20_011, 10_010, True),
        (11, 10, False),
        (10, 10, False),
        (9, 10, False),
    ],
    ids=str,
)
def test_an_area_is_far_at_the_edge_of_the_sheet_or_ten_thousand_cells_beyond_the_last_filled(end, used, far):
    assert is_far(end, used, MAX_ROW) is far
