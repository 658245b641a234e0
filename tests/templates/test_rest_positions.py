"""Impact speeds searched from rest positions: a known truth comes back, and as often as the ranges say."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import kstest
from simulated import simulated

TRUTH = {"V1_before": 38, "alpha_1": 0, "V2_before": 24, "alpha_2": 90, "f_1": 0.68, "f_2": 0.68, "e_n": 0.12}
TRUTH |= {"w_1": 3500, "I_1": 2100, "x_1": 82, "y_1": 6, "w_2": 3100, "I_2": 1750, "x_2": 14, "y_2": -32}
TRUTH |= {"gamma_t": 88, "e_t": 0.1, "closure": 1}
REST = ["beta_1", "s_1", "beta_2", "s_2"]


def test_the_readings_are_what_the_truth_leads_to(cells, described):
    result = cells("rest-positions", TRUTH, REST)
    readings = {row.symbol: row.reading for row in described["rest-positions"].evidence if row.reading is not None}
    assert list(readings) == ["beta_1", "s_1", "beta_2", "s_2"]
    for symbol, reading in readings.items():
        assert result[symbol].item() == pytest.approx(reading, abs=0.05), symbol


def test_the_truth_comes_back(model_of, described):
    """Within the central 95 % of the trials that fit, of ranges that were five times as wide."""
    run = simulated(model_of("rest-positions"), 20_000_000, seed=999, until_accepted=300, rare="never")
    assert run.accepted == 300
    ranges = {given.symbol: given.parameters for given in described["rest-positions"].assumptions}
    for name, symbol in (
        ("Vehicle 1 impact speed that fits", "V1_before"),
        ("Vehicle 2 impact speed that fits", "V2_before"),
    ):
        low, high = np.quantile(run[name].values, [0.025, 0.975])
        assert low < TRUTH[symbol] < high
        assert high - low < (ranges[symbol]["High"] - ranges[symbol]["Low"]) / 4


def test_a_truth_drawn_from_the_ranges_is_anywhere_among_the_trials_that_fit(cells, described):
    """Its rank is uniform: the method's own closed loop, without which the ranges would be too wide or too narrow."""
    rng, n, scenes = np.random.default_rng(5), 600_000, 150
    ranges = {row.symbol: row.parameters for row in described["rest-positions"].assumptions if not row.frozen}
    drawn = {symbol: rng.uniform(each["Low"], each["High"], n) for symbol, each in ranges.items()}
    rest = cells("rest-positions", drawn, REST)
    off_by = {"beta_1": 6, "beta_2": 6, "s_1": 4, "s_2": 4}
    ranks = {symbol: [] for symbol in ("V1_before", "V2_before", "alpha_2")}
    for truth in range(scenes):
        fits = np.ones(n, bool)
        for symbol, most in off_by.items():
            off = rest[symbol] - (rest[symbol][truth] + rng.uniform(-most, most))
            fits &= np.abs((off + 180) % 360 - 180 if symbol.startswith("beta") else off) <= most
        fits[truth] = False
        if fits.sum() >= 20:
            for symbol, result in ranks.items():
                result.append(np.mean(drawn[symbol][fits] < drawn[symbol][truth]))
    for symbol, result in ranks.items():
        assert len(result) > 100
        assert kstest(result, "uniform").pvalue > 1e-3, symbol
