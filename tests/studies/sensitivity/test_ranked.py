from __future__ import annotations

import numpy as np

from xlmc.studies.sensitivity.ranked import Ranked


def test_classes_of_the_largest_numbers_are_those_of_their_size():
    values = np.linspace(-1.0, 1.0, 2_001) ** 3
    plain, huge = Ranked.of(values).classes, Ranked.of(values * 1.7e308).classes
    np.testing.assert_array_equal(huge.label, plain.label)
    np.testing.assert_allclose(huge.squares, plain.squares, rtol=1e-12)
