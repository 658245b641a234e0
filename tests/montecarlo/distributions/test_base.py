from __future__ import annotations

import itertools

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.base import SMALLEST_U, TRIED_U, Family, Member

GOOD = {
    "Uniform": (2.0, 6.0),
    "Normal": (3.0, 2.0),
    "Triangular": (2.0, 5.0, 6.0),
    "Trapezoid": (2.0, 3.0, 5.0, 6.0),
    "Beta": (2.0, 6.0, 2.0, 3.0),
    "BetaPERT": (2.0, 5.0, 6.0),
    "Exponential": (0.5,),
    "Gamma": (1.0, 2.0, 3.0),
    "Logistic": (3.0, 2.0),
    "Lognormal": (1.0, 3.0, 2.0),
    "Lognorm2": (1.0, 0.5, 0.5),
    "Maximum Extreme": (3.0, 2.0),
    "Minimum Extreme": (3.0, 2.0),
    "Pareto": (2.0, 3.0),
    "Student's t": (3.0, 2.0, 5.0),
    "Trigen": (2.0, 5.0, 6.0, 10.0, 90.0),
    "Weibull": (1.0, 2.0, 2.0),
    "Cumul": (-2.0, 2.0),
    "General": (-2.0, 2.0),
    "Histogrm": (-2.0, 2.0),
    "Binomial": (0.3, 20.0),
    "Discrete Uniform": (2.0, 7.0),
    "Geometric": (0.25,),
    "Geomet": (0.25,),
    "Hypergeometric": (20.0, 10.0, 50.0),
    "Negative Binomial": (0.25, 3.0),
    "Negbin": (0.25, 3.0),
    "Poisson": (4.0,),
    "Yes-No": (0.25,),
}
DATA = {
    "Cumul": [[-0.5, 0.25], [0.5, 0.5]],
    "General": [[-0.5, 1.0], [0.5, 3.0]],
    "Histogrm": [[1.0], [2.0], [3.0]],
}


def example(name):
    """The family, built if need be."""
    return FAMILIES[name].built(np.array(DATA[name])) if name in DATA else FAMILIES[name]


CASES = [pytest.param(example(name), GOOD[name], id=name) for name in FAMILIES if name in GOOD]
U = np.array([0.0, 2.0**-53, 0.25, 0.5, 0.75, 1 - 2.0**-53])


@pytest.mark.parametrize(("family", "params"), CASES)
def test_numbers_arrays_and_keys_give_the_same(family, params):
    expected = family.ppf(U, *params)
    by_key = dict(zip(family.keys, params, strict=True))
    columns = [np.full(U.shape, value) for value in params]
    np.testing.assert_array_equal(family.ppf(U, **by_key), expected)
    np.testing.assert_array_equal(family.ppf(U, *columns), expected)
    np.testing.assert_array_equal([family.ppf(u, *params) for u in U], expected)
    assert family.ppf(0.5, *columns).shape == U.shape


@pytest.mark.parametrize(("family", "params"), CASES)
def test_u_is_left_alone_unless_it_is_out(family, params):
    u = U.copy()
    expected = family.ppf(u, *params)
    np.testing.assert_array_equal(u, U)
    elsewhere = np.empty_like(u)
    assert family.ppf(u, *params, out=elsewhere) is elsewhere
    np.testing.assert_array_equal(elsewhere, expected)
    np.testing.assert_array_equal(u, U)
    assert family.ppf(u, *params, out=u) is u
    np.testing.assert_array_equal(u, expected)


@pytest.mark.parametrize(("family", "params"), CASES)
def test_a_member_gives_what_the_family_gives_and_checks_nothing(family, params):
    names = "ppf", "isf", "cdf", "sf"
    expected = [getattr(family, name)(U, *params) for name in names] + [family.mean(*params), family.variance(*params)]
    ends = family.support(*params)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(family, "valid", None)
        member = Member(family, params)
        result = [getattr(member, name)(U) for name in names] + [member.mean(), member.variance()]
    assert [each.tobytes() for each in result] == [each.tobytes() for each in expected]
    assert member.support() == ends


