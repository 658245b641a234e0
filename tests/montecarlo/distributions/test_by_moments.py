"""Families given by mean and standard deviation: they have these moments, and known members come back."""

from __future__ import annotations

import math
import pickle
import re

import pytest

from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.by_moments import COV, COV_SHARE, by_moments
from xlmc.montecarlo.distributions.parameters import STD_DEV

# Family -> the parameters that are given beside the moments, and its own for mean 50 and standard deviation 5.
EULER = 0.5772156649015329
GUMBEL = 5 * math.sqrt(6) / math.pi
LOG = math.log(1 + 0.1**2)
CASES = {
    "Normal": ({}, (50.0, 5.0)),
    "Uniform": ({}, (50 - 5 * math.sqrt(3), 50 + 5 * math.sqrt(3))),
    "Logistic": ({}, (50.0, 5 * math.sqrt(3) / math.pi)),
    "Maximum Extreme": ({}, (50 - EULER * GUMBEL, GUMBEL)),
    "Minimum Extreme": ({}, (50 + EULER * GUMBEL, GUMBEL)),
    "Gamma": ({}, (0.0, 0.5, 100.0)),
    "Lognormal": ({}, (0.0, 50.0, 5.0)),
    "Lognorm2": ({}, (0.0, math.log(50) - LOG / 2, math.sqrt(LOG))),
    "Pareto": ({}, (50 * math.sqrt(101) / (1 + math.sqrt(101)), 1 + math.sqrt(101))),
    "Inverse Gaussian": ({}, (0.0, 50.0, 5000.0)),
    "Beta": ({"low": 0.0, "high": 100.0}, (0.0, 100.0, 49.5, 49.5)),
    "Student's t": ({"degrees": 5.0}, (50.0, 5 * math.sqrt(3 / 5), 5.0)),
    "Weibull": ({}, None),
    "Log-logistic": ({}, None),
    "Frechet": ({}, None),
    "Fatigue life": ({}, None),
    "Pearson5": ({}, None),
    "Laplace": ({}, (50.0, 5.0)),
}


@pytest.mark.parametrize(("name", "given", "own"), [(name, *case) for name, case in CASES.items()], ids=CASES)
def test_the_member_has_the_moments_and_is_the_known_one(name, given, own):
    family = by_moments(FAMILIES[name], given, STD_DEV)
    parameters = {**{spec.key: spec.default for spec in family._given if spec.default is not None}, **given}
    parameters |= {"mean": 50.0, "std_dev": 5.0}
    assert family.check(**parameters) is None
    assert float(family.mean(**parameters)) == pytest.approx(50, rel=1e-9)
    assert float(family.variance(**parameters)) == pytest.approx(25, rel=1e-8)
    if own is not None:
        assert family.member(**parameters) == pytest.approx(own, rel=1e-9)


@pytest.mark.parametrize("name", [name for name, (given, _) in CASES.items() if not given])
def test_a_coefficient_of_variation_is_the_same_in_percent_and_as_a_share(name):
    members = []
    for spread, value in ((STD_DEV, 5.0), (COV, 10.0), (COV_SHARE, 0.1)):
        family = pickle.loads(pickle.dumps(by_moments(FAMILIES[name], (), spread)))
        members.append(family.member(mean=50.0, **{spread.key: value}))
    assert members[1] == pytest.approx(members[0], rel=1e-12)
    assert members[2] == pytest.approx(members[0], rel=1e-12)


def test_a_weibull_is_found_from_the_moments_of_one():
    weibull = FAMILIES["Weibull"]
    for shape in (0.5, 1.0, 2.0, 8.0):
        mean, variance = (float(each(2.0, 3.0, shape)) for each in (weibull.mean, weibull.variance))
        result = by_moments(weibull, ("location",), STD_DEV).member(
            location=2.0, mean=mean, std_dev=math.sqrt(variance)
        )
        assert result == pytest.approx((2.0, 3.0, shape), rel=1e-9)


@pytest.mark.parametrize("name", ["Triangular", "Exponential", "Yes-No", "Johnson SU", "Custom"])
def test_what_two_moments_do_not_determine_is_refused(name):
    with pytest.raises(ValueError, match="do not determine"):
        by_moments(FAMILIES[name], (), COV)


@pytest.mark.parametrize(
    ("name", "numbers", "message"),
    [
        ("Gamma", {"location": 0.0, "mean": -1.0, "std_dev": 1.0}, "No Gamma has"),
        ("Logistic", {"mean": 1.0, "std_dev": 0.0}, "Std dev .0. must be above 0"),
        ("Cauchy", {"mean": 1.0, "std_dev": 1.0}, "No Cauchy has"),
    ],
)
def test_moments_that_no_member_has_are_told(name, numbers, message):
    fault = by_moments(FAMILIES[name], (), STD_DEV).check(**numbers)
    assert fault is not None
    assert re.search(message, fault)
