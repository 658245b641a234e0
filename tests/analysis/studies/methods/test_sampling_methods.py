from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.methods import ImportanceGrid, Sampled, Surrogate
from xlmc.analysis.studies.methods.importance_grid import BINS, DEFENSIVE, _density
from xlmc.analysis.studies.methods.sampled import MONTE_CARLO
from xlmc.analysis.studies.methods.surrogate import fit_quadratic
from xlmc.errors import SimulationError

REFERENCE = {"Chevrolet delta-V": (11.80333, 0.73709), "Nissan delta-V": (23.06344, 1.41424)}
REFERENCE |= {"Chevrolet impact speed": (33.16317, 1.76307), "Nissan impact speed": (4.74205, 2.00052)}
ACCEPTANCE = 0.01756579
"""Mean and SD, mph: 2·10⁹ trials made independently of this project."""


@pytest.mark.parametrize("method", [MONTE_CARLO, ImportanceGrid(), Surrogate()], ids=lambda method: method.key)
def test_the_case_study(case_study, method):
    """Within five standard errors of 131,072 independent trials; the surrogate's polynomials cost 2 % of an SD more."""
    result = method.run(case_study, 131_072, 4)
    accepted = 131_072 * ACCEPTANCE
    own = 0.02 if method.key == "surrogate" else 0.0
    for name, (mean, sd) in REFERENCE.items():
        assert abs(result.answers[name].mean - mean) < 5 * sd / accepted**0.5 + own * sd
        assert abs(result.answers[name].sd - sd) < 5 * sd / accepted**0.5 + own * sd
    error = (ACCEPTANCE * (1 - ACCEPTANCE) / 131_072) ** 0.5
    assert abs(result.acceptance - ACCEPTANCE) < 5 * error + own * ACCEPTANCE


def test_the_budget_is_kept(case_study):
    assert MONTE_CARLO.run(case_study, 5_000, 1).evaluations == 5_000
    assert ImportanceGrid().run(case_study, 50_000, 1).evaluations == 50_000
    assert Surrogate().run(case_study, 50_000, 1).evaluations == 1_024


def test_a_run_repeats(case_study):
    for method in (MONTE_CARLO, ImportanceGrid(), Surrogate()):
        first, again = (method.run(case_study, 10_000, 5).answers for _ in range(2))
        assert first == again


def test_the_grid_halves_the_error_of_the_case_study(case_study):
    """Of the mean, 20 seeds of 16,384 trials: variances of 4 forecasts, each known to 32 %; the ratio is 2 to 4."""
    runs = {
        method.key: np.array([
            [answer.mean for answer in method.run(case_study, 16_384, seed).answers.values()] for seed in range(20)
        ])
        for method in (MONTE_CARLO, ImportanceGrid())
    }  # fmt: skip
    gains = runs["mc"].var(axis=0) / runs["grid"].var(axis=0)
    assert np.exp(np.mean(np.log(gains))) > 1.6


def test_the_grid_is_unbiased_where_the_answer_is_known(halved):
    """y = x² kept where x is above a half: mean 7/12, variance 1/5 · 31/16 − (7/12)²; 49 runs of 4,096 trials."""
    result = [ImportanceGrid().run(halved, 4_096, seed) for seed in range(49)]
    mean, sd = 7 / 12, (31 / 80 - (7 / 12) ** 2) ** 0.5
    errors = np.array([each.answers["y"].mean for each in result]) - mean
    assert abs(errors.mean()) < 5 * errors.std() / 7
    assert errors.std() < 1.3 * sd / (2_048 * 0.5) ** 0.5
    accepted = np.array([each.acceptance for each in result])
    assert abs(accepted.mean() - 0.5) < 5 * accepted.std() / 7


def test_effective_sample_size_is_at_most_the_accepted(case_study):
    result = ImportanceGrid().run(case_study, 65_536, 2)
    assert 1_000 < result.effective < 65_536 * ACCEPTANCE * 12
    assert "count fully (effective sample size)" in result.remarks[0]


def test_where_a_pilot_tells_nothing_the_grid_is_flat():
    counts = np.random.default_rng(7).multinomial(1_000, [1 / BINS] * BINS)
    assert _density(counts.astype(float)) == pytest.approx(1.0, abs=0.1)
    assert np.all(_density(np.full(BINS, 50.0)) == 1.0)


