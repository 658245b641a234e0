from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.outputs.histogram import histogram
from xlmc.outputs.page.fitted_curves import fitted_curves


def bins_of(x):
    return histogram(x, *np.percentile(x, [25, 75]))


def test_the_best_family_describes_the_trials():
    x = np.sort(stats.norm.ppf((np.arange(3_000) + 0.5) / 3_000, 20.0, 3.0))
    bins = bins_of(x)
    best = fitted_curves(x, bins)[0]
    assert (best.name, best.parameters) == ("Normal", "Mean 20, Std dev 3")
    assert best.distance < 0.002
    edges = [*bins.edges, bins.upper_edges[-1]]
    np.testing.assert_allclose(best.shares[:: best.parts], stats.norm.cdf(edges, 20.0, 3.0), atol=2e-4)
    assert best.shares.size == best.parts * bins.edges.size + 1


def test_whole_numbers_are_fitted_as_counts():
    x = np.sort(stats.poisson.ppf((np.arange(3_000) + 0.5) / 3_000, 4.0))
    bins = bins_of(x)
    best = next(each for each in fitted_curves(x, bins) if each.name == "Poisson")
    assert best.parts == 1
    np.testing.assert_allclose(np.diff(best.shares), stats.poisson.pmf(bins.edges, 4.0), atol=2e-3)


@pytest.mark.parametrize("x", [np.full(100, 3.0), np.arange(14.0)], ids=["all equal", "too few"])
def test_nothing_is_fitted_to_what_tells_nothing(x):
    assert fitted_curves(x, bins_of(x)) == []
