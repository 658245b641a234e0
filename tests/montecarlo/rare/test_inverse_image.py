"""Functions undone: what the argument must be is what the function itself says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from xlmc.montecarlo.rare import inverse_image
from xlmc.montecarlo.rare.spans import Spans, choose, intersection, union, union_of_pairs

ARGUMENTS = np.concatenate([np.linspace(-6.2, 6.2, 199), [-1.0, 0.0, 1.0, 3.0]])
OF_ONE = {
    "SQRT": np.sqrt,
    "EXP": np.exp,
    "LN": np.log,
    "LOG10": np.log10,
    "ABS": np.abs,
    "SIN": np.sin,
    "COS": np.cos,
    "TAN": np.tan,
    "ASIN": np.arcsin,
    "ACOS": np.arccos,
    "ATAN": np.arctan,
    "RADIANS": np.radians,
    "DEGREES": np.degrees,
    "-": np.negative,
    "+": np.positive,
    "%": lambda s: s / 100.0,
}
OF_TWO = {
    inverse_image.term: lambda s, o: s + o,
    inverse_image.factor: lambda s, o: s * o,
    inverse_image.numerator: lambda s, o: s / o,
    inverse_image.divisor: lambda s, o: o / s,
    inverse_image.largest: np.maximum,
    inverse_image.smallest: np.minimum,
    inverse_image.exponent: lambda s, o: np.where(o > 0.0, np.abs(o) ** s, np.nan),
}
ENDS = st.one_of(st.sampled_from([0.0, 1.0, -1.0, math.inf, -math.inf]), st.floats(-4.0, 4.0))


def check(spans: Spans, values, low, high):
    """Arguments are in what was found where their values are within the bounds; at the ends rounding decides."""
    near = np.isclose(values, low, rtol=1e-9, atol=1e-9) | np.isclose(values, high, rtol=1e-9, atol=1e-9)
    tried = np.isfinite(values) & ~near
    wanted = (low <= values) & (values <= high)
    assert np.array_equal(spans.contain(ARGUMENTS)[tried], wanted[tried])


def test_every_function_is_tried():
    assert OF_ONE.keys() == inverse_image.FUNCTIONS.keys()


@pytest.mark.parametrize("name", OF_ONE)
@given(ends=st.tuples(ENDS, ENDS))
def test_a_function_of_one_argument(name, ends):
    low, high = min(ends), max(ends)
    with np.errstate(all="ignore"):
        values = OF_ONE[name](ARGUMENTS)
    check(inverse_image.FUNCTIONS[name](Spans.between(np.array([low]), np.array([high]))), values, low, high)


@pytest.mark.parametrize("step", OF_TWO, ids=lambda step: step.__name__)
@given(ends=st.tuples(ENDS, ENDS), o=st.one_of(st.just(0.0), st.just(1.0), st.floats(0.1, 3.0), st.floats(-3.0, -0.1)))
def test_one_of_two_operands(step, ends, o):
    low, high = min(ends), max(ends)
    with np.errstate(all="ignore"):
        values = OF_TWO[step](ARGUMENTS, o)
    check(step(Spans.between(np.array([low]), np.array([high])), np.array([o])), values, low, high)


@pytest.mark.parametrize("power", [2.0, 3.0, 4.0, 0.5, 1.5, -1.0, -2.0, -0.5])
@given(ends=st.tuples(ENDS, ENDS))
def test_powers(power, ends):
    low, high = min(ends), max(ends)
    with np.errstate(all="ignore"):
        values = ARGUMENTS**power
    check(inverse_image.powered(Spans.between(np.array([low]), np.array([high])), power), values, low, high)


@example(ends=(math.inf, math.inf), of=(1.0, 1.0, 1.0, 0.5))
@example(ends=(-math.inf, -math.inf), of=(1.0, 1.0, 1.0, 0.5))
@example(ends=(1.0, math.inf), of=(1.0, 1.0, 1.0, 0.5))
@example(ends=(-math.inf, 1.0), of=(1.0, 1.0, 1.0, 0.5))
@given(ends=st.tuples(ENDS, ENDS), of=st.tuples(*[st.sampled_from([-2.5, -1.0, 0.0, 0.5, 1.0, 3.0])] * 4))
def test_ratios_of_lines(ends, of):
    low, high = min(ends), max(ends)
    a, b, c, d = of
    with np.errstate(all="ignore"):
        values = (a + b * ARGUMENTS) / (c + d * ARGUMENTS)
    spans = Spans.between(np.array([low]), np.array([high]))
    check(inverse_image.ratio(spans, *(np.array([each]) for each in of)), values, low, high)


def test_pieces_are_in_order_and_apart():
    ends = [([4.0], [5.0]), ([1.0], [2.0]), ([1.5], [3.0]), ([9.0], [8.0]), ([math.nan], [1.0])]
    result = union_of_pairs([(np.array(low), np.array(high)) for low, high in ends])
    assert result.low.T.tolist() == [[1.0, 4.0]]
    assert result.high.T.tolist() == [[3.0, 5.0]]


def test_sets_are_met_joined_and_chosen():
    first = union_of_pairs([(np.zeros(2), np.ones(2)), (np.full(2, 4.0), np.full(2, 6.0))])
    second = Spans.between(np.full(2, 0.5), np.full(2, 5.0))
    assert intersection([first, second]).low[:, 0].tolist() == [0.5, 4.0]
    assert intersection([first, second]).high[:, 0].tolist() == [1.0, 5.0]
    assert union([first, second]).high[:, 0].tolist() == [6.0]
    either = choose(np.array([True, False]), first, second)
    assert either.low.T.tolist() == [[0.0, 4.0], [0.5, math.inf]]
    assert not Spans.where(np.array([False])).contain(np.zeros(1))
