from __future__ import annotations

import pytest

from xlmc.report.base_case import base_case


def test_the_base_case_is_computed_with_frozen_cells_held(run):
    found = base_case(run)
    assert found.forecasts == {"area": 2.0 * 3.0 + 10.0, "difference": -1.0}
    assert found.rejected_by == ()


@pytest.mark.parametrize(
    ("base", "rejected"),
    [(0.5, ()), (5.0, ("small",)), (-1.0, ("root",)), (11.0, ("small", "tiny"))],
)
def test_filters_that_would_reject_the_base_case_are_named(make, base, rejected):
    run = make.simulate(
        {"A1": base, "B1": "=A1", "C1": "=SQRT(A1)", "C2": "=A1<10"},
        [make.uniform("a", "A1", 0.0, 1.0, base=base)],
        [make.forecast("x", "B1")],
        [make.filter("small", "A1", at_most=2.0), make.filter("root", "C1"), make.filter("tiny", "C2")],
        trials=10,
    )
    assert base_case(run).rejected_by == rejected


def test_a_forecast_that_is_no_number_at_the_base_case_has_none(make):
    run = make.simulate(
        {"A1": 0.0, "B1": "=1/A1"}, [make.uniform("a", "A1", 0.0, 1.0, base=0.0)], [make.forecast("x", "B1")]
    )
    assert base_case(run).forecasts == {"x": None}


def test_without_a_base_value_there_is_no_base_case(make):
    run = make.simulate({"A1": None, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("x", "B1")])
    assert base_case(run) is None
