"""The template low-speed against two masses and a spring, stepped through time, and back through its other inputs."""

from __future__ import annotations

import numpy as np
import pytest

MPH, KMH, G, G_SI = 3600 / 5280, 3.6, 32.174, 9.80665
WANTED = ["V1_mph", "dV1_mph", "dV2_mph", "t_contact", "a_mean_1", "a_mean_2"]
FREE = {"f_1": 0, "f_2": 0, "g": G, "known": 1}


def stepped(m, speeds, e, deepest, drags, *, constant=False, steps=200_000):
    """Speeds after, and duration, of two masses whose contact has one force to go in, and a steeper one to spring back.

    Args:
        m: masses, slug.
        speeds: ft/s before; the second may brake, and its brakes never push it back.
        e: restitution: the way back gives e² of the energy.
        deepest: greatest deflection, ft, which an impact without brakes reaches.
        drags: of the braked wheels, g.
        constant: whether the force is, or grows in proportion to the deflection.
    """
    reduced = m[0] * m[1] / (m[0] + m[1])
    closing = speeds[0] - speeds[1]
    energy = reduced * closing**2 / 2
    force = energy / deepest if constant else 2 * energy / deepest
    v, x, most, t, dt = list(speeds), 0.0, 0.0, 0.0, 10 * deepest / closing / steps
    for _ in range(steps):
        most = max(most, x)
        if x >= most:
            contact = force * (1 if constant else x / deepest)
        else:
            peak = force * (1 if constant else most / deepest)
            back = e**2 * most
            left = x - (most - back)
            contact = 0 if left <= 0 else peak * (1 if constant else left / back)
        if contact == 0 and t > 0 and v[0] < v[1] and x < most:
            break
        v[0] += dt * (-contact / m[0] - np.sign(v[0]) * drags[0] * G)
        push = contact / m[1] - drags[1] * G
        v[1] = max(v[1] + dt * push, 0) if speeds[1] == 0 else v[1] + dt * push
        x += dt * (v[0] - v[1])
        t += dt
    return v, t


@pytest.mark.parametrize("constant", [False, True])
@pytest.mark.parametrize("e", [0.2, 0.4, 0.7])
def test_without_brakes_speeds_and_duration_are_those_of_two_masses_and_a_spring(cells, e, constant):
    given = FREE | {"w_1": 3500, "w_2": 2800, "e": e, "V1_before": 8, "X": 4, "kappa": 2 if constant else np.pi / 2}
    result = {name: value.item() for name, value in cells("low-speed", given, WANTED).items()}
    (v1, v2), t = stepped((3500 / G, 2800 / G), (8 / MPH, 0), e, 4 / 12, (0, 0), constant=constant)
    assert result["t_contact"] == pytest.approx(t, rel=1e-3)
    assert [result["dV1_mph"], result["dV2_mph"]] == pytest.approx([8 - v1 * MPH, v2 * MPH], rel=1e-3)
    assert result["a_mean_2"] == pytest.approx(v2 / t / G, rel=2e-3)


@pytest.mark.parametrize("drags", [(0, 0.7), (0.7, 0), (0.6, 0.6)])
@pytest.mark.parametrize("constant", [False, True])
def test_brakes_shift_delta_v_as_in_time(cells, drags, constant):
    """The duration is taken as if nobody braked, which leaves a few per cent of the shift."""
    given = FREE | {"w_1": 3500, "w_2": 2800, "e": 0.3, "V1_before": 10, "X": 4, "f_1": drags[0], "f_2": drags[1]}
    given |= {"kappa": 2 if constant else np.pi / 2}
    result = {name: value.item() for name, value in cells("low-speed", given, WANTED).items()}
    (_, v2), _ = stepped((3500 / G, 2800 / G), (10 / MPH, 0), 0.3, 4 / 12, drags, constant=constant)
    free = cells("low-speed", given | {"f_1": 0, "f_2": 0}, ["dV2_mph"])["dV2_mph"].item()
    assert free - result["dV2_mph"] == pytest.approx(free - v2 * MPH, rel=0.15)


