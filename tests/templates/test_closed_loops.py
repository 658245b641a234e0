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
    result = {symbol: value.item() for symbol, value in cells("crush-energy", CRASH_TEST | {"e": e}, wanted).items()}
    brought = 0.5 * 3000 / 32.174 * (30 / MPH) ** 2
    expected = [30, 30 * (1 + e), 30, 30 * (1 - e**2) ** 0.5, brought, brought * (1 - e**2)]
    assert list(result.values()) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("e", ENDS)
def test_stiffness_made_of_energy_lost_returns_its_test_too(cells, e):
    """Of the same test, with b1 fitted so that its energy is what the test lost."""
    lost = (1 - e**2) ** 0.5
    given = CRASH_TEST | {"basis": 2, "b0_1": 5 * lost, "b1_1": 25 / 16 * lost, "e": e}
    result = cells("crush-energy", given, ["closing_mph", "dV1_mph", "EES1_mph"])
    assert [value.item() for value in result.values()] == pytest.approx([30, 30 * (1 + e), 30 * lost], rel=1e-9)


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
    result = cells("crush-energy", given, ["V_close", "dV_1", "dV_2"])
    whole = (given["c_1_1"] > 0) & (given["c_2_1"] > 0)
    assert whole.sum() > 250
    np.testing.assert_allclose(result["V_close"][whole], closing[whole], rtol=1e-9)
    impulse = both * (1 + given["e"]) * closing
    for j in (1, 2):
        np.testing.assert_allclose(result[f"dV_{j}"][whole], (impulse / (given[f"w_{j}"] / 32.174))[whole], rtol=1e-9)


CENTRAL = {f"{symbol}_{j}": 0 for symbol in ("x", "y") for j in (1, 2)} | {"omega1_deg": 0, "omega2_deg": 0}
CENTRAL |= {"closure": 1, "e_t": 0, "e_n": 0, "g": 32.174}


