from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions.discrete import DUniform
from xlmc.montecarlo.distributions.empirical import Empirical
from xlmc.montecarlo.distributions.parameters import DataError

COLUMN = np.array([[4.0], [1.0], [np.nan], [2.0], [1.0]])


@pytest.mark.parametrize("family", [Empirical(), DUniform()])
def test_values_are_drawn_as_they_are(family):
    built = family.built(COLUMN)
    np.testing.assert_array_equal(built.ppf(np.array([0.0, 0.5, 0.51, 0.75, 0.76])), [1, 1, 2, 2, 4])
    assert built.name == family.name
    assert built.mean() == 2
    assert built.variance() == pytest.approx(1.5, rel=1e-14)


@pytest.mark.parametrize("family", [Empirical(), DUniform()])
def test_blank_data(family):
    with pytest.raises(DataError, match="The data are blank"):
        family.built(np.full((3, 1), np.nan))
