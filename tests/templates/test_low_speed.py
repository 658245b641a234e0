"""A rear-end impact at low speed: the tyres of the struck vehicle, duration, mean acceleration."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated
from typed_cells import model_of, with_typed

EDITIONS = [("collinear", "w", 32.174, 3600 / 5280), ("collinear-si", "m", 9.80665, 3.6)]
WAITS = ["Vehicle 1 impact speed, Vehicle 2 braked", "Vehicle 1 delta-V, Vehicle 2 braked"]
WAITS += ["Vehicle 2 delta-V, braked", "Vehicle 1 mean acceleration", "Vehicle 2 mean acceleration"]


def collided(m_1, m_2, closing, e, braked, duration, g, steps=200_000):
    """Step through an impact: a spring while it closes, its force times e² while it opens; brakes on the second.

    Speeds after, of the first at `closing` and the second at rest, for a contact that lasts about `duration`.
    """
    reduced = m_1 * m_2 / (m_1 + m_2)
    natural = (np.pi / 2 + np.pi / 2 / e) / duration
    stiffness, dt = reduced * natural**2, 1.5 * duration / steps
    v_1, v_2, gap = closing, 0.0, 0.0
    for step in range(steps):
        force = stiffness * gap * (1 if v_1 > v_2 else e**2)
        friction = m_2 * braked * g
        if v_2 > 0 or force > friction:
            v_2 += (force - friction) * dt / m_2
        v_1 -= force * dt / m_1
        gap += (v_1 - v_2) * dt
        if gap <= 0 and step:
            return v_1, v_2, step * dt
    raise AssertionError("still in contact")


@pytest.mark.parametrize("known", [1, 2])
@pytest.mark.parametrize(("name", "mass", "g", "per_second"), EDITIONS)
def test_momentum_closes_with_the_impulse_of_the_tyres(name, mass, g, per_second, known, cells):
    rng, n = np.random.default_rng(2), 300
    given = {f"{mass}_{j}": rng.uniform(1000, 3000, n) for j in (1, 2)}
    given |= {"e": rng.uniform(0.1, 0.5, n), "known": known, "V2_before": 0.0, "V1_before": rng.uniform(8, 15, n)}
    given |= {"V2_after": rng.uniform(3, 9, n), "t_impact": rng.uniform(0.08, 0.15, n), "g": g}
    given |= {"f_braked": rng.uniform(0.1, 0.7, n)}
    unit = "kmh" if name.endswith("si") else "mph"
    result = cells(name, given, [f"V1b_{unit}", "dV_1b", "dV_2b", "taken", "closed_b", "a_mean_2"])
    j = given["f_braked"] * g * given["t_impact"]
    moved = result["dV_2b"] > 0
    assert moved.mean() > 0.5
    lost, gained = given[f"{mass}_1"] * result["dV_1b"], given[f"{mass}_2"] * (result["dV_2b"] + j)
    np.testing.assert_allclose(lost[moved], gained[moved], rtol=1e-9)
    apart = result["dV_2b"] - (result["closed_b"] - result["dV_1b"])
    np.testing.assert_allclose(apart, given["e"] * result["closed_b"], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["a_mean_2"], result["dV_2b"] / given["t_impact"] / g, rtol=1e-12)
    if known == 2:
        np.testing.assert_allclose(result["dV_2b"] * per_second, given["V2_after"], rtol=1e-9)
    else:
        np.testing.assert_allclose(result[f"V1b_{unit}"], given["V1_before"], rtol=1e-9)


def test_a_standing_vehicle_is_held_by_its_brakes(cells):
    """The blow is less than the brakes hold: it stays, and the other rebounds as from a wall."""
    given = {"known": 1, "V2_before": 0, "V1_before": 1, "e": 0.3, "t_impact": 0.5, "f_braked": 0.9}
    result = cells("collinear", given, ["dV_2b", "dV_1b", "closed_b"])
    assert result["dV_2b"].item() == 0
    assert result["dV_1b"].item() == pytest.approx(1.3 * result["closed_b"].item())


def test_a_stepped_impact_agrees(cells):
    """Within what the pulse's shape leaves, as the brakes change the closing a little."""
    m_1, m_2, closing, e, braked, g = 1500.0, 1200.0, 3.0, 0.3, 0.5, 9.80665
    v_1, v_2, duration = collided(m_1, m_2, closing, e, braked, 0.12, g)
    given = {"m_1": m_1, "m_2": m_2, "known": 1, "V2_before": 0, "V1_before": closing * 3.6, "g": g}
    given |= {"e": (v_2 - v_1) / closing, "t_impact": duration, "f_braked": braked}
    result = cells("collinear-si", given, ["dV_1b", "dV_2b"])
    assert result["dV_2b"].item() == pytest.approx(v_2, abs=0.03)
    assert result["dV_1b"].item() == pytest.approx(closing - v_1, abs=0.03)


@pytest.mark.parametrize("name", ["collinear", "collinear-si"])
def test_it_waits_until_it_is_asked(name, read):
    free = simulated(model_of(read(name)), 1_000)
    assert not set(WAITS) & set(free.forecasts)
    lasting = simulated(model_of(with_typed(read(name), {"t_impact": 0.1})), 1_000)
    assert set(WAITS) & set(lasting.forecasts) == set(WAITS[3:])
    both = simulated(model_of(with_typed(read(name), {"t_impact": 0.1, "f_braked": 0.6})), 1_000)
    assert set(WAITS) <= set(both.forecasts)
