from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from templates.planar_impact import evaluate

FIXED = {"omega1_deg": 0.0, "omega2_deg": 0.0, "g": 32.174, "in_per_ft": 12, "s_per_hour": 3600, "ft_per_mile": 5280}
FORECASTS = ("dV1_mph", "dV2_mph", "V1_mph", "V2_mph")
KERNELS = ("plain", "buffered")


@pytest.mark.parametrize("kernel", KERNELS)
def test_kernels_compute_the_equations_of_the_template(hand_written, kernel):
    n = 20_000
    low, high = hand_written.LOW[:, None], hand_written.HIGH[:, None]
    inputs = low + (high - low) * np.random.default_rng(5).random((len(low), n))
    v = evaluate(FIXED | dict(zip(hand_written.SYMBOLS, inputs, strict=True)))
    keep = (v["e_n"] >= 0) & (v["e_n"] < 1) & (v["e_t"] >= 0) & (v["e_t"] <= 0.25) & (v["V2_i"] > 0)
    expected = np.array([v[symbol][keep] for symbol in FORECASTS])
    assert expected.shape[1] > 300
    np.testing.assert_allclose(hand_written.KERNELS[kernel](n)(inputs.copy()), expected, rtol=1e-12)


def test_both_kernels_keep_the_same_trials(hand_written):
    plain, buffered = (hand_written.simulate(50_001, 3, 4_096, kernel) for kernel in KERNELS)
    assert plain[0] == buffered[0] == plain[1].shape[1]
    np.testing.assert_allclose(plain[1], buffered[1], rtol=1e-13)


def test_acceptance_is_that_of_the_reference(hand_written):
    trials, truth = 400_000, 0.01756579
    accepted, _ = hand_written.simulate(trials, 11, 16_384)
    assert abs(accepted / trials - truth) < 4 * np.sqrt(truth * (1 - truth) / trials)


def test_ranges_are_those_of_the_example(hand_written):
    path = Path(hand_written.__file__).parents[1] / "examples/build.py"
    spec = importlib.util.spec_from_file_location("examples_build", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    ranges = {given.symbol: given.parameters for given in example.EXAMPLES["intersection"].assumptions}
    assert tuple(ranges) == hand_written.SYMBOLS
    np.testing.assert_array_equal(hand_written.LOW, [p["Low"] for p in ranges.values()])
    np.testing.assert_array_equal(hand_written.HIGH, [p["High"] for p in ranges.values()])
