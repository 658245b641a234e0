"""The independent reader of the harness finds a cell that xlmc would read otherwise."""

from __future__ import annotations

import pytest

SHEET = "xl/worksheets/sheet1.xml"
MISREAD = {
    "a number": (b"<v>2.5</v>", b"<v>2.5000000000000004</v>"),
    "a number in a cell of a date": (b"<v>45000.75</v>", b"<v>45000.76</v>"),
    "a number in a cell of a duration": (b"<v>-0.25</v>", b"<v>-0.75</v>"),
    "a text in the list of texts": (b't="s"><v>0</v>', b't="s"><v>1</v>'),
    "an error": (b't="e"><v>#N/A</v>', b't="n"><v>0</v>'),
    "a logical value": (b't="b"><v>1</v>', b't="n"><v>1</v>'),
    "a cell that is not there": (b'<c r="A5"><v>1000000000000000.0</v></c>', b""),
}


@pytest.fixture
def parts():
    pytest.importorskip("python_calamine")
    from fuzzing.foreign_parts import book

    return book()


def compared(parts, others):
    from fuzzing.books import packed
    from fuzzing.second_reader import agreed

    from xlmc.excel.workbook.reader import read_workbook

    return agreed(read_workbook(packed(parts), "read by xlmc"), packed(others))


def test_both_readers_see_the_same(parts):
    cells = compared(parts, parts)
    assert cells["S"][1, 1] == 2.5
    assert cells["In"][2, 1] == "u"


@pytest.mark.parametrize(("here", "there"), MISREAD.values(), ids=[*MISREAD])
def test_a_cell_that_is_read_otherwise_is_found(parts, here, there):
    from fuzzing.inputs import Disagreement

    assert here in parts[SHEET]
    with pytest.raises(Disagreement, match=r"calamine reads another value: S!R[1-5]C[1-5]: "):
        compared({**parts, SHEET: parts[SHEET].replace(here, there, 1)}, parts)


def test_a_part_in_an_encoding_that_one_reader_does_not_know_is_not_compared(parts):
    older = {
        **parts,
        "xl/sharedStrings.xml": b'<?xml version="1.0" encoding="latin-1"?>' + parts["xl/sharedStrings.xml"],
    }
    assert compared(parts, older) is None
