"""What is known of the case study of SAE 2001-01-3347 beside its Table 2, computed elsewhere with up to 2·10⁹ trials.

The example book's cells are computed for 500,000 draws of Table 1. Each figure must lie within four standard errors.
"""

from __future__ import annotations

import numpy as np
import pytest

WANTED = ["dV1_mph", "dV2_mph", "V1_mph", "V2_mph", "e_n", "e_t"]
DRAWS, BLOCKS = 125_000, 4
KEPT = 703_090
"""Accepted trials on which the figures of evidence rest."""


@pytest.fixture(scope="module")
def drawn(cells, described):
    """Quantity -> its values in all draws; and `ok`, whether the filters of the paper keep the draw."""
    ranges = {each.symbol: each.parameters for each in described["intersection"].assumptions}
    result = {}
    for block in range(BLOCKS):
        rng = np.random.default_rng(2001 + block)
        draws = {symbol: rng.uniform(ends["Low"], ends["High"], DRAWS) for symbol, ends in ranges.items()}
        for symbol, values in (draws | cells("intersection", draws, WANTED)).items():
            result.setdefault(symbol, []).append(values)
    v = {symbol: np.concatenate(parts) for symbol, parts in result.items()}
    v["e_n ok"] = (v["e_n"] >= 0) & (v["e_n"] < 1)
    v["e_t ok"] = (v["e_t"] >= 0) & (v["e_t"] <= 0.25)
    v["V2 ok"] = v["V2_mph"] > 0
    return v | {"ok": v["e_n ok"] & v["e_t ok"] & v["V2 ok"]}


@pytest.fixture(scope="module")
def accepted(drawn):
    """Quantity -> its values in accepted trials."""
    return {symbol: values[drawn["ok"]] for symbol, values in drawn.items()}


def of_share(kept, expected, behind=np.inf):
    """Check a share; `behind` says on how many trials the expected one rests."""
    error = np.sqrt(expected * (1 - expected) * (1 / kept.size + 1 / behind))
    assert kept.mean() == pytest.approx(expected, abs=4 * error + 1e-9)


def of_mean(values, expected, digits, behind=np.inf):
    """Check a mean that is printed with so many digits."""
    error = values.std() * np.sqrt(1 / values.size + 1 / behind)
    assert values.mean() == pytest.approx(expected, abs=4 * error + 0.5 * 10.0**-digits)


@pytest.mark.parametrize(
    ("which", "share"),
    [("ok", 0.01756579), ("e_n ok", 0.63225), ("e_t ok", 0.028704), ("V2 ok", 0.991101)],
)
def test_what_each_filter_keeps_alone(drawn, which, share):
    of_share(drawn[which], share)


def test_what_both_restitutions_keep_together(drawn):
    of_share(drawn["e_n ok"] & drawn["e_t ok"], 0.017969)


@pytest.mark.parametrize(
    ("symbol", "mean", "deviation"),
    [
        ("dV1_mph", 12.1658, 1.1324),
        ("dV2_mph", 23.7710, 2.1971),
        ("V1_mph", 33.6923, 1.7862),
        ("V2_mph", 8.8974, 4.1869),
    ],
)
def test_the_answers_without_any_filter(drawn, symbol, mean, deviation):
    of_mean(drawn[symbol], mean, 4)
    assert drawn[symbol].std() == pytest.approx(deviation, rel=0.01)


@pytest.mark.parametrize(("limit", "mean"), [(0.10, 4.21), (0.15, 4.35), (0.25, 4.74), (0.50, 6.20), (1.0, 8.88)])
def test_the_limit_of_the_tangential_restitution_is_the_slower_speed(drawn, limit, mean):
    kept = drawn["e_n ok"] & drawn["V2 ok"] & (drawn["e_t"] >= 0) & (drawn["e_t"] <= limit)
    of_mean(drawn["V2_mph"][kept], mean, 2)


@pytest.mark.parametrize(("limit", "mean"), [(0.10, 23.0), (1.0, 24.2)])
def test_it_hardly_moves_the_delta_v(drawn, limit, mean):
    kept = drawn["e_n ok"] & drawn["V2 ok"] & (drawn["e_t"] >= 0) & (drawn["e_t"] <= limit)
    of_mean(drawn["dV2_mph"][kept], mean, 1)


@pytest.mark.parametrize(
    ("symbol", "mean", "digits", "narrower"),
    [
        ("alpha_1", 188.1, 1, 0.55),
        ("beta_1", 188.6, 1, 0.39),
        ("beta_2", 199.1, 1, 0.78),
        ("f_1", 0.732, 3, None),
        ("f_2", 0.820, 3, None),
    ],
)
def test_filters_condition_the_inputs(drawn, accepted, symbol, mean, digits, narrower):
    of_mean(accepted[symbol], mean, digits)
    if narrower is not None:
        assert accepted[symbol].std() / drawn[symbol].std() == pytest.approx(narrower, abs=0.02)


