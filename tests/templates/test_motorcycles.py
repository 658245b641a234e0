"""The template motorcycle returns what forward models made: impulses, flights, skids; and says how well it can."""

from __future__ import annotations

import numpy as np
import pytest

MPH, G = 3600 / 5280, 32.174


def impacts(n, seed):
    """Inputs of n crossing impacts with any impulse against the motorcycle's way, and the speeds before, ft/s."""
    rng = np.random.default_rng(seed)
    w = rng.uniform(450, 900, n), rng.uniform(2500, 5000, n)
    alpha = rng.uniform(0, 360, n), None
    alpha = alpha[0], alpha[0] + rng.choice([-1, 1], n) * rng.uniform(30, 150, n)
    v = rng.uniform(30, 70, n), rng.uniform(5, 40, n)
    before = [speed * np.exp(1j * np.radians(angle)) for speed, angle in zip(v, alpha, strict=True)]
    share = rng.uniform(0.5, 1.05, n)
    impulse = -w[0] / G * share * before[0] + rng.uniform(-5, 5, n) * w[0] / G * 1j * before[0] / v[0]
    after = before[0] + impulse / (w[0] / G), before[1] - impulse / (w[1] / G)
    given = {"g": G, "known": 2, "d_slide": 0}
    for j in (1, 2):
        friction = rng.uniform(0.3, 0.8, n)
        given |= {f"w_{j}": w[j - 1], f"alpha_{j}": alpha[j - 1], f"f_{j}": friction}
        given |= {
            f"beta_{j}": np.degrees(np.angle(after[j - 1])),
            f"s_{j}": abs(after[j - 1]) ** 2 / (2 * friction * G),
        }
    return given, v, np.abs(impulse) / (w[1] / G)


@pytest.mark.parametrize("car_known", [1, 2])
def test_impacts_come_back_from_their_run_outs(cells, car_known):
    given, (v1, v2), change = impacts(300, 7)
    given |= {"car_known": car_known, "V2_before": v2 * MPH}
    result = cells("motorcycle", given, ["vi_mph", "V2_mph", "dV2_mph", "across", "check_energy"])
    np.testing.assert_allclose(result["vi_mph"], v1 * MPH, rtol=1e-9)
    np.testing.assert_allclose(result["V2_mph"], v2 * MPH, rtol=1e-9)
    np.testing.assert_allclose(result["dV2_mph"], change * MPH, rtol=1e-9)
    if car_known == 2:
        np.testing.assert_allclose(result["across"], 0, atol=1e-8)


@pytest.mark.parametrize("alpha_2", [0, 90, 180, 270])
def test_momentum_along_its_way_needs_no_crossing(cells, alpha_2):
    """Head-on, rear-end, and at right angles as α2 = 90° and 270° exactly: the car's speed before is known."""
    m, v2 = (600 / G, 3400 / G), 20 / MPH * np.exp(1j * np.radians(alpha_2))
    impulse = m[0] * 45 / MPH
    after = 0.5 / MPH * 1j, v2 + (impulse - m[0] * 0.5 / MPH * 1j) / m[1]
    given = {"w_1": 600, "w_2": 3400, "alpha_1": 0, "alpha_2": alpha_2, "car_known": 2, "V2_before": 20, "g": G}
    given |= {"f_1": 0.5, "f_2": 0.5}
    for j in (1, 2):
        given |= {f"beta_{j}": np.degrees(np.angle(after[j - 1])), f"s_{j}": abs(after[j - 1]) ** 2 / G}
    result = {name: value.item() for name, value in cells("motorcycle", given, ["vm_mph", "across"]).items()}
    assert result["vm_mph"] == pytest.approx(45, rel=1e-9)
    assert result["across"] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("car_known", [1, 2])
def test_conditioning_is_the_change_by_a_degree_and_by_a_tenth(cells, car_known):
    given, (_, v2), _ = impacts(100, 8)
    given |= {"car_known": car_known, "V2_before": v2 * MPH}
    slopes = cells("motorcycle", given, ["v_momentum", "per_degree", "per_approach", "per_tenth"])

    def moved(change):
        return [cells("motorcycle", given | change(way), ["v_momentum"])["v_momentum"] for way in (1, -1)]

    for symbol, change, steps in (
        ("per_degree", lambda way: {"beta_2": given["beta_2"] + way * 1e-3}, 1e3),
        ("per_approach", lambda way: {"alpha_2": given["alpha_2"] + way * 1e-3}, 1e3),
        ("per_tenth", lambda way: {"s_2": given["s_2"] * (1 + way * 1e-4) ** 2}, 1e3),
    ):
        more, less = moved(change)
        expected = 100 * np.abs((more - less) / 2 * steps / slopes["v_momentum"])
        np.testing.assert_allclose(slopes[symbol], expected, rtol=1e-5, atol=1e-5, err_msg=symbol)


