"""Parameters without scatter leave one value: Poisson(0), Normal(x, 0), Lognormal of SD 0, Gamma of scale 0."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES, Truncated

POINTS = {
    "Normal": ((3.0, 0.0), 3.0),
    "Lognormal": ((0.0, 5.0, 0.0), 5.0),
    "Lognorm2": ((1.0, 0.5, 0.0), 1.0 + np.exp(0.5)),
    "Gamma": ((2.0, 0.0, 3.0), 2.0),
    "Weibull": ((2.0, 0.0, 3.0), 2.0),
    "Logistic": ((2.0, 0.0), 2.0),
    "Laplace": ((2.0, 0.0), 2.0),
    "Cauchy": ((2.0, 0.0), 2.0),
    "Maximum Extreme": ((2.0, 0.0), 2.0),
    "Minimum Extreme": ((2.0, 0.0), 2.0),
    "Students t": ((2.0, 0.0, 4.0), 2.0),
    "Poisson": ((0.0,), 0.0),
    "Uniform": ((2.0, 2.0), 2.0),
    "Triangular": ((5.0, 5.0, 5.0), 5.0),
    "BetaPERT": ((5.0, 5.0, 5.0), 5.0),
}
U = np.array([0.0, 0.1, 0.5, 0.999])


def named(name):
    return next(family for key, family in FAMILIES.items() if key.replace("'", "") == name.replace("'", ""))


@pytest.mark.parametrize(("name", "params", "point"), [(name, *each) for name, each in POINTS.items()], ids=[*POINTS])
def test_one_value_is_drawn(name, params, point):
    family = named(name)
    assert family.check(*params) is None
    np.testing.assert_array_equal(family.ppf(U, *params), point)
    np.testing.assert_array_equal(family.isf(U[1:], *params), point)
    assert (float(family.mean(*params)), float(family.variance(*params))) == (point, 0.0)
    assert tuple(map(float, family.support(*params))) == (point, point)
    assert family.cdf(np.array([point - 1, point, point + 1]), *params).tolist() == [0, 1, 1]
    assert family.sf(np.array([point - 1, point, point + 1]), *params).tolist() == [1, 1, 0]


@pytest.mark.parametrize(("name", "params", "point"), [(name, *each) for name, each in POINTS.items()], ids=[*POINTS])
def test_in_some_trials_only(name, params, point):
    """Beside trials with scatter, and beside trials whose parameters are no distribution."""
    family = named(name)
    wide = tuple(value + shift for value, shift in zip(params, (0.0, 1.0, 2.0), strict=False))
    wide = (1.0,) if name == "Poisson" else wide
    columns = [np.array([a, b, np.nan]) for a, b in zip(params, wide, strict=True)]
    result = family.ppf(np.full(3, 0.7), *columns)
    assert result[0] == point
    assert result[1] == pytest.approx(float(family.ppf(0.7, *wide)), rel=1e-12)
    assert np.isnan(result[2])


def test_other_rules_still_hold():
    assert FAMILIES["Gamma"].check(0.0, 0.0, -1.0) == "Scale (0) must be above 0"
    assert FAMILIES["Normal"].check(float("nan"), 0.0) is not None


@pytest.mark.parametrize("cutoff", [(0.0, 10.0), (-np.inf, 5.0)])
def test_within_cutoffs(cutoff):
    np.testing.assert_array_equal(Truncated(FAMILIES["Normal"]).ppf(U, *cutoff, 3.0, 0.0), 3.0)
