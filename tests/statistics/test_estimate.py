from __future__ import annotations

import dataclasses
import math
import subprocess
import sys

import pytest
from scipy import stats

from xlmc.statistics import Estimate
from xlmc.statistics.estimate import t_quantile, with_error, with_relative_error


def test_is_frozen_and_slotted():
    estimate = Estimate(1.0, 0.1, (0.8, 1.2), 50)
    with pytest.raises(dataclasses.FrozenInstanceError):
        estimate.value = 2.0
    assert not hasattr(estimate, "__dict__")


@pytest.mark.parametrize("dof", [1, 2.5, 9, 199, 1e7])
@pytest.mark.parametrize("confidence", [0.5, 0.95, 0.999])
def test_t_quantile_is_students(dof, confidence):
    assert t_quantile(dof, confidence) == pytest.approx(stats.t.ppf(0.5 + confidence / 2, dof), rel=1e-9)


def test_t_quantile_without_limit_of_freedom_is_normal():
    assert t_quantile(math.inf, 0.95) == pytest.approx(1.959963984540054, rel=1e-12)


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_a_confidence_outside_0_and_1_is_refused(confidence):
    with pytest.raises(ValueError, match="between 0 and 1"):
        t_quantile(5, confidence)


def test_interval_is_value_and_t_errors_either_side():
    estimate = with_error(10.0, 2.0, 4.0, 0.95, 5)
    assert estimate.interval == pytest.approx((10 - 2 * 2.7764451, 10 + 2 * 2.7764451))


@pytest.mark.parametrize(
    ("value", "error", "dof"), [(1.0, 0.1, 0.5), (math.nan, 0.1, 9), (1.0, math.nan, 9), (math.inf, 1.0, 9)]
)
def test_an_error_that_cannot_be_known_is_none(value, error, dof):
    estimate = with_error(value, error, dof, 0.95, 3)
    assert (estimate.error, estimate.interval, estimate.n) == (None, None, 3)


def test_the_interval_of_a_scale_stays_positive_and_agrees_with_the_plain_one_when_narrow():
    low, high = with_relative_error(1.0, 0.9, 3.0, 0.95, 4).interval
    assert 0.0 < low < 1.0 < high
    assert low * high == pytest.approx(1.0)
    narrow = with_relative_error(5.0, 0.001, 99.0, 0.95, 100).interval
    assert narrow == pytest.approx(with_error(5.0, 0.001, 99.0, 0.95, 100).interval, rel=1e-6)


def test_the_interval_of_a_scale_of_two_trials_may_be_unbounded():
    assert with_relative_error(1.0, 1.0, 1.0, 0.9999, 2).interval == (0.0, math.inf)


def test_importing_does_not_load_scipy():
    code = "import sys, xlmc.statistics; print([name for name in sys.modules if name.startswith('scipy')])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
