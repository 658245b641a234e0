"""Every template gives the published or independently computed figures of its worked examples."""

from __future__ import annotations

import pytest

MPH = 3600 / 5280
KMH = 3.6
STANDING = {"w_1": 5000, "w_2": 5000, "V2_before": 0, "e": 0, "known": 1}
TEXTBOOK = {"m_1": 1500, "m_2": 2500, "V2_before": 0, "V2_after": 15 * KMH, "e": 0.5, "known": 2}
YAW = {"chord": 52, "ordinate": 6, "f": 0.2, "bank": 0, "offset": 0, "g": 32.174}
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
    ("critical-speed-yaw", YAW, {"R_mark": 59.33, "v_mph": 13.32}, 5e-3),
    # The mark of the outer front tyre, 2.5 ft outside the path; 5 % of bank.
    ("critical-speed-yaw", YAW | {"offset": 2.5}, {"v_mph": (0.2 * 32.174 * (59.3333 - 2.5)) ** 0.5 * MPH}, 1e-4),
    ("critical-speed-yaw", YAW | {"bank": 5}, {"f_side": 0.25 / 0.99}, 1e-12),
    # 5000 lb at 90 ft/s into an equal car that stands, plastic: 45 ft/s together. Either speed may be the known one.
    ("collinear", STANDING | {"V1_before": 90 * MPH}, {"V1_f": 45, "V2_f": 45, "dV_1": 45, "V1_mph": 61.3636}, 5e-5),
    ("collinear", STANDING | {"known": 2, "V2_after": 45 * MPH}, {"V1_i": 90, "dV_1": 45}, 1e-9),
    # 5000 lb at 20 against 2500 lb at 40, head-on, plastic: both stop.
    (
        "collinear",
        STANDING | {"w_2": 2500, "V2_before": -40, "V1_before": 20},
        {"V1_f": 0, "V2_f": 0, "dV1_mph": 20, "dV2_mph": 40},
        1e-9,
    ),
    # 1500 kg into 2500 kg at rest, which leaves at 15 m/s; e = 0.5.
    ("collinear-si", TEXTBOOK, {"V1_i": 26.6667, "V1_kmh": 96, "dV_2": 15, "V1_f": 1.6667}, 5e-5),
    # Equal cars, one struck off centre: delta-V overstated by .6, 2.3 and 8.6 % at .5, 1 and 2 ft.
    ("collinear", STANDING | {"V1_before": 30, "h_2": 0.5, "k_yaw": 4.6}, {"overstated": 0.6}, 0.05),
    ("collinear", STANDING | {"V1_before": 30, "h_2": 1, "k_yaw": 4.6}, {"overstated": 2.3}, 0.05),
    ("collinear", STANDING | {"V1_before": 30, "h_2": 2, "k_yaw": 4.6}, {"overstated": 8.6}, 0.05),
]


@pytest.mark.parametrize(("template", "inputs", "expected", "tolerance"), EXAMPLES)
def test_worked_example(template, inputs, expected, tolerance, cells):
    found = cells(template, inputs, list(expected))
    for symbol, value in expected.items():
        assert found[symbol].item() == pytest.approx(value, abs=tolerance), symbol


def test_the_textbook_that_prints_80_is_caught(cells):
    """Its separation speed is negative; the right speed passes the same check."""
    wanted = ["check_claim", "checks_hold", "e_claimed", "V1_kmh"]
    printed = cells("collinear-si", TEXTBOOK | {"V1_claimed": 80 * KMH}, wanted)
    assert printed["e_claimed"].item() == pytest.approx(-0.5)
    assert printed["check_claim"].item() == printed["checks_hold"].item() == 0
    right = cells("collinear-si", TEXTBOOK | {"V1_claimed": printed["V1_kmh"].item()}, wanted)
    assert right["e_claimed"].item() == pytest.approx(0.5)
    assert right["check_claim"].item() == right["checks_hold"].item() == 1
