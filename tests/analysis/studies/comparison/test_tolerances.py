from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.analysis.studies.comparison.tolerances import Verdict, judge, read_tolerances
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
    found = read_tolerances(texts, BOTH)
    assert found.of(SPEED, 2.0) == (pytest.approx(speed[0]), speed[1])
    assert found.of(ANGLE, 2.0) == (pytest.approx(angle[0]), angle[1])


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
    found = judge({"mean": (Estimate(value, error), tolerance)})
    if found.verdict is not Verdict.UNDECIDED:
        assert found.times == 1.0
    elif math.isinf(found.times):
        assert 3 * error < 0.05 * tolerance
    else:
        assert 1.0 <= found.times <= 9.0 * (1 + 1e-12)
        later = judge({"mean": (Estimate(value, error / math.sqrt(found.times * 1.001)), tolerance)})
        assert later.verdict is not Verdict.UNDECIDED or abs(tolerance - value) <= error
