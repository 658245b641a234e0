"""Numbers of a distribution itself, beside sums over its values by other means."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.definitions.in_cells.theory import Distribution, theoretical
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
