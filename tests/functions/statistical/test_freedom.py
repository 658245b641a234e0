from __future__ import annotations

import numpy as np

from xlmc.functions.statistical.probabilities import degrees_of_freedom


def test_from_1_to_ten_billion_fractions_dropped():
    given = np.array([0.9, 1, 1.9, 5, 1e10, 1e10 + 0.5, -3])
    valid, freedom = degrees_of_freedom(given)
    assert valid.tolist() == [False, True, True, True, True, False, False]
    assert freedom.tolist() == [1, 1, 1, 5, 1e10, 1, 1]
