"""Matrices, one of each trial: (n, r, c). A cell that is no number, a blank too, makes the result `#VALUE!`.

The result is the same size in every trial, so that `MUNIT` wants one size for all.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.functions.registry import Cells, Kind, Number, excel
from xlmc.functions.toolpak import first_error
from xlmc.functions.values import ERROR, NUM, NUMBER, VALUE, Codes, Floats, Value, constant

__all__: list[str] = []

_WIDEST: Final = 16384
"""The columns of a worksheet."""


def _matrix(value: Value) -> tuple[Floats, Codes]:
    """The numbers, and the first error of each trial, as it is spread over a matrix: (n, r, c), (n, 1, 1)."""
    cells = value.as_range()
    other = np.where(cells.kinds >= ERROR, cells.kinds - np.uint8(ERROR), np.uint8(ErrorCode.VALUE))
    codes = np.where(cells.kinds == NUMBER, np.uint8(0), other).astype(np.uint8)
    rows = np.broadcast_to(codes, cells.shape).reshape(cells.shape[0], -1)
    return np.broadcast_to(cells.numbers, cells.shape), first_error(rows)[:, None, None]


@excel("MMULT", Cells, Cells, returns=Kind.ANY)
def product(left: Value, right: Value) -> Value:
    """Matrix product, (n, r, k) by (n, k, c); `#VALUE!` where the sizes do not go together.

    Products are added from left to right, each trial by itself, so that no bit depends on the other trials.
    """
    (a, a_errors), (b, b_errors) = _matrix(left), _matrix(right)
    if a.shape[2] != b.shape[1]:
        return constant(ErrorCode.VALUE)
    total = a[:, :, :1] * b[:, :1, :]
    for i in range(1, a.shape[2]):
        total = total + a[:, :, i : i + 1] * b[:, i : i + 1, :]
    return Value.of_numbers(total, np.where(a_errors > 0, a_errors, b_errors).astype(np.uint8))


@excel("MDETERM", Cells)
def determinant(matrix: Value) -> Value:
    """Determinant; `#VALUE!` unless the matrix is square."""
    a, errors = _matrix(matrix)
    if a.shape[1] != a.shape[2]:
        return constant(ErrorCode.VALUE)
    return Value.of_numbers(np.linalg.det(a), errors[:, 0, 0])


@excel("MINVERSE", Cells, returns=Kind.ANY)
def inverse(matrix: Value) -> Value:
    """Inverse; `#VALUE!` unless the matrix is square, `#NUM!` where it is singular."""
    a, errors = _matrix(matrix)
    if a.shape[1] != a.shape[2]:
        return constant(ErrorCode.VALUE)
    regular = (np.linalg.slogdet(a).sign != 0)[:, None, None]
    found = np.linalg.inv(np.where(regular, a, np.eye(a.shape[1])))
    return Value.of_numbers(np.where(regular, found, NUM), errors)


@excel("MUNIT", Number, returns=Kind.ANY)
def unit_matrix(dimension: Floats) -> Floats:
    """Unit matrix; `#VALUE!` of no rows, or of more than a sheet has columns.

    Raises:
        FormulaError: the size is not the same in every trial.
    """
    sizes = np.unique(np.trunc(dimension))
    if sizes.size > 1:
        raise FormulaError("MUNIT has not the same size in every trial", hint="give it a constant size")
    if not 1 <= sizes[0] <= _WIDEST:
        return np.full(1, VALUE)
    return np.eye(int(sizes[0]))[None]


@excel("TRANSPOSE", Cells, returns=Kind.ANY)
def transposed(cells: Value) -> Value:
    """Rows as columns: (n, r, c) -> (n, c, r)."""
    value = cells.as_range()
    numbers, kinds = (array.transpose(0, 2, 1) for array in (value.numbers, value.kinds))
    return Value(numbers, kinds, None if value.texts is None else value.texts.transpose(0, 2, 1))
