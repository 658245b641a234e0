"""Lookups have the derivative of the cell found; functions that move cells have those of the cells, moved."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.passes.derivatives.jet import Jet
from xlmc.engine.passes.derivatives.rules import RULES, Operand
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION
from xlmc.excel.functions.values import Value, constant, from_objects

KEYS = [[1.0], [2.0], [4.0]]
CELLS = [[10.0], [20.0], [40.0]]
TABLE = [[1.0, 10.0, 5.0], [2.0, 20.0, 6.0], [4.0, 40.0, 7.0]]
ROWS = [[1.0, 2.0, 4.0], [10.0, 20.0, 40.0], [5.0, 6.0, 7.0]]
CORNER = [[1.0, 2.0, 4.0, 8.0], [10.0, 20.0, 40.0, 80.0]]


def by(jet, active, count):
    """The first derivative of trial 0 by each of `count` assumptions, the first of them `active`."""
    own = dict(zip(jet.active, jet.first.reshape(len(jet.active), -1)[:, 0].tolist(), strict=True))
    return [own.get(active + number, 0.0) for number in range(count)]


@pytest.mark.parametrize(
    ("name", "arguments", "table", "cells", "found", "x"),
    [
        ("VLOOKUP", (2.5, TABLE, 2.0), 1, 9, 4, 20.0),
        ("VLOOKUP", (4.0, TABLE, 3.0, False), 1, 9, 8, 7.0),
        ("VLOOKUP", (1.5, TABLE, 1.0, True), 1, 9, 0, 1.0),
        ("HLOOKUP", (2.5, ROWS, 2.0), 1, 9, 4, 20.0),
        ("HLOOKUP", (4.0, ROWS, 3.0, False), 1, 9, 8, 7.0),
        ("LOOKUP", (2.5, KEYS, CELLS), 2, 3, 1, 20.0),
        ("LOOKUP", (2.5, TABLE), 1, 9, 5, 6.0),
        ("LOOKUP", (2.5, CORNER), 1, 8, 5, 20.0),
        ("XLOOKUP", (2.0, KEYS, CELLS), 2, 3, 1, 20.0),
        ("XLOOKUP", (3.0, KEYS, CELLS, 99.0, 1.0), 2, 3, 2, 40.0),
        ("XLOOKUP", (3.0, KEYS, CELLS, 99.0), 2, 4, 3, 99.0),
        ("INDEX", (CELLS, 2.0), 0, 3, 1, 20.0),
        ("INDEX", (TABLE, 3.0, 2.0), 0, 9, 7, 40.0),
    ],
)
def test_the_cell_found(outcome_of, name, arguments, table, cells, found, x):
    """`table` is the argument whose cells vary, `found` which of them, counted along the rows."""
    still = tuple(index for index in range(len(arguments)) if index != table and (index, cells) != (3, 4))
    jet = outcome_of(name, *arguments, still=still).jet
    assert jet.x.ravel().tolist() == [x]
    assert by(jet, 0, cells) == [float(number == found) for number in range(cells)]
    assert not jet.second.any()


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("VLOOKUP", (TABLE, 2.0)),
        ("LOOKUP", (KEYS, CELLS)),
        ("LOOKUP", ([[1.0, 10.0], [2.0, 20.0], [4.0, 40.0]],)),
        ("XLOOKUP", (KEYS, CELLS, 0.0, -1.0)),
        ("MATCH", (KEYS,)),
        ("XMATCH", (KEYS, -1.0)),
        (POSITION, (KEYS, 1.0)),
    ],
)
def test_a_key_at_a_step(outcome_of, name, arguments):
    """Between the keys it is 0; at one of them, where the next cell is found, there is none."""
    still = tuple(range(1, len(arguments) + 1))
    outcome = outcome_of(name, np.array([1.5, 2.0, 3.0]), *arguments, still=still)
    assert np.array_equal(outcome.jet.first, [[0.0, np.nan, 0.0]], equal_nan=True)
    position = not isinstance(name, str) or "MATCH" in name
    assert outcome.branches is not None
    assert outcome.jet.x.tolist() == ([1.0, 2.0, 2.0] if position else [10.0, 20.0, 20.0])
    assert len(set(outcome.branches.tolist())) == 2


@pytest.mark.parametrize(
    ("name", "arguments"), [("VLOOKUP", (TABLE, 2.0, False)), ("XLOOKUP", (KEYS, CELLS)), ("MATCH", (KEYS, 0.0))]
)
def test_an_exact_key_is_a_label(outcome_of, name, arguments):
    outcome = outcome_of(name, np.array([1.0, 2.0, 4.0]), *arguments, still=tuple(range(1, len(arguments) + 1)))
    assert not outcome.jet.first.any()


def test_a_key_that_finds_several_cells_at_once(outcome_of):
    """XLOOKUP of a row of two cells: each has the derivative of its own."""
    jet = outcome_of("XLOOKUP", 1.5, [[1.0], [2.0]], [[10.0, 11.0], [20.0, 21.0]], 0.0, 1.0, still=(1, 3, 4)).jet
    assert jet.x.tolist() == [[[20.0, 21.0]]]
    cells = jet.first[jet.active.index(3)], jet.first[jet.active.index(4)]
    assert [cell.tolist() for cell in cells] == [[[[1.0, 0.0]]], [[[0.0, 1.0]]]]


def test_a_column_number_without_a_derivative(operands_of):
    """Of two trials the first has no derivative by the column, and so none of the cell found."""
    function = REGISTRY["VLOOKUP"]
    key, table = operands_of([2.0, TABLE], still=(0,))
    column = Value.of_numbers(np.array([2.0, 3.0]))
    bent = Jet(column.numbers, (20,), np.array([[np.nan, 0.0]]), np.zeros((1, 1, 2)))
    operands = [key, table, Operand(column, bent)]
    jet = RULES["VLOOKUP"].apply(function, function([each.value for each in operands]), operands).jet
    assert jet.x.tolist() == [20.0, 6.0]
    assert np.isnan(jet.first[:, 0]).all()
    assert jet.first[5, 1] == 1.0


MOVED = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        ("TRANSPOSE", (MOVED,), [[1, 4], [2, 5], [3, 6]]),
        ("TAKE", (MOVED, 1.0), [[1, 2, 3]]),
        ("DROP", (MOVED, 1.0, 1.0), [[5, 6]]),
        ("CHOOSEROWS", (MOVED, 2.0), [[4, 5, 6]]),
        ("CHOOSECOLS", (MOVED, 3.0, 1.0), [[3, 1], [6, 4]]),
        ("TOCOL", (MOVED,), [[1], [2], [3], [4], [5], [6]]),
        ("TOROW", (MOVED, 0.0, True), [[1, 4, 2, 5, 3, 6]]),
        ("SORTBY", (MOVED, [[1.0], [2.0]], -1.0), [[4, 5, 6], [1, 2, 3]]),
        ("FILTER", (MOVED, [[False], [True]]), [[4, 5, 6]]),
        ("FILTER", (MOVED, [[False], [False]], 9.0), [[9]]),
        ("WRAPROWS", ([[1.0, 2.0, 3.0]], 2.0, 9.0), [[1, 2], [3, 9]]),
        ("WRAPCOLS", ([[1.0, 2.0, 3.0]], 2.0, 9.0), [[1, 3], [2, 9]]),
        ("EXPAND", (MOVED, 2.0, 4.0, 9.0), [[1, 2, 3, 9], [4, 5, 6, 9]]),
        ("VSTACK", (MOVED, [[7.0, 8.0, 9.0]]), [[1, 2, 3], [4, 5, 6], [7, 8, 9]]),
        ("HSTACK", ([[1.0], [2.0]], [[7.0], [8.0]]), [[1, 7], [2, 8]]),
    ],
)
def test_cells_that_are_moved(outcome_of, name, arguments, expected):
    """The derivative by the cell of a number is 1 exactly where that number stands in the result."""
    operands = [np.atleast_2d(argument) for argument in arguments]
    moving = range(len(operands)) if "STACK" in name else (0, 2) if name[:4] in ("FILT", "WRAP") else (0, 3)
    still = tuple(index for index in range(len(operands)) if index not in moving)
    jet = outcome_of(name, *arguments, still=still).jet
    assert jet.x[0].tolist() == expected
    numbers = np.concatenate([operands[index].ravel() for index in moving if index < len(operands)])
    assert len(jet.active) == numbers.size
    for number, first in zip(numbers, jet.first, strict=True):
        assert first[0].tolist() == (np.array(expected) == number).astype(float).tolist()


def test_texts_and_logicals_among_moved_cells(outcome_of):
    """They have the derivative 0, and do not shift those of the numbers beside them."""
    cells = [[1.0, "x", 3.0], [True, 5.0, None]]
    jet = outcome_of("TRANSPOSE", cells).jet
    assert [first[0].tolist() for first in jet.first] == [
        [[1, 0], [0, 0], [0, 0]], [[0, 0], [0, 0], [1, 0]], [[0, 0], [0, 1], [0, 0]],
    ]  # fmt: skip


def test_a_logical_that_an_assumption_changes_is_moved_too():
    """A logical holds no number of a cell: while cells are followed it counts as a number."""
    cells = np.empty((1, 1, 2), object)
    cells[0, 0] = [True, 5.0]
    value = from_objects(cells)
    jet = Jet(value.numbers, (0,), np.array([np.nan, 1.0]).reshape(1, 1, 1, 2), np.zeros((1, 1, 1, 1, 1)))
    function = REGISTRY["INDEX"]
    operands = [Operand(value, jet), *(Operand(constant(1.0), Jet.still(np.ones(1))) for _ in range(2))]
    result = RULES["INDEX"].apply(function, function([each.value for each in operands]), operands)
    assert np.isnan(result.jet.first).all()
    assert result.branches.tolist() == [1.0]


def test_which_cells_take_branches(outcome_of):
    assert outcome_of("INDEX", CELLS, np.array([1.0, 3.0]), still=(1,)).branches.tolist() == [1.0, 3.0]
    assert outcome_of("TRANSPOSE", MOVED).branches is None
    assert RULES["INDEX"].jumps
    assert not RULES["TRANSPOSE"].jumps


def test_a_constant_at_a_position(operands_of):
    """The number at a position that an assumption changes: 0, and none where the position has none."""
    (numbers,) = operands_of([CELLS], still=(0,))
    position = Value.of_numbers(np.array([1.0, 3.0, 2.0]))
    jet = Jet(position.numbers, (0,), np.array([[0.0, np.nan, 0.0]]), np.zeros((1, 1, 3)))
    operands = [numbers, Operand(position, jet)]
    result = CELL_AT([each.value for each in operands])
    outcome = RULES[CELL_AT.name].apply(CELL_AT, result, operands)
    assert outcome.jet.x.tolist() == [10.0, 40.0, 20.0]
    assert np.array_equal(outcome.jet.first, [[0.0, np.nan, 0.0]], equal_nan=True)
