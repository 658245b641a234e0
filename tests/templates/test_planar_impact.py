from __future__ import annotations

import numpy as np
import pytest

from templates.planar_impact import evaluate

FIXED = {"omega1_deg": 0.0, "omega2_deg": 0.0, "g": 32.174, "in_per_ft": 12, "s_per_hour": 3600, "ft_per_mile": 5280}

# Converged reference of the case study, from 2e9 independent trials:
# mean, standard deviation, 24.5 % and 75.5 % quantiles, median, 2.5 % and 97.5 %.
ACCEPTED = 0.01756579
REFERENCE = {
    "dV1_mph": (11.80333, 0.73709, 11.2793, 12.3532, 11.8555, 10.307, 13.111),
    "dV2_mph": (23.06344, 1.41424, 22.0565, 24.1252, 23.1747, 20.181, 25.543),
    "V1_mph": (33.16317, 1.76307, 31.7987, 34.4853, 33.0310, 30.097, 36.633),
    "V2_mph": (4.74205, 2.00052, 3.3507, 6.1320, 4.7774, 0.773, 8.644),
}
QUANTILES = (0.245, 0.755, 0.5, 0.025, 0.975)


def drawn(described, trials, seed):
    """Inputs of the case study, each (trials,)."""
    rng = np.random.default_rng(seed)
    ranges = {given.symbol: given.parameters for given in described["intersection"].assumptions}
    return FIXED | {symbol: rng.uniform(p["Low"], p["High"], trials) for symbol, p in ranges.items()}


def base_inputs(described):
    return {given.symbol: given.base for given in described["planar-impact"].inputs if given.base is not None}


def accepted(v):
    """The filters of the case study, (trials,)."""
    return (v["e_n"] >= 0) & (v["e_n"] < 1) & (v["e_t"] >= 0) & (v["e_t"] <= 0.25) & (v["V2_mph"] > 0)


@pytest.fixture
def scenes(described):
    """2,000 crashes with approaches in every direction, well away from the poles of the printed equations."""
    inputs = drawn(described, 4_000, 7)
    rng = np.random.default_rng(8)
    for j in (1, 2):
        inputs[f"alpha_{j}"] = rng.uniform(0, 360, 4_000)
        inputs[f"beta_{j}"] = rng.uniform(0, 360, 4_000)
        inputs[f"omega{j}_deg"] = rng.uniform(-60, 60, 4_000)
    tame = np.abs(np.sin(np.radians(inputs["alpha_1"] - inputs["alpha_2"]))) > 0.3
    tame &= np.abs(np.cos(np.radians(inputs["alpha_2"]))) > 0.3
    return {symbol: value[tame][:1_500] if np.ndim(value) else value for symbol, value in inputs.items()}


def as_printed(v):
    """SAE 2001-01-3347, equations (3), (4) with its sign corrected, (5), (6), (9) to (16), (19) to (21)."""
    rad = {symbol: np.radians(v[symbol]) for symbol in ("alpha_1", "beta_1", "alpha_2", "beta_2", "gamma_t")}
    al1, be1, al2, be2, ga = rad.values()
    m1, m2 = v["w_1"] / v["g"], v["w_2"] / v["g"]
    v1f, v2f = (np.sqrt(2 * v["g"] * v[f"f_{j}"] * v[f"s_{j}"]) for j in (1, 2))
    v1i = (m1 * v1f * np.sin(be1 - al2) - m2 * v2f * np.sin(al2 - be2)) / (m1 * np.sin(al1 - al2))
    v2i = (-m1 * v1i * np.cos(al1) + m1 * v1f * np.cos(be1) + m2 * v2f * np.cos(be2)) / (m2 * np.cos(al2))
    v1xi, v1yi, v2xi, v2yi = v1i * np.cos(al1), v1i * np.sin(al1), v2i * np.cos(al2), v2i * np.sin(al2)
    v1xf, v1yf, v2xf, v2yf = v1f * np.cos(be1), v1f * np.sin(be1), v2f * np.cos(be2), v2f * np.sin(be2)
    a1, b1, a2, b2 = (
        coordinate
        for j, al in ((1, al1), (2, al2))
        for coordinate in (
            -(v[f"x_{j}"] * np.cos(al) + v[f"y_{j}"] * np.sin(al)) / 12,
            -(v[f"x_{j}"] * np.sin(al) - v[f"y_{j}"] * np.cos(al)) / 12,
        )
    )
    px, py = m1 * (v1xf - v1xi), m1 * (v1yf - v1yi)
    o1i, o2i = np.radians(v["omega1_deg"]), np.radians(v["omega2_deg"])
    o1f, o2f = o1i + (-py * a1 + px * b1) / v["I_1"], o2i + (py * a2 - px * b2) / v["I_2"]
    sx, sy = v1xf + b1 * o1f - v2xf - b2 * o2f, v2yf - a2 * o2f - v1yf + a1 * o1f
    cx, cy = v2xi + b2 * o2i - v1xi - b1 * o1i, v1yi - a1 * o1i - v2yi + a2 * o2i
    return {
        "V1_i": v1i, "V2_i": v2i, "a_1": a1, "b_1": b1, "a_2": a2, "b_2": b2, "P_x": px, "P_y": py,
        "omega1_f": o1f, "omega2_f": o2f,
        "dV_1": np.hypot(v1xf - v1xi, v1yf - v1yi), "dV_2": np.hypot(v2xf - v2xi, v2yf - v2yi),
        "dV1_x": v1xf - v1xi, "dV1_y": v1yf - v1yi, "dV2_x": v2xf - v2xi, "dV2_y": v2yf - v2yi,
        "V_sep_n": sx * np.sin(ga) + sy * np.cos(ga), "V_close_n": cx * np.sin(ga) + cy * np.cos(ga),
        "V_sep_t": -sx * np.cos(ga) + sy * np.sin(ga), "V_close_t": -cx * np.cos(ga) + cy * np.sin(ga),
    }  # fmt: skip


