from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, constant

VALUE, NA = ErrorCode.VALUE, ErrorCode.NA

TABLE = [
    ("TEXT", (1234.567, "$#,##0.00"), "$1,234.57"),
    ("TEXT", (0.285, "0.0%"), "28.5%"),
    ("TEXT", (4.34, "# ?/?"), "4 1/3"),
    ("TEXT", (43845.5, "dd/mm/yyyy hh:mm"), "15/01/2020 12:00"),
    ("TEXT", ("12.5", "0.00"), "12.50"),
    ("TEXT", ("1/15/2020", "yyyy-mm-dd"), "2020-01-15"),
    ("TEXT", ("abc", "0.00"), "abc"),
    ("TEXT", ("abc", '0;0;0;"<"@">"'), "<abc>"),
    ("TEXT", (True, "0.00"), "TRUE"),
    ("TEXT", (None, "0.00"), "0.00"),
    ("TEXT", (None, None), ""),
    ("TEXT", ("abc", ""), ""),
    ("TEXT", (1, 0), "1"),
    ("TEXT", (-1, "yyyy"), VALUE),
    ("TEXT", (1, "y 0"), VALUE),
    ("TEXT", (NA, "0"), NA),
    ("TEXT", (1, NA), NA),
    ("TEXT", ([[1.0, 2.0]], "0.0"), [["1.0", "2.0"]]),
    ("FIXED", (1234.567, 1), "1,234.6"),
    ("FIXED", (1234.567, -1), "1,230"),
    ("FIXED", (-1234.567, -1, True), "-1230"),
    ("FIXED", (44.332,), "44.33"),
    ("FIXED", (0.5, 0), "1"),
    ("FIXED", (1.005, 2), "1.01"),
    ("FIXED", (-0.001, 2), "0.00"),
    ("FIXED", (1234.5, -1e300), "0"),
    ("FIXED", (1.7e308, -308), ErrorCode.NUM),
    ("FIXED", (1, 128), VALUE),
    ("FIXED", (1, 127), "1." + "0" * 127),
    ("FIXED", ("x",), VALUE),
    ("DOLLAR", (1234.567, 2), "$1,234.57"),
    ("DOLLAR", (-1234.567, -2), "($1,200)"),
    ("DOLLAR", (-0.123, 4), "($0.1230)"),
    ("DOLLAR", (99.888,), "$99.89"),
    ("DOLLAR", (1, 128), VALUE),
    ("VALUE", ("$1,000",), 1000),
    ("VALUE", (" 12% ",), 0.12),
    ("VALUE", ("1/15/2020",), 43845),
    ("VALUE", ("16:48",), 0.7),
    ("VALUE", (5,), 5),
    ("VALUE", (None,), 0),
    ("VALUE", ("",), VALUE),
    ("VALUE", ("abc",), VALUE),
    ("VALUE", (True,), VALUE),
    ("VALUE", (NA,), NA),
    ("NUMBERVALUE", ("2.500,27", ",", "."), 2500.27),
    ("NUMBERVALUE", ("3.5%",), 0.035),
    ("NUMBERVALUE", ("9%%",), 0.0009),
    ("NUMBERVALUE", (" 3 000 ",), 3000),
    ("NUMBERVALUE", ("",), 0),
    ("NUMBERVALUE", ("-1,2,3.5e1",), -1235),
    ("NUMBERVALUE", ("1.2.3",), VALUE),
    ("NUMBERVALUE", ("1.2,3",), VALUE),
    ("NUMBERVALUE", ("abc",), VALUE),
    ("NUMBERVALUE", ("1;5", ";;", ","), 1.5),
    ("NUMBERVALUE", ("15", "", ","), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


def test_trials_in_one_format():
    text = function_named("TEXT")([Value.of_numbers(np.array([0.5, 12.25])), constant("0.0")])
    assert text.objects().tolist() == ["0.5", "12.3"]


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [("TEXT", (1.0, "yyyy-mm-dd"), "1904-01-02"), ("VALUE", ("1/2/1904",), 1.0), ("TEXT", ("1/2/1904", "0"), "1")],
)
def test_workbooks_that_count_from_1904(name, arguments, expected):
    row = function_named(name)
    assert row.dated
    function = replace(row, body=partial(row.body, date1904=True))
    assert function([constant(item) for item in arguments]).objects().tolist() == [expected]


def test_a_format_of_another_language_is_refused():
    with pytest.raises(FormulaError, match=r"In the number format '\[\$-407\]mmmm' the names of months"):
        function_named("TEXT")([constant(1.0), constant("[$-407]mmmm")])
