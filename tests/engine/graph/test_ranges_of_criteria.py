"""Ranges of unequal size, the criterion `<>` on texts that read as numbers, and empty cells in GCD and LCM.

Microsoft's pages of SUMIFS, COUNTIFS, AVERAGEIFS, MAXIFS and MINIFS want ranges of one size, else `#VALUE!`; those
of SUMIF and AVERAGEIF take the size of the first range.
"""

from __future__ import annotations

from xlmc.errors import ErrorCode

VALUE = ErrorCode.VALUE

CELLS = {
    "A1": 1.0, "A2": 2.0, "A3": 3.0,
    "B1": 1.0, "B3": "23", "B4": 23.0,
    "C1": "x", "C2": "23 ", "C3": True,
    "D1": 5.0, "D3": 10.0,
}  # fmt: skip

UNEQUAL = [
    ("SUMIFS(A1:A3,B1:B2,1)", VALUE),
    ("SUMIFS(A1:A2,B1:B3,1)", VALUE),
    ("SUMIFS(A1:A3,A1:C1,1)", VALUE),
    ("SUMIFS(A:A,B1:B2,1)", VALUE),
    ("SUMIFS(A1:A3,B:B,1)", VALUE),
    ("SUMIFS(A:A,B2:B1048576,1)", VALUE),
    ("SUMIFS(A:A,1:1,1)", VALUE),
    ("COUNTIFS(A1:A3,1,B1:B2,1)", VALUE),
    ("COUNTIFS(A1:A3,1,A1:C1,1)", VALUE),
    ("COUNTIFS(A:A,1,B1:B9,1)", VALUE),
    ("COUNTIFS(A:A,1,1:1,1)", VALUE),
    ("COUNTIFS(A1:A1048575,1,B2:B1048576,1)", 0.0),
    ("AVERAGEIFS(A1:A3,B1:B4,1)", VALUE),
    ("MAXIFS(A1:A3,B1:B4,1)", VALUE),
    ("MINIFS(A1:A3,A1:A3,1,B1:B4,1)", VALUE),
    ("SUMIFS(A:A,B:B,1)", 1.0),
    ("SUMIF(A1:A3,\">1\",D1)", 10.0),
    ("AVERAGEIF(A1:A3,\">1\",D1)", 10.0),
]  # fmt: skip

TEXTS_THAT_READ_AS_NUMBERS = [
    ('COUNTIF(B1:B4,"<>23")', 3.0),
    ('COUNTIF(B1:B4,"=23")', 2.0),
    ('COUNTIF(B1:B4,"23")', 2.0),
    ("COUNTIF(B1:B4,23)", 2.0),
    ('COUNTIF(C1:C3,"<>23")', 3.0),
    ('COUNTIFS(A1:A3,">0",B1:B3,"<>23")', 3.0),
    ('SUMIF(B1:B3,"<>23",A1:A3)', 6.0),
    ('SUMIFS(A1:A3,B1:B3,"<>23",B1:B3,"<>1")', 5.0),
    ('SUMIFS(A1:A3,B1:B3,"<>"&B4)', 6.0),
    ('COUNTIF(C1:C3,"<>x")', 2.0),
    ('COUNTIF(C1:C3,"<>TRUE")', 2.0),
]

EMPTY_CELLS = [
    ("LCM(D1:D3)", 10.0),
    ("LCM(D1,D2,D3)", 10.0),
    ("LCM(D2:D3,4)", 20.0),
    ("LCM(D1:D3,0)", 0.0),
    ("LCM(D1,)", 0.0),
    ("GCD(D1:D3)", 5.0),
    ("GCD(D2,D3)", 10.0),
    ("LCM(D1,C1)", VALUE),
]


def test_functions_of_several_criteria_want_ranges_of_one_size(gives):
    assert gives(CELLS, UNEQUAL) == []


def test_unequal_to_a_number_keeps_the_texts_that_read_as_it(gives):
    assert gives(CELLS, TEXTS_THAT_READ_AS_NUMBERS) == []


def test_multiples_and_divisors_leave_out_empty_cells(gives):
    assert gives(CELLS, EMPTY_CELLS) == []
