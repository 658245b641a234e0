from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.per_element import per_object
from xlmc.excel.functions.registry import REGISTRY, Kind, Logical, Number
from xlmc.excel.functions.toolpak import Date, all_strict_numbers, numbers_only, strict_number, toolpak
from xlmc.excel.functions.values import Value, constant, from_objects

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

REFUSES_LOGICALS = {
    "GCD": (4,),
    "LCM": (4,),
    "FACTDOUBLE": (),
    "MULTINOMIAL": (1,),
    "ISEVEN": (),
    "ISODD": (),
    "SERIESSUM": (1, 1, 1),
    "BIN2DEC": (),
    "HEX2OCT": (),
    "DEC2BIN": (4,),
    "COMPLEX": (1,),
    "IMSQRT": (),
    "IMABS": (),
    "IMSUM": ("i",),
    "IMPOWER": (1,),
    "ERF": (1,),
    "ERFC": (),
    "BESSELJ": (1,),
    "DELTA": (1,),
    "GESTEP": (1,),
    "CONVERT": ("m", "ft"),
}


@pytest.mark.parametrize("name", REFUSES_LOGICALS)
def test_a_logical_is_no_number(check, name):
    check(name, (True, *REFUSES_LOGICALS[name]), VALUE)


@pytest.mark.parametrize(
    ("item", "number"),
    [(2.5, 2.5), (None, 0.0), ("1e3", 1000.0), ("x", VALUE), ("", VALUE), (True, VALUE), (NA, NA)],
)
def test_the_number_of_an_object_is_that_of_a_value(item, number):
    assert strict_number(item) == number
    result = numbers_only(lambda x: x)(constant(item)).objects()[0]
    assert (type(result), result) == (type(number), number)


def test_the_first_error_among_the_arguments_wins():
    assert numbers_only(np.add)(constant("x"), constant(NA)).objects()[0] is VALUE
    assert per_object(lambda x, y: 1.0)(constant(NUM), constant(NA)).objects()[0] is NUM


def test_a_value_for_all_goes_with_each_of_the_trials_and_cells():
    cells = from_objects(np.array([[[1.0, 2.0]], [[3.0, "x"]]], object))
    for body in (numbers_only(np.add), per_object(lambda x, y: x + y if isinstance(y, float) else VALUE)):
        result = body(constant(10.0), cells)
        assert result.objects().tolist() == [[[11.0, 12.0]], [[13.0, VALUE]]]


def test_arguments_side_by_side():
    cells = from_objects(np.array([[["7", None]], [[True, NA]]], object))
    numbers, errors = all_strict_numbers([constant(2.0), cells])
    assert numbers.tolist() == [[2.0, 7.0, 0.0], [2.0, 1.0, 0.0]]
    assert errors.tolist() == [[0, 0, 0], [0, VALUE, NA]]


def test_trials_keep_their_own_errors():
    trials = Value.of_numbers(np.array([4.0, -1.0, 6.0]))
    constants = from_objects(np.array([[[8.0, "12"]]], object))
    assert function_named("GCD")([trials, constants]).objects().tolist() == [4.0, NUM, 2.0]


NUM_OF_TOOLPAK_ROWS, VALUE_OF_TOOLPAK_ROWS, NA_OF_TOOLPAK_ROWS, DIV0 = (
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
    ErrorCode.DIV0,
)


@pytest.fixture(scope="module")
def row():
    """A function of a date, a number, and a logical: their sum, as a date."""

    @toolpak("TEST.TOOLPAK", Date, Number(default=10.0), Logical(default=True), gives_date=True)
    def body(day, number, logical):
        """A sum."""
        return day + number + np.where(logical, 100, 0)

    yield REGISTRY["TEST.TOOLPAK"]
    del REGISTRY["TEST.TOOLPAK"]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ((1.9,), 111),
        ((1, 0.5, False), 1.5),
        (("2", "3", "FALSE"), 5),
        ((None, None, None), 0),
        ((1, 2, 0), 3),
        ((True,), VALUE_OF_TOOLPAK_ROWS),
        ((1, True), VALUE_OF_TOOLPAK_ROWS),
        ((1, NA_OF_TOOLPAK_ROWS, "x"), NA_OF_TOOLPAK_ROWS),
        ((-1, NA_OF_TOOLPAK_ROWS), NA_OF_TOOLPAK_ROWS),
        ((-1,), NUM_OF_TOOLPAK_ROWS),
        ((2958466,), NUM_OF_TOOLPAK_ROWS),
        ((1, -200), NUM_OF_TOOLPAK_ROWS),
    ],
)
def test_arguments(row, arguments, expected):
    assert row([from_objects(np.array([x], object)) for x in arguments]).objects().tolist() == [expected]


def test_the_row_says_what_it_takes(row):
    assert row.dated
    assert row.arity() == (1, 3)
    assert row.body.__doc__ == "A sum."
    assert {parameter.kind for parameter in row.parameters} == {Kind.ANY}


def test_bodies_get_days_of_the_1900_system(row):
    """1462 goes in, and out again."""
    days = Value.of_numbers(np.array([0.0, 2957003.0, 2957004.0]))
    assert row.body(days, date1904=True).objects().tolist() == [110.0, NUM_OF_TOOLPAK_ROWS, NUM_OF_TOOLPAK_ROWS]


def test_ranges_and_single_values_go_together(row):
    cells = from_objects(np.array([[[1.0, DIV0]]], object))
    assert row([cells, Value.of_numbers(np.array([1.0, 2.0]))]).objects().tolist() == [[[102, DIV0]], [[103, DIV0]]]
