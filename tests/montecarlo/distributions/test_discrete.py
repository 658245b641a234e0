from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions.discrete import Discrete
from xlmc.montecarlo.distributions.parameters import DataError


def test_values_and_probabilities():
    built = Discrete().built(np.array([[1, 0.2], [2, 0.8]]))
    assert built.mean() == pytest.approx(1.8)
    np.testing.assert_array_equal(built.ppf(np.array([0.2, 0.21])), [1, 2])


def test_cumulative_probabilities():
    built = Discrete().built(np.array([[1, 0.2], [2, 1.0]]), cumulative=True)
    assert built.cdf(1.0) == 0.2


def test_bad_probabilities():
    with pytest.raises(DataError, match=r"The weight \(-1\) is below 0") as caught:
        Discrete().built(np.array([[1, 0.2], [2, -1]]))
    assert (caught.value.row, caught.value.column) == (1, 1)
