"""What an independent simulation of the motion makes, the template returns: each loop begins from speeds and times.

The simulations step through time and know nothing of the templates' equations; forces come from Newton's law alone.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

G = 32.174
MPH = 3600 / 5280
STEP = 1e-3
"""Seconds. Where the force is constant over a step, a step is exact."""
SEEDS = pytest.mark.parametrize("seed", range(4))


def one(result):
    return {symbol: value.item() for symbol, value in result.items()}


def braked_over(v, length, a):
    """Speed after a length, and the time it took, under a deceleration a; steps of time, the last one shortened."""
    x = t = 0.0
    while x < length:
        h = STEP
        if x + v * h - a * h * h / 2 >= length:
            low, high = 0.0, h
            for _ in range(60):
                h = (low + high) / 2
                low, high = (h, high) if x + v * h - a * h * h / 2 < length else (low, h)
        x, v, t = x + v * h - a * h * h / 2, v - a * h, t + h
        if h < STEP:
            break
        assert v > 0, "it stopped before"
    return v, t


def way_to_rest(v, deceleration):
    """Distance and time until the speed is 0, where the deceleration depends on the time; midpoints of steps."""
    x = t = 0.0
    while True:
        a = deceleration(t + STEP / 2)
        if a * STEP >= v:
            return x + v * v / (2 * a), t + v / a
        x, v, t = x + v * STEP - a * STEP**2 / 2, v - a * STEP, t + STEP


def thrown(v, angle, mu, fall):
    """Whole distance of a body: flight, a landing blow with friction μ, slide; and whether it slid."""
    vx, vy, y, x = v * math.cos(angle), v * math.sin(angle), fall, 0.0
    while True:
        if y + vy * STEP - G * STEP**2 / 2 <= 0:
            h = (vy + math.sqrt(vy * vy + 2 * G * y)) / G
            x, vy = x + vx * h, vy - G * h
            break
        x, y, vy = x + vx * STEP, y + vy * STEP - G * STEP**2 / 2, vy - G * STEP
    after = vx + mu * vy  # the blow upward is -vy, its friction μ times that
    if after <= 0:
        return x, False
    return x + way_to_rest(after, lambda _: mu * G)[0], True


@SEEDS
def test_a_skid_over_surfaces_a_grade_and_a_roll(cells, seed):
    rng = np.random.default_rng(seed)
    grade, share, start = rng.uniform(-8, 8), rng.uniform(0.6, 1), rng.uniform(90, 130)
    slope = math.atan(grade / 100)
    inputs = {"grade": grade, "braking": share, "g": G}
    v = start
    for phase, braked in (("1", True), ("2", True), ("3", True), ("yaw", False), ("trip", False), ("roll", False)):
        f, d = rng.uniform(0.4, 0.9), rng.uniform(5, 25)
        inputs |= {f"f_{phase}": f, f"d_{phase}": d}
        v, _ = braked_over(v, d, G * ((share if braked else 1) * f * math.cos(slope) + math.sin(slope)))
    back = one(cells("skid", inputs | {"known": 1, "v_end": v * MPH}, ["v_mph"]))
    assert back["v_mph"] == pytest.approx(start * MPH, rel=1e-9)
    on = one(cells("skid", inputs | {"known": 2, "v_begin": start * MPH}, ["vend_mph"]))
    assert on["vend_mph"] == pytest.approx(v * MPH, rel=1e-9)


@SEEDS
def test_air_brakes_that_rise(cells, seed):
    rng = np.random.default_rng(seed)
    rise, f, start = rng.uniform(0.2, 0.8), rng.uniform(0.4, 0.7), rng.uniform(50, 100)
    length, _ = way_to_rest(start, lambda t: f * G * min(t / rise, 1))
    result = one(
        cells("skid", {"f_1": f, "d_1": length, "t_rise": rise, "g": G, "known": 1, "v_end": 0}, ["v_air_mph"])
    )
    assert result["v_air_mph"] == pytest.approx(start * MPH, rel=1e-5)


@SEEDS
def test_a_yaw_mark_on_a_bank(cells, seed):
    """A point at the limit of friction, stepped along its curve; chord and middle ordinate measured on its path."""
    rng = np.random.default_rng(seed)
    v, f, bank = rng.uniform(50, 110), rng.uniform(0.5, 0.9), rng.uniform(-4, 8)
    tilt = math.atan(bank / 100)
    normal = G / (math.cos(tilt) - f * math.sin(tilt))
    inward = normal * (math.sin(tilt) + f * math.cos(tilt))
    x, y, heading, path = 0.0, 0.0, 0.0, [(0.0, 0.0)]
    for _ in range(1200):
        turn = inward / v * STEP
        middle = heading + turn / 2
        x, y, heading = x + v * math.cos(middle) * STEP, y + v * math.sin(middle) * STEP, heading + turn
        path.append((x, y))
    first, between, last = np.array(path[0]), np.array(path[600]), np.array(path[-1])
    chord = np.linalg.norm(last - first)
    ordinate = np.linalg.norm(between - (first + last) / 2)
    given = {"chord": chord, "ordinate": ordinate, "f": f, "bank": bank, "offset": 0, "g": G}
    result = one(cells("critical-speed-yaw", given, ["v_mph", "checks_hold"]))
    assert result["v_mph"] == pytest.approx(v * MPH, rel=1e-5)
    assert result["checks_hold"] == 1


THROW = ["v_throw", "v_level", "v_least", "u_after"]


@pytest.mark.parametrize("fall", [0, 1.2, 2.3, 4])
@pytest.mark.parametrize("degrees", [-8, 0, 10, 33.4, 50, 70])
def test_a_throw_of_flight_landing_and_slide(cells, degrees, fall):
    v, mu = 45.0, 0.66
    distance, slid = thrown(v, math.radians(degrees), mu, fall)
    assert slid is (degrees < 60)  # a steep throw stops where it lands
    given = {"s": distance, "mu": mu, "H": fall, "angle": degrees, "efficiency": 0.9, "g": G}
    result = one(cells("pedestrian-throw", given, [*THROW, "V_vehicle_mph"]))
    assert result["v_throw"] == pytest.approx(v, rel=1e-9)
    assert result["V_vehicle_mph"] == pytest.approx(v / 0.9 * MPH, rel=1e-9)
    assert result["v_least"] <= v * (1 + 1e-12)
    assert (result["v_level"] >= v * (1 - 1e-12)) is (0 <= degrees < 60)  # else it was faster: no upper limit
    assert (result["u_after"] >= 0) is slid


def test_any_throw_comes_back_and_no_angle_throws_so_far_at_a_lower_speed(cells):
    """Any angle, any fall: also of bodies that stop where they land."""
    rng = np.random.default_rng(1)
    draws = [
        (rng.uniform(8, 80), math.radians(rng.uniform(-60, 89)), rng.uniform(0.3, 1.1), rng.uniform(0.01, 5))
        for _ in range(300)
    ]
    made = [thrown(*draw) for draw in draws]
    v, angle, mu, fall = np.array(draws).T
    distance, slid = np.array([s for s, _ in made]), np.array([slid for _, slid in made])
    assert 60 < slid.sum() < 240
    result = cells("pedestrian-throw", {"s": distance, "mu": mu, "H": fall, "angle": np.degrees(angle), "g": G}, THROW)
    np.testing.assert_allclose(result["v_throw"], v, rtol=1e-8)
    assert (result["v_least"] <= v * (1 + 1e-9)).all()
    assert ((result["u_after"] >= 0) == slid).all()
    given = {"s": distance, "mu": mu, "H": fall, "angle": np.degrees(angle), "efficiency": 1, "g": G, "known": 2}
    np.testing.assert_allclose(cells("pedestrian", given, ["v_i"])["v_i"], v, rtol=1e-8)


def test_a_level_throw(cells):
    """Sliding on, and so short that it stops where it lands."""
    for v, fall in ((40.0, 2.3), (6.0, 2.3), (3.0, 4.0)):
        distance, slid = thrown(v, 0.0, 0.66, fall)
        assert slid is (v > 10)
        result = one(cells("pedestrian-throw", {"s": distance, "mu": 0.66, "H": fall, "g": G}, ["v_level"]))
        assert result["v_level"] == pytest.approx(v, rel=1e-9)


def test_the_least_speed_is_reached_at_the_best_angle(cells):
    for mu, fall in ((0.5, 0.0), (0.66, 2.3), (0.8, 2.7)):
        distance, slid = thrown(50.0, math.atan(mu), mu, fall)
        result = one(cells("pedestrian-throw", {"s": distance, "mu": mu, "H": fall, "g": G}, ["v_least", "angle_best"]))
        assert slid
        assert result["v_least"] == pytest.approx(50, rel=1e-9)
        assert result["angle_best"] == pytest.approx(math.degrees(math.atan(mu)))


def test_without_the_fall_the_lower_bound_was_four_percent_too_high(cells):
    result = cells("pedestrian-throw", {"s": 20, "mu": 0.66, "H": np.array([0, 2.3]), "g": G}, ["vmin_mph"])["vmin_mph"]
    assert result[0] / result[1] == pytest.approx(1.040, abs=5e-4)


@SEEDS
def test_a_flight_over_an_edge(cells, seed):
    rng = np.random.default_rng(seed)
    v, slope, drop = rng.uniform(40, 90), rng.uniform(-10, 20), rng.uniform(3, 15)
    f, braking = rng.uniform(0.3, 0.7), rng.uniform(5, 40)
    angle = math.radians(slope)
    x, y, vx, vy = 0.0, drop, v * math.cos(angle), v * math.sin(angle)
    while y + vy * STEP - G * STEP**2 / 2 > 0:
        x, y, vy = x + vx * STEP, y + vy * STEP - G * STEP**2 / 2, vy - G * STEP
    h = (vy + math.sqrt(vy * vy + 2 * G * y)) / G
    x, vy = x + vx * h, vy - G * h
    before = v
    for _ in range(60):  # the speed from which braking leaves v
        before += v - braked_over(before, braking, f * G)[0] if before > v else 10.0
    given = {"d": x, "h": drop, "theta": slope, "f": f, "s": braking, "g": G}
    result = one(cells("airborne", given, ["v", "v_1", "v_land", "landing_slope", "v_min"]))
    assert result["v"] == pytest.approx(v, rel=1e-9)
    assert result["v_1"] == pytest.approx(before, rel=1e-6)
    assert result["v_land"] == pytest.approx(math.hypot(vx, vy), rel=1e-9)
    assert result["landing_slope"] == pytest.approx(math.degrees(math.atan2(vy, vx)), rel=1e-9)
    assert result["v_min"] <= v * (1 + 1e-12)


@pytest.mark.parametrize("brake_on", [0, 2, 4], ids="brake on in the last {} samples".format)
@SEEDS
def test_a_record_of_a_vehicle_that_brakes(cells, seed, brake_on):
    """The recorder samples the wheels; braking begins at the first sample that shows the brake on."""
    rng = np.random.default_rng(seed)
    cruising, f, kappa = rng.uniform(70, 110), rng.uniform(0.4, 0.7), rng.uniform(0.05, 0.2)
    q, bias, tau, interval = rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 2), rng.uniform(0.05, 0.45), 0.5
    times = [-tau - k * interval for k in range(6)]
    begins = times[brake_on - 1] if brake_on else math.inf

    def speed(t):
        return cruising - f * G * max(t - begins, 0)

    def recorded(k):
        slips = brake_on > 1 and k < brake_on - 1
        return speed(times[k]) * MPH * (1 - kappa) - q if slips else speed(times[k]) * MPH - q - bias

    given = {"v_last": recorded(0), "n_on": brake_on, "T_s": interval, "tau": tau, "f": f, "kappa": kappa, "g": G}
    given |= {"q": q, "bias": bias} | {f"v_{k}": recorded(k) for k in range(1, 6)}
    result = one(cells("edr-speed", given, ["v_impact_s", "v_on_mph", "x_on", "checks_hold"]))
    steps = np.linspace(begins if brake_on else times[0], 0, 20_001)
    middles = (steps[1:] + steps[:-1]) / 2
    assert result["v_impact_s"] == pytest.approx(speed(0), rel=1e-9)
    assert result["v_on_mph"] == pytest.approx(cruising * MPH, rel=1e-9)
    assert result["x_on"] == pytest.approx(sum(map(speed, middles)) * (steps[1] - steps[0]), rel=1e-6)
    assert result["checks_hold"] == 1


@SEEDS
def test_a_video_of_a_vehicle_that_slows(cells, seed):
    """Frames are counted from the first after one mark to the first after the other, at a camera's own phase."""
    rng = np.random.default_rng(seed)
    v, a, distance, rate = rng.uniform(40, 90), rng.uniform(0, 0.6), rng.uniform(30, 60), rng.uniform(10, 60)
    first = rng.uniform(0, 1)
    at_last, took = braked_over(v, distance, a * G)
    crossings = np.array([first, first + took]) * rate
    frames = np.ceil(crossings)
    shares = frames - crossings
    given = {
        "d": distance,
        "n": frames[1] - frames[0],
        "u_1": shares[0],
        "u_2": shares[1],
        "rate": rate,
        "a": a,
        "g": G,
    }
    result = one(cells("video-speed", given, ["v_mean", "v_first", "v_end"]))
    assert result["v_mean"] == pytest.approx(distance / took, rel=1e-9)
    assert result["v_first"] == pytest.approx(v, rel=1e-9)
    assert result["v_end"] == pytest.approx(at_last, rel=1e-9)


