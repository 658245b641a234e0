"""The laws of readings, against the densities and distribution functions that they stand for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ndtr

from xlmc.excel.address import Cell
from xlmc.excel.formula import formula_text
from xlmc.montecarlo.definitions.evidence import USE_IS_OFF, Bell, Evidence, Within

AT = Cell("S", 1, 2)
M = np.array([-3.0, 0.0, 4.0, 9.5, 10.0, 11.0, 25.0])


def test_a_normal_error():
    """The density of reading 10 with SD 2, over its largest."""
    bell = Bell(10.0, 2.0)
    z = (10.0 - M) / 2.0
    assert bell.z(M) == pytest.approx(z)
    assert bell.log_weight(M) == pytest.approx(-0.5 * z**2)
    assert bell.reached(M) == pytest.approx(ndtr(z))


def test_a_lognormal_error():
    """A reading is m·exp(σε): its logarithm is normal, and what is not positive has no chance."""
    bell = Bell(10.0, 0.2, logarithmic=True)
    positive = M > 0.0
    z = np.log(10.0 / M[positive]) / 0.2
    assert bell.z(M)[positive] == pytest.approx(z)
    assert bell.log_weight(M)[positive] == pytest.approx(-0.5 * z**2)
    assert (bell.log_weight(M)[~positive] == -math.inf).all()
    assert (bell.reached(M)[~positive] == 1.0).all()


@pytest.mark.parametrize(("sides", "sign"), [((True, False), 1.0), ((False, True), -1.0)])
def test_one_sided_readings_keep_trials_by_the_tail(sides, sign):
    bell = Bell(10.0, 2.0, sides=sides)
    z = (M - 10.0) / 2.0 * sign
    assert np.exp(bell.log_weight(M)) == pytest.approx(ndtr(z))
    assert bell.z(M) == pytest.approx(np.minimum(z, 0.0) * -sign)  # 0 on the side that is beyond doubt
    assert bell.one_sided
    assert not Bell(10.0, 2.0).one_sided


@pytest.mark.parametrize(
    "bell", [Bell(0.0, 1.0), Bell(0.0, 1.0, sides=(True, False)), Bell(0.0, 1.0, sides=(False, True))]
)
def test_beyond_39_standard_deviations_the_chance_is_0(bell):
    """exp(−39²/2) is the last that is above 0 in double precision."""
    far = np.array([-39.5, -38.9, 38.9, 39.5])
    possible = np.isfinite(bell.log_weight(far)).tolist()
    low, high = bell.sides
    if low and high:
        assert possible == [False, True, True, False]
    else:  # the tail is thinner by z·√(2π)
        assert possible == ([False, False, True, True] if low else [True, True, False, False])


@pytest.mark.parametrize(
    ("bell", "formula"),
    [
        (Bell(10.0, 2.0), "EXP(((-0.5)*(((10.0-(S!B1+0.0))/2.0)*((10.0-(S!B1+0.0))/2.0))))"),
        (
            Bell(10.0, 0.2, logarithmic=True),
            "EXP(((-0.5)*((LN((10.0/(S!B1+0.0)))/0.2)*(LN((10.0/(S!B1+0.0)))/0.2))))",
        ),
        (Bell(10.0, 2.0, sides=(True, False)), "NORM.S.DIST((((S!B1+0.0)-10.0)/2.0),TRUE)"),
        (Bell(10.0, 2.0, sides=(False, True)), "NORM.S.DIST(((10.0-(S!B1+0.0))/2.0),TRUE)"),
    ],
)
def test_the_chance_as_a_formula(bell, formula):
    assert formula_text(bell.tree_of_chance(AT)) == formula


def test_a_tolerance():
    """|12 − m| ≤ 0.1·|m| + 0.3: from 11.7/1.1 to 12.3/0.9."""
    law = Within(12.0, 0.1, 0.3)
    assert (law.low, law.high) == (pytest.approx(11.7 / 1.1), pytest.approx(12.3 / 0.9))
    m = np.array([10.0, 12.0, 15.0])
    assert law.beyond(m) == pytest.approx([(11.7 / 1.1 - 10.0) / 1.3, 0.0, (15.0 - 12.3 / 0.9) / 1.8])
    assert law.log_weight(m).tolist() == [-math.inf, 0.0, -math.inf]
    assert law.reached(np.array([12.0, 11.0, 13.0])) == pytest.approx([0.5, 2.4 / 2.8, 0.6 / 3.2])


def test_a_tolerance_of_0_and_readings_below_0():
    assert Within(12.0, 0.0, 0.0).beyond(np.array([11.0, 12.0])).tolist() == [math.inf, 0.0]
    assert Within(12.0, 0.0, 0.0).reached(np.array([11.0, 12.0, 13.0])).tolist() == [1.0, 1.0, 0.0]
    below = Within(-12.0, 0.1, 0.3)
    assert (below.low, below.high) == (pytest.approx(-12.3 / 0.9), pytest.approx(-11.7 / 1.1))


@pytest.mark.parametrize(
    ("sides", "low", "high", "one_sided"),
    [((True, True), 11.5, 12.5, False), ((True, False), 11.5, None, True), ((False, True), None, 12.5, True)],
)
def test_sides(sides, low, high, one_sided):
    law = Within(12.0, 0.0, 0.5, sides)
    assert (law.low, law.high, law.one_sided) == (low, high, one_sided)


@pytest.mark.parametrize(
    ("error", "sizes", "law"),
    [
        ("uniform", {"percent": 25.0}, Within(-12.0, 0.0, 3.0)),
        ("uniform", {"plus_minus": 0.5}, Within(-12.0, 0.0, 0.5)),
        ("instrument", {"percent": 10.0, "resolution": 0.3}, Within(-12.0, 0.1, 0.3)),
        ("normal", {"percent": 25.0}, Bell(-12.0, 3.0)),
        ("lognormal", {"percent": 20.0}, Bell(-12.0, 0.2, logarithmic=True)),
        ("at least", {}, Within(-12.0, 0.0, 0.0, (True, False))),
        ("at most", {"plus_minus": 1.0}, Within(-12.0, 0.0, 1.0, (False, True))),
        ("at most", {"std_dev": 0.5}, Bell(-12.0, 0.5, sides=(False, True))),
        ("at least", {"std_dev": 0.0}, Within(-12.0, 0.0, 0.0, (True, False))),
    ],
)
def test_a_row_is_a_law(error, sizes, law):
    result = Evidence("y", AT, AT, -12.0, error, sizes)
    assert result.law == law
    assert result.bell == (law if isinstance(law, Bell) else None)
    assert result.by_chance is isinstance(law, Bell)
    assert not Evidence("y", AT, AT, -12.0, error, sizes, weighed=True).by_chance


def test_rows_that_do_not_count():
    assert Evidence("y", AT, AT, 1.0, "uniform").used
    for why, can in (("", True), (USE_IS_OFF, True), ("it has no reading", False)):
        result = Evidence("y", AT, AT, 1.0, "uniform", unused=why)
        assert (result.used, result.can_be_used) == (not why, can)


def test_cells_and_streams():
    result = Evidence(" Skid ", AT, AT, Cell("S", 2, 2), "normal", {"std_dev": Cell("S", 3, 2), "percent": 1.0})
    assert list(result.cells) == [Cell("S", 2, 2), Cell("S", 3, 2)]
    assert result.stream == "evidence\x1fskid"  # that of an item spelt otherwise
