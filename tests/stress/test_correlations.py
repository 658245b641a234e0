"""Correlations near ±1, and matrices on either side of what is possible."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from simulated import simulated

TRIALS = 50_000


PAIRS = [
    *(("mc", asked) for asked in (0.999, -0.999, 0.999_999, -0.999_999, 1.0, -1.0)),
    *(("lhs", asked) for asked in (0.999_999, -1.0)),
    *(("sobol", asked) for asked in (-0.999, 1.0)),
]


@pytest.mark.parametrize(("sampling", "asked"), PAIRS)
def test_pairs_near_one(asked, sampling):
    """Within 5 standard errors of what so many draws of this correlation have on average; each margin stays its own,
    to a Kolmogorov distance that chance exceeds once in 100,000."""
    from stressing.dependence import book, compared

    named = {("first", "second"): asked}
    model = book(named)
    run = simulated(model, TRIALS, 3, sampling=sampling)
    (result,) = compared(model, named, run)
    assert model.notices == ()
    assert result["aimed"] == pytest.approx(asked, abs=1e-12)
    assert abs(result["found"] - result["expected"]) < 5 * result["error"]
    draws = run.inputs
    for name, law in (("first", stats.uniform()), ("second", stats.norm(5.0, 2.0))):
        assert stats.kstest(draws[name], law.cdf, method="asymp").statistic < 2.5 / np.sqrt(TRIALS)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_exactly_one_is_one_draw_seen_twice(sign):
    from stressing.dependence import book

    draws = simulated(book({("first", "second"): sign}), TRIALS, 4).inputs
    u = draws["first"] if sign > 0 else 1.0 - draws["first"]
    np.testing.assert_allclose(draws["second"], stats.norm(5.0, 2.0).ppf(u), rtol=1e-9, atol=1e-9)


def test_possible_matrices_are_left_alone_and_impossible_ones_are_told():
    from stressing.dependence import MATRICES, book, measure

    reported = {}
    for name, named in MATRICES.items():
        model = book(named)
        result = measure(model, named, TRIALS, 5)
        reported[name] = bool(model.notices)
        for pair in result:
            assert abs(pair["found"] - pair["expected"]) < 5 * pair["error"], (name, pair)
            assert reported[name] or pair["aimed"] == pytest.approx(pair["asked"], abs=1e-9), (name, pair)
        pearson = np.eye(3)
        for (i, j), pair in zip([(0, 1), (0, 2), (1, 2)], result, strict=True):
            pearson[i, j] = pearson[j, i] = 2 * np.sin(np.pi * pair["aimed"] / 6)
        assert np.linalg.eigvalsh(pearson)[0] > -1e-9
    assert [name for name, message in reported.items() if message] == ["just impossible", "contradictory"]