def approach(distance, v, response, b, until):
    """Arrival at the point of impact and the speed there; None, 0 where the vehicle stops before `until` or never."""
    x = t = 0.0
    while x < distance:
        a = b if t >= response else 0.0
        h = min(STEP, response - t) if t < response else STEP
        if v - a * h <= 0 or t > until:
            return math.inf, 0.0
        step = v * h - a * h * h / 2
        if x + step >= distance:
            left = distance - x
            h = 2 * left / (v + math.sqrt(max(v * v - 2 * a * left, 0)))
            return t + h, v - a * h
        x, v, t = x + step, v - a * h, t + h
    return t, v


def moved(u, a, time):
    """Distance of an intruder after a time, in steps."""
    edges = np.linspace(0, time, 10_001)
    return float(np.sum((u + a * (edges[1:] + edges[:-1]) / 2) * np.diff(edges)))


TIMES = [
    "v_0",
    "t_response",
    "D_0",
    "t_intruder",
    "stops_same",
    "avoided_same",
    "avoided_least",
    "did_brake",
    "t_beyond",
]


@pytest.mark.parametrize("limit", [25, 40, 55])
@SEEDS
def test_a_driver_who_braked(cells, seed, limit):
    rng = np.random.default_rng(seed)
    v0, f, response, braking = rng.uniform(70, 90), rng.uniform(0.5, 0.8), rng.uniform(0.7, 2.5), rng.uniform(10, 60)
    u, a = rng.uniform(3, 8), rng.uniform(0, 5)
    v_impact, braked_for = braked_over(v0, braking, f * G)
    time = response + braked_for
    way, far = moved(u, a, time), rng.uniform(3, 15)
    given = {"v_impact": v_impact * MPH, "d_brake": braking, "braked": 1, "f": f, "u": u * MPH, "a_intruder": a / G}
    given |= {"d_intruder": way, "clearance": far, "limit": limit, "g": G}
    result = one(cells("time-distance", given, [*TIMES, "t_clear", "t_arrive_same", "v_hit_same"]))
    assert result["v_0"] == pytest.approx(v0, rel=1e-8)
    assert result["t_response"] == pytest.approx(response, rel=1e-8)
    assert result["D_0"] == pytest.approx(v0 * response + braking, rel=1e-8)
    assert moved(u, a, result["t_clear"]) == pytest.approx(way + far, rel=1e-8)
    arrives, hits = approach(v0 * response + braking, limit / MPH, response, f * G, 60)
    assert result["stops_same"] == math.isinf(arrives)
    if not math.isinf(arrives):
        assert result["t_arrive_same"] == pytest.approx(arrives, rel=1e-7)
        assert result["v_hit_same"] == pytest.approx(hits, rel=1e-4)
    assert result["avoided_same"] == result["avoided_least"] == (arrives >= result["t_clear"])
    assert result["t_beyond"] == pytest.approx(max(0.5 - response, response - 3), rel=1e-6)


