from __future__ import annotations

import numpy as np
import pytest

from xlmc.functions.math.arithmetic import powered


@pytest.mark.parametrize("exponent", [2.0, 0.5, -1.0, 3.0])
def test_the_same_to_the_bit_for_one_trial_and_for_many(exponent):
    base = np.random.default_rng(1).uniform(0.1, 3, 1000)
    exponents = np.where(np.arange(1000) == 0, 7.1, exponent)
    together = powered(base, exponents)
    assert powered(base[1:], np.array([exponent])).tolist() == together[1:].tolist()
    assert powered(base[1:], exponent).tolist() == together[1:].tolist()
    assert all(powered(base[i : i + 1], exponents[i : i + 1])[0] == together[i] for i in range(1000))
    assert all(powered(float(base[i]), float(exponents[i]))[0] == together[i] for i in range(1000))