@pytest.mark.parametrize(("first", "second", "correlation"), [("alpha_1", "beta_1", 0.69), ("dV2_mph", "V1_mph", 0.72)])
def test_filters_tie_quantities_together(accepted, first, second, correlation):
    error = (1 - correlation**2) / np.sqrt(accepted[first].size)
    result = np.corrcoef(accepted[first], accepted[second])[0, 1]
    assert result == pytest.approx(correlation, abs=4 * error + 0.005)


def ranks(values):
    return np.argsort(np.argsort(values))


@pytest.mark.parametrize(
    ("symbol", "kept", "all_trials"), [("beta_2", 0.76, 0.25), ("alpha_1", -0.71, None), ("beta_1", -0.12, 0.50)]
)
def test_what_drives_the_slower_speed_depends_on_the_filters(drawn, accepted, symbol, kept, all_trials):
    for v, expected in ((accepted, kept), (drawn, all_trials)):
        if expected is not None:
            result = np.corrcoef(ranks(v[symbol]), ranks(v["V2_mph"]))[0, 1]
            assert result == pytest.approx(expected, abs=4 / np.sqrt(v[symbol].size) + 0.005)


@pytest.mark.parametrize(
    ("reading", "share", "means"),
    [
        (12, 0.8617, (11.98, 33.50, 4.78)),
        (10.5, 0.4072, (11.08, 31.87, 4.58)),
        (14, 0.1011, (12.99, 34.98, 5.01)),
        (15, 0.00097, None),
    ],
)
def test_a_recorded_delta_v_within_ten_percent_of_the_true_one(accepted, reading, share, means):
    """0.9·ΔV ≤ R ≤ 1.1·ΔV: of the model's value, not of the reading."""
    true = accepted["dV1_mph"]
    kept = (0.9 * true <= reading) & (reading <= 1.1 * true)
    of_share(kept, share, KEPT)
    for symbol, mean in zip(("dV1_mph", "V1_mph", "V2_mph"), means or (), strict=False):
        of_mean(accepted[symbol][kept], mean, 2, KEPT * share)


def test_a_recorded_speed_within_four_percent(accepted):
    kept = abs(accepted["V1_mph"] - 33) <= 0.04 * 33
    of_share(kept, 0.5074, KEPT)
    for symbol, mean in (("dV1_mph", 11.86), ("V1_mph", 32.94), ("V2_mph", 4.77)):
        of_mean(accepted[symbol][kept], mean, 2, KEPT / 2)
    assert accepted["V1_mph"][kept].std() == pytest.approx(0.74, abs=0.02)


def test_two_readings_that_agree_keep_more_than_chance(accepted):
    """The product of both shares is .437; and the speed of the other vehicle is not informed."""
    true = accepted["dV1_mph"]
    kept = (0.9 * true <= 12) & (1.1 * true >= 12) & (abs(accepted["V1_mph"] - 33) <= 0.04 * 33)
    of_share(kept, 0.4844, KEPT)
    for symbol, mean in (("dV1_mph", 11.90), ("V1_mph", 32.97), ("V2_mph", 4.78)):
        of_mean(accepted[symbol][kept], mean, 2, KEPT / 2)


def test_a_normal_error_weighs_the_trials(accepted):
    weights = np.exp(-0.5 * ((12 - accepted["dV1_mph"]) / 0.6) ** 2)
    error = weights.std() * np.sqrt(1 / weights.size + 1 / KEPT)
    assert weights.mean() == pytest.approx(0.6158, abs=4 * error)
    assert weights.sum() ** 2 / np.sum(weights**2) / weights.size == pytest.approx(0.783, abs=0.02)
    for symbol, mean in (("dV1_mph", 11.96), ("V1_mph", 33.50), ("V2_mph", 4.78)):
        result = np.average(accepted[symbol], weights=weights)
        assert result == pytest.approx(mean, abs=4 * accepted[symbol].std() / np.sqrt(0.78 * weights.size) + 0.005)


def test_the_acceptance_depends_on_gravity(drawn, cells, described):
    """With 32.2 ft/s² it is .0176054: in the same draws, a few are then kept, and fewer dropped."""
    ranges = {each.symbol: each.parameters for each in described["intersection"].assumptions}
    rng = np.random.default_rng(2001)
    draws = {symbol: rng.uniform(ends["Low"], ends["High"], DRAWS) for symbol, ends in ranges.items()}
    other = cells("intersection", draws | {"g": 32.2}, WANTED)
    kept = (
        (other["e_n"] >= 0) & (other["e_n"] < 1) & (other["e_t"] >= 0) & (other["e_t"] <= 0.25) & (other["V2_mph"] > 0)
    )
    before = drawn["ok"][:DRAWS]
    moved = (kept != before).sum()
    assert kept.mean() - before.mean() == pytest.approx(0.0176054 - 0.0175658, abs=4 * np.sqrt(moved + 1) / DRAWS)
