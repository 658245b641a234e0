"""Quantiles far out against the cotangent, where the tangent of nearly a right angle has lost its digits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES

CAUCHY = FAMILIES["Cauchy"]


@pytest.mark.parametrize("rest", [0.3, 2.0**-10, 2.0**-30, 2.0**-52])
def test_both_tails_keep_their_digits(rest):
    far = 1 / math.tan(math.pi * rest)
    ends = CAUCHY.ppf(np.array([rest, 1 - rest]), 10.0, 2.0)
    np.testing.assert_allclose((ends - 10) / 2, [-far, far], rtol=1e-14)
