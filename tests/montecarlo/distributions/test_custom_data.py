from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.montecarlo.distributions.custom_data import custom_pieces, rows_of, value_pieces, weighted_pieces
from xlmc.montecarlo.distributions.parameters import DataError
from xlmc.montecarlo.distributions.pieces import Piece

B = None  # a blank cell

FORMS = {
    "values": ([[3], [1], [3]], [Piece(1, 1, 1), Piece(3, 3, 2)]),
    "values beside blanks": ([[3], [B], [1]], [Piece(1, 1), Piece(3, 3)]),
    "values in six columns": ([[6, 5, 4, 3, 2, 1]], [Piece(value, value) for value in range(1, 7)]),
    "weighted values": ([[3, 0.25], [1, B]], [Piece(1, 1, 1.0), Piece(3, 3, 0.25)]),
    "a weighted value twice": ([[3, 1], [3, 2]], [Piece(3, 3, 3)]),
    "ranges": ([[5, 15, 0.75], [16, 21, B]], [Piece(5, 15, 0.75), Piece(16, 21, 1.0)]),
    "ranges in any order": ([[16, 21, 1], [5, 15, 2]], [Piece(5, 15, 2), Piece(16, 21, 1)]),
    "ranges that follow one another": ([[5, 15, 3], [B, 20, 1]], [Piece(5, 15, 3), Piece(15, 20, 1)]),
    "a value among ranges": ([[5, 15, 1], [15, B, 2]], [Piece(5, 15, 1), Piece(15, 15, 2)]),
    "a value twice among ranges": ([[1, B, 1], [1, B, 2]], [Piece(1, 1, 1), Piece(1, 1, 2)]),
    "steps": ([[1, 2, 3, 0.5]], [Piece(1, 1, 1), Piece(1.5, 1.5, 1), Piece(2, 2, 1)]),
    "steps that miss the end": ([[1, 2, 2, 0.6]], [Piece(1, 1, 1), Piece(1.6, 1.6, 1)]),
    "steps in decimals": ([[0, 0.3, 4, 0.1]], [Piece(v, v, 1) for v in (0, 0.1, 0.2, 0.3)]),
    "steps of nothing": ([[1, 2, 3, 0], [4, 5, 1, B], [6, B, 1, B]], [Piece(1, 2, 3), Piece(4, 5, 1), Piece(6, 6, 1)]),
    "a range after steps": ([[1, 2, 2, 0.6], [B, 5, 1, B]], [Piece(1, 1, 1), Piece(1.6, 1.6, 1), Piece(2, 5, 1)]),
    "slopes": ([[0, 2, 1, 4, 2]], [Piece(0, 2, 1, 1.0, 0.5)]),
    "slopes and a flat range": ([[0, 2, B, 0, 3], [2, 4, 2, B, B]], [Piece(0, 2, 1, 0, 1), Piece(2, 4, 2)]),
    "a weight of nothing": ([[0, 2, 0], [1, 4, 1]], [Piece(1, 4, 1)]),
}


@pytest.mark.parametrize(("rows", "pieces"), FORMS.values(), ids=FORMS)
def test_every_form(rows, pieces):
    result = custom_pieces(rows)
    for piece, expected in zip(result, pieces, strict=True):
        for field in ("low", "high", "weight", "left", "right"):
            assert getattr(piece, field) == pytest.approx(getattr(expected, field), rel=1e-12, abs=1e-15), field


CUMULATIVE = {
    "values": ([[1, 0.25], [2, 0.5], [3, 1]], [0.25, 0.25, 0.5]),
    "ranges": ([[0, 1, 20], [1, 2, 50], [2, 3, 50]], [20, 30]),
    "steps": ([[0, 1, 2, 1], [5, B, 3, B]], [1, 1, 1]),
}


@pytest.mark.parametrize(("rows", "weights"), CUMULATIVE.values(), ids=CUMULATIVE)
def test_cumulative_weights(rows, weights):
    assert [piece.weight for piece in custom_pieces(rows, cumulative=True)] == weights


