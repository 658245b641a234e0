"""Every template gives the published or independently computed figures of its worked examples."""

from __future__ import annotations

import pytest

MPH = 3600 / 5280
SKID = {"f_1": 0.75, "d_1": 100, "d_2": 0, "d_3": 0, "v_end": 0, "grade": 0, "g": 32.174}

# Template, inputs, what must come out, tolerance: half a unit of the last digit printed.
EXAMPLES = [
    ("skid", SKID, {"v_mph": 47.366}, 5e-4),
    # Speeds combine as the root of the sum of their squares: 47.366 and 30.
    ("skid", SKID | {"v_end": 30}, {"v_mph": (47.366**2 + 30**2) ** 0.5}, 1e-3),
    # Two surfaces of half the length are one of the whole.
    ("skid", SKID | {"d_1": 60, "f_2": 0.75, "d_2": 40}, {"v_mph": 47.366}, 5e-4),
    # 10 % downhill: f cos θ − sin θ = (0.75 − 0.10)/√1.01.
    ("skid", SKID | {"grade": -10}, {"v_mph": (2 * 32.174 * 100 * 0.65 / 1.01**0.5) ** 0.5 * MPH}, 1e-9),
    (
        "skid",
        SKID | {"t_reaction": 1.25},
        {"d_reaction": 86.8377, "d_total": 186.8377},
        5e-5,
    ),
]


@pytest.mark.parametrize(("template", "inputs", "expected", "tolerance"), EXAMPLES)
def test_worked_example(template, inputs, expected, tolerance, cells):
    found = cells(template, inputs, list(expected))
    for symbol, value in expected.items():
        assert found[symbol].item() == pytest.approx(value, abs=tolerance), symbol
