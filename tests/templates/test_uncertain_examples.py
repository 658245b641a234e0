"""Examples with ranges: what independent programs found with 4e7 or 8e6 trials.

A mean may differ by 4 of its standard errors and half a unit of the last digit given; a share or a percentile likewise.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm

N = 200_000
MPH = 3600 / 5280
KMH = 3.6


class Draws:
    """One seeded generator; uniform and cut normal numbers, (n,)."""

    def __init__(self, seed):
        self._rng = np.random.default_rng(seed)

    def uniform(self, low, high):
        return self._rng.uniform(low, high, N)

    def around(self, middle, half):
        return self.uniform(middle - half, middle + half)

    def cut_normal(self, mean, deviation, low, high):
        ends = norm.cdf([(low - mean) / deviation, (high - mean) / deviation])
        return mean + deviation * norm.ppf(self.uniform(*ends))


def close_mean(values, expected, digit, weights=None):
    w = np.ones(values.size) if weights is None else weights
    mean = np.average(values, weights=w)
    error = np.sqrt(np.sum((w * (values - mean)) ** 2)) / w.sum()
    assert abs(mean - expected) < 4 * error + digit / 2, (mean, expected, error)


def close_quantile(values, p, expected, digit):
    """Four standard errors of the rank, as the values at those ranks."""
    off = 4 * np.sqrt(p * (1 - p) / values.size)
    low, high = np.quantile(values, [max(p - off, 0), min(p + off, 1)])
    assert low - digit / 2 <= expected <= high + digit / 2, (low, expected, high)


def test_a_left_turn_with_and_without_the_published_response_time(cells):
    draws = Draws(1)
    inputs = {
        "v_impact": draws.uniform(37, 43),
        "d_brake": draws.uniform(57, 63),
        "f": draws.uniform(0.65, 0.75),
        "d_intruder": draws.uniform(21, 23),
        "a_intruder": draws.cut_normal(0.2, 0.04, 0.1, 0.3),
        "clearance": draws.uniform(11, 13),
    }
    wanted = ["v0_mph", "t_response", "D_0", "stops_same", "avoided_same", "stops_fresh"]
    result = cells("time-distance", inputs | {"u": 0, "limit": 45, "t_fresh": 1.25, "g": 32.174}, wanted)
    close_mean(result["v0_mph"], 53.454, 1e-3)
    close_mean(result["t_response"], 1.7769, 1e-4)
    close_mean(result["stops_same"], 0.0312, 1e-4)
    close_mean(result["avoided_same"], 0.9075, 1e-4)
    weights = np.where(result["t_response"] > 0, np.exp(-0.5 * ((result["t_response"] - 1.25) / 0.46) ** 2), 0)
    close_mean(weights, 0.5467, 1e-4)
    for symbol, mean, digit in (("t_response", 1.6420, 1e-4), ("D_0", 188.70, 1e-2)):
        close_mean(result[symbol], mean, digit, weights)
    close_mean(result["stops_same"], 0.0087, 1e-4, weights)
    close_mean(result["avoided_same"], 0.8940, 1e-4, weights)
    assert np.average(result["stops_same"], weights=weights) < 0.01 < result["stops_fresh"].mean()


def test_a_fresh_response_time_answers_another_question(cells):
    """With the response time that the crash implies .9 % stop; with one drawn afresh, .68."""
    draws = Draws(2)
    inputs = {
        "v_impact": draws.uniform(37, 43),
        "d_brake": draws.uniform(57, 63),
        "f": draws.uniform(0.65, 0.75),
        "d_intruder": draws.uniform(21, 23),
        "a_intruder": draws.cut_normal(0.2, 0.04, 0.1, 0.3),
        "t_fresh": draws.cut_normal(1.25, 0.46, 0.5, 3),
    }
    result = cells("time-distance", inputs | {"u": 0, "limit": 45, "g": 32.174}, ["stops_fresh"])
    close_mean(result["stops_fresh"], 0.68, 1e-2)


def test_the_flight_of_amy(cells):
    draws = Draws(3)
    inputs = {
        "d": draws.around(44.6, 1),
        "h": draws.around(8.3, 0.5),
        "theta": draws.around(0, 2),
        "f": draws.uniform(0.40, 0.50),
        "s": draws.around(32.7, 1),
        "g": 32.174,
    }
    result = cells("airborne", inputs, ["v_mph", "v1_mph"])
    close_mean(result["v_mph"], 42.55, 1e-2)
    close_mean(result["v1_mph"], 47.46, 1e-2)
    assert result["v_mph"].std() == pytest.approx(2.52, abs=4 * 2.52 / np.sqrt(2 * N) + 5e-3)
    assert result["v1_mph"].std() == pytest.approx(2.29, abs=4 * 2.29 / np.sqrt(2 * N) + 5e-3)
    close_quantile(result["v_mph"], 0.025, 38.50, 1e-2)
    close_quantile(result["v_mph"], 0.975, 47.53, 1e-2)


def test_a_recorded_speed_under_hard_braking(cells):
    draws = Draws(4)
    inputs = {
        "q": draws.around(0, 0.5),
        "kappa": draws.uniform(0.08, 0.18),
        "f": draws.uniform(0.65, 0.75),
        "tau": draws.uniform(0, 0.5),
        "v_last": 40,
        "n_on": 3,
        "g": 32.174,
    }
    result = cells("edr-speed", inputs, ["t_0", "vi_mph"])
    close_mean(result["t_0"], 46.03, 1e-2)
    close_mean(result["vi_mph"], 42.19, 1e-2)
    assert result["vi_mph"].std() == pytest.approx(2.72, abs=4 * 2.72 / np.sqrt(2 * N) + 5e-3)
    close_quantile(result["vi_mph"], 0.025, 37.10, 1e-2)
    close_quantile(result["vi_mph"], 0.975, 47.33, 1e-2)


@pytest.mark.parametrize(
    ("distance", "frames", "expected"),
    [(10, 2, {0.025: 24.56, 0.5: 34.09, 0.975: 55.72}), (100, 20, {0.025: 32.82, 0.975: 35.47})],
)
def test_speed_read_from_frames(cells, distance, frames, expected):
    draws = Draws(5)
    inputs = {"d": distance, "n": frames, "u_1": draws.uniform(0, 1), "u_2": draws.uniform(0, 1), "rate": 10, "a": 0}
    speeds = cells("video-speed", inputs, ["v_mph"])["v_mph"]
    for p, value in expected.items():
        close_quantile(speeds, p, value, 1e-2)


def rabbit_and_mercedes(draws):
    """Inputs of both models (SAE Transactions 96, 1987), with ranges; `m` and speeds in SI units."""
    after = {1: 35 / KMH * draws.around(1, 0.1), 2: 51 / KMH * draws.around(1, 0.1)}
    return {
        "m_1": draws.uniform(870, 890),
        "m_2": draws.uniform(1580, 1620),
        "alpha_1": draws.around(0, 3),
        "beta_1": draws.around(-9, 5),
        "beta_2": draws.around(182, 5),
        **{f"s_{j}": after[j] ** 2 / (2 * 9.81) for j in (1, 2)},
        **{f"f_{j}": 1.0 for j in (1, 2)},
        "g": 9.81,
    }


def test_near_head_on_energy_answers_and_momentum_does_not(cells):
    draws = Draws(6)
    both = rabbit_and_mercedes(draws)
    energy = {
        "EES_1": 66 * draws.around(1, 0.1),
        "EES_2": 42 * draws.around(1, 0.1),
        "mu_1": draws.around(0.4, 0.1),
        "mu_2": draws.around(0.3, 0.1),
        "phi_1": 200,
        "phi_2": 64,
        "I_1": 998.348,
        "I_2": 2681.42,
        "R_1": 2.4,
        "R_2": 2.795,
    }
    result = cells("momentum-energy-si", both | energy, ["V1_kmh", "V2_kmh"])
    for symbol, mean, deviation in (("V1_kmh", 70.76, 2.79), ("V2_kmh", 71.04, 2.82)):
        close_mean(result[symbol], mean, 1e-2)
        assert result[symbol].std() == pytest.approx(deviation, abs=4 * deviation / np.sqrt(2 * N) + 5e-3)
    assert np.corrcoef(result["V1_kmh"], result["V2_kmh"])[0, 1] == pytest.approx(0.05, abs=4 / np.sqrt(N) + 5e-3)
    blind = cells("momentum-si", both | {"alpha_2": draws.around(183.9, 3)}, ["V1_kmh"])["V1_kmh"]
    close_quantile(blind, 0.025, -817, 1)
    close_quantile(blind, 0.975, 1036, 1)


def test_momentum_and_momentum_with_energy_agree_where_both_answer(cells):
    """The energy that momentum finds lost, given as crush: speeds and the approach angle come back to 1e-9."""
    rng = np.random.default_rng(7)
    n = 500
    scene = {
        "m_1": rng.uniform(800, 3000, n),
        "m_2": rng.uniform(800, 3000, n),
        "alpha_1": rng.uniform(0, 360, n),
        "f_1": rng.uniform(0.4, 0.9, n),
        "f_2": rng.uniform(0.4, 0.9, n),
        "s_1": rng.uniform(2, 20, n),
        "s_2": rng.uniform(2, 20, n),
        "g": 9.80665,
    }
    scene["alpha_2"] = scene["alpha_1"] + rng.uniform(60, 120, n) * rng.choice([-1, 1], n)
    scene["beta_1"] = scene["alpha_1"] + (scene["alpha_2"] - scene["alpha_1"]) * rng.uniform(0.2, 0.5, n)
    scene["beta_2"] = scene["alpha_1"] + (scene["alpha_2"] - scene["alpha_1"]) * rng.uniform(0.3, 0.6, n)
    truth = cells("momentum-si", scene, ["V1_i", "V2_i", "E_lost", "dV_1", "PDOF_2"])
    given = {symbol: values for symbol, values in scene.items() if symbol != "alpha_2"}
    ees = np.sqrt(2 * np.maximum(truth["E_lost"], 0) / (scene["m_1"] + scene["m_2"])) * KMH
    given |= {"EES_1": ees, "EES_2": ees, "phi_1": 0, "phi_2": 0}
    result = cells("momentum-energy-si", given, ["V1_i", "V2_i", "alpha_2", "dV_1", "PDOF_2", "reach", "root"])
    # The root is the one that answers where vehicle 2 closed in along the approach of vehicle 1.
    closing = truth["V1_i"] - truth["V2_i"] * np.cos(np.radians(scene["alpha_2"] - scene["alpha_1"]))
    usable = (truth["E_lost"] > 0) & (truth["V1_i"] > 0) & (truth["V2_i"] > 0) & (closing > 1)
    assert usable.sum() > 200
    for symbol in ("V1_i", "V2_i", "dV_1", "PDOF_2"):
        np.testing.assert_allclose(result[symbol][usable], truth[symbol][usable], rtol=1e-9, atol=1e-9, err_msg=symbol)
    turned = (result["alpha_2"] - scene["alpha_2"] + 180) % 360 - 180
    np.testing.assert_allclose(turned[usable], 0, atol=1e-8)
