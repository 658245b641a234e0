"""Rows of crash tests on sheet Stiffness: each test comes back, a line comes back, the scatter is that of the tests."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import kstest
from simulated import simulated
from typed_cells import computed_at, model_of, values_of, with_typed

from templates.writer.cached import computed
from xlmc.excel.address import Cell

EDITIONS = ["crush-energy", "crush-energy-si"]
FIRST_ROW = 6
PROFILES = {
    "even": (20, 20, 20, 20, 20, 20),
    "bulging": (16, 21, 23, 23, 20, 15),
    "corner": (0, 4, 9, 15, 22, 30),
}


def entered(book, tests, typed=None):
    """The book with rows of vehicle, weight, speed, C1 to C6 and width on its sheet Stiffness."""
    cells = {
        Cell("Stiffness", FIRST_ROW + i, 2 + j): float(value)
        for i, row in enumerate(tests)
        for j, value in enumerate(row)
    }
    return with_typed(book, cells | (typed or {}))


def speed_of(b0, b1, profile):
    """The speed whose energy crushes a profile: the root of the mean square of b0 + b1·C, straight between stations."""
    v = b0 + b1 * np.asarray(profile, float)
    a, b = v[:-1], v[1:]
    return float(np.sqrt(np.mean((a * a + a * b + b * b) / 3)))


def barrier(name, weight, profile, width, typed):
    """The inputs of the crash of a test into a rigid wall, straight on, without rebound."""
    mass = "m" if name.endswith("-si") else "w"
    crash = {f"{mass}_1": weight, "L_1": width, "theta_1": 0, "h_1": 0, "bias_1": 0, "e": 0}
    crash |= {f"c_1_{i}": depth for i, depth in enumerate(profile, 1)}
    return crash | {f"{mass}_2": 1e18, "L_2": 0, "theta_2": 0, "h_2": 0, "bias_2": 0} | typed


@pytest.mark.parametrize("b0", [2.0, 5.0, 8.0])
@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
@pytest.mark.parametrize("name", EDITIONS)
def test_one_test_returns_its_own_speed_whatever_b0_is(name, profile, b0, read):
    given = barrier(name, 3650, profile, 66, {"b0_1": b0})
    unit = "kmh" if name.endswith("-si") else "mph"
    book = entered(read(name), [(1, 3650, 35.1, *profile, 66)], given)
    speed, holds = values_of(book, [f"closing_{unit}", "check_tests"])
    assert speed == pytest.approx(35.1, rel=1e-12)
    assert holds is True
    assert computed(book)["Stiffness", FIRST_ROW - 1, 20] == pytest.approx(0, abs=1e-12)


def test_a_b_and_g_are_those_of_the_test(read):
    book = entered(read("crush-energy"), [(1, 3650, 35.0, *PROFILES["even"], 66)], {"b0_1": 5.0})
    b1, force, stiffness, energy = values_of(book, ["b1_used_1", "A_1", "B_1", "G_1"])
    mass, to_feet = 3650 / 32.174, 5280 / 3600
    assert b1 == pytest.approx((35 - 5) / 20)
    assert force == pytest.approx(12 * mass * 5 * to_feet * 1.5 * to_feet / 66)
    assert stiffness == pytest.approx(12 * mass * (1.5 * to_feet) ** 2 / 66)
    assert energy == pytest.approx(force**2 / (2 * stiffness))
    row = [computed(book)["Stiffness", FIRST_ROW - 1, column] for column in (16, 17, 18)]
    assert row == pytest.approx([force, stiffness, energy])


@pytest.mark.parametrize("name", EDITIONS)
def test_a_straight_line_comes_back_from_tests_of_other_weights_and_widths(name, read):
    """Energy per width is what tests of one structure share; the corner's profile takes the passes longest."""
    b0, b1, tests = 6.0, 1.4, []
    for weight, width, depth, profile in (
        (3500, 60, 0.5, "bulging"),
        (3700, 66, 1.0, "even"),
        (3600, 63, 0.9, "corner"),
        (3800, 58, 1.4, "bulging"),
    ):
        crush = [depth * each for each in PROFILES[profile]]
        tests.append([2, weight, speed_of(b0, b1, crush), *crush, width])
    mean_weight, mean_width = np.mean([row[1] for row in tests]), np.mean([row[-1] for row in tests])
    for row in tests:  # as fast as the same energy per width makes this weight
        row[2] *= np.sqrt(mean_weight / mean_width / (row[1] / row[-1]))
    book = entered(read(name), tests, {"line_2": 1})
    result = values_of(book, ["b0_used_2", "b1_used_2", "line_sd_2", "lined_1", "check_tests"])
    assert result[:2] == pytest.approx([b0, b1], rel=2e-4)
    assert result[2] == pytest.approx(0, abs=1e-3)
    assert result[3:] == [0, True]


