from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, constant

VALUE, NA = ErrorCode.VALUE, ErrorCode.NA
TABLE_OF = [["Tulsa", None], ["", 74133.0], [True, "US"]]
MIXED = [[True, VALUE], [1234.01234, 'Sea"ttle'], [None, 1123.0]]

TABLE = [
    ("CONCATENATE", ("Stream ", "population", 32, True, None), "Stream population32TRUE"),
    ("CONCATENATE", ("a",), "a"),
    ("CONCATENATE", ("a", NA, VALUE), NA),
    ("CONCATENATE", ("a" * 20000, "b" * 20000), VALUE),
    ("CONCATENATE", ([["a", "b"]], 1), [["a1", "b1"]]),
    ("CONCAT", ("a", TABLE_OF, 0.5), "aTulsa74133TRUEUS0.5"),
    ("CONCAT", (TABLE_OF, [[NA, VALUE]]), NA),
    ("CONCAT", ([["a" * 20000, "b" * 20000]],), VALUE),
    ("TEXTJOIN", (", ", True, TABLE_OF), "Tulsa, 74133, TRUE, US"),
    ("TEXTJOIN", (", ", False, TABLE_OF), "Tulsa, , , 74133, TRUE, US"),
    ("TEXTJOIN", ("-", "TRUE", "a", None, "b"), "a-b"),
    ("TEXTJOIN", ([["1", "2"]], True, [["a", "b", "c", "d"]]), "a1b2c1d"),
    ("TEXTJOIN", (None, True, "a", "b"), "ab"),
    ("TEXTJOIN", ("-", True, None), ""),
    ("TEXTJOIN", ("-", "x", "a"), VALUE),
    ("TEXTJOIN", (NA, "x", "a"), NA),
    ("TEXTJOIN", ("-", True, "a", [[NA]]), NA),
    ("TEXTJOIN", ("-" * 20000, True, "a" * 10000, "b" * 10000), VALUE),
    ("TEXTJOIN", ("-", [[True, False]], "a", ""), [["a", "a-"]]),
    ("VALUETOTEXT", (1234.5,), "1234.5"),
    ("VALUETOTEXT", ("Hello",), "Hello"),
    ("VALUETOTEXT", ("Hello", 1), '"Hello"'),
    ("VALUETOTEXT", ('a"b', 1), '"a""b"'),
    ("VALUETOTEXT", (True, 1), "TRUE"),
    ("VALUETOTEXT", (NA,), "#N/A"),
    ("VALUETOTEXT", ("a", None), "a"),
    ("VALUETOTEXT", ("a", 2), VALUE),
    ("VALUETOTEXT", ("a", "b"), VALUE),
    ("VALUETOTEXT", ("a", NA), NA),
    ("VALUETOTEXT", ([["a", 1.0]], 1), [['"a"', "1"]]),
    ("ARRAYTOTEXT", (MIXED,), 'TRUE, #VALUE!, 1234.01234, Sea"ttle, , 1123'),
    ("ARRAYTOTEXT", (MIXED, 1), '{TRUE,#VALUE!;1234.01234,"Sea""ttle";,1123}'),
    ("ARRAYTOTEXT", ("a", 1), '{"a"}'),
    ("ARRAYTOTEXT", ("a", -1), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize("name", ["CONCAT", "CONCATENATE"])
def test_trials_beside_constants(name):
    joined = function_named(name)([constant("x="), Value.of_numbers(np.array([1.0, 2.5]))])
    assert joined.objects().tolist() == ["x=1", "x=2.5"]
