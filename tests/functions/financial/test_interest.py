from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value

NUM, VALUE, DIV0, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.DIV0, ErrorCode.NA

VALUES = [
    ("EFFECT", (0.0525, 4), 0.0535426673707584),
    ("EFFECT", (0.0525, 4.9), 0.0535426673707584),
    ("EFFECT", (0, 4), NUM),
    ("EFFECT", (0.05, 0.5), NUM),
    ("EFFECT", (True, 4), VALUE),
    ("NOMINAL", (0.053543, 4), 0.0525003198683558),
    ("NOMINAL", (-0.05, 4), NUM),
    ("RRI", (96, 10000, 11000), 0.000993307376291),
    ("RRI", (96, 10000, 0), -1),
    ("RRI", (1, -100, -110), 0.1),
    ("RRI", (0, 10000, 11000), NUM),
    ("RRI", (96, 0, 11000), NUM),
    ("RRI", (96, -1, 11000), NUM),
    ("PDURATION", (0.025, 2000, 2200), 3.85986616262266),
    ("PDURATION", (0.025 / 12, 1000, 1200), 87.6054764193714),
    ("PDURATION", (0, 2000, 2200), NUM),
    ("PDURATION", (0.025, 0, 2200), NUM),
    ("FVSCHEDULE", (1, [[0.09, 0.11, 0.1]]), 1.33089),
    ("FVSCHEDULE", (1, [[0.09, None, 0.1]]), 1.199),
    ("FVSCHEDULE", (1, [[0.09, "x", NA]]), VALUE),
    ("FVSCHEDULE", (1, [[0.09, NA, True]]), NA),
    ("FVSCHEDULE", ("x", [[NA]]), VALUE),
    ("FVSCHEDULE", (200, 0.5), 300),
    ("DOLLARDE", (1.02, 16), 1.125),
    ("DOLLARDE", (1.1, 32), 1.3125),
    ("DOLLARDE", (-1.1, 32), -1.3125),
    ("DOLLARDE", (1.1, 10), 1.1),
    ("DOLLARDE", (1.1, 1), 1.1),
    ("DOLLARDE", (1.1, 0.5), DIV0),
    ("DOLLARDE", (1.1, -1), NUM),
    ("DOLLARFR", (1.125, 16.5), 1.02),
    ("DOLLARFR", (1.125, 32), 1.04),
    ("DOLLARFR", (1.125, 1000), 1.125),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


def test_a_schedule_of_the_trial_and_a_principal_of_many_cells():
    """(2, 1, 2) rates, and principals that are one, as many as the trials, or cells."""
    rates = Value.of_numbers(np.array([[[0.5, 0.0]], [[1.0, 1.0]]]))
    call = function_named("FVSCHEDULE")
    assert call([Value.of_numbers(np.array([2.0])), rates]).numbers.tolist() == [3.0, 8.0]
    assert call([Value.of_numbers(np.array([2.0, 4.0])), rates]).numbers.tolist() == [3.0, 16.0]
    assert call([Value.of_numbers(np.array([[[2.0, 4.0]]])), rates]).numbers.tolist() == [[[3.0, 6.0]], [[8.0, 16.0]]]
