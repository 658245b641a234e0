from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.methods import FirstOrder, SecondOrder
from xlmc.errors import SimulationError

FIRST = {"Chevrolet delta-V": (12.042, 1.105), "Nissan delta-V": (23.531, 2.143)}
FIRST |= {"Chevrolet impact speed": (33.763, 1.764), "Nissan impact speed": (8.865, 4.165)}
SECOND = {"Chevrolet delta-V": 12.166, "Nissan delta-V": 23.771, "Chevrolet impact speed": 33.692}
SECOND |= {"Nissan impact speed": 8.897}
"""mph, computed independently of this project."""


def test_first_order_on_the_case_study(case_study):
    answers = FirstOrder().run(case_study, 0, 1).answers
    for name, (mean, sd) in FIRST.items():
        assert answers[name].mean == pytest.approx(mean, abs=1e-3)
        assert answers[name].sd == pytest.approx(sd, abs=1e-3)


def test_second_order_on_the_case_study(case_study):
    answers = SecondOrder().run(case_study, 0, 1).answers
    for name, mean in SECOND.items():
        assert answers[name].mean == pytest.approx(mean, abs=1e-3)


def test_first_order_of_a_sum_of_normals_is_exact(sum_of_normals):
    answer = FirstOrder().run(sum_of_normals, 0, 1).answers["S"]
    assert answer.mean == pytest.approx(-2.0, abs=1e-12)
    assert answer.sd == pytest.approx(2.5, rel=1e-12)
    assert (answer.low, answer.high) == pytest.approx((-2 - 2.5 * 0.6903088, -2 + 2.5 * 0.6903088), abs=1e-6)


def test_correlation_counts(book):
    """Normals with rank correlation r_s have Pearson's 2 sin(π r_s / 6)."""
    model = book(
        {"A1": 0.0, "B1": 0.0, "C1": "=A1+B1"},
        {
            "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
            "b": {"cell": "B1", "distribution": "Normal", "mean": 0, "std_dev": 2},
        },
        {"S": "C1"},
        correlations={("a", "b"): 0.5},
    )
    result = FirstOrder().run(model, 0, 1)
    expected = np.sqrt(1 + 4 + 2 * 2 * 2 * np.sin(np.pi / 12))
    assert result.answers["S"].sd == pytest.approx(expected, rel=2e-3)  # of 65,536 Sobol draws
    assert any("correlations" in remark for remark in result.remarks)


def test_second_order_of_a_quadratic_polynomial_is_exact(book):
    """f = x² + 2xy + y, x uniform on 0 to 2, y uniform on 1 to 4: mean 4/3 + 2·1·2.5 + 2.5."""
    model = book(
        {"A1": 1.0, "B1": 2.0, "C1": "=A1^2+2*A1*B1+B1"},
        {"x": {"cell": "A1", "low": 0, "high": 2}, "y": {"cell": "B1", "low": 1, "high": 4}},
        {"f": "C1"},
    )
    answer = SecondOrder().run(model, 0, 1).answers["f"]
    assert answer.mean == pytest.approx(4 / 3 + 5 + 2.5, rel=1e-12)
    run = simulated(model, 1 << 18, 5, sampling="sobol")["f"]
    assert answer.sd == pytest.approx(run.standard_deviation.value, rel=1e-4)
    low, high = run.central()
    assert (answer.low, answer.high) == pytest.approx((low.value, high.value), rel=1e-3)


def test_cutoffs_are_minded(book):
    model = book(
        {"A1": 0.0, "B1": "=A1"},
        {"a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1, "lower_cutoff": 0.0}},
        {"f": "B1"},
    )
    answer = FirstOrder().run(model, 0, 1).answers["f"]
    assert answer.mean == pytest.approx(np.sqrt(2 / np.pi), rel=1e-4)
    assert answer.sd == pytest.approx(np.sqrt(1 - 2 / np.pi), rel=1e-3)


def test_a_distribution_without_a_mean_is_refused(book):
    model = book(
        {"A1": 1.0, "B1": "=A1"},
        {"a": {"cell": "A1", "distribution": "Pareto", "location": 1, "shape": 1}},
        {"f": "B1"},
    )
    with pytest.raises(SimulationError, match="'a' has no finite mean"):
        FirstOrder().run(model, 0, 1)


def test_where_there_is_no_derivative_there_is_no_answer(book):
    model = book({"A1": 1.0, "B1": "=1/(A1-1)"}, {"a": {"cell": "A1", "low": 0, "high": 2}}, {"f": "B1"})
    for method in (FirstOrder(), SecondOrder()):
        result = method.run(model, 0, 1)
        assert np.isnan(result.answers["f"].mean)
        assert any("no answer for f: a derivative is missing" in remark for remark in result.remarks)