@pytest.mark.parametrize("message", [(1, 0), (2, 0), (2, 60)], ids=["no marks", "did not", "did not, marks left over"])
@pytest.mark.parametrize("limit", [25, 32, 45])
@SEEDS
def test_a_driver_who_never_braked(cells, seed, limit, message):
    """Whatever he would have done after the impact's time, the outcome at another speed lies between both ends."""
    rng = np.random.default_rng(seed)
    v, f, u = rng.uniform(48, 54), rng.uniform(0.5, 0.8), rng.uniform(2.5, 5)
    time, far = rng.uniform(1, 5), rng.uniform(3, 8)
    braked, marks = message
    given = {"v_impact": v * MPH, "d_brake": marks, "braked": braked, "f": f, "u": u * MPH, "a_intruder": 0}
    given |= {"d_intruder": u * time, "clearance": far, "limit": limit, "g": G}
    result = one(cells("time-distance", given, [*TIMES, "t_clear", "t_weighed", "t_usual"]))
    assert result["did_brake"] == 0
    assert result["v_0"] == pytest.approx(v)
    assert result["t_response"] == pytest.approx(time)
    assert result["t_beyond"] == 0
    assert result["t_weighed"] == result["t_usual"]
    responses = [time, *(time + rng.exponential(0.5, 8)), math.inf]
    outcomes = [approach(v * time, limit / MPH, each, f * G, 120)[0] >= result["t_clear"] for each in responses]
    assert result["avoided_same"] == outcomes[0]
    assert result["avoided_least"] == outcomes[-1]
    assert result["avoided_least"] <= min(outcomes) <= max(outcomes) <= result["avoided_same"]


