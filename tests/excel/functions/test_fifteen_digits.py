"""Comparisons at 15 digits, against digits counted one by one in decimal arithmetic."""

from __future__ import annotations

import math
import operator
import struct
from decimal import ROUND_HALF_UP, Context

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from xlmc.excel.functions.denormals import TINIEST
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.fifteen_digits import (
    COMPARISONS,
    SNAP_TO_ZERO,
    SnapToZero,
    copy_sum,
    equal_range,
    never_cancels,
)
from xlmc.excel.functions.operators import ALL_BITS
from xlmc.excel.functions.values import from_objects

RELATIONS = {
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
DIGITS = Context(prec=15, rounding=ROUND_HALF_UP)

# Doubles from which on Excel's answer changes: one less is equal to it, one more is larger, two more equal to that.
# Found by trying in Excel: Apache POI, NumberComparisonExamples.
STEPS = [
    "4010000000000005",
    "4010000000000010",
    "401000000000001C",
    "403CE0FFFFFFFFF1",
    "5010000000000006",
    "5010000000000010",
    "501000000000001A",
    "544CE6345CF32018",
    "544CE6345CF3205A",
    "544CE6345CF3209C",
    "544CE6345CF320DE",
    "54B250001000101D",
    "54B2500010001050",
    "54B2500010001083",
    "6230100010001000",
    "6230100010001005",
    "623010001000100A",
    "7F50300020001011",
    "7F5030002000102B",
    "7F50300020001044",
    "2B2BFFFF1000102A",
    "2B2BFFFF10001079",
    "2B2BFFFF100010C8",
    "2B2BFF001000102D",
    "2B2BFF0010001035",
    "2B2BFF001000103D",
    "2B61800040002024",
    "2B61800040002055",
    "2B61800040002086",
    "008000000000000B",
    "0010000000000007",
    "001000000000001B",
    "001000000000002F",
]


def double(bits):
    return struct.unpack("<d", struct.pack("<q", bits))[0]


def neighbour(number, steps):
    """The double so many places on, away from 0."""
    (bits,) = struct.unpack("<q", struct.pack("<d", abs(number)))
    return math.copysign(double(max(bits + steps, 0)), number)


def rounded(number):
    return DIGITS.create_decimal_from_float(0.0 if abs(number) < TINIEST else number)


NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
NEARBY = st.tuples(NUMBERS, st.integers(-120, 120)).map(lambda pair: (pair[0], neighbour(*pair)))
PAIRS = NEARBY.filter(lambda pair: math.isfinite(pair[1])) | st.tuples(NUMBERS, NUMBERS)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("bits", STEPS)
def test_the_answer_changes_where_excels_does(bits, sign):
    before, last, first, after = (sign * double(int(bits, 16) + step) for step in (-1, 0, 1, 2))
    for equal in ((before, last), (first, after)):
        assert COMPARISONS["="](*np.atleast_2d(equal).T)[0]
    assert COMPARISONS["<" if sign > 0 else ">"](np.array([last]), np.array([first]))[0]


@pytest.mark.parametrize("symbol", RELATIONS)
@given(PAIRS)
def test_numbers_are_compared_by_their_digits(symbol, pair):
    """As two that vary, and each beside the other as a constant."""
    x, y = pair
    truth = RELATIONS[symbol](rounded(x), rounded(y))
    compare = COMPARISONS[symbol]
    with np.errstate(all="ignore"):
        varying = compare(np.array([x, 1.0, x]), np.array([y, 2.0, y]))
    assert varying[[0, 2]].tolist() == [truth, truth]
    assert compare(np.array([x, x]), y).tolist() == [truth, truth]
    assert compare(x, np.array([y, y])).tolist() == [truth, truth]


@given(PAIRS)
def test_just_one_of_less_equal_and_more_holds_and_both_ways_alike(pair):
    x, y = (np.array([number, 5.0]) for number in pair)
    with np.errstate(all="ignore"):
        assert sum(bool(COMPARISONS[symbol](x, y)[0]) for symbol in "<=>") == 1
        assert COMPARISONS["="](x, y)[0] == COMPARISONS["="](y, x)[0]
        assert COMPARISONS["<"](x, y)[0] == COMPARISONS[">"](y, x)[0]


@given(NUMBERS)
def test_the_ends_are_the_last_doubles_that_are_equal(number):
    least, most = equal_range(number)
    assert least <= number <= most or abs(number) < TINIEST
    assert rounded(least) == rounded(number) == rounded(most)
    outside = math.nextafter(least, -math.inf), math.nextafter(most, math.inf)
    assume(all(map(math.isfinite, outside)))
    assert rounded(number) not in map(rounded, outside)


def test_ranges_are_compared_cell_by_cell():
    cells = np.array([0.1, 0.2, 0.3]).reshape(1, 3, 1)
    trials = np.array([3.0, 2.0]).reshape(2, 1, 1)
    result = COMPARISONS["="](cells * 3, np.broadcast_to(cells * trials, (2, 3, 1)))
    assert result[..., 0].tolist() == [[True] * 3, [False] * 3]
    assert COMPARISONS["="](cells * trials, 0.3)[..., 0].tolist() == [[True, False, False], [False] * 3]


def test_what_is_no_number_is_compared_as_it_is():
    infinite = np.array([math.inf, -math.inf, math.nan])
    assert COMPARISONS["="](infinite, math.inf).tolist() == [True, False, False]


@pytest.mark.parametrize("symbol", RELATIONS)
def test_limits_in_tables_keep_all_bits(symbol):
    x, y = (from_objects(np.array([number], object)) for number in (0.1 * 3, 0.3))
    assert bool(ALL_BITS[symbol]([x, y]).numbers[0]) is RELATIONS[symbol](0.1 * 3, 0.3)
    assert bool(function_named(symbol)([x, y]).numbers[0]) is RELATIONS[symbol](0.3, 0.3)


NUMBERS_OF_LAST_SUM = st.floats(-1e300, 1e300, allow_subnormal=False)
LIMITS = st.floats(-1e6, 1e6)


def settled(total, first):
    return SNAP_TO_ZERO.ufunc(np.atleast_1d(total), np.atleast_1d(first))


@given(NUMBERS_OF_LAST_SUM, st.integers(-20, 20))
def test_fewer_than_eight_units_of_the_first_number_are_0(first, units):
    total = units * math.ulp(first)
    assert settled(total, first)[0] == (0.0 if abs(units) < 8 and first != 0 else total)


@given(st.lists(st.tuples(NUMBERS_OF_LAST_SUM, NUMBERS_OF_LAST_SUM), min_size=1))
def test_it_is_the_same_for_each_trial_alone_and_in_any_memory(pairs):
    total, first = np.array(pairs).T.copy()
    alone = [settled(*pair)[0] for pair in pairs]
    assert settled(total, first).tolist() == alone
    assert SnapToZero(float(np.abs(first).max()))(total, first).tolist() == alone
    for out in (total.copy(), first.copy()):
        a, b = total.copy(), first.copy()
        assert SNAP_TO_ZERO.ufunc(a, b, out=out).tolist() == alone
    assert SNAP_TO_ZERO.ufunc(total.copy(), first, out=first).tolist() == alone


def test_numbers_that_cancel_beside_numbers_that_do_not():
    total, first = np.array([1e-17, 1e-17, -3.0, 0.0]), np.array([0.1, 1e-17, 1e10, 0.0])
    assert settled(total, first).tolist() == [0.0, 1e-17, -3.0, 0.0]


@given(LIMITS, LIMITS, LIMITS, LIMITS, st.booleans(), st.integers(0, 2**32))
def test_what_never_cancels_is_kept(a, b, c, d, adds, seed):
    first, second = sorted((a, b)), sorted((c, d))
    other = second if adds else [-second[1], -second[0]]
    result = first[0] + other[0], first[1] + other[1]
    if not never_cancels(result, tuple(first), tuple(second) if adds else None):
        return
    rng = np.random.default_rng(seed)
    x, y = (rng.uniform(*ends, 20) for ends in (first, second))
    total = x + y if adds else x - y
    assert settled(total, x).tolist() == total.tolist() == copy_sum(total, x, out=x).tolist()


@given(LIMITS, LIMITS, LIMITS, LIMITS, st.booleans(), st.integers(0, 2**32))
def test_what_bounds_tell_of_either_number_changes_no_sum(a, b, c, d, adds, seed):
    """Sums of numbers within bounds, half of which cancel all but the last bits."""
    first, second = sorted((a, b)), sorted((c, d))
    rng = np.random.default_rng(seed)
    x, y = (rng.uniform(*ends, 20).clip(*ends) for ends in (first, second))
    opposite = -x if adds else x
    y = np.where(rng.random(20) < 0.5, (opposite * (1 + rng.integers(-8, 9, 20) * 2.0**-52)).clip(*second), y)
    total = x + y if adds else x - y
    for known in ((tuple(first), tuple(second)), (None, tuple(second)), (tuple(first), None)):
        assert SnapToZero.within(*known)(total, x).tolist() == settled(total, x).tolist()
    assert SnapToZero.within(None, (-math.inf, 1.0)).largest is None


def test_numbers_that_are_near_each_other_in_some_trials_only():
    """Whether any are near decides how all are compared."""
    x = np.array([1.0, 2.0, 3.0, 0.1 + 0.2, 5.0])
    for y in (np.array([2.0, 1.0, 4.0, 0.3, 5.0]), np.array([2.0, 1.0, 4.0, 0.4, 4.0])):
        for symbol, relation in RELATIONS.items():
            wanted = [relation(rounded(a), rounded(b)) for a, b in zip(x, y, strict=True)]
            assert COMPARISONS[symbol](x, y).tolist() == wanted
            assert COMPARISONS[symbol](x, y, out=np.empty(5, bool)).tolist() == wanted
            for bounds in ((None, (0.0, 5.0)), ((1.0, math.inf), (1.0, 5.0)), ((0.0, 5.0), None)):
                assert COMPARISONS[symbol].within(*bounds)(x, y).tolist() == wanted


def test_infinite_numbers_that_vary_are_compared_as_they_are():
    x, y = np.array([math.inf, -math.inf, 1.0, math.nan]), np.array([math.inf, math.inf, -math.inf, 1.0])
    with np.errstate(all="ignore"):
        result = {symbol: COMPARISONS[symbol](x, y).tolist() for symbol in RELATIONS}
        assert result == {symbol: relation(x, y).tolist() for symbol, relation in RELATIONS.items()}


@pytest.mark.parametrize(
    ("result", "first", "second", "never"),
    [
        ((1.0, 3.0), (0.0, 1.0), (1.0, 2.0), True),
        ((0.0, 3.0), (0.0, 1.0), (0.0, 2.0), True),
        ((-3.0, 0.0), (-1.0, 0.0), (-2.0, 0.0), True),
        ((-1.0, 3.0), (-2.0, 1.0), (1.0, 2.0), False),
        ((1.0, 3.0), (4.0, 5.0), None, True),
        ((-3.0, -1.0), (1.0, 2.0), None, True),
        ((0.0, 3.0), (4.0, 5.0), None, False),
        ((1e-12, 3.0), (4.0, 5.0), None, False),
        ((0.0, math.inf), (0.0, math.inf), (0.0, 2.0), True),
        ((2.0, math.inf), (4.0, math.inf), (-2.0, 2.0), False),
    ],
)
def test_bounds_tell_what_never_cancels(result, first, second, never):
    assert never_cancels(result, first, second) is never
