from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from xlmc.analysis.results.statements.significant_digits import percent_text, rounded_range
from xlmc.montecarlo import statistics
from xlmc.montecarlo.statistics import Estimate, Sample, proportion

SHARES = {
    (0.14213, 0.0042): "14.2 % ± 0.4 %",
    (0.14213, 0.0142): "14.2 % ± 1.4 %",
    (0.017712, 0.00029): "1.77 % ± 0.03 %",
    (0.017712, 0.00012): "1.771 % ± 0.012 %",
    (0.4, 0.22): "40 % ± 22 %",
    (0.9996, 0.0096): "100.0 % ± 1.0 %",
}


@pytest.mark.parametrize(("number", "text"), SHARES.items())
def test_shares_have_the_digits_of_their_error(number, text):
    assert percent_text(Estimate(*number, n=100)) == text


@pytest.mark.parametrize(
    ("hits", "text"),
    [
        (0, "0 of 30,000 trials; at most 0.013 % with 95 % confidence"),
        (30_000, "all 30,000 trials; at least 99.987 % with 95 % confidence"),
    ],
)
def test_none_and_all_are_bounded_rather_than_0_and_0(hits, text):
    result = proportion(hits, 30_000)
    assert percent_text(result) == text
    bound = float(re.search(r"(?:most|least) ([\d.]+) %", text)[1]) / 100.0
    low, high = result.interval
    assert bound >= high if hits == 0 else bound <= low  # rounded to the safe side


def test_without_an_error_or_trials_nothing_is_invented():
    assert percent_text(Estimate(0.25, n=4)) == "25 %"
    assert percent_text(Estimate(0.0, n=4)) == "0 of 4 trials"
    assert percent_text(Estimate(float("nan"))) == "no trials"


@example(seed=0, n=101, centre=1.0, spread=1e-6, nominal=0.5)  # more decimals than an axis has
@given(st.integers(0, 2**32), st.integers(2, 3000), st.floats(-1e6, 1e6), st.floats(1e-6, 1e6), st.floats(0.05, 0.95))
def test_a_rounded_range_holds_its_share_and_lies_near_its_ends(seed, n, centre, spread, nominal):
    sample = Sample.of(np.random.default_rng(seed).normal(centre, spread, n))
    ends = statistics.central_interval(sample, nominal)
    inside = statistics.probability_between(sample, ends[0].value, ends[1].value).value
    result = rounded_range(sample, ends, min(nominal, inside))
    assert result.share.value >= min(nominal, inside)
    assert result.share == statistics.probability_between(sample, result.low, result.high)
    assert (float(result.low_text.replace(",", "")), float(result.high_text.replace(",", ""))) == (
        result.low,
        result.high,
    )
    errors = [end.error for end in ends if end.error]
    unit = 5.01 * max(errors) if errors else 1e-4 * max(abs(centre), spread)
    assert abs(result.low - ends[0].value) <= unit
    assert abs(result.high - ends[1].value) <= unit


def test_ends_have_one_number_of_decimals_and_constants_no_noise():
    sample = Sample.of(np.random.default_rng(1).normal(23.06, 1.4, 3500))
    result = rounded_range(sample, statistics.central_interval(sample), 0.51)
    assert re.fullmatch(r"22\.\d", result.low_text)
    assert re.fullmatch(r"2[34]\.\d", result.high_text)
    for value, text in ((3.0, "3"), (177919.6712, "177,919.6712"), (0.1 + 0.2, "0.3")):
        constant = Sample.of([value] * 50)
        result = rounded_range(constant, statistics.central_interval(constant), 0.51)
        assert (result.low, result.low_text, result.high_text, result.share.value) == (value, text, text, 1.0)


def test_without_trials_there_is_no_range():
    assert rounded_range(Sample.of([]), statistics.central_interval([]), 0.51) is None


@pytest.mark.parametrize(
    ("low", "high", "texts"),
    [
        (1.0, 2.25, ("1.00", "2.25")),
        (0.905172413793, 1.09482758621, ("0.90517", "1.09483")),
        (105.0, 127.0, ("105", "127")),
    ],
)
def test_two_ends_without_an_error_have_as_many_decimals(low, high, texts):
    values = np.array([low] * 40 + [high] * 60)
    result = rounded_range(Sample.of(values), (Estimate(low, 0.0), Estimate(high, 0.0)), 0.9)
    assert (result.low_text, result.high_text) == texts
