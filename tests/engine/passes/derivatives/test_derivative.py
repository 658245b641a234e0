"""Notes taken during differentiation, over the portions of a run."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.engine.passes.derivatives.derivative import Kink, Notes, Numerical, Undefined
from xlmc.excel.address import Cell

A, B, C = (Cell("S", row, 1) for row in (1, 2, 3))
OWNERS = {10: A, 20: B, 30: C}


def test_branches_of_several_portions():
    """IF takes one way 5 times and the other 3 times of 8; ROUND 4, 1 and 1 of 6; ABS never turns."""
    notes = Notes()
    notes.took(10, "IF", np.array([True, True, False, True]), True)
    notes.took(10, "IF", np.array([False, False, True, True]), True)
    notes.took(20, "MAX", np.array([0, 0, 0, 0, 2, 7]), False)
    notes.took(30, "ABS", np.array([1.0, 1.0]), False)
    assert notes.kinks(OWNERS) == (Kink(A, "IF", 2, 3 / 8, True), Kink(B, "MAX", 3, 1 - 4 / 6, False))
    notes.took(20, "MAX", np.array([2, 2]), False)
    assert [kink.cell for kink in notes.kinks(OWNERS)] == [B, A]
    assert notes.kinks(OWNERS)[0].share == 0.5


def test_losses_that_concern_a_cell():
    """Trials are counted over all portions; those that concern nobody are left out."""
    notes = Notes()
    notes.lose(10, "LN", "it is #NUM!", np.array([True, False, True]), 0)
    notes.lose(10, "LN", "it is #NUM!", np.array([True, False, False]), 3)
    notes.lose(10, "LN", "another", np.array([False, True, False]), 3)
    notes.lose(20, "ABS", "it turns", np.array([True] * 5), 2)
    assert notes.undefined(OWNERS, range(9)) == (
        Undefined(B, "ABS", "it turns", 5, 2),
        Undefined(A, "LN", "it is #NUM!", 3, 0),
        Undefined(A, "LN", "another", 1, 4),
    )
    assert notes.undefined(OWNERS, [3, 4, 0]) == (
        Undefined(A, "LN", "it is #NUM!", 2, 0),
        Undefined(B, "ABS", "it turns", 2, 3),
        Undefined(A, "LN", "another", 1, 4),
    )
    assert notes.undefined(OWNERS, []) == ()


@pytest.mark.parametrize(
    ("portions", "worst"),
    [
        ([([2.0, -4.0], [0.1, 0.8])], 0.2),
        ([([2.0], [0.1]), ([1.0], [0.3]), ([1.0], [0.2])], 0.3),
        ([([2.0], None)], 0.0),
        ([([0.0], [0.1])], math.nan),
        ([([0.0], [0.1]), ([2.0], [0.1])], 0.05),
        ([([2.0], [0.1]), ([0.0], [0.1])], 0.05),
        ([([np.nan, 2.0, 1.0], [0.1, 0.1, np.inf])], 0.05),
    ],
)
def test_the_largest_relative_error(portions, worst):
    notes = Notes()
    for first, error in portions:
        notes.note_difference(10, "ERF", np.array(first), None if error is None else np.array(error))
    (numerical,) = notes.numerical(OWNERS)
    assert (numerical.cell, numerical.function) == (A, "ERF")
    assert numerical.error == pytest.approx(worst, nan_ok=True)


def test_the_least_certain_come_first():
    notes = Notes()
    for node, error in ((10, 0.1), (20, 0.3), (30, 0.2)):
        notes.note_difference(node, "ERF", np.ones(1), np.array([error]))
    assert [each.cell for each in notes.numerical(OWNERS)] == [B, C, A]
    assert notes.numerical(OWNERS)[0] == Numerical(B, "ERF", 0.3)