@pytest.mark.parametrize("contact", [0, 30, 74.6, 135, 200, 301])
def test_a_central_impact_is_that_of_two_points(cells, contact):
    """Two cars lock, whichever way the contact is drawn: they go on with the momentum of both."""
    given = CENTRAL | {"w_1": 3000, "w_2": 4000, "V1_before": 30, "V2_before": 40, "alpha_1": 180, "alpha_2": 85}
    wanted = ["V1f_mph", "V2f_mph", "beta_1", "beta_2", "checks_hold", "approach_mph", "E_lost", "check_closing"]
    result = {
        name: value.item() for name, value in cells("planar-forward", given | {"gamma_t": contact}, wanted).items()
    }
    carried = (3000 * 30 * np.exp(1j * np.pi) + 4000 * 40 * np.exp(1j * np.radians(85))) / 7000
    assert [result["V1f_mph"], result["V2f_mph"]] == pytest.approx([abs(carried)] * 2, rel=1e-9)
    assert [result["beta_1"], result["beta_2"]] == pytest.approx([np.degrees(np.angle(carried)) % 360] * 2, rel=1e-9)
    assert result["check_closing"] == result["checks_hold"] == 1
    assert result["approach_mph"] > 0


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
    result = cells("planar-impact", back, ["V1_mph", "V2_mph", "e_n", "e_t", "approach_mph", "check_closing"])
    for j in (1, 2):
        np.testing.assert_allclose(result[f"V{j}_mph"], given[f"V{j}_before"], rtol=1e-9)
    np.testing.assert_allclose(result["e_n"], given["e_n"], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(result["approach_mph"], forward["approach_mph"], rtol=1e-8)
    assert (result["check_closing"] == 1).all()


def returned(cells, template, given, expected):
    """Check that a template returns what made its inputs: symbol of a cell -> values."""
    result = cells(template, given, list(expected))
    for symbol, values in expected.items():
        np.testing.assert_allclose(
            result[symbol], np.broadcast_to(values, result[symbol].shape), rtol=1e-8, err_msg=symbol
        )


@pytest.mark.parametrize("known", [1, 2, 3])
def test_collinear_returns_collisions_in_line(cells, known):
    """Each speed after is that of the common centre of gravity, and rebound turns the rest round, times e."""
    rng, n = np.random.default_rng(7), 300
    w = {j: rng.uniform(2e3, 8e4, n) for j in (1, 2)}
    before = {2: rng.uniform(-50, 50, n)}
    before[1] = before[2] + rng.uniform(1, 60, n)
    e = rng.uniform(0.02, 0.9, n)
    centre = (w[1] * before[1] + w[2] * before[2]) / (w[1] + w[2])
    after = {j: centre + e * (centre - before[j]) for j in (1, 2)}
    read = {1: ("V1_before", "V2_before"), 2: ("V2_after", "V2_before"), 3: ("V1_after", "V2_after")}
    speeds = {f"V{j}_{when}": x[j] for when, x in (("before", before), ("after", after)) for j in (1, 2)}
    given = {"known": known, "e": e, "w_1": w[1], "w_2": w[2], "g": 32.174}
    given |= {symbol: x if symbol in read[known] else 99.0 for symbol, x in speeds.items()}
    lost = sum(w[j] / 32.174 * (before[j] ** 2 - after[j] ** 2) for j in (1, 2)) / 2 / MPH**2
    expected = {"V1_mph": before[1], "V1f_mph": after[1], "V2f_mph": after[2], "closing_mph": before[1] - before[2]}
    expected |= {"dV1_mph": before[1] - after[1], "dV2_mph": after[2] - before[2], "E_lost": lost}
    returned(cells, "collinear", given, expected)


def test_collinear_returns_the_published_low_speed_test(cells):
    """A car at 5.5 mph into a standing one: delta-V 3.5 and 3.1 mph, so e is 0.2 and the masses are as 31 to 35."""
    given = {"known": 2, "e": 0.2, "w_1": 3100, "w_2": 3500, "V2_before": 0, "V2_after": 3.1}
    returned(cells, "collinear", given, {"V1_mph": 5.5, "dV1_mph": 3.5, "dV2_mph": 3.1})


def turned(degrees):
    """The unit vector of a direction, as a complex number."""
    return np.exp(1j * np.radians(degrees))


def run_out(after, friction):
    """Departure angle and travel to rest of a velocity in mph, feet."""
    return np.degrees(np.angle(after)) % 360, np.abs(after / MPH) ** 2 / (2 * 32.174 * friction)


@pytest.mark.parametrize("template", ["momentum", "planar-impact"])
def test_momentum_returns_collisions_at_an_angle(cells, template):
    """Any impulse at all between two vehicles: the speeds before it come back, and its sides of either vehicle."""
    rng, n = np.random.default_rng(8), 300
    alpha = {1: rng.uniform(0, 360, n)}
    alpha[2] = alpha[1] + rng.choice([-1, 1], n) * rng.uniform(20, 160, n)
    speed, w = ({j: rng.uniform(*ends, n) for j in (1, 2)} for ends in ((10, 70), (2e3, 8e4)))
    impulse = rng.uniform(1e4, 1e5, n) * turned(rng.uniform(0, 360, n))
    given, expected = {"g": 32.174, "together": 0}, {}
    for j, force in ((1, impulse), (2, -impulse)):
        change, friction = force / w[j], rng.uniform(0.1, 0.9, n)
        beta, travel = run_out(speed[j] * turned(alpha[j]) + change, friction)
        given |= {f"w_{j}": w[j], f"alpha_{j}": alpha[j], f"beta_{j}": beta, f"s_{j}": travel, f"f_{j}": friction}
        seen = change / turned(alpha[j])  # forward and, as y is to the right, minus that to the left
        expected |= {f"V{j}_mph": speed[j], f"dV{j}_mph": abs(change), f"dV{j}_long": seen.real}
        expected |= {f"dV{j}_right": -seen.imag, f"PDOF_{j}": np.degrees(np.angle(-seen))}
        expected |= {f"PDOF{j}_cw": -np.degrees(np.angle(-seen)) % 360}
    returned(cells, template, given, expected)


@pytest.mark.parametrize("apart", [(150, 210), (-25, 25)], ids=["head-on", "from behind"])
def test_momentum_energy_returns_collisions_that_crush_and_spin(cells, apart):
    rng, n = np.random.default_rng(9), 300
    w = {j: rng.uniform(2e3, 8e4, n) for j in (1, 2)}
    alpha = {1: rng.uniform(-180, 180, n)}
    alpha[2] = alpha[1] + rng.uniform(*apart, n)
    speed = {1: rng.uniform(45, 70, n), 2: rng.uniform(10, 30, n)}
    before = {j: speed[j] * turned(alpha[j]) for j in (1, 2)}
    centre = (w[1] * before[1] + w[2] * before[2]) / (w[1] + w[2])
    rebound = rng.uniform(0.05, 0.5, n) * turned(rng.uniform(-30, 30, n))
    given, spun = {"g": 32.174, "together": 0, "alpha_1": alpha[1], "lane_2": alpha[2] + rng.uniform(-90, 90, n)}, 0.0
    crushed = 0.0
    for j in (1, 2):
        after, friction = centre + rebound * (centre - before[j]), rng.uniform(0.1, 0.9, n)
        beta, travel = run_out(after, friction)
        mass, inertia, base, mu = w[j] / 32.174, rng.uniform(1e3, 5e3, n), 9.0, rng.uniform(0.2, 0.6, n)
        yaw, first = rng.uniform(-1, 1, n), rng.uniform(-0.2, 0.2, n)
        given |= {f"w_{j}": w[j], f"beta_{j}": beta, f"s_{j}": travel, f"f_{j}": friction, f"I_{j}": inertia}
        given |= {f"mu_{j}": mu, f"R_{j}": base, f"omega{j}_deg": np.degrees(first)}
        given |= {f"phi_{j}": np.degrees(np.sign(yaw) * inertia * yaw**2 / (mu * mass * 32.174 * base))}
        spun = spun + inertia * (yaw**2 - first**2) / 2
        crushed = crushed + mass * (abs(before[j]) ** 2 - abs(after) ** 2) / 2 / MPH**2
    crushed = crushed - spun
    assert (crushed > 0).all()
    for j, share in ((1, 0.3), (2, 0.7)):
        given[f"EES_{j}"] = np.sqrt(2 * share * crushed / (w[j] / 32.174)) * MPH
    expected = {f"V{j}_mph": speed[j] for j in (1, 2)} | {"alpha_2": alpha[2], "E_lost": crushed}
    expected |= {"closing_mph": abs(before[1] - before[2]), "check_balance": 1.0}
    returned(cells, "momentum-energy", given, expected)


@pytest.mark.parametrize("e", ENDS)
def test_the_speeds_of_crush_energy_are_those_that_momentum_energy_takes(cells, e):
    """Head-on through both centres: the crush of a collision gives the energy that it lost, and that its speeds."""
    weights, speeds = {1: 3000.0, 2: 4500.0}, {1: 45.0, 2: 20.0}
    mass = {j: w / 32.174 for j, w in weights.items()}
    both, closing = mass[1] * mass[2] / sum(mass.values()), sum(speeds.values())
    barrier = {j: np.sqrt(both * closing**2 / 2 / mass[j]) for j in (1, 2)}
    crush = SQUARE | {"e": e}
    for j in (1, 2):
        crush |= {f"w_{j}": weights[j], f"w_test_{j}": weights[j], f"L_{j}": 60.0, f"L_test_{j}": 60.0}
        crush |= {f"b0_{j}": 5.0, f"b1_{j}": 1.5} | uniform_crush(j, (barrier[j] - 5) / 1.5)
    result = cells("crush-energy", crush, ["EES1_mph", "EES2_mph", "E_crush", "closing_mph"])
    assert result["closing_mph"].item() == pytest.approx(closing, rel=1e-9)
    centre = (mass[1] * speeds[1] - mass[2] * speeds[2]) / sum(mass.values())
    given = {"g": 32.174, "together": 0, "alpha_1": 0, "lane_2": 180, "omega1_deg": 0, "omega2_deg": 0}
    for j, before in ((1, speeds[1]), (2, -speeds[2])):
        beta, travel = run_out(complex(centre + e * (centre - before)), 0.7)
        given |= {f"w_{j}": weights[j], f"beta_{j}": beta, f"s_{j}": travel, f"f_{j}": 0.7, f"phi_{j}": 0}
        given[f"EES_{j}"] = result[f"EES{j}_mph"].item()
    returned(cells, "momentum-energy", given, {"V1_mph": speeds[1], "V2_mph": speeds[2], "E_lost": result["E_crush"]})


def test_the_centroid_of_a_profile_and_the_lever_arm_through_it_come_back(cells):
    """The area of a profile cut into thin strips; the arm of a force as the distance of its line from the CG."""
    rng, n = np.random.default_rng(12), 40
    depths = rng.uniform(0, 30, (6, n))
    given = {f"c_1_{i}": depths[i - 1] for i in range(1, 7)} | {"bias_1": 0.0, "L_1": rng.uniform(40, 70, n)}
    given |= {"theta_1": rng.uniform(-40, 40, n), "face_1": rng.uniform(80, 100, n), "aside_1": rng.uniform(-20, 20, n)}
    result = cells("crush-energy", given, ["along_1", "inward_1", "arm_1", "h_used_1", "m_eff_1", "m_1", "k_1"])
    strips = (np.arange(50_000) + 0.5) / 50_000
    for trial in range(n):
        width = given["L_1"][trial]
        depth = np.interp(strips, np.linspace(0, 1, 6), depths[:, trial])
        along = np.sum((strips - 0.5) * width * depth) / np.sum(depth)
        inward = np.sum(depth**2 / 2) / np.sum(depth)
        centre = np.array([given["face_1"][trial] - inward, given["aside_1"][trial] + along])
        turned = np.radians(given["theta_1"][trial])
        force = np.array([-np.cos(turned), np.sin(turned)])
        arm = np.hypot(*(centre - force * (centre @ force))) / 12
        assert [result[s][trial] for s in ("along_1", "inward_1", "arm_1")] == pytest.approx(
            [along, inward, arm], rel=1e-6
        )
    np.testing.assert_array_equal(result["arm_1"], result["h_used_1"])
    effective = result["m_1"] * result["k_1"] ** 2 / (result["k_1"] ** 2 + result["arm_1"] ** 2)
    np.testing.assert_allclose(result["m_eff_1"], effective, rtol=1e-12)


def test_without_the_distance_of_the_face_the_lever_arm_is_that_of_the_inputs(cells):
    result = cells("crush-energy", {"h_1": np.array([0.3, 1.7])}, ["h_used_1", "arm_1"])
    np.testing.assert_array_equal(result["h_used_1"], [0.3, 1.7])
