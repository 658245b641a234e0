from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from xlmc.excel.functions.denormals import TINIEST, Underflow, flush, tiny_to_zero
from xlmc.excel.functions.registry import row_of
from xlmc.excel.functions.values import DIV0, Value, constant, parse_number, unbox_errors

ANY = st.floats() | st.floats(-1e-300, 1e-300)
SMALL = st.floats(-1e-140, 1e-140).filter(lambda x: x == 0 or abs(x) > 1e-170)


def same(x, y):
    return np.array_equal(x, y, equal_nan=True)


@given(arrays(np.float64, st.integers(0, 8), elements=ANY))
def test_numbers_that_excel_has_stay_and_smaller_ones_are_0(x):
    expected = [0.0 if abs(number) < TINIEST else number for number in x.tolist()]
    assert same(tiny_to_zero(x), np.array(expected))
    own = x.copy()
    flush(own)
    assert same(own, np.array(expected))


def test_an_array_without_them_is_not_copied_and_errors_keep_their_codes():
    x = np.array([1.0, 0.0, TINIEST])
    assert tiny_to_zero(x) is x
    assert unbox_errors(tiny_to_zero(np.array([DIV0, 1e-310]))).tolist() == unbox_errors(np.array([DIV0, 0.0])).tolist()


def test_truth_values_stay():
    truth = np.array([True, False])
    flush(truth)
    assert truth.tolist() == [True, False]


@pytest.mark.parametrize("number", [5e-324, -1e-310, np.nextafter(TINIEST, 0)])
def test_a_cell_a_text_and_a_result_are_0(number):
    assert constant(float(number)).numbers.tolist() == [0.0]
    assert parse_number(repr(float(number))) == 0.0
    assert Value.of_numbers(np.array([number])).numbers.tolist() == [0.0]


@given(st.sampled_from(["*", "/", "PRODUCT", "EXP", "^", "SUM", "-"]), SMALL, SMALL)
def test_no_function_gives_a_smaller_one(name, x, y):
    row = row_of(name)
    numbers = [x, y] if row.arity()[1] > 1 else [abs(x) * -1e142]
    result = row([constant(number) for number in numbers]).numbers[0]
    assert result == 0 or abs(result) >= TINIEST


def test_a_product_is_0_from_there_on():
    assert row_of("PRODUCT")([constant(x) for x in (1e-160, 1e-150, 1e20)]).numbers.tolist() == [0.0]


def test_numpy_tells_of_products_quotients_powers_and_exponentials():
    """Which is what the fast path rests on, whatever the processor and its vectors."""
    for n in (1, 7, 4096):
        for made in (
            lambda n=n: np.full(n, 1e-160) * np.full(n, 1e-150),
            lambda n=n: np.full(n, 1e-307) / np.full(n, 1e10),
            lambda n=n: np.exp(np.full(n, -720.0)),
            lambda n=n: np.power(np.full(n, 2.0), np.full(n, -1023.5)),
        ):
            with np.errstate(under="call", call=(underflow := Underflow())):
                made()
            assert underflow.raised