@pytest.mark.parametrize(("family", "params"), CASES)
def test_draws_are_finite_rise_and_lie_in_the_support(family, params):
    x = family.ppf(U, *params)
    low, high = family.support(*params)
    assert np.isfinite(x).all()
    assert (np.diff(x) >= 0).all()
    assert low <= x[0]
    assert x[-1] <= high


@pytest.mark.parametrize(("family", "params"), CASES)
def test_a_bad_parameter_spoils_its_own_trials_only(family, params, clean):
    """NaN, infinite and too large ones in every place."""
    for place, bad in itertools.product(range(len(params)), (np.nan, np.inf, -np.inf, 1e200)):
        columns = [np.full(3, value) for value in params]
        columns[place][1] = bad
        for result, expected in (
            (family.ppf(0.3, *columns), family.ppf(0.3, *params)),
            (family.isf(0.3, *columns), family.isf(0.3, *params)),
            (family.cdf(4.0, *columns), family.cdf(4.0, *params)),
            (family.sf(4.0, *columns), family.sf(4.0, *params)),
            (family.mean(*columns), family.mean(*params)),
            (family.variance(*columns), family.variance(*params)),
            (family.support(*columns)[0], family.support(*params)[0]),
            (family.support(*columns)[1], family.support(*params)[1]),
        ):
            np.testing.assert_array_equal(result, [expected, np.nan, expected])


@pytest.mark.parametrize(("family", "params"), CASES)
def test_rules_agree_for_numbers_and_trials(family, params, clean):
    """Every order of the parameters: `check` is silent exactly where `valid` holds and `ppf` gives a number."""
    rng = np.random.default_rng(1)
    trials = rng.integers(-2, 3, size=(150, len(params))).astype(float)
    valid = family.valid(*trials.T)
    np.testing.assert_array_equal(valid, [family.check(*row) is None for row in trials])
    np.testing.assert_array_equal(np.isfinite(family.ppf(0.5, *trials.T)), valid)
    assert 0 < valid.sum() < len(trials)


@pytest.mark.parametrize(("family", "params"), CASES)
def test_a_number_that_is_none(family, params):
    broken = (*params[:-1], float("nan"))
    spec = family.parameters[-1]
    assert family.check(*broken) == f"{spec.heading} (nan) must be a number between -1E150 and 1E150"
    assert family.fault(*broken).key == spec.key
    assert np.isnan(family.ppf(0.5, *broken))


@pytest.mark.parametrize(("family", "params"), CASES)
def test_wrong_parameters_are_a_type_error(family, params):
    with pytest.raises(TypeError, match=f"{family.name} takes {family.keys[0]}"):
        family.ppf(0.5, *params[:-1])
    with pytest.raises(TypeError, match="takes"):
        family.ppf(0.5, *params, low=1.0, mean=1.0)
    with pytest.raises(TypeError, match="takes"):
        family.ppf(0.5, *params[:-1], nonsense=1.0)


def test_zero_stands_for_half_a_step_where_the_quantile_is_infinite():
    normal = FAMILIES["Normal"]
    assert normal.ppf(0.0, 0, 1) == normal.ppf(SMALLEST_U, 0, 1) == pytest.approx(-8.2924, abs=1e-4)
    assert FAMILIES["Uniform"].ppf(0.0, 2, 6) == 2


def test_a_family_without_an_upper_tail_is_refused_when_it_is_written():
    with pytest.raises(TypeError, match="Half has no upper tail: write `_mirrored`, or both `_sf` and `_isf`"):
        type("Half", (Family,), {"_sf": Family._cdf})


def test_quantiles_are_tried_from_the_least_to_the_largest_u_that_a_sampler_gives():
    """Draws use u = k·2^-53; the ends of a tail that rare acceptance looks at go down to 2^-80."""
    assert list(TRIED_U) == sorted(TRIED_U)
    assert (TRIED_U[0], TRIED_U[-1]) == (2.0**-80, np.nextafter(1.0, 0.0))
    assert {2.0**-54, 0.5} <= {*TRIED_U}
    assert max(np.diff(TRIED_U)) <= 0.2 + 1e-12
    assert sum(u < 0.5 for u in TRIED_U) == sum(u > 0.5 for u in TRIED_U) + 1
