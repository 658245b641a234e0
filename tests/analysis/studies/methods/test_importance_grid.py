"""Grids of uniforms, their weights, and the answers of a filtered model that is known."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.methods.importance_grid import (
    BINS,
    DEFENSIVE,
    ImportanceGrid,
    _Bent,
    _density,
    _learned,
    _weighted,
)
from xlmc.errors import SimulationError


@pytest.fixture(scope="module")
def model(model_of):
    """Two uniforms on (0, 1); accepted where the first is below 1/4."""
    inputs = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}, "v": {"cell": "A2", "low": 0.0, "high": 1.0}}
    return model_of({"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"}, inputs, {"sum": "B1"}, {"f": {"cell": "A1", "below": 0.25}})


def test_counts_that_chance_would_make_are_not_trusted():
    assert _density(np.full(16, 100.0)).tolist() == [1] * 16
    rng = np.random.default_rng(1)
    counts = np.full(16, 100.0) + rng.choice([-5.0, 5.0], 16)
    assert _density(counts).tolist() == [1] * 16  # χ² is 4, and 15 by chance


def test_the_density_of_counts_by_hand():
    """Two bins with 30 and 10: χ² = 100/20 + 100/20 = 10, of which 1 is chance; nine tenths of that is taken."""
    assert _density(np.array([30.0, 10.0])) == pytest.approx([1 + 0.9 * 0.9 * 0.5, 1 - 0.9 * 0.9 * 0.5])
    few = _density(np.array([1000.0, *[0.0] * 15]))
    assert few.mean() == pytest.approx(1)
    assert few[1] == pytest.approx(DEFENSIVE, abs=1e-2)


class Plain:
    """A stream of evenly spaced uniforms."""

    def uniforms(self, start, out):
        out[...] = (np.arange(out.size) + 0.5) / out.size


def test_uniforms_fall_into_bins_as_often_as_the_density_says():
    density, out, weights = np.array([1.6, 0.4]), np.empty(1000), np.full(1000, 7.0)
    _Bent(Plain(), density, weights, True).uniforms(0, out)
    assert np.count_nonzero(out < 0.5) == 800
    np.testing.assert_allclose(np.sort(out)[[0, 799, 800, 999]], [0.0005 / 1.6, 0.4997, 0.50125, 0.99875], atol=1e-3)
    np.testing.assert_allclose(weights[out < 0.5], 1 / 1.6)  # whatever stood there before
    np.testing.assert_allclose(weights[out >= 0.5], 1 / 0.4)
    assert weights.mean() == pytest.approx(1)


def test_weights_are_products_and_a_flat_grid_changes_nothing():
    out, weights = np.empty(100), np.full(100, 7.0)
    _Bent(Plain(), np.ones(2), weights, True).uniforms(0, out)
    np.testing.assert_array_equal(out, (np.arange(100) + 0.5) / 100)
    np.testing.assert_array_equal(weights, 1)
    _Bent(Plain(), np.array([1.5, 0.5]), weights, False).uniforms(0, out)
    _Bent(Plain(), np.array([1.5, 0.5]), weights, False).uniforms(0, out)
    np.testing.assert_allclose(weights[out < 0.5], 1 / 2.25)


def test_a_uniform_stays_below_1():
    class Last:
        def uniforms(self, start, out):
            out[...] = np.nextafter(1.0, 0.0)

    out, weights = np.empty(3), np.empty(3)
    _Bent(Last(), np.array([0.3, 1.7]), weights, True).uniforms(0, out)
    assert (out < 1).all()
    np.testing.assert_allclose(weights, 1 / 1.7)


def test_what_a_pilot_learns(model):
    grids = _learned(model, 8_000, 1)
    assert grids["u"].shape == (BINS,)
    assert grids["u"][:4] == pytest.approx([4 * 0.9 + 0.1] * 4, abs=0.4)
    assert grids["u"][4:] == pytest.approx([0.1] * 12, abs=0.02)
    assert grids["v"] == pytest.approx([1] * BINS, abs=0.15)


def test_nothing_to_learn_from(model_of):
    inputs = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}
    model = model_of({"A1": 0.5}, inputs, {"x": "A1"}, {"f": {"cell": "A1", "below": -1.0}})
    with pytest.raises(SimulationError, match="accept none of 4,096 trials"):
        ImportanceGrid().run(model, 10_000, 1)


@pytest.mark.parametrize("block", [1_000, 32_768])
def test_weighted_trials_of_several_blocks(model, monkeypatch, block):
    monkeypatch.setattr("xlmc.analysis.studies.methods.importance_grid._BLOCK", block)
    grids = {"u": np.repeat([3.7, 0.1], [4, 12]), "v": np.ones(16)}
    weights, (values,), ends = _weighted(model, grids, 3_500, 2)
    assert weights == pytest.approx(1 / 3.7)  # all that is accepted lies in the first four bins
    assert weights.size == pytest.approx(3_500 * 3.7 / 4, abs=4 * np.sqrt(3_500 * 0.07))
    assert weights.sum() / 3_500 == pytest.approx(0.25, abs=0.02)
    assert values.size == weights.size
    assert values.mean() == pytest.approx(0.125 + 0.5, abs=0.03)
    assert {each.forecast for each in ends} == {"sum"}


@pytest.mark.parametrize(
    ("budget", "pilot"),
    [(100_000, 12_500), (20_000, 4_096), (6_000, 3_000), (1_000_000, 65_536)],
)
def test_how_much_of_the_budget_the_pilot_takes(model, monkeypatch, budget, pilot):
    asked = []
    where = "xlmc.analysis.studies.methods.importance_grid"
    monkeypatch.setattr(f"{where}._learned", lambda model, trials, seed: asked.append((trials, seed)) or "grids")
    drawn = np.array([0.5, 0.5, 1.0]), [np.array([1.0, 2.0, 3.0])], ()

    def weighted(model, grids, trials, seed):
        asked.append((trials, seed))
        return drawn

    monkeypatch.setattr(f"{where}._weighted", weighted)
    result = ImportanceGrid().run(model, budget, 7)
    assert asked == [(pilot, 7), (budget - pilot, 7 + (1 << 40))]
    assert result.evaluations == budget
    assert result.acceptance == pytest.approx(2 / (budget - pilot))
    assert result.effective == pytest.approx(4 / 1.5)
    assert result.answers["sum"].mean == pytest.approx(2.25)
    assert result.remarks == ("of 3 accepted trials, 3 count fully (effective sample size)",)


def test_the_answers_of_a_model_that_is_known(model):
    result = ImportanceGrid().run(model, 20_000, 3)
    answer = result.answers["sum"]
    assert answer.mean == pytest.approx(0.625, abs=0.015)
    assert answer.sd == pytest.approx(np.sqrt(1 / 12 + 1 / 192), abs=0.01)
    assert result.acceptance == pytest.approx(0.25, abs=0.01)
    assert 10_000 < result.effective <= 20_000  # of a quarter without a grid
