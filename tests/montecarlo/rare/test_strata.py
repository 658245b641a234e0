"""Branches and discrete assumptions divide all trials into strata, each with a distance of its own."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction
from xlmc.montecarlo.rare.strata import MOST_STRATA

NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}
COIN = {"distribution": "Yes-No", "probability": 0.5}
DIE = {"distribution": "Discrete Uniform", "low": 1, "high": 3}
CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "A4": 1.0, "B2": "=IF(A1>0,A2,-A2)", "B3": "=A1>1.5"}
GIVEN = {
    "a": {"cell": "A1", **NORMAL},
    "b": {"cell": "A2", **NORMAL},
    "c": {"cell": "A3", **COIN},
    "d": {"cell": "A4", **DIE},
}


@pytest.fixture
def function(book):
    def make(formula, **limits):
        filters = {"f": {"cell": "B1", **limits}}
        return LimitStateFunction(book({**CELLS, "B1": formula}, GIVEN, {"x": "A1"}, filters), np.random.default_rng(3))

    return make


WAYS = [
    ("=A1+A2", {"at_least": 3}, 1),
    ("=IF(A2>0,A1-3,50*A1-99)", {"at_least": 0}, 2),
    ("=5+3*IF(A2>0,A1-3,50*A1-99)", {"at_least": 5}, 2),
    ("=IF(A3=1,A1,A2)", {"at_least": 2}, 2),
    ("=A3*A1+(1-A3)*100*A2", {"at_least": 2}, 2),
    ("=CHOOSE(A4,A1,100*A2,A1+A2)", {"at_least": 2}, 3),
    ("=SWITCH(ROUND(A1,0),1,A2,2,50*A2,A2-9)", {"at_least": 2}, 3),
    ("=IFS(A1>1,A2,A1>0,99*A2,TRUE,A2-9)", {"at_least": 2}, 3),
    ("=MAX(A1,40*A2)", {"at_least": 80}, 2),
    ("=MAX(A1:A2)", {"at_least": 2}, 2),
    ("=MAX(A1,A2)", {"at_most": -1}, 1),
    ("=MIN(A1,A2)", {"at_least": 1}, 1),
    ("=MIN(A1,A2)", {"at_most": -2}, 2),
    ("=3-MAX(A1,40*A2)", {"at_most": 0}, 2),
    ("=B2*2", {"at_least": 3}, 2),
    ("=SUM(B2:B2)", {"at_least": 2}, 2),
    ("=OR(A1>2,100*A2>150)", {}, 2),
    ("=AND(A1>1,A2>1)", {}, 1),
    ("=NOT(AND(A1<1.5,100*A2<150))", {}, 2),
    ("=OR(B3,A2<-1)", {}, 2),
    ("=IF(A1>0,A2>1.5,A1*A2>2)", {}, 2),
    ("=CHOOSE(A4,A1,IF(A2>0,A1,A2),MAX(A1,A2))+A3", {"at_least": 2}, 12),
]


UNDIVIDED = [
    "=SUM(IF(A1:A2>0,A1:A2,9))",
    "=LET(x,A1,IF(x>0,x,9-x))",
    "=SUM(MAP(A1:A2,LAMBDA(x,IF(x>0,x,2*x))))",
    "=IF(,A1,A2)",
    "=IFERROR(SQRT(A1),A2)",
    "=MAX(A1:A2,,A2)",
]


@pytest.mark.parametrize("formula", UNDIVIDED)
def test_what_has_no_single_value_is_not_divided(function, random, formula):
    result = function(formula, at_least=1)
    points = random.standard_normal((500, result.dimensions))
    (stratum,) = result.strata
    assert np.array_equal(stratum(points) == 0.0, result.accepts(points))


@pytest.mark.parametrize(("formula", "limits", "count"), WAYS)
def test_the_strata_are_all_trials_and_each_is_in_one(function, random, formula, limits, count):
    """What is accepted is 0 away in exactly one stratum, and nothing else is 0 away in any."""
    result = function(formula, **limits)
    points = 1.5 * random.standard_normal((4000, result.dimensions))
    distances = np.array([stratum(points) for stratum in result.strata])
    assert len(distances) == count <= MOST_STRATA
    accepted = result.accepts(points)
    assert accepted.any()
    assert np.array_equal((distances == 0.0).sum(axis=0), accepted.astype(int))


def test_a_branch_is_not_compared_with_another(function):
    """In either stratum the nearer trial is nearer, whatever the other branch is measured in."""
    result = function("=IF(A3=1,A1-4,1000*(A2-4))", at_least=0)
    order = [result.dimensions - 1 - i for i in range(result.dimensions)]
    assert sorted(order) == list(range(3))
    points = np.zeros((3, 3))
    points[:, 0], points[:, 1], points[:, 2] = [0.0, 2.0, 3.0], [0.0, 2.0, 3.0], [2.0, 2.0, -2.0]
    (one, other) = (stratum(points) for stratum in result.strata)
    for inside, outside in ((slice(0, 2), slice(2, 3)), (slice(2, 3), slice(0, 2))):
        mine, theirs = (one, other) if one[inside].max() < 1000 else (other, one)
        assert mine[outside].min() > 1000 > mine[inside].max()
        assert theirs[inside].min() > 1000


def test_more_switches_than_there_is_room_for_are_left_together(book):
    cells = {
        **{f"A{i}": 1.0 for i in range(1, 7)},
        "B1": "=" + "+".join(f"IF(A{i}>0,A{i},2*A{i})" for i in range(1, 7)),
    }
    given = {f"a{i}": {"cell": f"A{i}", **NORMAL} for i in range(1, 7)}
    model = book(cells, given, {"x": "A1"}, {"f": {"cell": "B1", "at_least": 9}})
    assert len(LimitStateFunction(model, np.random.default_rng(3)).strata) == 8


def test_branches_of_other_scales_are_all_found(book):
    """Half of the coin's trials each; without strata the smaller scale takes all."""
    cells = {**CELLS, "B1": "=IF(A3=1,0.001*(-A1-4),1000*(A2-4))"}
    model = book(cells, {name: GIVEN[name] for name in "abc"}, {"x": "A3"}, {"f": {"cell": "B1", "at_least": 0}})
    run = simulated(model, seed=2, until_accepted=900, rare="always")
    assert run.warnings == []
    assert abs(run.acceptance.value - 3.167124e-05) < 4.5 * run.acceptance.error
    assert abs(run.inputs["c"].mean() - 1 / 2) < 4.5 * np.sqrt(1 / 4 / 900)
    assert run.rare.ways == 2
    assert "in 2 strata" in run.rare.sentence