BAD = {
    "blank values": ([[B], [B]], {}, "The data are blank", [(0, 0)]),
    "blank ranges": ([[B, B, B]], {}, "The data are blank", [(0, 0)]),
    "an overlap": (
        [[0, 5, 1], [4, 9, 1]],
        {},
        "This row (4 to 9) overlaps the row of {also} (0 to 5)",
        [(1, 0), (0, 0)],
    ),
    "an overlap in any order": (
        [[4, 9, 1], [6, 7, 1], [0, 1, 1]],
        {},
        "This row (6 to 7) overlaps the row of {also} (4 to 9)",
        [(1, 0), (0, 0)],
    ),
    "the same range": ([[0, 5, 1], [0, 5, 1]], {}, "This row (0 to 5) overlaps", [(1, 0), (0, 0)]),
    "a value inside a range": ([[0, 5, 1], [3, B, 1]], {}, "This row (3 to 3) overlaps", [(1, 0), (0, 0)]),
    "steps inside a range": ([[0, 5, 1, B], [1, 3, 1, 1]], {}, "This row (1 to 3) overlaps", [(1, 0), (0, 0)]),
    "steps that meet": ([[0, 4, 1, 2], [4, 6, 1, 1]], {}, "This row (4 to 6) overlaps", [(1, 0), (0, 0)]),
    "a value where steps end": ([[0, 4, 1, 2], [4, B, 1, B]], {}, "This row (4 to 4)", [(1, 0), (0, 0)]),
    "ends exchanged": ([[5, 0, 1]], {}, "The low end (5) is above the high end (0)", [(0, 0)]),
    "a blank low": ([[B, 5, 1]], {}, "The low end is blank", [(0, 0)]),
    "blank ends": ([[0, 1, 1], [B, B, 2]], {}, "Both ends are blank", [(1, 0)]),
    "a blank value": ([[1, 1], [B, 2]], {}, "The value is blank", [(1, 0)]),
    "a negative weight": ([[1, 1], [2, -2]], {}, "The weight (-2) is below 0", [(1, 1)]),
    "a negative weight of a range": ([[1, 2, -0.5]], {}, "The weight (-0.5) is below 0", [(0, 2)]),
    "no weight": ([[1, 0], [2, 0]], {}, "Every weight is 0", [(0, 1)]),
    "a negative step": ([[1, 2, 1, -1]], {}, "The step (-1) is below 0", [(0, 3)]),
    "too many steps": ([[0, 1, 1, 1e-9]], {}, "The data give more than 100,000 single values", [(0, 3)]),
    "too many rows of steps": (
        [[0, 1, 1, 2e-5], [2, 3, 1, 1.5e-5]],
        {},
        "The data give more than 100,000 single values",
        [(0, 0)],
    ),
    "one height": ([[0, 1, 1, 2, B]], {}, "One of the two heights is blank", [(0, 4)]),
    "a negative height": ([[0, 1, 1, -2, 1]], {}, "The height (-2) is below 0", [(0, 3)]),
    "no height": ([[0, 1, 1, 0, 0]], {}, "Both heights are 0", [(0, 3)]),
    "a huge number": ([[1e200]], {}, "The number (1e+200) must be between -1E150 and 1E150", [(0, 0)]),
    "a huge end": ([[0, 1e200, 1]], {}, "The number (1e+200) must be between -1E150 and 1E150", [(0, 1)]),
    "a falling cumulative weight": (
        [[1, 0.5], [2, 0.25]],
        {"cumulative": True},
        "The cumulative weight (0.25) falls: before it, in {also}, it is 0.5",
        [(1, 1), (0, 1)],
    ),
    "a blank cumulative weight": (
        [[1, 2, 0.5], [2, 3, B]],
        {"cumulative": True},
        "A cumulative weight is blank",
        [(1, 2)],
    ),
    "a negative cumulative weight": (
        [[1, -0.5], [2, 1]],
        {"cumulative": True},
        "The cumulative weight (-0.5) falls",
        [(0, 1)],
    ),
    "cumulative slopes": (
        [[0, 1, 1, 1, 2]],
        {"cumulative": True},
        "Weights cannot be cumulative in data with heights of a slope",
        [(0, 0)],
    ),
    "cumulative values": (
        [[1]],
        {"cumulative": True},
        "Weights cannot be cumulative in data with no weights",
        [(0, 0)],
    ),
}


@pytest.mark.parametrize(("rows", "options", "message", "places"), BAD.values(), ids=list(BAD))
def test_bad_data(rows, options, message, places):
    with pytest.raises(DataError) as caught:
        custom_pieces(rows, **options)
    assert caught.value.message.startswith(message)
    result = [(caught.value.row, caught.value.column), caught.value.also]
    assert result[: len(places)] == places
    assert caught.value.hint
    assert not caught.value.hint.endswith(".")


def test_steps_share_the_weight():
    pieces = custom_pieces([[60, 80, 0.3, 1]])
    assert len(pieces) == 21
    assert math.fsum(piece.weight for piece in pieces) == pytest.approx(0.3, rel=1e-14)


def test_minus_zero_is_zero():
    assert value_pieces([[0.0], [-0.0]]) == [Piece(0.0, 0.0, 2.0)]
    assert weighted_pieces([[-0.0, 1.0], [0.0, 1.0]]) == [Piece(0.0, 0.0, 2.0)]


def test_blanks_of_an_array():
    assert rows_of(np.array([[1.0, np.nan]])) == [[1.0, None]]
