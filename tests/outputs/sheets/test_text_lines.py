from __future__ import annotations

import pytest

from xlmc.outputs.sheets.text_lines import line_count


@pytest.mark.parametrize(
    ("text", "room", "lines"),
    [
        ("", 10, 1),
        ("1234567890", 10, 1),
        ("12345678901", 10, 2),
        ("1234 67890", 10, 1),
        ("12345 7890 2", 10, 2),
        ("1\n2\n3", 10, 3),
        ("1" * 35, 10, 4),
        ("iiiiiiiiii iiiiiiiiii", 10.5, 1),
        ("WWWWW WWWWW", 10, 2),
        ("速度" * 5, 10, 2),
        ("a text", -3.0, 5),
    ],
)
def test_lines_break_between_words_that_are_as_wide_as_their_letters(text, room, lines):
    assert line_count(text, room) == lines


def test_bold_letters_are_wider_and_letters_of_code_all_alike():
    assert line_count("1234567890", 10.0, bold=True) == 2
    assert line_count("iiiiiiiiii", 9.0) == 1
    assert line_count("iiiiiiiiii", 9.0, even=1.0) == 2


def test_running_text_has_more_letters_than_digits_to_a_line():
    text = "Filters keep only the combinations in which they hold, so an assumption that they bear on is distributed "
    assert line_count(text * 10, len(text) / 1.2) <= 10 < line_count(text * 10, len(text) / 1.3)
