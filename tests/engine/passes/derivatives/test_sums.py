"""Sums, extremes and deviations of cells, each number an assumption, against mpmath's derivatives."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from xlmc.engine.passes.derivatives.jet import Jet
from xlmc.engine.passes.derivatives.rules import RULES, Operand
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.math.aggregate import SO_FAR
from xlmc.excel.functions.values import ERROR, Value

MIXED = [[2.0, "text", 3.5], [True, None, -1.25]]
"""Three numbers among cells that no aggregate counts: a text, TRUE and a blank."""


def mean(*x):
    return mpmath.fsum(x) / len(x)


def squares(*x):
    return mpmath.fsum((one - mean(*x)) ** 2 for one in x)


AGGREGATES = {  # of the numbers of MIXED, and of 4 given directly
    "SUM": lambda *x: mpmath.fsum(x),
    "SUMSQ": lambda *x: mpmath.fsum(one * one for one in x),
    "AVERAGE": mean,
    "PRODUCT": lambda *x: mpmath.fprod(x),
    "DEVSQ": squares,
    "VAR.S": lambda *x: squares(*x) / (len(x) - 1),
    "VAR.P": lambda *x: squares(*x) / len(x),
    "STDEV.S": lambda *x: mpmath.sqrt(squares(*x) / (len(x) - 1)),
    "STDEV.P": lambda *x: mpmath.sqrt(squares(*x) / len(x)),
    "MIN": lambda a, b, c, d: c,
    "MAX": lambda a, b, c, d: d,
    "MEDIAN": lambda a, b, c, d: (a + b) / 2,
}


@pytest.mark.parametrize("name", AGGREGATES)
def test_numbers_among_other_cells(outcome_of, same_derivatives, name):
    point = (2.0, 3.5, -1.25, 4.0)
    same_derivatives(outcome_of(name, MIXED, 4.0).jet, AGGREGATES[name], point)


@pytest.mark.parametrize(("name", "value"), [("SUM", 7.5), ("AVERAGE", 2.5), ("PRODUCT", 14.0), ("DEVSQ", 4.5 + 2.0)])
def test_a_logical_given_directly_counts(outcome_of, same_derivatives, name, value):
    """`TRUE` is 1 among the arguments: of 2.5 and 4, or of 3.5 and 4, and of that 1."""
    x = {"PRODUCT": 3.5, "SUM": 2.5, "AVERAGE": 2.5, "DEVSQ": 2.5}[name]
    f = AGGREGATES[name]
    same_derivatives(outcome_of(name, x, 4.0, True).jet, lambda a, b: f(a, b, mpmath.mpf(1)), (x, 4.0))


def test_a_product_with_0_has_the_derivatives_of_the_other_factors(outcome_of):
    jet = outcome_of("PRODUCT", [[0.0, 3.0, 5.0]]).jet
    assert jet.first[:, 0].tolist() == [15.0, 0.0, 0.0]
    assert jet.second[0, :, 0].tolist() == [0.0, 5.0, 3.0]


@pytest.mark.parametrize(
    ("name", "cells", "x", "first", "branch"),
    [
        ("MIN", [[3.0, 1.0, 2.0]], 1.0, [0, 1, 0], 1),
        ("MAX", [[1.0, 2.0, 3.0]], 3.0, [0, 0, 1], 2),
        ("MAX", [["x", 2.0, True]], 2.0, [1], 1),
        ("MEDIAN", [[3.0, 1.0, 2.0]], 2.0, [0, 0, 1], 2 * 3 + 2),
        ("MEDIAN", [[9.0, 1.0, 2.0, 4.0]], 3.0, [0, 0, 0.5, 0.5], 2 * 4 + 3),
        ("MEDIAN", [[9.0, "x", 2.0, 4.0]], 4.0, [0, 0, 1], 3 * 4 + 3),
    ],
)
def test_the_cell_that_counts(outcome_of, name, cells, x, first, branch):
    outcome = outcome_of(name, cells)
    assert outcome.jet.x.tolist() == [x]
    assert outcome.jet.first[:, 0].tolist() == first
    assert outcome.branches.tolist() == [branch]


@pytest.mark.parametrize("name", ["MIN", "MAX", "MEDIAN"])
def test_two_equal_numbers(outcome_of, name):
    assert np.isnan(outcome_of(name, 2.0, 2.0).jet.first).all()


@pytest.mark.parametrize(("name", "rank", "first"), [("LARGE", 2.0, [0, 0, 1]), ("SMALL", 1.0, [0, 1, 0])])
def test_a_rank_that_stands_still(outcome_of, name, rank, first):
    outcome = outcome_of(name, [[3.0, 1.0, 2.0]], rank, still=(1,))
    assert outcome.jet.first[:, 0].tolist() == first
    assert not outcome.numerical


@pytest.mark.parametrize("rank", [1.5, [[1.0, 2.0]]])
def test_other_ranks_take_differences(outcome_of, rank):
    """A rank that varies, and several ranks at once."""
    still = (1,) if isinstance(rank, list) else ()
    outcome = outcome_of("LARGE", [[3.0, 1.0, 2.0]], rank, still=still)
    assert outcome.numerical
    if still:
        assert pytest.approx(np.array([[1, 0, 0], [0, 0, 1]]), abs=1e-9) == outcome.jet.first[:, 0, 0, :].T


def test_the_product_so_far_is_a_product(outcome_of):
    row = next(row for row in SO_FAR.values() if row.name == "PRODUCT so far")
    assert RULES[row.name] == RULES["PRODUCT"]
    assert RULES["MAX so far"] == RULES["MAX"]


def test_trials_of_which_some_lack_a_number():
    """VAR.S over a range whose second cell is an error in trial 1: the count is that of each trial."""
    kinds = np.array([[[0, 0, 0]], [[0, 2, 0]]], np.uint8)
    numbers = np.array([[[1.0, 5.0, 3.0]], [[1.0, 0.0, 4.0]]])
    texts = np.array([[["", "", ""]], [["", "x", ""]]], object)
    value = Value(numbers, kinds, texts)
    jet = Jet(numbers, (0,), np.array([1.0, 0.0, 0.0]).reshape(1, 1, 1, 3), np.zeros((1, 1, 1, 1, 1)))
    function = REGISTRY["VAR.S"]
    result = RULES["VAR.S"].apply(function, function([value]), [Operand(value, jet)]).jet
    # d/dx of ((x-m)²+...)/(k-1) is 2(x-m)/(k-1): 2(1-3)/2 and 2(1-2.5)/1; the second is 2(1-1/k)/(k-1)
    assert result.first[0] == pytest.approx([-2.0, -3.0])
    assert result.second[0, 0] == pytest.approx([2 * (2 / 3) / 2, 2 * 0.5])


def test_sums_of_products(outcome_of, same_derivatives):
    """Texts, TRUE and blanks count 0: 2·4 + 3.5·6, and -1.25 lies beside a text."""
    other = [[4.0, 5.0, 6.0], [7.0, 8.0, "y"]]

    def f(a, b, c, p, q, r, s, t):
        return a * p + b * r

    same_derivatives(outcome_of("SUMPRODUCT", MIXED, other).jet, f, (2.0, 3.5, -1.25, 4.0, 5.0, 6.0, 7.0, 8.0))
    same_derivatives(outcome_of("SUMPRODUCT", 2.0, 3.0).jet, lambda x, y: x * y, (2.0, 3.0))


def test_a_product_of_matrices(outcome_of):
    """[[a b]; [c d]]·[[p]; [q]] = [[ap + bq]; [cp + dq]]."""
    jet = outcome_of("MMULT", [[1.0, 2.0], [3.0, 4.0]], [[5.0], [6.0]]).jet
    assert jet.x[0].tolist() == [[17.0], [39.0]]
    assert jet.first[:, 0, 0, 0].tolist() == [5.0, 6.0, 0.0, 0.0, 1.0, 2.0]
    assert jet.first[:, 0, 1, 0].tolist() == [0.0, 0.0, 5.0, 6.0, 3.0, 4.0]
    assert jet.second[:, 4, 0, 0, 0].tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]


KEYS, CELLS = [["a"], ["b"], ["b"]], [[2.0], [3.0], [5.0]]


@pytest.mark.parametrize(
    ("name", "arguments", "still", "first"),
    [
        ("SUMIF", (KEYS, "b", CELLS), (), [0, 1, 1]),
        ("SUMIF", (CELLS, ">2"), (), [0, 1, 1]),
        ("SUMIFS", (CELLS, KEYS, "b"), (), [0, 1, 1]),
        ("AVERAGEIF", (KEYS, "b", CELLS), (), [0, 0.5, 0.5]),
        ("AVERAGEIF", (CELLS, "<4"), (), [0.5, 0.5, 0]),
        ("AVERAGEIFS", (CELLS, KEYS, "b", CELLS, ">3"), (3,), [0, 0, 1]),
    ],
)
def test_sums_of_cells_that_meet_a_condition(outcome_of, name, arguments, still, first):
    jet = outcome_of(name, *arguments, still=still).jet
    assert jet.first[:, 0].tolist() == first
    assert not jet.second.any()


def test_a_cell_without_a_derivative_takes_that_of_the_sum(operands_of):
    function = REGISTRY["SUMIF"]
    keys, criterion, cells = operands_of((KEYS, "b", CELLS), order=1)
    first = cells.jet.first.copy()
    first[1] = np.inf
    operands = [keys, criterion, Operand(cells.value, Jet(cells.jet.x, cells.jet.active, first))]
    result = function([operand.value for operand in operands])
    jet = RULES["SUMIF"].apply(function, result, operands).jet
    assert np.isnan(jet.first[1, 0])
    assert jet.first[2, 0] == 1.0
    assert not (result.kinds >= ERROR).any()
