"""A body thrown on a grade, carried before, and sharing momentum: what flight, landing and slide give comes back."""

from __future__ import annotations

import numpy as np
import pytest
from committed_books import BOOKS
from simulated import simulated
from typed_cells import model_of, with_typed

TEMPLATES = [("pedestrian-throw", 32.174), ("pedestrian-throw-si", 9.80665)]


def distance(speed, angle, fall, mu, grade, g):
    """How far a body goes along the road by flight, landing blow and slide; and whether it slid.

    Along the road x, across it z; the grade pulls along x all the time, the landing takes μ times the speed across.
    """
    tilt = np.arctan(grade)
    along, across = g * np.sin(tilt), g * np.cos(tilt)
    vx, vz = speed * np.cos(angle), speed * np.sin(angle)
    time = (vz + np.sqrt(vz**2 + 2 * across * fall)) / across
    flown = vx * time - along * time**2 / 2
    ground = vx - along * time - mu * np.sqrt(vz**2 + 2 * across * fall)
    if ground <= 0:
        return flown, False
    return flown + ground**2 / (2 * (mu * across + along)), True


@pytest.mark.parametrize("carried", [0.0, 3.0])
@pytest.mark.parametrize(("name", "g"), TEMPLATES)
def test_the_speed_of_a_throw_on_a_grade_comes_back(name, g, carried, cells):
    rng, n = np.random.default_rng(8), 400
    speed, angle = rng.uniform(4, 25, n), rng.uniform(-5, 75, n)
    fall, mu, grade = rng.uniform(0.3, 1.2, n), rng.uniform(0.4, 0.8, n), rng.uniform(-12, 12, n)
    thrown = [
        distance(v, np.radians(a), h, m, k / 100, g)
        for v, a, h, m, k in zip(speed, angle, fall, mu, grade, strict=True)
    ]
    s, slid = np.array([each for each, _ in thrown]), np.array([each for _, each in thrown])
    given = {"s": s + carried, "carried": carried, "angle": angle, "H": fall, "mu": mu, "grade": grade, "g": g}
    result = cells(name, given, ["v_throw", "u_after", "v_least", "v_level"])
    np.testing.assert_allclose(result["v_throw"], speed, rtol=1e-9)
    np.testing.assert_array_equal(result["u_after"] >= 0, slid)
    assert 20 < (~slid).sum() < n - 100
    assert (result["v_least"][slid] <= speed[slid] * (1 + 1e-12)).all()
    level = cells(name, given | {"angle": 0.0}, ["v_throw"])["v_throw"]
    np.testing.assert_allclose(result["v_level"], level, rtol=1e-9)


@pytest.mark.parametrize("share", [1.0, 0.9, 0.7])
def test_the_vehicle_lost_what_the_body_gained(cells, share):
    """180 lb leave 3000 lb at a share of the speed that these have left: momentum is kept, thrown or marked."""
    given = {"angle": 15.0, "efficiency": share, "w_body": 180.0, "w_vehicle": 3000.0}
    result = cells("pedestrian-throw", given, ["V_vehicle_mph", "v_throw"])
    body = result["v_throw"].item()
    before = (3000 * body / share + 180 * body) / 3000
    assert result["V_vehicle_mph"].item() == pytest.approx(before * 3600 / 5280, rel=1e-9)
    wanted = ["v_thrown", "v_marks", "v_projected", "b"]
    both = {symbol: value.item() for symbol, value in cells("pedestrian", given | {"d_after": 50.0}, wanted).items()}
    assert both["v_thrown"] == pytest.approx(both["v_projected"] * (1 / share + 0.06), rel=1e-9)
    after = (2 * both["b"] * 50) ** 0.5
    assert both["v_marks"] == pytest.approx((3000 * after + 180 * share * after) / 3000, rel=1e-9)


def test_a_regression_waits_for_its_scatter(read):
    name = "«1» speed by the regression entered".replace("«1»", "Vehicle")
    book = read("pedestrian-throw")
    assert name not in simulated(model_of(book), 1_000).forecasts
    without = with_typed(book, {"fit_k": 4.0, "fit_p": 0.5})
    assert name not in simulated(model_of(without), 1_000).forecasts
    given = with_typed(book, {"fit_k": 4.0, "fit_p": 0.5, "fit_c": 1.0, "fit_sd": 3.0})
    run = simulated(model_of(given), 20_000)
    s = run.inputs["Throw distance along the ground, from the impact to rest"]
    rest = run[name].values - 4 * np.sqrt(s) - 1
    assert abs(rest.mean()) < 4 * 3 / np.sqrt(rest.size)
    assert rest.std() == pytest.approx(3, rel=4 / np.sqrt(2 * rest.size))


@pytest.mark.parametrize("name", ["pedestrian", "pedestrian-throw"])
def test_more_of_the_throw_is_blank(name, described):
    assert name in BOOKS
    blank = {"grade", "carried", "w_body", "w_vehicle"}
    assert blank <= {row.symbol for row in described[name].optional if row.base is None}
