"""What loops round has the bits of the functions' own bodies; what these compute in decimals is left to them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from hypothesis import example, given, settings
from hypothesis import strategies as st

from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.tracking import TrackingEvaluator
from xlmc.excel.functions.denormals import tiny_to_zero
from xlmc.excel.functions.registry import REGISTRY
from xlmc.excel.functions.values import Value

GENERATOR = np.random.default_rng(11)
DIGITS = (0, 2, 9, 15, 22, -1, -22)
TO_DIGITS = ("ROUND", "ROUNDUP", "ROUNDDOWN", "TRUNC")


def around(numbers):
    """The numbers, and doubles near them: by one bit, by some, and by about half a unit of the 15th digit."""
    numbers = np.asarray(numbers, float)
    shares = np.array([1, 3, 9, 20, 23, 45]) * 2.0**-52
    with np.errstate(over="ignore", under="ignore"):
        near = [numbers * (1 + share) for share in (*shares, *-shares)]
    result = np.concatenate([numbers, np.nextafter(numbers, 0), *near])
    return result[np.isfinite(result)]


def any_size(n):
    return np.exp(GENERATOR.uniform(np.log(1e-300), np.log(1e300), n))


WHOLE = np.concatenate(
    [np.arange(0.0, 60), 10.0 ** np.arange(0, 23), 2.0 ** np.arange(0, 60), 10.0 ** np.arange(16) - 1]
)
NUMBERS = {
    "whole": around(WHOLE),
    "halves": around(WHOLE + 0.5),
    "decimals": around(
        np.concatenate([np.arange(1, 400, 4) * 0.1, np.arange(1, 400, 4) * 0.005, np.arange(1, 90) / 1000])
    ),
    "far decimals": around(np.outer(10.0 ** np.arange(-22, 5), np.arange(1, 20, 3) * 0.5).ravel()),
    "any size": around(any_size(100)),
    "plain": GENERATOR.uniform(0, 1000, 2000),
    "15 digits and more": around(GENERATOR.uniform(1e13, 1e17, 100)),
    "large": np.array([1e15, 2.0**52, 2.0**53, 4503599627370495.5, 1e22, 1e300, 1.7976931348623157e308]),
    "tiny": np.array([0.0, -0.0, 5e-324, 1e-310, 2.3e-308, 1e-307, 9e-291, 1e-290, 1.1e-290, 1e-200, 1e-30]),
}


def signed(numbers):
    return np.concatenate([numbers, -numbers])


def of_body(name, *arguments):
    """What the careful path gives: numbers, and codes of errors."""
    function = REGISTRY[name]
    result = function([Value.of_numbers(np.asarray(argument, float).reshape(-1)) for argument in arguments])
    return np.broadcast_to(result.numbers, result.shape), np.broadcast_to(result.errors, result.shape)


def same_bits(result, expected):
    np.testing.assert_array_equal(result.view(np.int64), np.ascontiguousarray(expected, float).view(np.int64))


@pytest.fixture(scope="module")
def rounded(compiled):
    """`rounded(x)`: (function, digits) -> its numbers, of all functions and digits at once."""
    calls = [(name, digits) for name in TO_DIGITS for digits in DIGITS] + [("INT", None), ("TRUNC", None)]
    cells = {
        f"B{row}": f"={name}(A1)" if digits is None else f"={name}(A1,{digits})"
        for row, (name, digits) in enumerate(calls, 1)
    }
    evaluate = compiled(cells)

    def of(x):
        return dict(zip(calls, evaluate(x), strict=True))

    return of


@cache
def rounded_by_body(kind, name, digits):
    """What the body makes of the numbers of a kind, for processors of both sorts."""
    return of_body(name, tiny_to_zero(signed(NUMBERS[kind])), *([] if digits is None else [[digits]]))


@pytest.mark.parametrize("kind", NUMBERS)
def test_numbers_are_rounded_to_the_bits_of_the_body(rounded, kind):
    for (name, digits), result in rounded(signed(NUMBERS[kind])).items():
        expected, errors = rounded_by_body(kind, name, digits)
        assert not errors.any()
        same_bits(result, expected)


FINITE = st.floats(allow_nan=False, allow_infinity=False)
DECIMALS = st.builds(lambda whole, digits: whole / 10.0**digits, st.integers(-(10**17), 10**17), st.integers(0, 20))


@settings(max_examples=45)
@given(st.lists(FINITE | DECIMALS, min_size=1, max_size=40))
@example([0.09999999999999995, 1.005, 2490399.9999999995, -2490399.9999999995, 0.285, 1e15 - 0.5])
def test_any_numbers_are_rounded_to_the_bits_of_the_body(rounded, numbers):
    x = around(numbers)
    for (name, digits), result in rounded(x).items():
        expected, errors = of_body(name, tiny_to_zero(x), *([] if digits is None else [[digits]]))
        assert not errors.any()
        same_bits(result, expected)


def columns_of(lower, formulas, *draws):
    """The columns of formulas of A1, A2, by loops; and how many trials were computed again."""
    inputs = [f"A{row}" for row in range(1, len(draws) + 1)]
    cells = {f"B{row}": f"={formula}" for row, formula in enumerate(formulas, 1)}
    lowering, targets = lower(cells, inputs, [*cells])
    program, again = JitProgram(lowering, targets, [], frozenset()), []
    assert program.first.loops is not None
    careful = TrackingEvaluator.filters
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TrackingEvaluator, "filters", lambda *given: again.append(given[2]) or careful(*given))
        columns = program.evaluator(draws[0].size).filters(dict(zip(inputs, draws, strict=True)), draws[0].size)
    return columns, sum(again)


PAIRS = {
    "plain": (GENERATOR.uniform(-50, 50, 3000), GENERATOR.uniform(-3, 3, 3000)),
    "decimals": tuple(part.ravel() for part in np.meshgrid(np.arange(-60, 61) * 0.05, np.arange(-12, 13) * 0.1)),
    "whole": tuple(part.ravel() for part in np.meshgrid(np.arange(-30.0, 31), np.arange(-6.0, 7))),
    "any size": (signed(any_size(1000)), signed(any_size(1000))[::-1].copy()),
    "tiny and large": tuple(
        part.ravel() for part in np.meshgrid(*2 * [signed(np.append(NUMBERS["tiny"], NUMBERS["large"]))])
    ),
}


@pytest.mark.parametrize("kind", PAIRS)
@pytest.mark.parametrize("name", ["QUOTIENT", "MROUND", "MOD"])
def test_multiples_have_the_bits_of_the_body_and_its_errors(lower, kind, name):
    x, divisor = map(tiny_to_zero, PAIRS[kind])
    (column,), _ = columns_of(lower, [f"{name}(A1,A2)"], x, divisor)
    expected, errors = of_body(name, x, divisor)
    errors = np.where((errors == 0) & ~np.isfinite(expected), 6, errors)
    codes = np.zeros(x.size, np.uint8) if column.codes is None else column.codes
    np.testing.assert_array_equal(codes, errors)
    same_bits(column.values[errors == 0], tiny_to_zero(expected)[errors == 0])


@pytest.fixture(scope="module")
def remainder(compiled):
    return compiled({"B1": "=MOD(A1,A2)"}, ("A1", "A2"))


@settings(max_examples=45)
@given(st.lists(st.tuples(FINITE | DECIMALS, FINITE | DECIMALS), min_size=1, max_size=20), st.integers(1, 2**54))
@example([(0.3, 0.1), (1.0, 0.1), (-0.3, 0.1), (6.0, 1.1)], 3)
def test_remainders_of_any_numbers_and_of_near_multiples_are_exact(remainder, pairs, times):
    x, divisor = map(np.array, zip(*pairs, strict=True))
    with np.errstate(over="ignore", under="ignore"):
        products = divisor * times
        near = [products, np.nextafter(products, 0), np.nextafter(products, np.inf), -products, divisor * times / 2]
    x, divisor = np.concatenate([x, *near]), np.tile(divisor, 6)
    fine = np.isfinite(x) & (tiny_to_zero(divisor) != 0)
    x, divisor = tiny_to_zero(x[fine]), tiny_to_zero(divisor[fine])
    same_bits(remainder(x, divisor)[0] if x.size else x, tiny_to_zero(np.remainder(x, divisor)))


def test_even_and_odd(lower):
    x = signed(np.concatenate(list(NUMBERS.values())))
    columns, again = columns_of(lower, ["ISEVEN(A1)", "ISODD(A1)"], x)
    for column, name in zip(columns, ("ISEVEN", "ISODD"), strict=True):
        assert column.values.tolist() == of_body(name, tiny_to_zero(x))[0].tolist()
    assert again == 0


@pytest.mark.parametrize(
    ("formulas", "x"),
    [
        (["INT(A1)"], signed(np.arange(0, 500) / 4)),
        ([f"{name}(A1,2)" for name in TO_DIGITS], signed(np.arange(0, 3000) / 1000)),
        (["ROUND(A1*3,1)", "ROUND(A1/7,-1)", "INT(A1*0.1)"], signed(np.arange(0, 2000) / 10)),
        ([f"{name}(A1,4)" for name in (*TO_DIGITS, "ROUND")], GENERATOR.uniform(-100, 100, 5000)),
    ],
)
def test_no_trial_with_plain_numbers_is_computed_again(lower, formulas, x):
    """Not even where they are halves and multiples, as doubles have them."""
    assert columns_of(lower, formulas, x)[1] == 0


@pytest.mark.parametrize(
    ("formula", "begin", "step", "tenths"),
    [
        ("TRUNC(A1,1)", 0.1, -(2.0**-57), {0, 1}),
        ("ROUNDDOWN(A1,1)", -0.1, 2.0**-57, {0, -1}),
        ("ROUNDUP(A1,1)", 0.1, 2.0**-56, {1, 2}),
        ("ROUND(A1,1)", 0.05, -(2.0**-58), {0, 1}),
        ("INT(A1)", 1.0, -(2.0**-53), {0, 10}),
        ("INT(A1)", -1.0, -(2.0**-52), {-10, -20}),
    ],
)
def test_what_decimals_decide_is_computed_again(lower, formula, begin, step, tenths):
    """0.09999999999999995 shows as 0.0999999999999999 or as 0.1, with 15 digits: its last bit says which."""
    x = begin + np.arange(60) * step
    (column,), again = columns_of(lower, [formula], x)
    assert 0 < again < 9
    assert {*np.round(column.values * 10).tolist()} == tenths


@pytest.mark.parametrize(
    "call", ["ROUND(1/A1,2)", "INT(1/A1)", "ROUNDUP(1/A1,-2)", "IF(ISODD(1/A1),1,2)", "TRUNC(1/A1)"]
)
def test_errors_stay_errors(lower, call):
    (column,), again = columns_of(lower, [call], np.array([0.0, 1.0, 0.0, 4.0]))
    assert again == 2
    assert column.codes.tolist() == [2, 0, 2, 0]


def test_digits_that_are_not_known_are_left_to_numpy(lower):
    cells = {"B1": "=ROUND(A1,A2)", "B2": "=ROUND(A1,23)", "B3": "=ROUND(A1,2.9)"}
    lowering, targets = lower(cells, ["A1", "A2"], [*cells])
    program = JitProgram(lowering, targets, [], frozenset())
    outside = [step for step in program.first._steps if isinstance(step, tuple)]
    assert [lowering.dag.nodes[node].function.name for step in outside for node in step] == ["ROUND", "ROUND"]
