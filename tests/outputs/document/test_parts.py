"""What all writers of a document read: the widths of tables."""

from __future__ import annotations

import pytest

from xlmc.outputs.document.parts import Table


def test_columns_are_wide_enough_for_their_longest_words():
    heads = ("Name", "Mean", "Because")
    rows = (("Weight", "965,800,000,000 ± 2,000,000,000", "a reason that can be broken wherever it has to be"),)
    narrow = Table("", heads, rows, widths=(1.0, 1.0, 30.0)).relative_widths
    assert sum(narrow) == pytest.approx(1.0)
    assert narrow[1] * 105 >= len("965,800,000,000")
    assert narrow[0] * 105 >= len("Weight")


def test_widths_that_are_enough_stay_as_they_were_given():
    table = Table("", ("A", "B"), (("one", "two"),), widths=(1.0, 3.0))
    assert table.relative_widths == pytest.approx((0.25, 0.75))
    assert table.crowded == 1.0


def test_a_table_of_too_many_long_words_shares_the_page_out_by_them():
    rows = (tuple(["1,069,600,000,000"] * 8),)
    table = Table("", tuple("ABCDEFGH"), rows, widths=tuple(range(1, 9)))
    assert table.relative_widths == pytest.approx([1 / 8] * 8)
    assert table.crowded == pytest.approx(8 * 19 / 105)
