"""Which layout a sheet gets."""

from __future__ import annotations

import pytest

from xlmc.outputs.sheets.paper import MOST_ACROSS, MOST_UPRIGHT, SMALLEST, lay_out


def test_what_fits_is_one_page_in_the_direction_of_the_larger_letters():
    wide, high = lay_out(600.0, [15.0] * 30, []), lay_out(500.0, [15.0] * 45, [])
    assert (wide.whole, wide.upright, wide.scale) == (True, False, 1.0)
    assert (high.whole, high.upright, high.scale) == (True, True, 1.0)


def test_letters_shrink_before_a_page_is_begun_but_never_below_what_can_be_read():
    result = lay_out(500.0, [15.0] * 60, [])
    assert result.whole
    assert SMALLEST <= result.scale < 1.0
    longer = lay_out(500.0, [15.0] * 100, list(range(0, 100, 10)))
    assert not longer.whole
    assert longer.breaks == (40, 80)
    assert longer.pages == 3
    assert longer.scale >= SMALLEST


@pytest.mark.parametrize(("width", "upright"), [(MOST_UPRIGHT, True), (MOST_ACROSS, False)])
def test_the_widest_sheets_have_the_smallest_letters(width, upright):
    result = lay_out(width, [15.0] * 200, list(range(0, 200, 5)))
    assert result.upright == upright
    assert result.scale == pytest.approx(SMALLEST)


def test_a_page_takes_as_many_whole_parts_as_it_has_room_for():
    room = lay_out(MOST_UPRIGHT, [1.0] * 2_000, range(2_000), whole=False).breaks[0]
    parts = [room // 3] * 7
    assert lay_out(MOST_UPRIGHT, parts, range(7), whole=False).breaks == (3, 6)
    assert lay_out(MOST_UPRIGHT, parts, range(7), room // 3, whole=False).breaks == (3, 5)  # repeated rows take room
    assert lay_out(MOST_UPRIGHT, parts, [2, 4, 6], whole=False).breaks == (2, 4)


def test_a_part_that_has_no_room_on_a_page_counts_as_several():
    assert lay_out(MOST_ACROSS, [15.0] * 300, [], whole=False).pages > 2


def test_a_sheet_wider_than_any_page_is_printed_as_large_as_it_can_be():
    result = lay_out(2_000.0, [15.0] * 10, [])
    assert not result.upright
    assert result.scale < SMALLEST
