from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.analysis.studies.comparison.tolerances import (
    Verdict,
    chance_of,
    chance_tolerance,
    in_tolerances,
    judge,
    read_tolerances,
)
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.statistics import Estimate

SPEED = Forecast("Chevy delta-V", Cell("S", 1, 1), Cell("S", 1, 1), units="mph")
ANGLE = Forecast("PDOF", Cell("S", 2, 1), Cell("S", 2, 1), units="deg")
BOTH = [SPEED, ANGLE]


@pytest.mark.parametrize(
    ("texts", "speed", "angle"),
    [
        ([], (0.2, False), (0.2, False)),
        (["0.5"], (0.5, True), (0.5, True)),
        (["1.609344 km/h"], (1.0, True), (0.2, False)),
        (["0.5 mph", "3 deg"], (0.5, True), (3.0, True)),
        (["20%"], (0.4, True), (0.4, True)),
        (["5e-1mph"], (0.5, True), (0.2, False)),
        (["chevy DELTA-V=0.5 mph"], (0.5, True), (0.2, False)),
        (["1", "PDOF = 5"], (1.0, True), (5.0, True)),
    ],
)
def test_tolerances_as_typed(texts, speed, angle):
    result = read_tolerances(texts, BOTH)
    assert result.of(SPEED, 2.0) == (pytest.approx(speed[0]), speed[1])
    assert result.of(ANGLE, 2.0) == (pytest.approx(angle[0]), angle[1])


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["half"], "cannot be read"),
        (["-1"], "cannot be read"),
        (["0"], "cannot be read"),
        (["1.2.3"], "cannot be read"),
        (["Chevy delta-V="], "cannot be read"),
        (["Ford=1"], "no forecast 'Ford'"),
        (["PDOF=1", "pdof=2"], "Two tolerances"),
        (["1 kg"], "No forecast has the unit"),
        (["1 mph", "2 km/h"], "hold for the same forecasts"),
        (["1", "2"], "hold for the same forecasts"),
    ],
)
def test_what_cannot_be_a_tolerance(texts, message):
    with pytest.raises(SimulationError, match=message):
        read_tolerances(texts, BOTH)


def test_a_tolerance_in_another_kind_of_unit():
    with pytest.raises(SimulationError, match=r"S!A1: The tolerance 'Chevy delta-V=3 deg' is in deg"):
        read_tolerances(["Chevy delta-V=3 deg"], BOTH).of(SPEED, 1.0)


@pytest.mark.parametrize(
    ("value", "error", "verdict"),
    [
        (0.2, 0.05, "within"),
        (-0.2, 0.05, "within"),
        (0.4, 0.05, "undecided"),
        (0.6, 0.05, "undecided"),
        (-0.7, 0.05, "beyond"),
        (0.5, 0.0, "within"),
        (0.2, None, "undecided"),
        (math.nan, None, "undecided"),
    ],
)
def test_a_verdict_clears_the_tolerance_by_three_errors(value, error, verdict):
    assert judge({"mean": (Estimate(value, error), 0.5)}).verdict.value == verdict


def test_one_number_beyond_is_enough_and_all_must_be_within():
    near, far, unknown = Estimate(0.1, 0.01), Estimate(2.0, 0.01), Estimate(0.49, 0.01)
    assert judge({"a": (near, 0.5), "b": (far, 0.5), "c": (unknown, 0.5)}).largest == "b"
    assert judge({"a": (near, 0.5), "b": (far, 0.5), "c": (unknown, 0.5)}).verdict is Verdict.BEYOND
    assert judge({"a": (near, 0.5), "c": (unknown, 0.5)}).verdict is Verdict.UNDECIDED
    assert judge({"a": (near, 0.5)}).verdict is Verdict.WITHIN


@given(st.floats(0, 10), st.floats(1e-6, 10), st.floats(1e-3, 10))
def test_as_many_trials_as_it_asks_for_decide_if_the_difference_is_what_it_seems(value, error, tolerance):
    result = judge({"mean": (Estimate(value, error), tolerance)})
    if result.verdict is not Verdict.UNDECIDED:
        assert result.times == 1.0
    elif math.isinf(result.times):
        assert 3 * error < 0.05 * tolerance
    else:
        assert 1.0 <= result.times <= 9.0 * (1 + 1e-12)
        later = judge({"mean": (Estimate(value, error / math.sqrt(result.times * 1.001)), tolerance)})
        assert later.verdict is not Verdict.UNDECIDED or abs(tolerance - value) <= error