def test_the_line_is_that_of_least_squares(read):
    """Even crush leaves no profile to take off, so that it is the textbook's line."""
    speeds, depths = np.array([19.2, 25.3, 29.8, 35.4, 40.1]), np.array([9.0, 13.0, 17.5, 20.0, 24.0])
    tests = [(1, 3600, speed, *[depth] * 6, 64) for speed, depth in zip(speeds, depths, strict=True)]
    wanted = ["line_b0_1", "pass_1_5", "line_sd_1", "Sxx_1", "level_1"]
    result = values_of(entered(read("crush-energy"), tests, {"line_1": 1}), wanted)
    slope, intercept = np.polyfit(depths, speeds, 1)
    rest = speeds - intercept - slope * depths
    around = np.sum((depths - depths.mean()) ** 2)
    assert result == pytest.approx([intercept, slope, np.sqrt(rest @ rest / 3), around, speeds.mean()])


@pytest.mark.parametrize("lined", [False, True], ids=["b0 given", "line"])
def test_the_next_sister_test_lies_in_the_range_as_often_as_it_says(lined, read):
    """Tests are made with a scatter; the speed that the template gives for one more covers it in 80 of 100 families."""
    rng, b0, b1, scatter, families = np.random.default_rng(11), 5.0, 1.5, 1.2, 400
    depths = np.array([12.0, 16.0, 20.0, 24.0, 20.0]) if lined else np.full(5, 20.0)
    speeds = b0 + b1 * depths + scatter * rng.standard_normal((families, 5))
    tests = [(1, 3600, 30.0, *[depth] * 6, 64) for depth in depths]
    book = entered(read("crush-energy"), tests, {"b0_1": b0, "line_1": 1} if lined else {"b0_1": b0})
    varies = {Cell("Stiffness", FIRST_ROW + i, 4): speeds[:, i] for i in range(5)}
    names = ["level_1", "pass_1_5", "line_sd_1", "x_tests_1", "Sxx_1"] if lined else ["b1_tests_1", "b1_sd_1"]
    result = computed_at(book, varies, names)
    t_level, t_slope = (rng.standard_t(3 if lined else 4, (4_000, families)) for _ in range(2))
    if lined:
        level, slope, around, mean, sum_of_squares = (result[name] for name in names)
        slopes = slope + around / np.sqrt(sum_of_squares) * t_slope
        predicted = level + around * np.sqrt(1.2) * t_level + slopes * (20.0 - mean)
    else:
        centre, deviation = (result[name] for name in names)
        predicted = b0 + 20.0 * (centre + deviation * np.sqrt(1.2) * t_level)
    low, high = np.quantile(predicted, [0.1, 0.9], axis=0)
    following = b0 + b1 * 20.0 + scatter * rng.standard_normal(families)
    covered = np.mean((low <= following) & (following <= high))
    assert abs(covered - 0.8) < 4 * np.sqrt(0.8 * 0.2 / families)


def test_the_scatter_is_drawn_as_students_t_and_held_without_tests(read):
    free = model_of(read("crush-energy"))
    held = [each.name for each in free.definitions.assumptions if "sister" in each.name and each.frozen]
    assert len(held) == 2
    speeds = (33.0, 35.0, 36.5)
    tests = [(1, 3600, speed, *PROFILES["even"], 64) for speed in speeds]
    given = barrier("crush-energy", 3600, PROFILES["even"], 64, {"b0_1": 5.0})
    book = entered(read("crush-energy"), tests, given)
    names = [each for each in model_of(book).definitions.assumptions if "sister" in each.name]
    assert [each.frozen for each in names] == [False, True]
    slopes = {each.name: each.frozen for each in model_of(book).definitions.assumptions if "b1" in each.name}
    assert list(slopes.values()) == [True, False]  # the tests replace that of vehicle 1
    t = simulated(model_of(book), 20_000).prior[names[0].name]
    assert kstest(t, "t", args=(2,)).pvalue > 1e-3


@pytest.mark.parametrize(
    ("tests", "typed"),
    [
        ([(1, 3600, 35, 20, 20, 20, 20, 20)], {}),
        ([(3, 3600, 35, 20, 20, 20, 20, 20, 20, 64)], {}),
        ([(1, 3600, 4, 20, 20, 20, 20, 20, 20, 64)], {"b0_1": 5.0}),
        ([(1, 3600, 35, -1, 20, 20, 20, 20, 20, 64)], {}),
        ([(1, 3600, 35, 20, 20, 20, 20, 20, 20, 64)] * 3, {"line_1": 1}),
    ],
    ids=["a number missing", "no such vehicle", "slower than b0", "negative crush", "no line"],
)
def test_what_is_no_test_is_said(tests, typed, read):
    assert values_of(entered(read("crush-energy"), tests, typed), ["check_tests"]) == [False]
