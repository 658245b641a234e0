"""What SUBTOTAL and AGGREGATE leave out of each of their ranges, and what they take as a rank.

Microsoft's page of AGGREGATE: options 0 to 3 leave out nested totals, 4 to 7 do not; functions 14 to 19 take one array
and a second argument, which is no range to be totalled, and without it are `#VALUE!`.
"""

from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode, FormulaError

CELLS = {
    "A1": 1.0, "A2": 2.0, "A3": 4.0,
    "B1": 8.0, "B2": "=SUBTOTAL(9,A1:A3)", "B3": "=AGGREGATE(2,4,A1:A3)-1",
    "C1": 2.0,
}  # fmt: skip
GIVES = [
    ("SUBTOTAL(9,A1:A3,B1:B3)", 15.0),
    ("AGGREGATE(9,0,A1:A3,B1:B3)", 15.0),
    ("AGGREGATE(9,4,B1:B3)", 17.0),
    ("AGGREGATE(9,4,A1:A3,B1:B3)", 24.0),
    ("AGGREGATE(9,6,A1,B2,B2:B3)", 17.0),
    ("AGGREGATE(14,0,A1:A3,B3)", 2.0),
    ("AGGREGATE(14,0,A1:A3,C1)", 2.0),
    ("SUM(AGGREGATE(15,6,A1:A3,B3:C3))", ErrorCode.NUM),
    ("AGGREGATE(14,6,(A1:A3,C1))", ErrorCode.VALUE),
    ("AGGREGATE(14,6,(A1:A2,A3),1)", ErrorCode.VALUE),
    ("AGGREGATE(14,6,A1:A3)", ErrorCode.VALUE),
]


def test_nested_totals_and_ranks(gives):
    assert gives(CELLS, GIVES) == []


def test_a_total_in_the_range_is_refused_where_the_options_vary(lower):
    cells = CELLS | {"H9": "=AGGREGATE(9,C1*2,A1:A3,B1:B3)", "H8": "=AGGREGATE(9,C1*2,A1:A3)"}
    lower(cells, {"C1": [0.0, 2.0]}, ["H8"])
    with pytest.raises(FormulaError, match="S!B2 is a total itself, and whether AGGREGATE leaves it out varies"):
        lower(cells, {"C1": [0.0, 2.0]}, ["H9"])


@pytest.mark.parametrize("ranks", ["{1,2,3}", "SEQUENCE(1,C1+1)", "IF(C1>1,{1,2,3},{1,2})"])
def test_arrays_of_functions_and_ranks_that_do_not_fit_are_refused(run, ranks):
    with pytest.raises(FormulaError, match="AGGREGATE is given arrays of different sizes"):
        run(CELLS | {"H9": f"=SUM(AGGREGATE({{14,15}},6,A1:A3,{ranks}))+C1"}, {"C1": [2.0]}, ["H9"])
