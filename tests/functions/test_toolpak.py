from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.toolpak import flattened, number_of, numbers_only, per_object
from xlmc.functions.values import Value, constant, from_objects

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
    assert number_of(item) == number
    found = numbers_only(lambda x: x)(constant(item)).objects()[0]
    assert (type(found), found) == (type(number), number)


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
    numbers, errors = flattened([constant(2.0), cells])
    assert numbers.tolist() == [[2.0, 7.0, 0.0], [2.0, 1.0, 0.0]]
    assert errors.tolist() == [[0, 0, 0], [0, VALUE, NA]]


def test_trials_keep_their_own_errors():
    trials = Value.of_numbers(np.array([4.0, -1.0, 6.0]))
    constants = from_objects(np.array([[[8.0, "12"]]], object))
    assert function_named("GCD")([trials, constants]).objects().tolist() == [4.0, NUM, 2.0]
