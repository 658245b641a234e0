"""What a forward model makes, its inverse returns; a test that gave a constant is returned by it."""

from __future__ import annotations

import numpy as np
import pytest

MPH = 3600 / 5280
ENDS = [0, 0.04, 0.1, 0.24, 0.35, 0.5, 0.75, 0.9]
"""Restitutions from none to nearly all."""

SQUARE = {f"{symbol}_{j}": 0 for symbol in ("bias", "theta", "h") for j in (1, 2)} | {"g": 32.174}
"""Both struck square through their centres of gravity, the depths read without error."""


def uniform_crush(vehicle, depth):
    return {f"c_{vehicle}_{station}": depth for station in range(1, 7)}


# 3,000 lb: 5 mph leaves no crush and 30 mph leaves 16 in, over 60 in.
CRASH_TEST = SQUARE | uniform_crush(1, 16) | {"w_1": 3000, "w_test_1": 3000, "b0_1": 5, "b1_1": 25 / 16}
CRASH_TEST |= {"L_1": 60, "L_test_1": 60, "L_2": 0, "w_2": 1e16}


@pytest.mark.parametrize("e", ENDS)
def test_crush_energy_returns_the_barrier_test_of_its_stiffness(cells, e):
    wanted = ["closing_mph", "dV1_mph", "EBS1_mph", "EES1_mph", "E_absorbed", "E_crush"]
    found = {symbol: value.item() for symbol, value in cells("crush-energy", CRASH_TEST | {"e": e}, wanted).items()}
    brought = 0.5 * 3000 / 32.174 * (30 / MPH) ** 2
    expected = [30, 30 * (1 + e), 30, 30 * (1 - e**2) ** 0.5, brought, brought * (1 - e**2)]
    assert list(found.values()) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("e", ENDS)
def test_stiffness_made_of_energy_lost_returns_its_test_too(cells, e):
    """Of the same test, with b1 fitted so that its energy is what the test lost."""
    lost = (1 - e**2) ** 0.5
    given = CRASH_TEST | {"basis": 2, "b0_1": 5 * lost, "b1_1": 25 / 16 * lost, "e": e}
    found = cells("crush-energy", given, ["closing_mph", "dV1_mph", "EES1_mph"])
    assert [value.item() for value in found.values()] == pytest.approx([30, 30 * (1 + e), 30 * lost], rel=1e-9)


def test_crush_energy_returns_collisions_of_two_vehicles(cells):
    """Two vehicles, off centre, of any stiffness: the crush that half the energy leaves on each gives the speeds."""
    rng, n = np.random.default_rng(43), 300
    given = SQUARE | {"e": rng.uniform(0, 0.9, n), "L_1": 60.0, "L_2": 60.0, "L_test_1": 60.0, "L_test_2": 60.0}
    effective = []
    for j in (1, 2):
        given[f"w_{j}"] = given[f"w_test_{j}"] = rng.uniform(2000, 6000, n)
        given |= {f"b0_{j}": rng.uniform(3, 8, n), f"b1_{j}": rng.uniform(1, 2, n)}
        given |= {f"h_{j}": rng.uniform(0, 3, n), f"k_{j}": rng.uniform(4, 5, n)}
        effective.append(given[f"w_{j}"] / 32.174 / (1 + (given[f"h_{j}"] / given[f"k_{j}"]) ** 2))
    both = effective[0] * effective[1] / sum(effective)
    closing = rng.uniform(25, 80, n) / MPH
    for j in (1, 2):
        barrier = np.sqrt(both * closing**2 / 2 / (given[f"w_{j}"] / 32.174)) * MPH
        given |= uniform_crush(j, np.maximum((barrier - given[f"b0_{j}"]) / given[f"b1_{j}"], 0))
    found = cells("crush-energy", given, ["V_close", "dV_1", "dV_2"])
    whole = (given["c_1_1"] > 0) & (given["c_2_1"] > 0)
    assert whole.sum() > 250
    np.testing.assert_allclose(found["V_close"][whole], closing[whole], rtol=1e-9)
    impulse = both * (1 + given["e"]) * closing
    for j in (1, 2):
        np.testing.assert_allclose(found[f"dV_{j}"][whole], (impulse / (given[f"w_{j}"] / 32.174))[whole], rtol=1e-9)


CENTRAL = {f"{symbol}_{j}": 0 for symbol in ("x", "y") for j in (1, 2)} | {"omega1_deg": 0, "omega2_deg": 0}
CENTRAL |= {"closure": 1, "e_t": 0, "e_n": 0, "g": 32.174}


@pytest.mark.parametrize("contact", [0, 30, 74.6, 135, 200, 301])
def test_a_central_impact_is_that_of_two_points(cells, contact):
    """Two cars lock, whichever way the contact is drawn: they go on with the momentum of both."""
    given = CENTRAL | {"w_1": 3000, "w_2": 4000, "V1_before": 30, "V2_before": 40, "alpha_1": 180, "alpha_2": 85}
    wanted = ["V1f_mph", "V2f_mph", "beta_1", "beta_2", "checks_hold", "approach_mph", "E_lost", "check_closing"]
    found = {
        name: value.item() for name, value in cells("planar-forward", given | {"gamma_t": contact}, wanted).items()
    }
    carried = (3000 * 30 * np.exp(1j * np.pi) + 4000 * 40 * np.exp(1j * np.radians(85))) / 7000
    assert [found["V1f_mph"], found["V2f_mph"]] == pytest.approx([abs(carried)] * 2, rel=1e-9)
    assert [found["beta_1"], found["beta_2"]] == pytest.approx([np.degrees(np.angle(carried)) % 360] * 2, rel=1e-9)
    assert found["check_closing"] == found["checks_hold"] == 1
    assert found["approach_mph"] > 0


def test_a_central_impact_goes_back_through_planar_impact(cells):
    """With rebound: the inverse model finds the speeds, and takes the impact for a possible one."""
    rng, n = np.random.default_rng(5), 200
    given = CENTRAL | {"alpha_1": rng.uniform(-20, 20, n), "alpha_2": rng.uniform(70, 110, n), "gamma_t": 130.0}
    given |= {"e_n": rng.uniform(0, 0.8, n), "e_t": rng.uniform(0, 0.25, n), "f_1": 0.7, "f_2": 0.6}
    given |= {f"V{j}_before": rng.uniform(15, 60, n) for j in (1, 2)} | {
        f"w_{j}": rng.uniform(2e3, 5e3, n) for j in (1, 2)
    }
    forward = cells("planar-forward", given, ["beta_1", "beta_2", "s_1", "s_2", "approach_mph", "check_push"])
    assert (forward["approach_mph"] > 0).all()
    assert (forward["check_push"] == 1).all()
    back = {
        name: value for name, value in given.items() if name not in ("e_n", "e_t", "closure") and "before" not in name
    }
    back |= {name: forward[name] for name in ("beta_1", "beta_2", "s_1", "s_2")}
    found = cells("planar-impact", back, ["V1_mph", "V2_mph", "e_n", "e_t", "approach_mph", "check_closing"])
    for j in (1, 2):
        np.testing.assert_allclose(found[f"V{j}_mph"], given[f"V{j}_before"], rtol=1e-9)
    np.testing.assert_allclose(found["e_n"], given["e_n"], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(found["approach_mph"], forward["approach_mph"], rtol=1e-8)
    assert (found["check_closing"] == 1).all()
