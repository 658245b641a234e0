from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named

VALUE = ErrorCode.VALUE

TABLE = [
    ("CEILING.PRECISE", (4.3,), 5),
    ("CEILING.PRECISE", (-4.3,), -4),
    ("CEILING.PRECISE", (4.3, 2), 6),
    ("CEILING.PRECISE", (4.3, -2), 6),
    ("CEILING.PRECISE", (-4.3, 2), -4),
    ("CEILING.PRECISE", (-4.3, -2), -4),
    ("CEILING.PRECISE", (23.5, 0), 0),
    ("CEILING.PRECISE", (-23.5,), -23),
    ("CEILING.PRECISE", (7.1, 0.1), 7.1),
    ("CEILING.PRECISE", ("x",), VALUE),
    ("FLOOR.PRECISE", (-3.2, -1), -4),
    ("FLOOR.PRECISE", (3.2, 1), 3),
    ("FLOOR.PRECISE", (-3.2, 1), -4),
    ("FLOOR.PRECISE", (3.2, -1), 3),
    ("FLOOR.PRECISE", (3.2,), 3),
    ("FLOOR.PRECISE", (3.2, 0), 0),
    ("FLOOR.PRECISE", (7.1, 0.1), 7.1),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-15)


@pytest.mark.parametrize("alias", ["ISO.CEILING", "ECMA.CEILING"])
def test_other_names(alias):
    assert function_named(alias) is function_named("CEILING.PRECISE")
