"""Tables on a terminal: what wraps, what gives way, and what becomes a list."""

from __future__ import annotations

import pytest

from xlmc.cli import printing
from xlmc.cli.printing import _fold, _one_line, _pieces, _wide, _wrap, heading, notices, table, table_lines, warnings


def lines(headings, rows, right=(), width=40):
    return [*table_lines(headings, rows, right, width, "-")]


ROWS = [("speed", "11.8"), ("way", "105.25")]


def test_numbers_are_aligned_to_the_right_and_gaps_are_three_wide():
    assert lines(["Name", "Mean"], ROWS, (1,)) == [
        " Name      Mean",
        " --------------",
        " speed     11.8",
        " way     105.25",
    ]


def test_texts_are_aligned_to_the_left_without_blanks_behind_them():
    assert lines(["Name", "Says"], [("a", "much longer"), ("long name", "b")]) == [
        " Name        Says",
        " -----------------------",
        " a           much longer",
        " long name   b",
    ]


def test_a_text_wraps_between_words():
    """Of 21 columns two are at the ends, three a gap and one the first column's: 15."""
    assert lines(["a", "one two three four"], [("b", "three four five six")], (), 21) == [
        " a   one two three",
        "     four",
        " -------------------",
        " b   three four five",
        "     six",
    ]


def test_the_widest_column_gives_way_first():
    """Of 28 columns 23 are left, of which the short text keeps its seven."""
    assert lines(["A", "B"], [("one two three four five six", "one two")], (), 28) == [
        f" A{' ' * 18}B",
        f" {'-' * 26}",
        " one two three      one two",
        " four five six",
    ]


@pytest.mark.parametrize(
    ("width", "gap"),
    [(14, 3), (13, 2)],  # one column at the left, one at the right, and 3 + 6 for the cells
)
def test_the_gap_is_narrower_where_something_would_be_cut(width, gap):
    made = lines(["Say", "Number"], [("abc", "123456")], (1,), width)
    assert made[2] == f" abc{' ' * gap}123456"


def test_a_table_that_is_too_wide_is_a_list():
    assert lines(["Name", "Mean", "Long heading"], [("speed", "123456", "7"), ("way", "", "8")], (1, 2), 12) == [
        " speed",
        "   Mean          123456",
        "   Long heading  7",
        " way",
        "   Long heading  8",
    ]


def test_cells_of_a_list_wrap_under_each_other():
    """Thirteen columns at least are left for a cell: 9 stand before it."""
    cells = ("a name of too many words", "one two three four five", "123456789")
    assert lines(["Name", "Mean", "Value"], [cells], (1, 2), 18) == [
        " a name of too",
        " many words",
        "   Mean   one two three",
        "          four five",
        "   Value  123456789",
    ]
    assert lines(["Name", "Mean", "Long heading"], [("a", "one two three four five", "123456789")], (1, 2), 32)[
        1:3
    ] == [
        "   Mean          one two three",
        "                 four five",
    ]


def test_a_number_wraps_before_to_alone():
    assert _pieces("172.53 ± 0.70 to 243.16 ± 0.97", True) == ["172.53 ± 0.70", "to 243.16 ± 0.97"]
    assert _pieces("172.53 ± 0.70", True) == ["172.53 ± 0.70"]
    assert _pieces("one two", False) == ["one", "two"]
    assert _pieces("", False) == [""]
    made = lines(["Range"], [("172.53 ± 0.70 to 243.16 ± 0.97",)], (0,), 18)
    assert made[2:] == ["    172.53 ± 0.70", " to 243.16 ± 0.97"]


def test_a_long_word_of_text_is_folded_at_thirteen_columns_and_more():
    made = lines(["A", "B"], [("x" * 30, "1234567890")], (1,), 28)
    assert made[2:] == [f" {'x' * 13}   1234567890", f" {'x' * 13}", f" {'x' * 4}"]
    assert len(lines(["A", "B"], [("x" * 30, "1234567890")], (1,), 27)[2]) == 26  # a narrower gap
    assert lines(["A", "B"], [("x" * 30, "1234567890")], (1,), 26)[0] == f" {'x' * 25}"  # a list


@pytest.mark.parametrize(
    ("pieces", "width", "wrapped"),
    [
        (["one", "two", "three"], 7, ["one two", "three"]),
        (["one", "two", "three"], 6, ["one", "two", "three"]),
        (["one", "two", "three"], 13, ["one two three"]),
        (["abcdefgh", "ij"], 5, ["abcde", "fgh", "ij"]),
        (["abcdefgh", "i"], 5, ["abcde", "fgh i"]),
        (["漢字漢字"], 5, ["漢字", "漢字"]),
    ],
)
def test_wrapping(pieces, width, wrapped):
    assert _wrap(pieces, width) == wrapped


def test_a_letter_that_is_wider_than_a_line_stands_alone():
    assert _fold("漢字", 1) == ["漢", "字"]


@pytest.mark.parametrize(("text", "columns"), [("abc", 3), ("é → ±", 5), ("漢字", 4), ("e\u0301", 1), ("", 0)])
def test_columns_of_the_screen(text, columns):
    assert _wide(text) == columns


def test_a_cell_is_one_line():
    assert _one_line("one\ntwo") == "one two"


def test_a_printed_table_has_its_title_above_and_a_line_of_space_below(capsys):
    table("What it is", ["Name", "Mean"], ROWS, right=[1])
    assert capsys.readouterr().out.splitlines() == [
        "What it is", "", " Name      Mean", " ──────────────", " speed     11.8", " way     105.25", ""
    ]  # fmt: skip
    table("", ["Name"], [("a",)])
    assert capsys.readouterr().out == " Name\n ────\n a\n\n"
    heading("A heading")
    assert capsys.readouterr().out == "A heading\n\n"


@pytest.mark.parametrize(("words", "wraps"), [(39, False), (41, True)])
def test_a_line_in_a_pipe_has_160_columns(capsys, words, wraps):
    table("", ["A"], [("abc " * words,)])
    assert (len(capsys.readouterr().out.splitlines()) > 4) is wraps


@pytest.mark.parametrize(
    ("terminal", "environment", "bold"),
    [
        (True, {"TERM": "xterm"}, True),
        (False, {"TERM": "xterm"}, False),
        (True, {"TERM": "dumb"}, False),
        (True, {"TERM": "xterm", "NO_COLOR": ""}, False),
    ],
)
def test_titles_are_bold_on_a_terminal(monkeypatch, terminal, environment, bold):
    monkeypatch.setattr(printing, "on_terminal", lambda: terminal)
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, text in environment.items():
        monkeypatch.setenv(name, text)
    assert printing._bold("title") == ("\x1b[1mtitle\x1b[0m" if bold else "title")


def test_a_table_on_a_terminal_is_as_wide_as_that(monkeypatch, capsys):
    monkeypatch.setattr(printing, "on_terminal", lambda: True)
    monkeypatch.setattr(printing, "width", lambda: 20)
    monkeypatch.setenv("NO_COLOR", "1")
    table("", ["A"], [("one two three four five",)])
    assert capsys.readouterr().out.splitlines()[2:4] == [" one two three four", " five"]


def test_notes_and_warnings_go_to_stderr(capsys):
    notices(["it is so"])
    warnings(["few trials", "no number"], {"no number"})
    shown = capsys.readouterr()
    assert shown.out == ""
    assert " ".join(shown.err.split()) == (
        "note: it is so warning: few trials; the answer must not be used as it is. "
        "warning: no number; this answer is missing, and the others do not need it."
    )
