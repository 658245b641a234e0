from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions.yes_no import YesNo

YES_NO = YesNo()


@pytest.mark.parametrize("probability", [0.25, 0.5, 0.999])
def test_against_scipy(probability, counts_agree):
    counts_agree(YES_NO, (probability,), stats.bernoulli(probability))


@pytest.mark.parametrize("always", [0, 1])
def test_certainty(always, clean):
    np.testing.assert_array_equal(YES_NO.ppf(np.array([0.0, 0.5, 1 - 2.0**-53]), always), always)
    np.testing.assert_array_equal(YES_NO.support(always), [always, always])


def test_a_rare_event_keeps_its_probability():
    u = np.array([1 - 2.0**-53, 1 - 2.0**-52])
    np.testing.assert_array_equal(YES_NO.ppf(u, 2.0**-52), [1, 0])


@pytest.mark.parametrize(("probability", "shown"), [(-0.25, "-0.25"), (25, "25")])
def test_bad_probabilities(probability, shown):
    fault = YES_NO.fault(probability)
    assert (fault.key, fault.message) == ("probability", f"Probability ({shown}) must be from 0 to 1")
    assert fault.hint
