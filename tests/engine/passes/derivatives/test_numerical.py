"""Differences of functions whose derivatives are known, with estimates of their errors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.engine.passes.derivatives.jet import Jet
from xlmc.engine.passes.derivatives.numerical import _best, by_differences
from xlmc.engine.passes.derivatives.rules import Operand
from xlmc.errors import ErrorCode
from xlmc.excel.functions.values import Value, constant, from_objects


def of_numbers(f):
    """A function of values, from one of their numbers that carries errors as NaN."""

    def apply(values):
        with np.errstate(all="ignore"):
            return Value.of_numbers(np.asarray(f(*(value.numbers for value in values)), float))

    return apply


def differences(function, operands):
    with np.errstate(all="ignore"):
        return by_differences(function, function([operand.value for operand in operands]), operands)


@pytest.fixture
def along(operands_of):
    """`along(f, *points, order=2, still=())`: the jet of `f`, whose estimates cover the true errors."""

    def make(f, *points, order=2, still=()):
        return differences(of_numbers(f), operands_of(points, still=still, order=order)).jet

    return make


@pytest.mark.parametrize("x", [1e-9, 3e-5, 0.4, 1.0, 2.0, 30.0, 4e6, -2e-7, -0.7, -50.0])
@pytest.mark.parametrize(
    ("f", "first", "second"),
    [
        (lambda x: 3 * x - 2, lambda x: 3.0, lambda x: 0.0),
        (lambda x: x**3, lambda x: 3 * x**2, lambda x: 6 * x),
        (lambda x: x / (1 + np.abs(x)) , lambda x: (1 + abs(x)) ** -2, lambda x: -2 * np.sign(x) * (1 + abs(x)) ** -3),
        (np.arctan, lambda x: 1 / (1 + x * x), lambda x: -2 * x / (1 + x * x) ** 2),
        (lambda x: np.exp(-x * x / 1e6), lambda x: -2e-6 * x * math.exp(-x * x / 1e6), None),
        (lambda x: 5.0 + 0 * x, lambda x: 0.0, lambda x: 0.0),
    ],
    ids=["line", "cube", "saturating", "arctan", "bell", "constant"],
)  # fmt: skip
def test_smooth_functions_of_any_size(along, f, first, second, x):
    jet = along(f, np.array([x]))
    size = abs(float(f(np.array([x]))[0]))
    if not (f(np.array([0.0])) == 0 and f(np.array([-1.0])) == -0.5):  # x/(1+|x|) bends at 0
        assert np.isfinite(jet.first).all()
    if np.isfinite(jet.first).all():
        assert abs(jet.first[0, 0] - first(x)) <= 10 * jet.error[0, 0] + 1e-13 * abs(first(x))
        assert jet.error[0, 0] <= 1e-4 * abs(first(x)) + 1e-6 * size / max(abs(x), 1e-9)
    if second is not None and np.isfinite(jet.second).all():
        assert abs(jet.second[0, 0, 0] - second(x)) <= 10 * jet.second_error[0, 0, 0] + 1e-13 * abs(second(x))


@pytest.mark.parametrize(
    ("f", "x", "first", "second"),
    [
        (np.sin, 0.3, math.cos(0.3), -math.sin(0.3)),
        (np.exp, 0.0, 1.0, 1.0),
        (lambda x: x**2, 0.0, 0.0, 2.0),
        (lambda x: 1 + np.cos(x - 3), 3.0, 0.0, -1.0),
        (np.exp, 2.0, math.exp(2), math.exp(2)),
        (lambda x: x**4, 10.0, 4000.0, 1200.0),
        (lambda x: 1 / x, -0.25, -16.0, -128.0),
        (lambda x: np.sqrt(x), 1e4, 0.005, -2.5e-7),
        (lambda x: np.log(x), 1e-4, 1e4, -1e8),
        (lambda x: np.sin(1000 * x), 0.5, 1000 * math.cos(500.0), -1e6 * math.sin(500.0)),
        (lambda x: np.abs(x - 1), 1.001, 1.0, 0.0),
        (lambda x: np.sin(x * 1e-3), 1e-3, 1e-3 * math.cos(1e-6), -1e-6 * math.sin(1e-6)),
    ],
)
def test_estimates_are_small(along, f, x, first, second):
    """Smooth at the step that suits the size of x, or at one of the others that are tried."""
    jet = along(f, np.array([x]))
    assert jet.first[0, 0] == pytest.approx(first, rel=1e-8, abs=1e-12)
    assert jet.error[0, 0] <= 1e-7 * abs(first) + 1e-9
    assert jet.second[0, 0, 0] == pytest.approx(second, rel=1e-4, abs=1e-6)


@pytest.mark.parametrize(
    ("f", "x"),
    [
        (lambda x: np.abs(x), 0.0),
        (lambda x: np.abs(x - 3), 3.0),
        (lambda x: np.maximum(x, 5 * x - 12), 3.0),
        (lambda x: np.floor(x), 3.0),
        (lambda x: np.where(x < 2, x, x + 1e-3), 2.0),
        (lambda x: np.sqrt(x), 0.0),
        (lambda x: np.cbrt(x), 0.0),
        (lambda x: np.where(x > 5, np.nan, x), 5.0),
    ],
    ids=[
        "turn",
        "turn at 3",
        "uneven turn",
        "jump",
        "small jump",
        "vertical",
        "vertical on both sides",
        "an error beyond",
    ],
)
def test_where_there_is_none(along, f, x):
    """In the first of two trials; the second is 11/8 beside it, where the function is smooth."""
    jet = along(f, np.array([x, x + 1.375]))
    assert np.isnan(jet.first[0, 0])
    assert np.isnan(jet.second[0, 0, 0])
    assert jet.error[0, 0] == np.inf


def test_trials_do_not_mix(along):
    x = np.array([0.5, 2.0, 1e5, 1e-5])
    jet = along(lambda x: x**2, x)
    assert jet.first[0] == pytest.approx(2 * x, rel=1e-9)
    assert jet.second[0, 0] == pytest.approx(np.full(4, 2.0), rel=1e-5)


@pytest.mark.parametrize("point", [(0.7, 1.9), (200.0, 0.03), (-3.0, 5e4)])
def test_two_arguments(along, point):
    """x²y + 3y: gradient (2xy, x² + 3), second derivatives 2y, 2x, 0."""
    x, y = point
    jet = along(lambda x, y: x * x * y + 3 * y, *(np.array([one]) for one in point))
    assert jet.active == (0, 1)
    assert jet.first[:, 0] == pytest.approx([2 * x * y, x * x + 3], rel=1e-9)
    assert jet.second[..., 0] == pytest.approx(np.array([[2 * y, 2 * x], [2 * x, 0]]), rel=1e-4, abs=1e-3 * abs(x / y))
    assert jet.second[0, 1, 0] == jet.second[1, 0, 0]
    assert (jet.second_error[0, 1] == jet.second_error[1, 0]).all()
    assert (jet.error < 1e-7 * np.abs(jet.first)).all()
    assert (jet.second_error >= 0).all()


def test_an_argument_that_stands_still(along):
    jet = along(lambda x, y: x * y, np.array([2.0]), np.array([3.0]), still=(0,))
    assert jet.active == (0,)
    assert jet.first[0, 0] == pytest.approx(2.0, rel=1e-9)


def test_in_the_first_order_there_are_no_second_derivatives(along):
    jet = along(lambda x, y: x * y, np.array([2.0]), np.array([3.0]), order=1)
    assert jet.first[:, 0] == pytest.approx([3.0, 2.0], rel=1e-9)
    assert (jet.second, jet.second_error) == (None, None)


def _bent(x, number, first, second, error=None, second_error=None):
    parts = [None if part is None else np.full((1,) * axes + (1,), part) for part, axes in
             ((first, 1), (second, 2), (error, 1), (second_error, 2))]  # fmt: skip
    return Operand(constant(x), Jet(np.array([x]), (number,), *parts))


def test_the_chain_rule_with_errors_of_the_arguments():
    """sin at 0.5 of a number with derivatives 2 and 3, known to 0.1 and 0.2: their errors are scaled and added."""
    operand = _bent(0.5, 0, 2.0, 3.0, 0.1, 0.2)
    jet = differences(of_numbers(np.sin), [operand]).jet
    c, s = math.cos(0.5), math.sin(0.5)
    assert jet.first[0, 0] == pytest.approx(2 * c, rel=1e-9)
    assert jet.second[0, 0, 0] == pytest.approx(3 * c - 4 * s, rel=1e-6)
    assert jet.error[0, 0] == pytest.approx(0.1 * c, rel=1e-6)
    assert jet.second_error[0, 0, 0] == pytest.approx(0.2 * c + 2 * s * 0.1 * 2, rel=1e-5)


@pytest.mark.parametrize("order", [1, 2])
def test_an_assumption_that_reaches_both_arguments(order):
    """x·y, both of them of one assumption, is differenced along it: first 2·3 + 5·4, second 7·3 + 2·2·5 + 9·4."""
    x, y = _bent(4.0, 0, 2.0, 7.0), _bent(3.0, 0, 5.0, 9.0)
    if order == 1:
        x, y = (Operand(one.value, Jet(one.jet.x, (0,), one.jet.first)) for one in (x, y))
    outcome = differences(of_numbers(lambda x, y: x * y), [x, y])
    assert outcome.numerical
    assert outcome.jet.active == (0,)
    assert outcome.jet.first[0, 0] == pytest.approx(26.0, rel=1e-9)
    assert outcome.jet.error[0, 0] <= 1e-7 * 26
    if order > 1:
        assert outcome.jet.second[0, 0, 0] == pytest.approx(77.0, rel=1e-5)
        assert outcome.jet.second_error[0, 0, 0] <= 1e-4 * 77
    else:
        assert (outcome.jet.second, outcome.jet.second_error) == (None, None)


def total(f):
    """A function of one range: the sum of `f` of its cells."""
    return of_numbers(lambda cells: f(cells).sum(axis=(1, 2)))


def test_cells_of_a_range(operands_of):
    """Σ sin(x): cos(x) and -sin(x) of each of four cells, no mixed derivatives."""
    cells = np.array([[[0.3, 1.2], [-0.8, 2.0]]])
    jet = differences(total(np.sin), operands_of([cells])).jet
    x = cells.ravel()
    assert jet.first[:, 0] == pytest.approx(np.cos(x), rel=1e-8)
    assert jet.second[..., 0] == pytest.approx(np.diag(-np.sin(x)), rel=1e-5, abs=1e-6)
    assert jet.second[0, 1, 0] == jet.second[1, 0, 0]


def test_cells_that_mix(operands_of):
    """(Σx)³ at 2 + 3 + 1: 3·36 by each, second derivatives 6·6, mixed ones too."""
    jet = differences(of_numbers(lambda cells: cells.sum(axis=(1, 2)) ** 3), operands_of([[[2.0, 3.0, 1.0]]])).jet
    assert jet.first[:, 0] == pytest.approx([108.0] * 3, rel=1e-9)
    assert jet.second[..., 0] == pytest.approx(np.full((3, 3), 36.0), rel=1e-5)
    assert (jet.second_error <= 1e-3 * 36).all()


def test_one_assumption_in_many_cells():
    """Σx² of cells a and a², with a = 3: first 2a + 4a³, second 2 + 12a²; the curve of the second cell counts."""
    x = np.array([[[3.0, 9.0]]])
    first = np.array([1.0, 6.0]).reshape(1, 1, 1, 2)
    second = np.array([0.0, 2.0]).reshape(1, 1, 1, 1, 2)
    operand = Operand(Value.of_numbers(x), Jet(x, (0,), first, second))
    jet = differences(total(np.square), [operand]).jet
    assert jet.first[0, 0] == pytest.approx(6 + 108, rel=1e-9)
    assert jet.second[0, 0, 0] == pytest.approx(2 + 108, rel=1e-5)


def test_relative_errors_of_the_cells_are_inherited():
    """One cell is known to 1 % and one to 5 %: the larger share counts, and a derivative of 0 has none."""
    x = np.array([[[3.0, 9.0, 2.0]]])
    first = np.array([2.0, -4.0, 0.0]).reshape(1, 1, 1, 3)
    error = np.array([0.02, 0.2, 0.7]).reshape(1, 1, 1, 3)
    jet = Jet(x, (0,), first, None, error)
    result = differences(total(lambda cells: cells), [Operand(Value.of_numbers(x), jet)]).jet
    assert result.first[0, 0] == pytest.approx(-2.0, rel=1e-9)
    # along a unit by which the cell that moves most moves by its size: 2/3 or 4/9 a unit, so by 1.5 units
    assert result.error[0, 0] == pytest.approx(0.05 * 1.5 * 2.0, rel=1e-4)


def test_a_result_of_many_cells(operands_of):
    """x·{1, 10}: one derivative a cell."""
    function = of_numbers(lambda x: np.asarray(x).reshape(-1, 1, 1) * np.array([[[1.0, 10.0]]]))
    jet = differences(function, operands_of([np.array([2.0, 5.0])])).jet
    assert jet.first[0].tolist() == pytest.approx(np.array([[[1.0, 10.0]]] * 2))
    assert jet.second.shape == (1, 1, 2, 1, 2)


def test_a_result_that_changes_its_size_has_none(operands_of):
    def grows(values):
        x = values[0].numbers
        cells = 2 if (x == 2.0).all() else 3
        return Value.of_numbers(np.broadcast_to(x.reshape(-1, 1, 1), (x.size, 1, cells)).copy())

    assert np.isnan(differences(grows, operands_of([np.array([2.0])])).jet.first).all()


def test_texts_that_are_read_as_numbers_stand_still():
    """The other operand is the text 3, which is added as a number when it is moved by nothing."""

    def product(values):
        return Value.of_numbers(values[0].numbers * values[1].to_numbers()[0])

    operands = [_bent(4.0, 0, 1.0, 0.0), Operand(constant("3"), Jet.still(np.array([3.0])))]
    outcome = differences(product, operands)
    assert outcome.numerical
    assert outcome.jet.first[0, 0] == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize("of", ["operand", "result"])
def test_through_a_text(of):
    """No differences: none where an assumption changes the text, 0 where it does not."""
    text, number = from_objects(np.array(["1", "2"], object)), Value.of_numbers(np.array([1.0, 2.0]))
    jet = Jet(np.array([1.0, 2.0]), (0,), np.array([[0.0, -4.0]]), np.zeros((1, 1, 2)))
    still = Operand(number, Jet.still(number.numbers))
    operand = Operand(text if of == "operand" else number, jet)
    outcome = by_differences(lambda values: values[0], number if of == "operand" else text, [operand, still])
    assert not outcome.numerical
    assert outcome.jet.active == (0,)
    assert np.array_equal(outcome.jet.first, [[0.0, np.nan]], equal_nan=True)
    assert outcome.jet.second.tolist() == [[[0.0, 0.0]]]


def test_through_a_text_of_several_cells():
    """Changes of opposite sign in two cells do not cancel; a result of cells loses each."""
    cells = np.array([[["x", "y"]], [["x", "y"]]], object)
    first = np.array([[[1.0, -1.0]], [[0.0, 0.0]]])[None]
    jet = Jet(np.zeros((2, 1, 2)), (0,), first, np.zeros((1, 1, 2, 1, 2)))
    value = from_objects(cells)
    outcome = by_differences(lambda values: values[0], value, [Operand(value, jet)])
    assert np.array_equal(outcome.jet.first, [[[[np.nan]], [[0.0]]]], equal_nan=True)


def test_errors_among_the_cells_stay_errors(operands_of):
    """The function sees the error in every step, and so has no derivative there."""
    cells = np.empty((2, 1, 2), object)
    cells[:, 0] = [[1.0, 2.0], [3.0, ErrorCode.NA]]
    value = from_objects(cells)
    jet = Jet(value.numbers, (0,), np.ones((1, 1, 1, 1)), np.zeros((1, 1, 1, 1, 1)))

    def first_error(values):
        kinds = np.broadcast_to(values[0].kinds, values[0].shape).max(axis=(1, 2))
        return Value(np.where(kinds >= 16, 0.0, values[0].numbers.sum(axis=(1, 2))), kinds)

    result = differences(first_error, [Operand(value, jet)]).jet
    assert result.first[0, 0] == pytest.approx(2.0, rel=1e-9)
    assert np.isnan(result.first[0, 1])


def _scaled(cells, by):
    """One operand of cells, of which two assumptions move each: by a, and by b only the first, in other units."""
    x = np.array(cells).reshape(1, 1, -1)
    first = np.stack([np.ones_like(x), np.zeros_like(x)]) * by
    first[1, 0, 0, 0] = 3.0 * by
    return Operand(Value.of_numbers(x), Jet(x, (0, 1), first, np.zeros((2, 2, 1, 1, 1))))


def test_other_units_of_the_assumptions():
    """In units of a quarter, all first derivatives and their errors are four times as large, second ones 16 times."""
    function = total(lambda cells: np.exp(cells / 5) + cells**3)
    one, other = (differences(function, [_scaled([2.0, 3.0, 7.0], by)]).jet for by in (1.0, 4.0))
    assert (other.first == 4.0 * one.first).all()
    assert (other.error == 4.0 * one.error).all()
    assert (other.second == 16.0 * one.second).all()
    assert (other.second_error == 16.0 * one.second_error).all()
    first = [sum(math.exp(x / 5) / 5 + 3 * x * x for x in (2, 3, 7)), 3 * (math.exp(0.4) / 5 + 12)]
    assert one.first[:, 0] == pytest.approx(first, rel=1e-9)
    mixed = 3 * (math.exp(0.4) / 25 + 12)
    assert one.second[0, 1, 0] == pytest.approx(mixed, rel=1e-5)
    assert one.second[1, 1, 0] == pytest.approx(3 * mixed, rel=1e-5)
    assert (one.error[:, 0] > 0).all()
    assert (one.second_error[..., 0] > 0).all()


def test_other_units_of_the_arguments(along):
    """The same function of four times its arguments: derivatives and errors are a quarter and a sixteenth."""
    one = along(lambda x, y: np.exp(x / y) + x * y, np.array([3.0, 5.0]), np.array([7.0, 2.0]))
    other = along(lambda x, y: np.exp(x / y) + x * y / 16, np.array([12.0, 20.0]), np.array([28.0, 8.0]))
    assert (other.first == one.first / 4).all()
    assert (other.error == one.error / 4).all()
    assert (other.second == one.second / 16).all()
    assert (other.second_error == one.second_error / 16).all()
    assert (one.error > 0).all()
    assert (one.second_error > 0).all()


def test_three_trials_of_a_text_that_stands_still():
    texts = from_objects(np.array(["1", "2", "3"], object))
    jet = Jet(np.zeros(3), (0,), np.zeros((1, 3)), np.zeros((1, 1, 3)))
    outcome = by_differences(lambda values: values[0], texts, [Operand(texts, jet)])
    assert outcome.jet.first.tolist() == [[0.0, 0.0, 0.0]]


@pytest.mark.parametrize("terms", [2, 3, 4])
def test_differences_at_halved_steps_are_extrapolated_to_the_last_term(terms):
    """T(h) = 2 + h² + h⁴ + …: Richardson's table removes one term with each further step, and is then exact."""
    rows = [np.array([2.0 + sum(h ** (2 * k) for k in range(1, terms))]) for h in (0.5, 0.25, 0.125, 0.0625)]
    best, error = _best(rows, [np.zeros(1)] * len(rows))
    assert best[0] == pytest.approx(2.0, abs=1e-12 if terms < 4 else 1e-4)
    assert abs(best[0] - 2.0) <= error[0] + 1e-15


def test_the_entry_with_the_least_error_is_taken_and_noise_adds_to_it():
    best, error = _best([np.array([1.0]), np.array([1.0]), np.array([7.0])], [np.full(1, 0.25)] * 3)
    assert (best[0], error[0]) == (1.0, 0.25)