def test_no_part_of_a_range_is_left_out():
    counts = np.zeros(BINS)
    counts[3] = 1_000.0
    density = _density(counts)
    assert density.min() > 0.99 * DEFENSIVE
    assert density.mean() == pytest.approx(1.0)


def test_the_grid_respects_correlations(book):
    """Weights belong to the uniforms before they are joined, so that joined draws stay what they are."""
    model = book(
        {"A1": 0.0, "B1": 0.0, "C1": "=A1+B1"},
        {
            "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
            "b": {"cell": "B1", "distribution": "Normal", "mean": 0, "std_dev": 1},
        },
        {"S": "C1"},
        {"high": {"cell": "C1", "above": 1}},
        correlations={("a", "b"): 0.8},
    )
    plain = simulated(model, 1 << 18, 3)["S"].mean
    result = ImportanceGrid().run(model, 1 << 16, 3).answers["S"].mean
    assert abs(result - plain.value) < 5 * np.hypot(plain.error, 2 * plain.error)


def test_nothing_to_learn_from(book):
    model = book(
        {"A1": 0.5, "B1": "=A1"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"f": "B1"},
        {"no": {"cell": "A1", "above": 2}},
    )
    with pytest.raises(SimulationError, match="nothing to learn"):
        ImportanceGrid().run(model, 8_192, 1)


def test_quadratic_polynomials_are_fitted_exactly():
    points = np.random.default_rng(3).uniform(-1, 4, (200, 3))
    values = np.column_stack([1 + points[:, 0] * points[:, 1] - points[:, 2] ** 2, 5 * points[:, 1]])
    more = np.random.default_rng(4).uniform(-1, 4, (2_500, 3))
    wanted = np.column_stack([1 + more[:, 0] * more[:, 1] - more[:, 2] ** 2, 5 * more[:, 1]])
    assert fit_quadratic(points, values)(more) == pytest.approx(wanted, abs=1e-6)


def test_a_column_that_does_not_vary_is_no_trouble():
    points = np.column_stack([np.linspace(0, 1, 50), np.ones(50)])
    assert fit_quadratic(points, points[:, :1] ** 2)(points)[:, 0] == pytest.approx(points[:, 0] ** 2, abs=1e-6)


def test_the_surrogate_stops_above_a_ratio(case_study):
    (message,) = Surrogate().run(case_study, 2_048, 1).remarks
    assert "Model!D52" not in message  # the tangential restitution
    assert "Model!D49" in message  # what it is the ratio of
    assert "Model!D50" in message


def test_a_workbook_that_is_no_polynomial_anywhere(book):
    model = book({"A1": 0.3, "B1": "=SIN(50*A1)"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"f": "B1"})
    with pytest.raises(SimulationError, match="No cell on the way to the answers is a quadratic"):
        Surrogate().run(model, 2_048, 1)


def test_the_surrogate_draws_correlated_assumptions(book):
    model = book(
        {"A1": 0.0, "B1": 0.0, "C1": "=A1*B1"},
        {
            "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
            "b": {"cell": "B1", "distribution": "Normal", "mean": 0, "std_dev": 1},
        },
        {"f": "C1"},
        correlations={("a", "b"): 0.5},
    )
    result = Surrogate().run(model, 1 << 16, 1).answers["f"]
    rho = 2 * np.sin(np.pi / 12)
    assert result.mean == pytest.approx(rho, abs=5 * (1 + rho**2) ** 0.5 / 256)


def test_draws_that_are_none_are_left_out_of_the_surrogate(book):
    """b lies between 0.2 and a: in a fifth of the trials that is no distribution."""
    model = book(
        {"A1": 0.5, "B1": 0.3, "C1": "=A1+B1"},
        {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "B1", "low": 0.2, "high": "A1"}},
        {"f": "C1"},
    )
    result = Surrogate().run(model, 40_000, 1)
    assert result.acceptance == pytest.approx(0.8, abs=5 * (0.16 / 40_000) ** 0.5)
    plain = MONTE_CARLO.run(model, 40_000, 2)
    assert plain.acceptance == pytest.approx(0.8, abs=5 * (0.16 / 40_000) ** 0.5)
    assert result.answers["f"].mean == pytest.approx(plain.answers["f"].mean, abs=0.02)


def test_an_engine_that_is_not_there(case_study):
    with pytest.raises(SimulationError, match="There is no engine"):
        Sampled("x", "x", engine="abacus").run(case_study, 1_024, 1)
