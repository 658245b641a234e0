"""What all writers of a document read: the widths of tables."""

from __future__ import annotations

import math

import pytest

from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import (
    HALF,
    Bar,
    Bars,
    Bullets,
    Chart,
    Document,
    Drawing,
    Figure,
    Heading,
    Line,
    Lines,
    Paragraph,
    Table,
    blocks_of,
    cell_text,
)


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


MEASURED = Measured(Estimate(2.5, 0.1), "number")
PICTURE = Drawing("<svg/>", "a picture of many words", 90.0)


@pytest.mark.parametrize(
    ("rows", "right", "at_right"),
    [
        ((("a", "1"),), (), set()),
        ((("a", "1"),), (1,), {1}),
        ((("a", MEASURED), (MEASURED, "b")), (), {0, 1}),
        ((("a", Shown(1.0, look="number"), Shown("x", look="text")),), (), {1}),
        ((("a", Shown(1.0, look="answer"), PICTURE),), (2,), {1, 2}),
    ],
)
def test_columns_of_numbers_stand_at_the_right(rows, right, at_right):
    assert Table("", (), rows, right).at_right == at_right


def test_a_table_without_headings_has_as_many_columns_as_its_longest_row():
    assert Table("", (), (("a",), ("a", "b", "c"))).columns == 3
    assert Table("", ("a", "b"), ()).columns == 2
    assert Table("", (), ()).columns == 0


@pytest.mark.parametrize(
    ("heads", "rows", "right", "wished"),
    [
        (("A", "B"), (("x" * 7, "y" * 17),), (), (10, 20)),
        (("A" * 7, "B"), (("x", "y" * 17),), (), (10, 20)),
        ((), (("x" * 7, "y y " * 30),), (), (10, 43)),
        (tuple("ABCDEFGH"), (("a b " * 9, *"bcdefgh"),), (), (39, *[4] * 7)),
        (tuple("ABCDEFGHI"), (("a b " * 9, *"bcdefghi"),), (), (17, *[4] * 8)),
        (("A", "B"), (("x", PICTURE),), (), (4, 26)),
    ],
)
def test_columns_are_as_wide_as_their_texts_up_to_forty_letters_or_fourteen_of_many(heads, rows, right, wished):
    assert Table("", heads, rows, right).relative_widths == wished


@pytest.mark.parametrize(
    ("rows", "right", "crowded"),
    [
        ((("x" * 39,) * 4,), (), 4 * 41 / 105),
        ((("x" * 40,) * 8,), (), 1.0),  # a word of forty letters is broken
        ((("1" * 39,) * 4,), (0, 1, 2, 3), 4 * (0.82 * 39 + 2) / 105),
        ((("x y",) * 4,), (), 1.0),
        ((("1 y" * 5,) * 10,), tuple(range(10)), 10 * (0.82 * 15 + 2) / 105),
        ((("1,000,000, at least",) * 12,), tuple(range(12)), 12 * (0.82 * 10 + 2) / 105),
    ],
)
def test_how_crowded_a_table_is(rows, right, crowded):
    table = Table("", (), rows, right)
    assert table.crowded == pytest.approx(crowded)
    assert table.letters == pytest.approx(max(8.5 / crowded, 6.0))


def test_numbers_are_broken_where_the_table_would_be_too_wide_for_them_whole():
    """Up to 1.4 pages a number stays beside its error; beyond that only its parts stay whole."""
    text = "1,000,000 ± 1"
    whole, broken = 0.82 * len(text) + 2, 0.82 * len("1,000,000") + 2
    most = math.floor(1.4 * 105 / whole)
    for count, each in ((most, whole), (most + 1, broken)):
        table = Table("", (), ((text,) * count,), tuple(range(count)))
        assert table.crowded == pytest.approx(max(count * each / 105, 1.0))


@pytest.mark.parametrize(
    ("cell", "lines"),
    [
        ("", 1),
        ("x" * 50, 1),
        ("x " * 26, 2),
        ("a\nb", 2),
        (PICTURE, 1),
        (Shown("1" * 61, look="number"), 1),
        (Shown("1" * 65, look="number"), 2),
    ],
)
def test_lines_of_one_cell(cell, lines):
    """Two columns of one width have room for 50.5 letters each, or 61.6 digits."""
    assert Table("", ("A", "B"), ((cell, ""),), widths=(1.0, 1.0)).lines == lines


def test_a_line_breaks_only_in_the_column_without_room():
    table = Table("", ("A", "B"), (("x " * 40, "y"), ("x", "y " * 20)), widths=(3.0, 1.0))
    assert table.lines == math.ceil(80 / (105 * 0.75 - 2)) + math.ceil(40 / (105 * 0.25 - 2))


def test_the_text_of_a_cell():
    assert cell_text("a") == "a"
    assert cell_text(MEASURED) == "2.50 ± 0.10"
    assert cell_text(PICTURE) == "a picture of many words"
    assert cell_text(Shown(2.5, "0.00")) == "2.50"


def test_ends_of_bars_and_lines():
    bars = Bars((Bar("a", ((0.0, 2.0, "dark"), (2.0, math.inf, "light")), (-1.0, 3.0)), Bar("b", ())))
    assert sorted(bars.ends) == [-1.0, 0.0, 2.0, 2.0, 3.0]
    lines = Lines((Line("a", ((1.0, 5.0), (2.0, 7.0, 0.5), (3.0, math.nan), (4.0, 6.0, None))),), "y")
    assert lines.ends == (1.0, 4.0)
    assert lines.heights == [5.0, 5.0, 6.5, 7.5, 6.0, 6.0]
    cloud = Lines(lines.lines, "y", from_zero=True, cloud=Line("c", ((-2.0, 9.0),)))
    assert cloud.ends == (-2.0, 4.0)
    assert cloud.heights == [0.0, 9.0, 9.0, *lines.heights]
    assert cloud.all == (Line("c", ((-2.0, 9.0),)), *lines.lines)


def test_what_the_looks_of_bars_mean_stands_beside_the_axis():
    bars = Bars((), looks=(("dark", "kept"), ("light", "lost")))
    assert Chart("", "mph", bars, "").across_and_looks == "mph (dark: kept, light: lost)"
    assert Chart("", "mph", Bars(()), "").across_and_looks == "mph"
    assert Chart("", "mph", Lines((), "y"), "").across_and_looks == "mph"


def test_what_leads_a_sentence_stands_before_the_rest_of_it():
    assert Bullets(("one two", "three"), leads=("one", "")).led == [("one", " two"), ("", "three")]
    assert Bullets(("one",)).led == [("", "one")]


def test_a_figure_of_half_a_page_and_a_paragraph_given_as_its_text():
    assert Figure(Drawing("", "", HALF), "").is_half
    assert not Figure(Drawing("", "", HALF + 1), "").is_half
    assert blocks_of(["a", Heading("b")]) == (Paragraph("a"), Heading("b"))
