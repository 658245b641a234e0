"""Values at the ends of what a number can be: a statistic is a finite number, or none, and nothing overflows."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.montecarlo.statistics import describe
from xlmc.outputs.sheets.styles import bounds

COIN = np.where(np.arange(600) % 2, 1.0, -1.0)
EVEN = np.linspace(0.0, 1.0, 600)
SAMPLES = {
    "near the largest number": 1.7e308 * (0.5 + EVEN / 2),
    "a variance that overflows": (EVEN - 0.5) * 1e200,
    "one large number after another": 1e308 + EVEN * 1e292,
    "as small as a number can be": EVEN * 1e-320,
    "the smallest number or none": np.where(COIN > 0, 5e-324, 0.0),
    "two neighbours": np.where(COIN > 0, 1.0 + 2.3e-16, 1.0),
    "all the same": np.ones(600),
}


@pytest.mark.parametrize("sample", SAMPLES.values(), ids=SAMPLES)
@pytest.mark.parametrize("replicates", [None, np.arange(600) // 60], ids=["trials", "replicates"])
def test_no_statistic_is_infinite_and_none_overflows(sample, replicates):
    result = describe(sample, replicate=replicates)
    names = ("mean", "median", "mode", "standard_deviation", "variance", "skewness", "kurtosis", "range_width")
    assert not any(math.isinf(getattr(result, name).value) for name in names)
    assert sample.min() <= result.mean.value <= sample.max()


def test_what_is_too_large_for_a_number_is_none():
    result = describe(SAMPLES["a variance that overflows"])
    assert math.isnan(result.variance.value)
    assert result.standard_deviation.value == pytest.approx(1e200 * np.std(EVEN, ddof=1), rel=1e-12)
    assert math.isnan(describe(1e308 * COIN).range_width.value)


def test_an_axis_of_the_smallest_numbers_has_no_limits():
    assert bounds(0.0, 5e-324) == {}
