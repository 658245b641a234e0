from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.values import (
    BLANK,
    DIV0,
    ERROR,
    LOGICAL,
    NA,
    NUM,
    NUMBER,
    REF,
    TEXT,
    VALUE,
    Value,
    constant,
    from_objects,
    general_text,
    parse_number,
    unbox_errors,
)


def _of(*items: object) -> Value:
    return from_objects(np.array([*items, None], object)[:-1])


@pytest.mark.parametrize(
    ("boxed", "code"),
    [
        (DIV0, ErrorCode.DIV0),
        (VALUE, ErrorCode.VALUE),
        (REF, ErrorCode.REF),
        (NUM, ErrorCode.NUM),
        (NA, ErrorCode.NA),
        (math.nan, ErrorCode.NUM),
        (-math.nan, ErrorCode.NUM),
        (math.inf, ErrorCode.NUM),
        (-math.inf, ErrorCode.NUM),
        (0.0, 0),
        (-1e308, 0),
    ],
)
def test_codes_in_floats(boxed, code):
    assert unbox_errors(np.array([1.0, boxed])).tolist() == [0, code]


def test_a_code_outlives_where():
    x = np.where(np.array([True, False]), DIV0, np.array([1.0, 2.0]))
    assert Value.of_numbers(x).objects().tolist() == [ErrorCode.DIV0, 2.0]


def test_numbers_with_errors_beside_them_take_those_first():
    x = np.array([1.0, NA, NA])
    errors = np.array([0, 0, ErrorCode.REF], np.uint8)
    assert Value.of_numbers(x, errors).objects().tolist() == [1.0, ErrorCode.NA, ErrorCode.REF]


def test_one_error_beside_many_trials_is_in_each():
    error = np.array([ErrorCode.REF], np.uint8)
    assert Value.of_numbers(np.zeros(3), error).objects().tolist() == [ErrorCode.REF] * 3
    assert Value.of_logicals(np.zeros(3, bool), error).objects().tolist() == [ErrorCode.REF] * 3
    assert Value.of_texts(np.full(3, "a", object), error).objects().tolist() == [ErrorCode.REF] * 3


objects = (
    st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False)  # which Excel does not have
    | st.booleans()
    | st.text()
    | st.none()
    | st.sampled_from(ErrorCode)
)


@given(st.lists(objects, min_size=1, max_size=6), st.sampled_from([(-1,), (1, -1, 1), (-1, 1, 1)]))
def test_objects_come_back(items, shape):
    array = np.empty(len(items), object)
    array[:] = items
    value = from_objects(array.reshape(shape))
    result = value.objects().ravel().tolist()
    assert [(type(item), item) for item in result] == [(type(item), item) for item in items]


@pytest.mark.parametrize(
    ("item", "kind"),
    [(1, NUMBER), (np.float64(1), NUMBER), (True, LOGICAL), (np.True_, LOGICAL), ("", TEXT), (None, BLANK)],
)
def test_kinds_of_objects(item, kind):
    assert constant(item).kinds.tolist() == [kind]


def test_kinds_of_errors():
    assert constant(ErrorCode.NA).kinds.tolist() == [ERROR + 7]
    assert constant(ErrorCode.NA).has_errors
    assert not constant(ErrorCode.NA).plain
    assert not constant("a").plain
    assert _of(1.0, True, None).plain


COERCIONS = [
    (2.5, 2.5, True, "2.5"),
    (0.0, 0.0, False, "0"),
    (True, 1.0, True, "TRUE"),
    (False, 0.0, False, "FALSE"),
    (None, 0.0, False, ""),
    ("", ErrorCode.VALUE, ErrorCode.VALUE, ""),
    ("12.5", 12.5, ErrorCode.VALUE, "12.5"),
    ("true", ErrorCode.VALUE, True, "true"),
    ("FALSE", ErrorCode.VALUE, False, "FALSE"),
    ("abc", ErrorCode.VALUE, ErrorCode.VALUE, "abc"),
    (ErrorCode.NA, ErrorCode.NA, ErrorCode.NA, ErrorCode.NA),
]
"""An object as a number, as a logical and as a text."""


def _outcome(array: np.ndarray, errors: np.ndarray, i: int, n: int) -> object:
    code = int(np.broadcast_to(errors, (n,))[i])
    return ErrorCode(code) if code else array[i]


@pytest.mark.parametrize("others", [(), (1.0,), ("x", None, ErrorCode.REF)])
@pytest.mark.parametrize(("item", "number", "logical", "text"), COERCIONS)
def test_coercions_whatever_stands_in_other_trials(item, number, logical, text, others):
    value = _of(item, *others)
    n = 1 + len(others)
    assert _outcome(*value.to_numbers(), 0, n) == number
    assert _outcome(*value.to_logicals(), 0, n) == logical
    assert _outcome(*value.to_texts(), 0, n) == text


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1", 1.0),
        (" -2.50 ", -2.5),
        ("+3", 3.0),
        ("1e3", 1000.0),
        ("1E-3", 0.001),
        ("1,234.5", 1234.5),
        ("50%", 0.5),
        ("7 %", 0.07),
        (".5", 0.5),
        ("5.", 5.0),
        ("", None),
        (" ", None),
        ("abc", None),
        ("%", None),
        ("5%%", None),
        ("--5", None),
        ("1_000", None),
        ("nan", None),
        ("inf", None),
        ("Infinity", None),
        ("1e400", None),
        ("0x10", None),
        ("TRUE", None),
    ],
)
def test_texts_as_numbers(text, number):
    assert parse_number(text) == number


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (5.0, "5"),
        (-5.0, "-5"),
        (2.5, "2.5"),
        (0.1 + 0.2, "0.3"),
        (1 / 3, "0.333333333333333"),
        (2 / 3, "0.666666666666667"),
        (1e15, "1000000000000000"),
        (123456789012345678.0, "123456789012346000"),
        (1e21, "1E+21"),
        (1.5e300, "1.5E+300"),
        (-1.5e-10, "-0.00000000015"),
        (0.0001, "0.0001"),
    ],
)
def test_numbers_as_general_texts(number, text):
    assert general_text(number) == text


@given(st.floats(-1e308, 1e308).filter(lambda x: x == 0 or abs(x) > 2.2250738585073e-308))
def test_general_texts_read_back_to_fifteen_digits(number):
    far_out = abs(number) >= 1e98 or abs(number) < 1e-98  # there Excel writes one digit less
    assert math.isclose(parse_number(general_text(number)), number, rel_tol=5.6e-14 if far_out else 5.1e-15)


def test_take_picks_trials_and_leaves_constants():
    value = _of(1.0, "a", ErrorCode.NA)
    assert value.take(np.array([2, 1])).objects().tolist() == [ErrorCode.NA, "a"]
    same = constant(3.0)
    assert same.take(np.array([0, 0])) is same
    few_kinds = Value.of_numbers(np.array([1.0, 2.0]))
    assert few_kinds.take(np.array([1])).objects().tolist() == [2.0]


def test_a_scalar_as_a_range_has_one_cell():
    value = _of(1.0, "a").as_range()
    assert value.shape == (2, 1, 1)
    assert value.objects()[:, 0, 0].tolist() == [1.0, "a"]
    assert value.as_range() is value


def test_a_constant_too_small_for_excel_is_zero_and_others_keep_their_bits():
    numbers = [5e-324, -1e-310, 2.0**-1022, -(2.0**-1022), -0.0, 1e308]
    result = [constant(number).numbers.item() for number in numbers]
    assert [number.hex() for number in result] == [number.hex() for number in (0.0, 0.0, *numbers[2:])]