def test_a_lighter_motorcycle_is_worse_conditioned(cells):
    """The same speeds, one partner lighter: what is not known of the car counts in inverse proportion to its mass."""
    shares = []
    for weight in (300, 600, 1200):
        m, v1, v2 = (weight / G, 3400 / G), 40 / MPH, 20j / MPH
        after = 5 / MPH, v2 + m[0] * (v1 - 5 / MPH) / m[1]
        given = {
            "w_1": weight,
            "w_2": 3400,
            "alpha_1": 0,
            "alpha_2": 90,
            "car_known": 1,
            "f_1": 0.5,
            "f_2": 0.5,
            "g": G,
        }
        for j in (1, 2):
            given |= {f"beta_{j}": np.degrees(np.angle(after[j - 1])), f"s_{j}": abs(after[j - 1]) ** 2 / G}
        shares.append(cells("motorcycle", given, ["per_degree"])["per_degree"].item())
    assert shares[0] / shares[1] == pytest.approx(2, rel=1e-9)
    assert shares[1] / shares[2] == pytest.approx(2, rel=1e-9)


def test_a_rider_who_flies_lands_and_slides_gives_the_speed_back(cells):
    rng, n = np.random.default_rng(9), 200
    v, angle, mu, fall = rng.uniform(30, 80, n), rng.uniform(10, 20, n), rng.uniform(0.5, 0.8, n), rng.uniform(2, 3, n)
    share = rng.uniform(0.7, 1, n)
    along, up = v * share * np.cos(np.radians(angle)), v * share * np.sin(np.radians(angle))
    landing = np.sqrt(up**2 + 2 * G * fall)
    slid = along - mu * landing
    assert (slid > 0).all()
    s = along * (up + landing) / G + slid**2 / (2 * mu * G)
    given = {"s": s, "mu": mu, "H": fall, "angle": angle, "efficiency": share, "g": G, "known": 3}
    result = cells("motorcycle", given, ["vr_mph", "vi_mph", "check_known"])
    np.testing.assert_allclose(result["vr_mph"], v * MPH, rtol=1e-9)
    np.testing.assert_allclose(result["vi_mph"], v * MPH, rtol=1e-9)


@pytest.mark.parametrize("grade", [-8, 0, 8])
def test_skid_and_slide_come_before_the_impact(cells, grade):
    """Stepped through time on the slope: upright, then on its side, then struck at 25 mph."""
    slope = np.arctan(grade / 100)
    v, t, x, dt = 70.0, 0.0, 0.0, 1e-5
    while x < 60 + 30:
        friction = 0.65 if x < 60 else 0.5
        v -= dt * G * (friction * np.cos(slope) + np.sin(slope))
        x, t = x + v * dt, t + dt
    given = {"known": 1, "v_given": v * MPH, "f_upright": 0.65, "d_upright": 60, "f_slide": 0.5, "d_slide": 30, "g": G}
    result = cells("motorcycle", given | {"grade": grade}, ["v0_mph", "t_before"])
    assert result["v0_mph"].item() == pytest.approx(70 * MPH, rel=1e-4)
    assert result["t_before"].item() == pytest.approx(t, rel=1e-3)


def test_a_regression_waits_until_it_has_a_scatter_and_a_wheelbase(cells):
    given = {"fit_0": 10.0, "fit_w": 2.0, "dL": 9.0, "known": 4}
    wanted = ["v_fit_mph", "check_known"]
    assert cells("motorcycle", given, wanted)["check_known"].item() == 0
    whole = given | {"fit_sd": 4.0, "z_fit": np.array([-1.0, 0, 1])}
    np.testing.assert_allclose(cells("motorcycle", whole, wanted)["v_fit_mph"], [24, 28, 32])
    crushed = whole | {"fit_c": 0.5, "crush": 6.0}
    np.testing.assert_allclose(cells("motorcycle", crushed, ["vi_mph"])["vi_mph"], [27, 31, 35])
