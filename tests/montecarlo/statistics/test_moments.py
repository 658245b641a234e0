from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.columns import PART
from xlmc.montecarlo.statistics import Sample, kurtosis, mean, skewness, variance


def exact_moments(values):
    """Mean and central moments 2 to 4 without rounding."""
    x = [Fraction(float(each)) for each in values]
    centre = sum(x) / len(x)
    return centre, *(sum((each - centre) ** k for each in x) / len(x) for k in (2, 3, 4))


@pytest.mark.parametrize("offset", [0.0, 1e9, -1e12])
@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_a_large_offset_costs_no_digits(offset, scale):
    values = offset + scale * np.random.default_rng(1).standard_gamma(3.0, 301)
    centre, m2, m3, m4 = exact_moments(values)
    assert mean(values).value == pytest.approx(float(centre), rel=2e-16)
    assert variance(values).value == pytest.approx(float(m2 * 301 / 300), rel=1e-13)
    assert skewness(values).value == pytest.approx(float(m3) / float(m2) ** 1.5, rel=1e-12)
    assert kurtosis(values).value == pytest.approx(float(m4 / m2**2), rel=1e-12)


@pytest.mark.parametrize("unit", [1e-160, 1e-300, 1e160, 1e300])
def test_units_may_be_tiny_or_huge(unit):
    values = np.random.default_rng(2).standard_normal(200)
    here, there = Sample.of(values).moments, Sample.of(values * unit).moments
    assert there.scale / unit == pytest.approx(here.scale, rel=1e-12)
    assert there.kurtosis == pytest.approx(here.kurtosis, rel=1e-12)
    assert there.covariance == pytest.approx(here.covariance, rel=1e-10)


def test_blocks_join_without_a_seam():
    values = np.random.default_rng(3).exponential(size=2 * PART + 17)
    moments = Sample.of(values).moments
    assert moments.skewness == pytest.approx(stats.skew(values), rel=1e-11)
    assert moments.kurtosis == pytest.approx(stats.kurtosis(values, fisher=False), rel=1e-11)
    z = (values - values.mean()) / values.std()
    whole = np.cov(np.stack([z, z**2, z**3, z**4])) / values.size
    assert moments.covariance == pytest.approx(whole, rel=1e-9)


def test_replicates_across_blocks_are_summed_once():
    rng = np.random.default_rng(4)
    values, ids = rng.normal(size=PART + 99), rng.integers(0, 5, PART + 99)
    covariance = Sample.of(values, replicate=ids).moments.covariance
    z = (values - values.mean()) / values.std()
    pulls = np.array([[np.sum(z[ids == r] ** k - np.mean(z**k)) for r in range(5)] for k in (1, 2, 3, 4)]) / z.size
    assert covariance == pytest.approx(pulls @ pulls.T * 5 / 4, rel=1e-9)


def test_equal_values_have_no_shape():
    moments = Sample.of([0.1] * 10).moments
    assert (moments.mean, moments.scale) == (0.1, 0.0)
    assert np.isnan([moments.skewness, moments.kurtosis]).all()
