from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

SHORT = "2008-02-07", "2008-06-15", "2007-10-15"
LONG = "1999-02-28", "2000-02-28", "1998-02-28"

VALUES = [
    ("ODDLPRICE", (*SHORT, 0.0375, 0.0405, 100, 2, 0), 99.8782860147213),
    ("ODDLPRICE", (*LONG, 0.07, 0.03, 100, 1, 2), 103.6796116505),
    ("ODDLPRICE", (*LONG, 0.07, 0.03, 100, 2, 0), 103.7180731889),
    ("ODDLPRICE", (*LONG, 0.1, 0.03, 130, 4, 0), 135.6854157873),
    ("ODDLPRICE", ("2008-06-15", "2008-02-07", "2007-10-15", 0.0375, 0.0405, 100, 2), NUM),
    ("ODDLPRICE", ("2007-10-15", "2008-06-15", "2007-10-15", 0.0375, 0.0405, 100, 2), NUM),
    ("ODDLPRICE", (*SHORT, -0.0375, 0.0405, 100, 2), NUM),
    ("ODDLPRICE", (*SHORT, 0.0375, -0.0405, 100, 2), NUM),
    ("ODDLPRICE", (*SHORT, 0.0375, 0.0405, -100, 2), NUM),
    ("ODDLPRICE", (*SHORT, 0.0375, 0.0405, 100, 2, -1), NUM),
    ("ODDLPRICE", (*SHORT, 0.0375, True, 100, 3), VALUE),
    ("ODDLYIELD", ("2008-04-20", "2008-06-15", "2007-12-24", 0.0375, 99.875, 100, 2, 0), 0.0451922356291693),
    ("ODDLYIELD", (*SHORT, 0.0375, 0, 100, 2), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-11)


@pytest.mark.parametrize("basis", [0.0, 1.0, 2.0, 3.0, 4.0])
@pytest.mark.parametrize("frequency", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("maturity", [40100.0, 40800.0])
def test_the_yield_is_found_again(evaluate, basis, frequency, maturity):
    pr = evaluate("ODDLPRICE", 40050.0, maturity, 39900.0, 0.05, 0.07, 100.0, frequency, basis)
    found = evaluate("ODDLYIELD", 40050.0, maturity, 39900.0, 0.05, pr, 100.0, frequency, basis)
    assert found == pytest.approx(0.07, rel=1e-10)