def test_a_scene_without_braking_that_cannot_tell(cells):
    """34 to 36 mph, a pedestrian at 4 to 5 ft/s over 12 ft, 6 ft to clear: at 25 mph 100 % or 0 %."""
    rng = np.random.default_rng(3)
    n = 20_000
    given = {"v_impact": rng.uniform(34, 36, n), "u": rng.uniform(4, 5, n) * MPH, "f": rng.uniform(0.55, 0.8, n)}
    given |= {"braked": 2, "a_intruder": 0, "d_intruder": 12, "clearance": 6, "limit": 25}
    result = cells("time-distance", given, ["avoided_same", "avoided_least", "t_beyond"])
    assert result["avoided_same"].all()
    assert not result["avoided_least"].any()
    assert not result["t_beyond"].any()


@pytest.mark.parametrize("brakes", [True, False], ids=["braked", "not before the impact"])
@pytest.mark.parametrize("known", [1, 2], ids=["marks", "throw"])
@SEEDS
def test_a_pedestrian(cells, seed, known, brakes):
    rng = np.random.default_rng(seed)
    v0, f, response, walking = rng.uniform(45, 70), rng.uniform(0.5, 0.8), rng.uniform(0.7, 2.5), rng.uniform(4, 5)
    before = rng.uniform(10, 25) if brakes else 0
    mu, fall, degrees, share = rng.uniform(0.5, 0.8), rng.uniform(1.5, 3), rng.uniform(0, 25), rng.uniform(0.8, 1)
    v_impact, braked_for = braked_over(v0, before, f * G) if brakes else (v0, 0.0)
    after, _ = way_to_rest(v_impact, lambda _: f * G)
    distance, slid = thrown(share * v_impact, math.radians(degrees), mu, fall)
    assert slid
    given = {"d_before": before, "braked": 1 if brakes else 2, "f": f, "mu": mu, "H": fall, "angle": degrees, "g": G}
    given |= {"efficiency": share, "walking": walking, "walked": walking * (response + braked_for), "limit": 30}
    given |= {"known": known, "s": distance if known == 2 else 0, "d_after": after if known == 1 else 0}
    wanted = ["v_i", "v_0", "t_response", "D_0", "stops", "stops_least", "vs_mph", "vt_mph", "checks_hold", "t_beyond"]
    result = one(cells("pedestrian", given, wanted))
    assert result["v_i"] == pytest.approx(v_impact, rel=1e-8)
    assert result["v_0"] == pytest.approx(v0, rel=1e-8)
    assert result["t_response"] == pytest.approx(response, rel=1e-8)
    assert result["D_0"] == pytest.approx(v0 * response + before, rel=1e-8)
    arrives, _ = approach(v0 * response + before, 30 / MPH, response, f * G, 60)
    assert result["stops"] == math.isinf(arrives)
    assert result["stops_least"] == (result["stops"] if brakes else 0)
    # What was not measured gives no answer, and not 0.
    assert math.isnan(result["vs_mph"]) is (known == 2)
    assert math.isnan(result["vt_mph"]) is (known == 1)
    assert result["checks_hold"] == 1
    assert result["t_beyond"] <= 0