def test_the_cells_are_the_equations_written_by_hand(cells, scenes):
    """The workbook, compiled, against `evaluate`: two codings of one model, bit for bit but for the order of sums."""
    ours = evaluate(scenes)
    result = cells("planar-impact", scenes, [symbol for symbol in ours if symbol != "checks_hold"])
    assert len(result) > 60
    for symbol, values in result.items():
        scale = np.abs(ours[symbol]).max()
        np.testing.assert_allclose(values, ours[symbol], rtol=1e-11, atol=1e-13 * scale, err_msg=symbol)


def test_equations_agree_with_the_printed_ones(scenes):
    ours, printed = evaluate(scenes), as_printed(scenes)
    for symbol, truth in printed.items():
        largest = np.abs(truth).max()
        np.testing.assert_allclose(ours[symbol], truth, rtol=1e-11, atol=1e-12 * largest, err_msg=symbol)
    np.testing.assert_array_equal(ours["e_n"], ours["V_sep_n"] / ours["V_close_n"])
    np.testing.assert_array_equal(ours["e_t"], ours["V_sep_t"] / ours["V_close_t"])


def test_momentum_is_conserved(scenes):
    """Equations (1) and (2)."""
    v = evaluate(scenes) | scenes
    for function in (np.cos, np.sin):
        before, after = (
            sum(v[f"m_{j}"] * v[f"V{j}_{when}"] * function(np.radians(v[f"{angle}_{j}"])) for j in (1, 2))
            for when, angle in (("i", "alpha"), ("f", "beta"))
        )
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-12 * np.abs(v["m_1"] * v["V1_i"]).max())


def test_energy_lost_is_the_work_of_the_impulse(scenes):
    """E lost = -P·(velocity of contact point 1 less that of 2, averaged before and after)."""
    v = evaluate(scenes)
    work = v["P_x"] * (v["V_sep_x"] - v["V_close_x"]) / 2 - v["P_y"] * (v["V_sep_y"] - v["V_close_y"]) / 2
    np.testing.assert_allclose(v["E_lost"], -work, rtol=0, atol=1e-11 * np.abs(v["E_before"]).max())


def test_swapping_the_vehicles_swaps_the_answers(scenes):
    swapped = {symbol: scenes[symbol.translate(str.maketrans("12", "21"))] for symbol in scenes}
    ours, theirs = evaluate(scenes), evaluate(swapped)
    for symbol in ("V1_i", "dV1_mph", "d_omega_1", "PDOF_1"):
        np.testing.assert_allclose(theirs[symbol.replace("1", "2")], ours[symbol], rtol=1e-10, atol=1e-11)
    for symbol in ("V_sep_n", "V_close_n", "V_sep_t", "V_close_t"):
        np.testing.assert_allclose(-theirs[symbol], ours[symbol], rtol=1e-10, atol=1e-9)


