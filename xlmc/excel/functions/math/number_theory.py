"""Whole numbers: divisors, multiples, ways to choose, factorials, even and odd. Letters: n trials, k numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import first_error_in_row
from xlmc.excel.functions.lookup.picked_cells import flatten_cells
from xlmc.excel.functions.registry import Cells, Kind, Number, excel
from xlmc.excel.functions.toolpak import OneCell, all_strict_numbers, numbers_only
from xlmc.excel.functions.values import BLANK, NUM, Bools, Codes, Floats, Value

__all__: list[str] = []

_EXACT: Final = 2.0**53
"""GCD and LCM refuse numbers from here on: not every whole number is a double."""

_MOST: Final = 2.0**31 - 1
"""The functions that count ways to choose refuse this number and larger ones."""

_ALL_OVERFLOW: Final = 520
"""From this number on, choosing so many of at least twice as many gives more ways than a double holds."""


def _double_factorial(n: int) -> float:
    return float(math.prod(range(n, 1, -2)))


_DOUBLE_FACTORIALS: Final = np.array([_double_factorial(n) for n in range(-1, 301)])


def _first_error(x: Floats, errors: Codes, bad: Bools) -> Codes:
    """Return the first error of each trial, `#NUM!` where a number is bad: (n, k) -> (n,)."""
    values = np.where((errors == 0) & bad, np.uint8(ErrorCode.NUM), errors).astype(np.uint8)
    return first_error_in_row(values)


@excel("GCD", Cells(repeat=True))
def gcd(*values: Value) -> Value:
    """Greatest common divisor; `#NUM!` below 0 and from 2^53 on."""
    x, errors = all_strict_numbers(values)
    bad = (x < 0) | (x >= _EXACT)
    whole = np.where(bad, 0.0, x).astype(np.int64)
    return Value.of_numbers(np.gcd.reduce(whole, axis=1).astype(np.float64), _first_error(x, errors, bad))


def _without_blanks(values: Sequence[Value], x: Floats) -> Floats:
    """Return the numbers, but 1 for each empty cell, which changes no multiple; unless all cells are empty: (n, k)."""
    empty = [
        flatten_cells((value.kinds == BLANK) & (value.numbers.ndim == 3), value)  # what is left out of a call is 0
        for value in values
    ]
    blank = np.concatenate([np.broadcast_to(part, (x.shape[0], part.shape[1])) for part in empty], axis=1)
    return np.where(blank & ~blank.all(axis=1, keepdims=True), 1.0, x)


@excel("LCM", Cells(repeat=True))
def lcm(*values: Value) -> Value:
    """Least common multiple; `#NUM!` below 0, and where a number or the multiple is 2^53 or more.

    Empty cells are left out; of these alone it is 0.
    """
    x, errors = all_strict_numbers(values)
    x = _without_blanks(values, x)
    bad = (x < 0) | (x >= _EXACT)
    result = np.ones(x.shape[0])
    for column in np.where(bad, 1.0, np.trunc(x)).T:
        divisor = np.gcd(np.where(result < _EXACT, result, 0).astype(np.int64), column.astype(np.int64))
        result = np.where(result < _EXACT, result / np.maximum(divisor, 1) * column, result)
    return Value.of_numbers(np.where(result < _EXACT, result, NUM), _first_error(x, errors, bad))


def _choices(n: Floats, k: Floats) -> Floats:
    """Binomial coefficients of whole n ≥ k ≥ 0: C(n, i) = C(n-1, i-1)·n/i, which stays whole at each step."""
    fewer = np.minimum(k, n - k)
    result = np.ones(np.broadcast_shapes(n.shape, k.shape))
    for i in range(1, 1 + min(int(fewer.max(initial=0.0)), _ALL_OVERFLOW)):
        top = n - fewer + i
        longer = np.where(result < _EXACT, result * top / i, result * (top / i))
        result = np.where(i <= fewer, longer, result)
    return result


def _combinations(n: Floats, k: Floats) -> Floats:
    bad = (n < 0) | (k < 0) | (k > n) | (n >= _MOST)
    return np.where(bad, NUM, _choices(np.where(bad, 0.0, n), np.where(bad, 0.0, k)))


@excel("COMBIN", Number, Number)
def combin(number: Floats, chosen: Floats) -> Floats:
    """Ways to choose some of a number of things; `#NUM!` for more than there are."""
    return _combinations(np.floor(number), np.floor(chosen))


@excel("COMBINA", Number, Number)
def combina(number: Floats, chosen: Floats) -> Floats:
    """Ways to choose, each thing as often as one likes."""
    n, k = np.floor(number), np.floor(chosen)
    bad = (n < 0) | (k < 0) | ((n == 0) & (k > 0)) | (n >= _MOST)
    choices = _combinations(np.where(bad | (n + k == 0), 0.0, n + k - 1), np.where(bad, 0.0, k))
    return np.where(bad, NUM, choices)


@excel("PERMUT", Number, Number)
def permut(number: Floats, chosen: Floats) -> Floats:
    """Ways to choose some of a number of things in order; `#NUM!` of none, or for more than there are."""
    n, k = np.trunc(number), np.trunc(chosen)
    bad = (n <= 0) | (k < 0) | (k > n)
    n, k = np.where(bad, 1.0, n), np.where(bad, 0.0, k)
    result = np.ones(np.broadcast_shapes(n.shape, k.shape))
    for i in range(min(int(k.max(initial=0.0)), 171)):
        result = np.where(i < k, result * (n - i), result)
    return np.where(bad, NUM, result)


@excel("PERMUTATIONA", Number, Number)
def permutationa(number: Floats, chosen: Floats) -> Floats:
    """Ways to choose in order, each thing as often as one likes: number to the power of chosen."""
    n, k = np.trunc(number), np.trunc(chosen)
    bad = (n < 0) | (k < 0) | ((n == 0) & (k > 0))
    return np.where(bad, NUM, np.float_power(np.where(bad, 1.0, n), np.where(bad, 0.0, k)))


@excel("FACTDOUBLE", OneCell)
@numbers_only
def factdouble(x: Floats) -> Floats:
    """Product of every other whole number down from `x`; `#NUM!` below -1 and above 300."""
    n = np.floor(x)
    outside = (n < -1) | (n > 300)
    return np.where(outside, NUM, _DOUBLE_FACTORIALS[np.where(outside, 0, n + 1).astype(np.intp)])


@excel("MULTINOMIAL", Cells(repeat=True))
def multinomial(*values: Value) -> Value:
    """Factorial of the sum, divided by the product of the factorials; `#NUM!` for a negative number."""
    x, errors = all_strict_numbers(values)
    bad = (x < 0) | (x >= _MOST)
    counts = np.where(bad, 0.0, np.trunc(x))
    sums = np.add.accumulate(counts, axis=1)
    result = np.ones(x.shape[0])
    for total, count in zip(sums.T, counts.T, strict=True):
        result = result * _choices(total, count)
    return Value.of_numbers(result, _first_error(x, errors, bad))


@excel("ISEVEN", OneCell, returns=Kind.LOGICAL)
@numbers_only
def is_even(x: Floats) -> Bools:
    """Whether the whole part is even."""
    return np.asarray(np.trunc(x) % 2 == 0)


@excel("ISODD", OneCell, returns=Kind.LOGICAL)
@numbers_only
def is_odd(x: Floats) -> Bools:
    """Whether the whole part is odd."""
    return np.asarray(np.trunc(x) % 2 != 0)
