from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

BOUGHT, LEAP_DAY, FIRST = "1998-02-28", "2000-02-29", "2002-05-14"

VALUES = [
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 1, 0.15, 1), 360),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0.15, 1), 2400 * 0.15 * 134 / 366),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 6, 0.15, 1), 2400 * (0.875 - 0.15 * 134 / 366 - 0.75)),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 7, 0.15, 1), 0),
    ("AMORLINC", (2400, "2008-08-19", "2008-08-19", 300, 0, 0.15, 1), 360),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 2400, 0, 0.15, 1), 0),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0.15, 2), NUM),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0, 1), NUM),
    ("AMORLINC", (2400, "2008-12-31", "2008-08-19", 300, 0, 0.15, 1), NUM),
    ("AMORLINC", (True, "2008-08-19", "2008-12-31", 300, 0, 0.15, 1), VALUE),
    ("AMORDEGRC", (2400, "2008-08-19", "2008-12-31", 300, 1, 0.15, 1), 776),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0, 0.15, 3), 75),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0, 0.3, 0), 90),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0.3, 0.3, 0), 0),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 1, 0.3, 1), 5),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 1.7, 0.1, 4), 13),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 2, 0.15, 1), 6),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 10, 0.07, 1), 2),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 50, 1, 0.3, 1), 23),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 0, 0.07, 1), 147),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 11.3, 0.07, 1), 1),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 13, 0.07, 1), 3),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 14, 0.07, 1), 3),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 15.5, 0.07, 1), 0),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 1, 0.5, 1), NUM),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 1, 0.22, 1), NUM),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 300, 1, 0.15, 1), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


def test_linear_losses_add_up_to_what_there_is_to_lose(evaluate):
    lost = [evaluate("AMORLINC", 2400.0, "2008-08-19", "2008-12-31", 300.0, float(per), 0.15, 3.0) for per in range(9)]
    assert sum(lost) == pytest.approx(2100)
