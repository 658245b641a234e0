"""Jets by hand: a = 3 with a' = 2, a'' = 5 in the assumption 0; b = 4 with b' = -1, b'' = 0.5 in the assumption 2."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.passes.derivatives.jet import Jet, align, by_value, chain, concatenate, flat
from xlmc.excel.functions.values import Value


def jet(x, number, first, second=None, error=None, second_error=None):
    parts = [None if part is None else np.full((1,) * axes + (1,), part) for part, axes in
             ((first, 1), (second, 2), (error, 1), (second_error, 2))]  # fmt: skip
    return Jet(np.array([x]), (number,), *parts)


A = jet(3.0, 0, 2.0, 5.0, 0.1, 0.2)
B = jet(4.0, 2, -1.0, 0.5, 0.3, 0.7)
STILL = Jet.still(np.array([7.0]))


def parts(result):
    """First derivatives, second derivatives, and the errors of both, of trial 0, as lists."""
    return [
        None if part is None else part[..., 0].tolist()
        for part in (result.first, result.second, result.error, result.second_error)
    ]


@pytest.mark.parametrize(
    ("result", "x", "active", "expected"),
    [
        (A + B, 7.0, (0, 2), [[2, -1], [[5, 0], [0, 0.5]], [0.1, 0.3], [[0.2, 0], [0, 0.7]]]),
        (A - B, -1.0, (0, 2), [[2, 1], [[5, 0], [0, -0.5]], [0.1, 0.3], [[0.2, 0], [0, 0.7]]]),
        # (ab)' = a'b, ab'; (ab)'' = a''b, a'b', ab''; errors 0.1·4, 0.3·3; mixed |a'|·0.3 + |b'|·0.1
        (A * B, 12.0, (0, 2), [[8, -3], [[20, -2], [-2, 1.5]], [0.4, 0.9], [[0.8, 0.7], [0.7, 2.1]]]),
        # (a/b): a'/b, -ab'/b²; a''/b, -a'b'/b², 2ab'²/b³ - ab''/b²
        (A / B, 0.75, (0, 2), [
            [0.5, 0.1875], [[1.25, 0.125], [0.125, 0.09375 - 0.09375]], [0.025, 0.05625],
            [[0.05, 0.04375], [0.04375, 0.13125 + 2 * 0.09375 * 0.3]],
        ]),
        # a² through the product of itself: 2aa', 2aa'' + 2a'²; errors 2a·0.1, 2a·0.2 + 2·2·a'·0.1
        (A * A, 9.0, (0,), [[12], [[38]], [0.6], [[2.0]]]),
        (A + STILL, 10.0, (0,), [[2], [[5]], [0.1], [[0.2]]]),
        (A * STILL, 21.0, (0,), [[14], [[35]], [0.7], [[1.4]]]),
        (STILL - A, 4.0, (0,), [[-2], [[-5]], [0.1], [[0.2]]]),
        (A.times(-3.0), -9.0, (0,), [[-6], [[-15]], [0.3], [[0.6]]]),
        (A.times(0.0, np.array([8.0])), 8.0, (0,), [[0], [[0]], [0], [[0]]]),
        # ln a: a'/a, a''/a - a'²/a²; errors 0.1/3, 0.2/3 + 2·2·0.1/9
        (A.ln(), np.log(3.0), (0,), [[2 / 3], [[5 / 3 - 4 / 9]], [0.1 / 3], [[0.2 / 3 + 0.4 / 9]]]),
        # √b: b'/(2√b), b''/(2√b) - b'²/(4b√b)
        (B.sqrt(), 2.0, (2,), [[-0.25], [[0.125 - 1 / 32]], [0.075], [[0.175 + 0.6 / 32]]]),
        (A.lost(np.array([False])), 3.0, (0,), [[2], [[5]], [0.1], [[0.2]]]),
        (jet(3.0, 1, 2.0).ln(), np.log(3.0), (1,), [[2 / 3], None, None, None]),
        (jet(3.0, 1, 2.0) * jet(4.0, 1, -1.0), 12.0, (1,), [[5], None, None, None]),
        (jet(3.0, 1, 2.0, error=0.1) * jet(4.0, 1, -1.0), 12.0, (1,), [[5], None, [0.4], None]),
        (STILL * STILL, 49.0, (), [[], [], None, None]),
    ],
)  # fmt: skip
def test_arithmetic(result, x, active, expected):
    assert result.x == pytest.approx([x])
    assert result.active == active
    for part, wanted in zip(parts(result), expected, strict=True):
        assert part is None if wanted is None else np.array(part) == pytest.approx(np.array(wanted))


def test_the_jet_of_draws():
    one, two = (Jet.of_input(np.array([1.0, 2.0]), 4, order) for order in (1, 2))
    assert (one.active, one.first.tolist(), one.second, one.order) == ((4,), [[1.0]], None, 1)
    assert (two.active, two.first.tolist(), two.second.tolist(), two.order) == ((4,), [[1.0]], [[[0.0]]], 2)
    assert (one.error, one.second_error) == (None, None)


@pytest.mark.parametrize(("x", "none"), [(np.zeros(3), (1,)), (np.zeros((3, 2, 2)), (1, 1, 1))])
def test_a_still_jet_has_no_derivatives(x, none):
    still = Jet.still(x)
    assert still.active == ()
    assert (still.first.shape, still.second.shape, still.order) == ((0, *none), (0, 0, *none), 2)


def test_derivatives_are_lost_where_told():
    """Trial 1 alone; the value stays."""
    two = Jet(np.array([3.0, 4.0]), (0,), np.array([[2.0, 5.0]]), np.array([[[7.0, 8.0]]]))
    result = two.lost(np.array([False, True]))
    assert result.x.tolist() == [3.0, 4.0]
    assert np.array_equal(result.first, [[2.0, np.nan]], equal_nan=True)
    assert np.array_equal(result.second, [[[7.0, np.nan]]], equal_nan=True)


def test_ranges_and_rows():
    wide = A.as_range()
    assert (wide.x.shape, wide.first.shape, wide.second.shape) == ((1, 1, 1), (1, 1, 1, 1), (1, 1, 1, 1, 1))
    assert wide.as_range() is wide
    grid = Jet(np.arange(12.0).reshape(2, 2, 3), (0,), np.full((1, 1, 1, 1), 2.0), np.full((1, 1, 1, 1, 1), 3.0))
    assert (grid.spread().first.shape, grid.spread().second.shape) == ((1, 2, 2, 3), (1, 1, 2, 2, 3))
    side = flat(grid, Value.of_numbers(grid.x))
    assert (side.x[1].tolist(), side.first.shape, side.second.shape) == ([6, 7, 8, 9, 10, 11], (1, 2, 6), (1, 1, 2, 6))
    total = side.total()
    assert total.x.tolist() == [15.0, 51.0]
    assert (total.first.tolist(), total.second.tolist()) == ([[12.0, 12.0]], [[[18.0, 18.0]]])
    single = flat(jet(3.0, 0, 2.0, 5.0), Value.of_numbers(np.array([3.0])))
    assert (single.x.tolist(), single.first.tolist()) == ([[3.0]], [[[2.0]]])


def test_jets_with_the_same_assumptions():
    """Rows and columns of 0 for those that do not reach it, errors alike; one that needs none stays as it is."""
    wide, other = align([B, A])
    assert wide.active == other.active == (0, 2)
    assert wide.first[:, 0].tolist() == [0.0, -1.0]
    assert wide.second[..., 0].tolist() == [[0.0, 0.0], [0.0, 0.5]]
    assert wide.error[:, 0].tolist() == [0.0, 0.3]
    assert wide.second_error[..., 0].tolist() == [[0.0, 0.0], [0.0, 0.7]]
    assert align([A, A])[0] is A


def test_second_derivatives_that_are_0_are_left_out():
    result = chain(np.array([0.0]), [A, B], [1.0, 1.0], lambda: {(0, 0): 0.0, (0, 1): np.zeros(1), (1, 1): 2.0})
    assert result.second[..., 0].tolist() == [[5.0, 0.0], [0.0, 0.5 + 2.0]]


def test_seconds_are_not_asked_for_in_the_first_order():
    def never():
        raise AssertionError

    assert chain(np.array([1.0]), [jet(3.0, 0, 2.0)], [4.0], never).first.tolist() == [[8.0]]


def test_cells_side_by_side():
    """A row of two cells and one of one, over two trials: what lacks an estimate counts as exact."""
    n = 2
    row = Jet(
        np.array([[1.0, 2.0]]), (0,), np.array([[[3.0, 4.0]]]), np.array([[[[5.0, 6.0]]]]), np.full((1, 1, 2), 0.5)
    )
    one = Jet(np.array([[7.0], [8.0]]), (0,), np.array([[[9.0]]]), np.array([[[[1.0]]]]))
    result = concatenate([row, one], n)
    assert result.x.tolist() == [[1.0, 2.0, 7.0], [1.0, 2.0, 8.0]]
    assert result.first.tolist() == [[[3.0, 4.0, 9.0]] * 2]
    assert result.second.tolist() == [[[[5.0, 6.0, 1.0]] * 2]]
    assert result.error.tolist() == [[[0.5, 0.5, 0.0]] * 2]
    assert result.second_error is None
    still = concatenate([Jet.still(np.array([[1.0]])), Jet.still(np.array([[2.0]]))], n)
    assert (still.active, still.first.shape) == ((), (0, 2, 2))


def test_the_first_cell_with_a_value():
    """Trial 0: the second cell; trial 1: two cells that change alike; 2: two that do not; 3: none that counts."""
    x = np.array([[1.0, 2.0, 3.0], [5.0, 4.0, 5.0], [6.0, 6.0, 1.0], [1.0, 2.0, 9.0]])
    first = np.array([[[1.0, 2.0, 3.0], [4.0, 7.0, 4.0], [8.0, 9.0, 1.0], [1.0, 1.0, 1.0]]])
    counts = np.array([[True] * 3] * 3 + [[True, True, False]])
    picked, chosen = by_value(Jet(x, (0,), first), counts, np.array([2.0, 5.0, 6.0, 9.0]))
    assert picked.x.tolist() == [2.0, 5.0, 6.0, 9.0]
    assert np.array_equal(picked.first, [[2.0, 4.0, np.nan, 0.0]], equal_nan=True)
    assert chosen[:3].tolist() == [1, 0, 0]
