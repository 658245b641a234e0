from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics.sample import Sample
from xlmc.outputs.histogram import histogram, not_drawn

RANDOM = np.random.default_rng(7)
MANY = st.lists(st.floats(-1e9, 1e9), min_size=1, max_size=60).map(np.array)


def test_no_values_give_no_histogram():
    assert histogram(np.array([]), 0.0, 1.0) is None


@given(MANY | st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=9).map(np.array))
def test_every_trial_is_counted_once(values):
    bins = histogram(values, float(np.sort(values)[values.size // 4]), float(values.max()))
    total = bins.inside.sum() + bins.outside.sum() + bins.below + bins.above
    assert total == values.size
    assert (bins.inside >= 0).all()
    assert bins.edges.size == bins.inside.size == bins.outside.size
    assert bins.edges.size % bins.step == 0


@given(MANY, st.floats(0.1, 10.0))
def test_counts_are_those_of_a_plain_loop(values, share):
    low, high = -share, share
    bins = histogram(values, low, high)
    for edge, upper, inside, outside in zip(bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True):
        held = [v for v in values if edge <= v < upper]
        assert inside == sum(low <= v <= high for v in held)
        assert outside == len(held) - inside


def test_the_inside_bars_hold_exactly_the_central_range():
    values = RANDOM.normal(12.0, 0.7, 5001)
    low, high = np.percentile(values, [24.5, 75.5])
    bins = histogram(values, low, high)
    assert bins.inside.sum() == np.count_nonzero((values >= low) & (values <= high))
    straddling = (bins.edges < low) & (bins.upper_edges > low)
    assert bins.inside[straddling].item() > 0
    assert bins.outside[straddling].item() > 0


@pytest.mark.parametrize(
    ("values", "width", "fewest", "most"),
    [
        (RANDOM.normal(12.0, 0.7, 3500), 0.1, 35, 60),
        (RANDOM.normal(12.0, 0.7, 1_000_000), 0.2, 30, 61),  # the range widens, the bins stay few
        (RANDOM.uniform(-3.2, 3.2, 3500), 0.25, 25, 40),
        (RANDOM.uniform(6661, 6861, 50), 10.0, 15, 30),
        (RANDOM.exponential(1e-6, 2000), 2e-7, 30, 60),
        (RANDOM.uniform(2e11, 2e12, 4000), 1e11, 15, 30),
    ],
)
def test_widths_are_round_and_bins_neither_few_nor_many(values, width, fewest, most):
    bins = histogram(values, *np.percentile(values, [24.5, 75.5]))
    assert bins.width == width
    assert fewest <= bins.edges.size <= most


@given(MANY)
def test_edges_are_multiples_of_a_round_width(values):
    bins = histogram(values, 0.0, 1.0)
    mantissa = float(f"{bins.width:e}".partition("e")[0])
    assert mantissa in (1.0, 2.0, 2.5, 5.0)
    multiples = bins.edges / bins.width
    np.testing.assert_allclose(multiples, np.round(multiples), rtol=1e-9, atol=1e-6)
    assert round(multiples[0]) % bins.step == 0


def test_a_limit_at_a_round_number_lies_between_two_bins():
    values = RANDOM.uniform(0.0, 0.25, 4000)
    bins = histogram(values, 0.1, 0.2)
    used = bins.edges[bins.inside + bins.outside > 0]
    assert used[0] == 0.0
    assert used[-1] + bins.width == pytest.approx(0.25)


def test_whole_numbers_have_a_bar_each():
    values = RANDOM.integers(0, 11, 500).astype(float)
    bins = histogram(values, 2.0, 7.0)
    assert bins.width == 1.0
    counted = dict(zip(bins.edges, bins.inside + bins.outside, strict=True))
    assert all(counted[k] == np.count_nonzero(values == k) for k in range(11))


@pytest.mark.parametrize("value", [0.0, 7.0, -3.3e12, 4.2e-9])
def test_a_constant_has_one_bar(value):
    bins = histogram(np.full(10, value), value, value)
    assert bins.inside.tolist().count(10) == 1
    assert bins.inside.sum() == 10


def test_far_outliers_are_counted_and_not_drawn():
    values = np.concatenate([RANDOM.normal(0.0, 1.0, 3000), [1e6, 2e6], [-1e7]])
    bins = histogram(values, -0.5, 0.5)
    assert (bins.below, bins.above) == (1, 2)
    assert bins.edges[0] > -10.0


@pytest.mark.parametrize(
    ("values", "labels"),
    [
        (np.linspace(9.6, 13.8, 3000), ["9.5", "10.0", "10.5", "11.0", "11.5", "12.0", "12.5", "13.0", "13.5"]),
        (np.linspace(1.1e11, 5e11, 3000), ["0", "500,000,000,000"]),
        (np.linspace(0.0, 0.00099, 3000), ["0.0000", "0.0001", "0.0002", "0.0003", "0.0004"]),
        (np.linspace(0.0, 4.9e6, 3000), ["0", "1,000,000", "2,000,000", "3,000,000", "4,000,000"]),
    ],
)
def test_labels_stand_at_round_lower_ends(values, labels):
    bins = histogram(values, *np.percentile(values, [24.5, 75.5]))
    shown = [(edge, text) for edge, text in zip(bins.edges, bins.labels, strict=True) if text]
    assert all(float(text.replace(",", "")) == pytest.approx(edge) for edge, text in shown)
    assert [text for _, text in shown][: len(labels)] == labels
    assert len(shown) <= 12


NORMAL = np.random.default_rng(3).normal(size=20_000)
DAYS = np.round(46_600 + 20 * NORMAL)
WORKING_DAYS = DAYS[(DAYS % 7 != 0) & (DAYS % 7 != 1)]


@pytest.mark.parametrize(
    ("values", "kind", "width"),
    [
        (WORKING_DAYS, Kind.DATE, 7.0),  # five working days each
        (DAYS, Kind.DATE, 5.0),
        (np.round((10 + NORMAL) * 2.5) / 2.5, Kind.NUMBER, 0.4),  # 0.2 would leave every second bar empty
        (np.round((100 + 30 * NORMAL) / 3) * 3, Kind.NUMBER, 3.0),
        (np.round(10 + NORMAL, 1), Kind.NUMBER, 0.2),
        (np.round((10 + 0.1 * NORMAL) * 20) / 20, Kind.CURRENCY, 0.05),
    ],
)
def test_bars_hold_equally_many_points_of_a_grid(values, kind, width):
    form = Form(kind, "yyyy-mm-dd" if kind is Kind.DATE else "General")
    bins = histogram(values, *np.percentile(values, [24.5, 75.5]), form)
    assert bins.width == width
    inner = bins.edges[(bins.edges > np.percentile(values, 10)) & (bins.upper_edges < np.percentile(values, 90))]
    points = np.unique(values) + 1e-9
    held = [np.count_nonzero((points >= edge) & (points < edge + width)) for edge in inner]
    assert len(held) > 3
    assert len(set(held)) == 1
    assert int((bins.inside + bins.outside).sum()) + bins.below + bins.above == values.size


PARTS = {
    "anywhere": (np.linspace(0.0, 9.5, 3_000) ** 1.3, 20),
    "whole numbers, several a bar": (np.repeat(np.arange(200.0), 30), 10),
    "whole numbers, a bar each": (np.repeat(np.arange(20.0), 30), 1),
    "on a grid": (np.repeat(np.arange(80.0) / 10.0, 80), 2),
    "outliers that are not drawn": (np.append(np.linspace(0.0, 1.0, 999), 1e6), 20),
    "as fine as rounding": (1e12 + np.linspace(0.0, 1e5, 999), 1),
    "one value": (np.full(50, 3.0), 20),
}


@pytest.mark.parametrize(("values", "parts"), PARTS.values(), ids=PARTS)
def test_parts_of_bins_hold_the_trials_of_the_bins(values, parts):
    bins = histogram(values, 0.0, 1.0)
    result = bins.in_parts(Sample.of(values), 20)
    assert result.shape == (bins.edges.size, parts)
    assert result.sum(axis=1).tolist() == (bins.inside + bins.outside).tolist()


def test_parts_of_bins_are_equally_wide():
    values = np.linspace(0.0, 10.0, 10_001)
    bins = histogram(values, 0.0, 1.0)
    result = bins.in_parts(Sample.of(values), 4)
    edges = np.append((bins.edges[:, None] + np.arange(4) * bins.width / 4).ravel(), bins.upper_edges[-1])
    expected = [np.count_nonzero((values >= low) & (values < high)) for low, high in pairwise(edges)]
    assert result.ravel().tolist() == expected


@pytest.mark.parametrize(("far", "message"), [(1, "0 trials below and 1 above"), (-1, "1 trial below and 0 above")])
def test_what_is_not_drawn_is_said_with_its_noun(far, message):
    bins = histogram(np.append(np.linspace(-1.0, 1.0, 999), 1e6 * far), 0.0, 1.0)
    assert not_drawn(bins) == f" Not drawn: {message}."
