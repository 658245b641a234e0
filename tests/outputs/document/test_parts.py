"""What all writers of a document read: the widths of tables."""

from __future__ import annotations

import pytest

from xlmc.outputs.document.parts import HALF, Document, Drawing, Figure, Heading, Paragraph, Table


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


@pytest.mark.parametrize(
    ("widths", "rows"),
    [
        ([HALF, HALF], [2]),
        ([HALF, HALF, HALF], [2, 1]),
        ([160.0, HALF, HALF], [0, 2]),
        ([HALF, 160.0, HALF], [1, 0, 1]),
        ([160.0, 160.0], [0, 0]),
    ],
)
def test_two_narrow_figures_stand_side_by_side(widths, rows):
    svg = '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>'
    figures = [Figure(Drawing(svg, "nothing", width), f"figure {number}") for number, width in enumerate(widths)]
    laid_out = Document("", "", None, "", "", (), (Heading("a"), *figures, Paragraph("z"))).with_next
    assert [after for _, after in laid_out[:1]] == figures[:1]
    assert laid_out[-1] == (Paragraph("z"), None)
    assert [len(each) if isinstance(each, tuple) else 0 for each, _ in laid_out[1:-1]] == rows
    assert [each for row, _ in laid_out[1:-1] for each in (row if isinstance(row, tuple) else [row])] == figures


def test_the_lines_of_a_table_are_counted():
    words = "a reason that takes several lines where its column is narrow, as it is here " * 3
    table = Table("", ("Name", "Because"), (("one", "short"), ("two", words), ("a\nb\nc", "short")), widths=(1.0, 1.0))
    assert len(words) > 4 * 105 / 2
    assert table.lines == 1 + 5 + 3