@pytest.mark.parametrize(
    ("value", "error", "verdict", "times"),
    [
        (0.375, 0.0625, "undecided", 2.25),  # 0.375 + 3 errors are 0.5625: of half the errors they are below 0.5
        (-0.625, 0.0625, "undecided", 2.25),
        (0.3125, 0.0625, "within", 1.0),  # with three errors exactly the tolerance
        (0.6875, 0.0625, "undecided", 1.0),
        (0.5, 0.0625, "undecided", 9.0),  # how near it is, is known to one error only
        (0.5, 0.008, "undecided", math.inf),  # three errors are less than 5 % of the tolerance
        (0.5, 0.009, "undecided", 9.0),
        (math.nan, 0.1, "undecided", math.inf),
        (0.1, None, "undecided", math.inf),
    ],
)
def test_how_many_times_as_many_trials_decide(value, error, verdict, times):
    result = judge({"mean": (Estimate(value, error), 0.5)})
    assert (result.verdict.value, result.times) == (verdict, pytest.approx(times))
    assert result.blind == (error is None or math.isnan(value))


def test_times_and_blindness_are_of_the_numbers_that_make_the_verdict():
    near, within, blind = Estimate(0.375, 0.0625), Estimate(0.1, 0.01), Estimate(0.3, None)
    result = judge({"a": (near, 0.5), "b": (Estimate(0.5, 0.0625), 0.5), "c": (within, 0.05)})
    assert (result.largest, result.times, result.blind) == ("c", 1.0, False)
    result = judge({"a": (near, 0.5), "b": (Estimate(0.5, 0.0625), 0.5), "c": (within, 0.5)})
    assert (result.largest, result.times, result.blind) == ("b", 9.0, False)
    assert judge({"a": (blind, 0.5), "c": (Estimate(2.0, 0.01), 0.5)}).blind is False
    assert judge({"a": (blind, 0.5), "c": (near, 0.5)}).blind is True
    with pytest.raises(ValueError, match="no difference"):
        judge({})


@pytest.mark.parametrize(
    ("value", "tolerance", "size"),
    [(-1.0, 0.5, 2.0), (0.0, 0.0, 0.0), (0.1, 0.0, math.inf), (math.nan, 0.5, math.inf), (0.0, 0.5, 0.0)],
)
def test_the_size_of_a_difference_in_its_tolerance(value, tolerance, size):
    assert in_tolerances(Estimate(value, 0.1), tolerance) == size


@pytest.mark.parametrize(
    ("share", "tolerance"),
    [(0.5, 0.05), (0.7, 0.03), (0.3, 0.03), (0.98, 0.002), (0.002, 0.001), (0.0, 0.001), (1.0, 0.001)],
)
def test_a_probability_without_a_stated_tolerance(share, tolerance):
    assert chance_tolerance(share) == tolerance


@pytest.mark.parametrize(("points", "share"), [(None, None), (1.0, 0.01), (0.5, 0.005), (99.0, 0.99)])
def test_percentage_points(points, share):
    assert chance_of(points) == share


@pytest.mark.parametrize("points", [0.0, 100.0, -1.0, math.nan])
def test_what_cannot_be_percentage_points(points):
    with pytest.raises(SimulationError, match="percentage points"):
        chance_of(points)


@pytest.mark.parametrize(
    ("texts", "chance", "result"),
    [
        ([], None, (math.nan, False)),
        (["0.5"], None, (math.nan, False)),
        (["20 %"], None, (0.08, True)),
        (["20 %"], 0.02, (math.nan, False)),
        (["PDOF=20 %"], None, (math.nan, False)),
        (["Chevy delta-V=20 %"], 0.02, (0.08, True)),
        (["Chevy delta-V=0.03"], None, (0.03, True)),
    ],
)
def test_tolerances_of_shares(texts, chance, result):
    assert read_tolerances(texts, BOTH).of_share(SPEED, 0.4, chance) == pytest.approx(result, nan_ok=True)


def test_a_number_for_all_forecasts_is_refused_where_all_are_counted():
    read_tolerances(["20 %", "PDOF=1"], BOTH).refuse_for_shares(BOTH)
    with pytest.raises(SimulationError, match=r"The tolerance '0.5 mph' holds for no forecast") as caught:
        read_tolerances(["PDOF=1", "0.5 mph"], BOTH).refuse_for_shares(BOTH)
    assert "'Chevy delta-V=0.02'" in caught.value.hint
