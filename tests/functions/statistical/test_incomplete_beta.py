"""Expected values: 40 digits of mpmath."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.functions.statistical.probabilities import incomplete_beta, inverse_beta

BELOW = [
    ((0.5, 0.5, 1e-300), 6.3661977236758135105e-151),
    ((3.0, 4.0, 1e-20), 1.9999999999999996709e-59),
    ((200.0, 3.0, 0.25), 4.4369253716407351781e-117),
    ((8.0, 10.0, 0.5), 0.6854705810546875),
]


@pytest.mark.parametrize(("arguments", "expected"), BELOW)
def test_both_ends_keep_their_digits(arguments, expected):
    a, b, x = map(np.array, arguments)
    assert incomplete_beta(a, b, x, 1 - x) == pytest.approx(expected, rel=1e-13)
    assert incomplete_beta(b, a, 1 - x, x) == pytest.approx(1 - expected, rel=1e-13)


@pytest.mark.parametrize(("arguments", "p"), BELOW)
def test_the_inverse_gives_the_number_and_its_complement(arguments, p):
    a, b, x = map(np.array, arguments)
    assert inverse_beta(a, b, np.array(p))[0] == pytest.approx(x, rel=1e-12)
    assert inverse_beta(b, a, np.array(p))[0] == pytest.approx(1 - inverse_beta(b, a, np.array(p))[1], rel=1e-13)


def test_arrays_broadcast():
    a, x = np.array([[1.0], [2.0]]), np.array([0.25, 0.5, 0.75])
    expected = [[0.25, 0.5, 0.75], [0.0625, 0.25, 0.5625]]
    assert incomplete_beta(a, np.array(1.0), x, 1 - x) == pytest.approx(np.array(expected), rel=1e-15)
