"""Numbers of a distribution itself, beside sums over its values by other means."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.errors import FormulaError
from xlmc.montecarlo.definitions.in_cells.theory import THEORETICAL, Distribution, theoretical
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.draws import Draw


def cut(family, given, low, high):
    """A draw between two cutoffs."""
    family = FAMILIES[family] if isinstance(family, str) else family
    return Draw.of("x", family, given | {"lower_cutoff": low, "upper_cutoff": high}).distribution


DISCRETE = FAMILIES["Discrete"].built(np.array([[1, 0.1], [5, 0.2], [9, 0.3], [20, 0.4]]))

COUNTS = {
    "Poisson": (cut("Poisson", {"rate": 5.0}, 2.5, 9.0), np.arange(3, 10), stats.poisson(5).pmf),
    "far out": (cut("Poisson", {"rate": 5.0}, 40.0, np.inf), np.arange(40, 200), stats.poisson(5).pmf),
    "Binomial": (
        cut("Binomial", {"probability": 0.3, "trials": 20.0}, -np.inf, 4.9),
        np.arange(5),
        stats.binom(20, 0.3).pmf,
    ),
    "values": (cut(DISCRETE, {}, 2.0, 19.0), np.array([5, 9]), lambda x: np.where(x == 5, 0.2, 0.3)),
    "all values": (Draw.of("x", DISCRETE, {}).distribution, DISCRETE.low, lambda _: DISCRETE.share),
}


@pytest.mark.parametrize(("whole", "values", "chance"), COUNTS.values(), ids=COUNTS)
def test_numbers_of_single_values_are_sums(whole, values, chance):
    of, shift = Distribution(whole, 2.0), 2.0
    p = chance(values) / chance(values).sum()
    mean = p @ values
    central = [p @ (values - mean) ** order for order in range(5)]
    expected = {
        "RiskTheoMean": mean + shift,
        "RiskTheoVariance": central[2],
        "RiskTheoStdDev": central[2] ** 0.5,
        "RiskTheoSkewness": central[3] / central[2] ** 1.5,
        "RiskTheoKurtosis": central[4] / central[2] ** 2,
        "RiskTheoMeanAbsDev": p @ np.abs(values - mean),
        "RiskTheoMin": values[0] + shift,
    }
    if len(values) < 100:
        expected |= {"RiskTheoMax": values[-1] + shift, "RiskTheoRange": values[-1] - values[0]}
    for function, number in expected.items():
        assert theoretical(function, of, 0.0) == pytest.approx(number, rel=1e-10, abs=1e-10), function


NORMAL = stats.norm(10.0, 2.0)

OF_THE_NORMAL = [
    ("RiskTheoMean", 0.0, 10.0),
    ("RiskTheoStdDev", 0.0, 2.0),
    ("RiskTheoVariance", 0.0, 4.0),
    ("RiskTheoSkewness", 0.0, 0.0),
    ("RiskTheoKurtosis", 0.0, 3.0),
    ("RiskTheoMeanAbsDev", 0.0, 2.0 * np.sqrt(2.0 / np.pi)),
    ("RiskTheoCoeffOfVariation", 0.0, 0.2),
    ("RiskTheoPercentile", 0.9, NORMAL.ppf(0.9)),
    ("RiskTheoPtoX", 0.9, NORMAL.ppf(0.9)),
    ("RiskTheoPercentileD", 0.9, NORMAL.isf(0.9)),
    ("RiskTheoPtoXD", 0.9, NORMAL.isf(0.9)),
    ("RiskTheoQtoX", 0.9, NORMAL.isf(0.9)),
    ("RiskTheoTarget", 12.5, NORMAL.cdf(12.5)),
    ("RiskTheoXtoP", 12.5, NORMAL.cdf(12.5)),
    ("RiskTheoTargetD", 12.5, NORMAL.sf(12.5)),
    ("RiskTheoXtoPD", 12.5, NORMAL.sf(12.5)),
    ("RiskTheoXtoQ", 12.5, NORMAL.sf(12.5)),
]


@pytest.mark.parametrize(("function", "number", "expected"), OF_THE_NORMAL)
def test_numbers_of_a_normal_distribution(function, number, expected):
    of = Distribution(Draw.of("x", FAMILIES["Normal"], {"mean": 10.0, "std_dev": 2.0}).distribution, 0.0)
    assert theoretical(function, of, number) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("function", ["RiskTheoMin", "RiskTheoMax", "RiskTheoRange"])
def test_ends_that_are_infinite_are_refused(function):
    of = Distribution(Draw.of("x", FAMILIES["Normal"], {"mean": 10.0, "std_dev": 2.0}).distribution, 0.0)
    with pytest.raises(FormulaError, match=f"{function}: this number of the distribution is infinite"):
        theoretical(function, of, 0.0)


@pytest.mark.parametrize(
    ("function", "number", "expected"),
    [
        ("RiskTheoMin", 0.0, 3.0),
        ("RiskTheoMax", 0.0, 8.0),
        ("RiskTheoRange", 0.0, 5.0),
        ("RiskTheoPtoX", 0.0, 3.0),
        ("RiskTheoPtoX", 0.2, 4.0),
        ("RiskTheoPtoX", 1.0, 8.0),
        ("RiskTheoPtoXD", 0.0, 8.0),
        ("RiskTheoPtoXD", 1.0, 3.0),
    ],
)
def test_probabilities_0_and_1_are_the_ends(function, number, expected):
    of = Distribution(Draw.of("x", FAMILIES["Uniform"], {"low": 1.0, "high": 6.0}).distribution, 2.0)
    assert theoretical(function, of, number) == pytest.approx(expected)


@pytest.mark.parametrize("number", [-0.01, 1.01])
@pytest.mark.parametrize("function", ["RiskTheoPtoX", "RiskTheoPtoXD", "RiskTheoQtoX", "RiskTheoPercentile"])
def test_a_probability_is_from_0_to_1(function, number):
    of = Distribution(Draw.of("x", FAMILIES["Uniform"], {"low": 1.0, "high": 6.0}).distribution, 2.0)
    with pytest.raises(FormulaError, match="a probability must be from 0 to 1"):
        theoretical(function, of, number)


def test_every_function_has_a_number_here():
    assert set(THEORETICAL) == {function for function, _, _ in OF_THE_NORMAL} | {
        "RiskTheoMin",
        "RiskTheoMax",
        "RiskTheoRange",
    }