@pytest.mark.parametrize("alpha_2", [90.0, 270.0])
def test_turning_the_axes_changes_nothing_even_at_the_pole_of_equation_16(described, shown, alpha_2):
    base = shown("intersection")
    scene = {given.symbol: given.base for given in described["intersection"].inputs if given.base is not None}
    turn = alpha_2 - scene["alpha_2"]
    for symbol in ("alpha_1", "alpha_2", "beta_1", "beta_2", "gamma_t"):
        scene[symbol] += turn
    turned = evaluate(scene)
    for symbol in ("V1_mph", "V2_mph", "dV1_mph", "dV2_mph", "e_n", "e_t", "PDOF_1", "PDOF_2", "E_lost"):
        assert turned[symbol] == pytest.approx(base[symbol], rel=2e-14), symbol


def test_direction_of_force_has_its_quadrant(described):
    """The Nissan is struck on its left, at +86.8 on average; the printed arctangent says the right, -93.2."""
    inputs = drawn(described, 200_000, 4)
    v = evaluate(inputs)
    keep = accepted(v)
    pdof = v["PDOF_2"][keep]
    half_a_last_digit = 0.05
    assert abs(pdof.mean() - 86.8) < 4 * pdof.std() / np.sqrt(len(pdof)) + half_a_last_digit
    printed = 180 + np.degrees(np.arctan(v["dV2_y"] / v["dV2_x"])) - inputs["alpha_2"]
    np.testing.assert_allclose(pdof - printed[keep], 180, atol=1e-9)


def test_the_three_directions_of_force_agree(scenes):
    v = evaluate(scenes)
    for j in (1, 2):
        pdof, clockwise, clock = v[f"PDOF_{j}"], v[f"PDOF{j}_cw"], v[f"PDOF{j}_clock"]
        assert ((pdof > -180) & (pdof <= 180)).all()
        assert ((clockwise >= 0) & (clockwise < 360)).all()
        np.testing.assert_allclose((clockwise + pdof + 180) % 360, 180, atol=1e-9)
        assert set(clock) == set(range(1, 13))
        hours_off = (clockwise / 30 - clock + 6) % 12 - 6
        assert np.abs(hours_off).max() <= 0.5


# Directions (alpha_1, alpha_2, beta_1, beta_2, gamma_t) that contradict physics in one way and no other.
@pytest.mark.parametrize(
    ("failing", "directions"),
    [
        ("check_energy", (170, 250, 180, 270, 40)),
        ("check_closing", (250, 210, 240, 150, 70)),
        ("check_angles", (300, 130, 160, 150, 150)),
        ("check_forward", (290, 310, 170, 310, 160)),
        ("check_restitution", (100, 220, 180, 210, 20)),
        (None, (188, 282, 188.5, 199, 101)),
    ],
)
def test_each_check_fails_alone_where_it_should(described, failing, directions):
    angles = dict(zip(("alpha_1", "alpha_2", "beta_1", "beta_2", "gamma_t"), directions, strict=True))
    values = evaluate(base_inputs(described) | angles)
    checks = {symbol: bool(value) for symbol, value in values.items() if symbol.startswith("check_")}
    assert len(checks) == 6
    assert [symbol for symbol, holds in checks.items() if not holds] == ([failing] if failing else [])
    assert bool(values["checks_hold"]) is (failing is None)


@pytest.mark.parametrize("friction", [{"f_1": 75}, {"f_2": 0}])
def test_frictions_that_no_tyre_has_fail_their_check(described, friction):
    values = evaluate(base_inputs(described) | friction)
    assert not values["check_friction"]
    assert not values["checks_hold"]


def test_parallel_approaches_have_no_answer_and_raise_nothing(described):
    scene = base_inputs(described) | {"alpha_1": 188, "alpha_2": 188}
    values = evaluate(scene)
    assert not np.isfinite(values["V1_i"])
    assert not values["checks_hold"]


def test_plain_monte_carlo_reproduces_the_reference(described):
    """200,000 trials, each figure within four of its standard errors."""
    trials = 200_000
    v = evaluate(drawn(described, trials, 2001))
    keep = accepted(v)
    assert abs(keep.mean() - ACCEPTED) < 4 * np.sqrt(ACCEPTED * (1 - ACCEPTED) / trials)
    for symbol, (mean, sd, *quantiles) in REFERENCE.items():
        x = np.sort(v[symbol][keep])
        n = len(x)
        fourth_moment = np.mean((x - x.mean()) ** 4)
        assert abs(x.mean() - mean) < 4 * sd / np.sqrt(n), symbol
        assert abs(x.std() - sd) < 4 * np.sqrt((fourth_moment - sd**4) / n) / (2 * sd), symbol
        for p, quantile in zip(QUANTILES, quantiles, strict=True):
            ranks = n * p + np.array([-4, 4]) * np.sqrt(n * p * (1 - p))
            low, high = x[np.floor(ranks).astype(int)]
            assert low <= quantile <= high, (symbol, p)