def test_like_cars_on_springs_have_the_mean_acceleration_of_the_guide(cells):
    given = FREE | {"w_1": 3000, "w_2": 3000, "e": np.array([0.2, 0.4, 0.75]), "V1_before": 8, "X": 4}
    result = cells("low-speed", given | {"kappa": np.pi / 2}, ["a_mean_2"])["a_mean_2"]
    np.testing.assert_allclose(result, (8 / MPH) ** 2 / (np.pi * 4 / 12) / G, rtol=1e-12)


def test_delta_v_and_run_out_go_back_to_the_speed(cells):
    """Braked or not, with the duration computed or typed in."""
    rng, n = np.random.default_rng(12), 200
    given = {"w_1": rng.uniform(2500, 5000, n), "w_2": rng.uniform(2500, 5000, n), "e": rng.uniform(0.1, 0.7, n)}
    given |= {"V1_before": rng.uniform(5, 12, n), "f_1": rng.uniform(0, 0.6, n), "f_2": rng.uniform(0, 0.6, n)}
    given |= {"X": rng.uniform(2, 6, n), "kappa": rng.uniform(1.6, 2, n), "g": G, "f_after": 0.4}
    for typed in ({}, {"t_impact": rng.uniform(0.05, 0.12, n)}):
        there = cells("low-speed", given | typed | {"known": 1}, ["dV2_mph", "V2_f", "dV1_mph"])
        moved = there["V2_f"] > 0
        assert moved.mean() > 0.9
        back = given | typed | {"V1_before": 0}
        by_delta_v = cells("low-speed", back | {"known": 2, "dV2_given": there["dV2_mph"]}, ["V1_mph", "dV1_mph"])
        by_run_out = cells("low-speed", back | {"known": 3, "d_after": there["V2_f"] ** 2 / 0.8 / G}, ["V1_mph"])
        for result in (by_delta_v, by_run_out):
            np.testing.assert_allclose(result["V1_mph"][moved], given["V1_before"][moved], rtol=1e-9)
        np.testing.assert_allclose(by_delta_v["dV1_mph"][moved], there["dV1_mph"][moved], rtol=1e-9)


def test_brakes_hold_a_standing_vehicle_and_never_push_it_back(cells):
    given = FREE | {"w_1": 2000, "w_2": 40_000, "e": 0.2, "V1_before": 1, "X": 6, "f_2": 0.8}
    result = {name: value.item() for name, value in cells("low-speed", given, ["dV2_mph", "dV1_mph"]).items()}
    assert result["dV2_mph"] == 0
    assert result["dV1_mph"] == pytest.approx(1.2)


def test_undamaged_bumpers_bound_the_closing_speed(cells):
    """Like cars whose bumpers each take 2.5 mph at a barrier meet their limits at 5 mph; beyond a barrier, at 2.5."""
    given = FREE | {"w_1": 3000, "w_2": np.array([3000, 3e9]), "v_bumper_1": 2.5, "v_bumper_2": np.array([2.5, 0])}
    result = cells("low-speed", given, ["V_limit_mph"])["V_limit_mph"]
    np.testing.assert_allclose(result, [5, 2.5], rtol=1e-5)


def test_both_recorded_delta_v_give_the_restitution_of_a_published_test(cells):
    """A Polo into a Fiesta at 5.5 mph, delta-V 3.5 and 3.1 mph: (3.5 + 3.1)/5.5 − 1 = 0.2."""
    given = FREE | {"w_1": 3100, "w_2": 3500, "e": 0.2, "V1_before": 5.5}
    result = {name: value.item() for name, value in cells("low-speed", given, ["dV1_mph", "dV2_mph"]).items()}
    assert [result["dV1_mph"], result["dV2_mph"]] == pytest.approx([3.5, 3.1], abs=0.05)
