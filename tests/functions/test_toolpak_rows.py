from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.registry import REGISTRY, Kind, Logical, Number
from xlmc.functions.toolpak import Date, toolpak
from xlmc.functions.values import Value, from_objects

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0


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
        ((True,), VALUE),
        ((1, True), VALUE),
        ((1, NA, "x"), NA),
        ((-1, NA), NA),
        ((-1,), NUM),
        ((2958466,), NUM),
        ((1, -200), NUM),
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
    assert row.body(days, date1904=True).objects().tolist() == [110.0, NUM, NUM]


def test_ranges_and_single_values_go_together(row):
    cells = from_objects(np.array([[[1.0, DIV0]]], object))
    assert row([cells, Value.of_numbers(np.array([1.0, 2.0]))]).objects().tolist() == [[[102, DIV0]], [[103, DIV0]]]
