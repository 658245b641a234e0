"""The search on goals that are known exactly: no trial has noise, and the best candidate is known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.optimising.candidates import MARGIN, Space, Standing
from xlmc.analysis.studies.optimising.measures import Measured
from xlmc.analysis.studies.optimising.search import (
    _beyond_margin,
    _energy,
    _enough,
    _evolve,
    _leading,
    _neighbours,
    _slide,
    _step_by_step,
    search,
)
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Decision

AT = Cell("S", 1, 1)


def between(name, low, high):
    return Decision(name, AT, (low, high), AT, between=(low, high))


def listed(name, *values, ordered=False):
    return Decision(name, AT, values, AT, listed=not ordered)


class Exact:
    """Candidates as `Tried` knows them, with a goal and requirements that are functions of the decisions."""

    def __init__(self, goal, *slacks, accepted=1.0, edged=True):
        self.goal, self.slacks, self.accepted = goal, slacks, accepted
        self.columns, self.asked = {}, []
        edge = type("Edge", (), {"exact": not edged})
        self.requirements = tuple(type("Required", (), {"slack": edge}) for _ in slacks)

    def length(self, candidate):
        return self.columns[candidate].shape[1] if candidate in self.columns else 0

    def extend(self, candidates, n):
        self.asked.append((n, [*candidates]))
        for each in candidates:
            if self.length(each) < n:
                column = np.full((1, n), np.nan)
                column[:, : int(n * self.accepted)] = 1.0
                self.columns[each] = column

    def standing(self, candidate, n=None):
        slacks = tuple(Measured(slack(*candidate)) for slack in self.slacks)
        return Standing(candidate, n or self.length(candidate), Measured(self.goal(*candidate)), slacks)

    def standings(self, candidates, n):
        self.extend(candidates, n)
        return sorted((self.standing(each, n) for each in candidates), key=lambda each: each.rank, reverse=True)

    @property
    def best(self):
        return max((self.standing(each) for each in self.columns), key=lambda each: each.rank).candidate


def told(tried, space, trials=4096, first=None):
    said = []
    return search(tried, space, first, trials, 1, said.append), said


@pytest.mark.parametrize(
    ("trials", "least"),
    [(1, 128), (1000, 128), (16_384, 128), (16_385, 256), (100_000, 1024), (1 << 20, 8192)],
)
def test_all_combinations_of_few_decisions(trials, least):
    """Every candidate gets a 128th of the trials, rounded up to a power of 2, and 128 at least."""
    space = Space.of([listed("a", 1.0, 2.0, 3.0), listed("b", 10.0, 20.0)], ())
    tried = Exact(lambda a, b: -((a - 2) ** 2) + b)
    how, said = told(tried, space, trials)
    assert (how, said) == ("every combination", ["all of 6 combinations"])
    assert tried.asked[-1] == (least, [(a, b) for a in (1, 2, 3) for b in (10, 20)])
    assert tried.best == (2, 20)


@pytest.mark.parametrize(("count", "every"), [(2000, True), (2001, False)])
def test_how_many_combinations_are_all_tried(count, every):
    space = Space.of([listed("a", *map(float, range(count)), ordered=True)], ())
    how, _ = told(Exact(lambda a: -abs(a - 700)), space, 500)
    assert (how == "every combination") is every


@pytest.mark.parametrize(
    ("accepted", "trials", "n"),
    [
        (1.0, 4096, 128),
        (0.5, 4096, 128),  # 64 are enough
        (0.49, 4096, 512),
        (0.1, 4096, 2048),  # 12, 51, 204 of 128, 512, 2,048
        (0.0, 3000, 4096),  # never enough: all of them, up to a power of 2
    ],
)
def test_more_trials_where_few_are_accepted(accepted, trials, n):
    space = Space.of([listed("a", 1.0, 2.0, 3.0)], ())
    tried = Exact(lambda a: a, accepted=accepted)
    assert _enough(tried, space, None, 128, trials) == n
    assert [*tried.columns] == [(2.0,)]  # the middle one
    assert _enough(Exact(lambda a: a), space, (3.0,), 128, trials) == 128


def test_a_first_candidate_that_is_not_allowed_is_not_tried():
    never = type("Never", (), {"holds_for": lambda self, candidate: False, "equal": False})()
    space = Space.of([listed("a", 1.0, 2.0, 3.0)], (never,))
    tried = Exact(lambda a: a, accepted=0.0)
    assert _enough(tried, space, None, 128, 4096) == 128
    assert tried.asked == []


def test_the_best_five_get_more_trials():
    tried = Exact(lambda a: -abs(a - 4))
    tried.extend([(float(a),) for a in range(10)], 100)
    assert {each[0] for each in _leading(tried, 400)} == {2, 3, 4, 5, 6}
    assert [tried.length((float(a),)) for a in (1, 2, 6, 7)] == [100, 400, 400, 100]
    assert _leading(tried, 400, 2)[0] == (4.0,)


def test_evolution_looks_at_every_part_of_a_range():
    space = Space.of([between("a", 0.0, 1.0), between("b", 0.0, 1.0)], ())
    tried = Exact(lambda a, b: -((a - 0.3) ** 2) - (b - 0.7) ** 2)
    _evolve(tried, space, (0.25, 0.5), 128, 1)
    first = np.array(tried.asked[0][1])
    assert len(first) == 20  # ten for each decision
    assert [0.25, 0.5] in first.tolist()
    for column in first.T:  # of twenty parts all but the one that the workbook's own decisions replace
        assert len({*np.round(column, 3)} & {*np.round(np.linspace(0, 1, 20), 3)}) == 19
    assert 250 <= sum(len(each) for _, each in tried.asked) <= 2 * 250
    assert tried.best == pytest.approx((0.3, 0.7), abs=0.1)
    assert {n for n, _ in tried.asked} == {128}


def test_evolution_of_many_decisions_has_no_more_than_eighty():
    space = Space.of([listed(f"x{number}", 0.0, 1.0, 2.0, ordered=True) for number in range(12)], ())
    tried = Exact(lambda *x: -sum(x))
    _evolve(tried, space, None, 128, 1)
    assert sum(len(each) for _, each in tried.asked) <= 2_500


def test_a_smooth_goal_without_requirements():
    space = Space.of([between("a", 0.0, 10.0), between("b", -1.0, 1.0)], ())
    tried = Exact(lambda a, b: -((a - 3.456) ** 2) - 4 * (b - 0.1234) ** 2 + a * b / 10)
    # the slopes are 0 at -2(a - 3.456) + b/10 = 0 and -8(b - 0.1234) + a/10 = 0
    a, b = np.linalg.solve([[2, -0.1], [-0.1, 8]], [2 * 3.456, 8 * 0.1234])
    how, said = told(tried, space, first=(5.0, 0.0))
    assert how == "differential evolution, then step by step"
    assert tried.best == pytest.approx((a, b), abs=0.02)
    assert said == [
        "searching by differential evolution",
        "searching step by step, 128 trials each",
        "searching step by step, 512 trials each",
        "searching step by step, 2,048 trials each",
    ]


def test_along_the_edge_of_what_is_required():
    """The largest a + b within a² + b² ≤ 1 lies at √½ each; more trials come last."""
    space = Space.of([between("a", 0.0, 1.0), between("b", 0.0, 1.0)], ())
    tried = Exact(lambda a, b: a + b, lambda a, b: 1 - a * a - b * b)
    _how, said = told(tried, space)
    assert said[-1] == "nearer to what is required, 8,192 trials each"
    assert sum(tried.best) == pytest.approx(math.sqrt(2), abs=5e-3)
    assert max(n for n, _ in tried.asked) == 8192
    exact = Exact(lambda a, b: a + b, lambda a, b: 1 - a * a - b * b, edged=False)
    assert told(exact, space)[1][-1] == "searching step by step, 2,048 trials each"


def test_sliding_needs_decisions_of_any_value_and_a_start_that_meets():
    space = Space.of([listed("a", 0.0, 1.0, ordered=True)], ())
    tried = Exact(lambda a: a, lambda a: 1.0)
    start = tried.standings([(0.0,)], 128)[0]
    assert _slide(tried, space, start, 128, 0.1, 10) is start
    fine = Space.of([between("a", 0.0, 1.0)], ())
    missed = Exact(lambda a: a, lambda a: -1.0)
    start = missed.standings([(0.5,)], 128)[0]
    assert _slide(missed, fine, start, 128, 0.1, 10) is start
    met = Exact(lambda a: a, lambda a: 0.8 - a)
    start = met.standings([(0.5,)], 128)[0]
    assert _slide(met, fine, start, 128, 0.1, 40).candidate[0] == pytest.approx(0.8, abs=0.02)


@pytest.mark.parametrize("start", [(0.1, 2.0), (0.9, 5.0)])
def test_steps_become_smaller_until_nothing_near_is_better(start):
    space = Space.of([between("a", 0.0, 1.0), listed("b", *map(float, range(8)), ordered=True)], ())
    tried = Exact(lambda a, b: -((a - 0.437) ** 2) - (b - 3) ** 2)
    best = tried.standings([start], 128)[0]
    end = _step_by_step(tried, space, best, 128, 0.08, 1)
    assert end.candidate[1] == 3
    assert end.candidate[0] == pytest.approx(0.437, abs=0.011)  # half of the finest step, a fiftieth of the range
    finer = _step_by_step(tried, space, end, 128, 0.0025, 1)
    assert finer.candidate[0] == pytest.approx(0.437, abs=0.0011)


def near(space, at, steps):
    return {tuple(each) for each in _neighbours(at, steps, space, np.random.default_rng(1))}


def test_neighbours_of_ordered_decisions():
    space = Space.of([listed("a", *map(float, range(10)), ordered=True)] * 2, ())
    moved = {(a, b) for a in (3, 5, 7) for b in (4, 5, 6)}
    assert near(space, [5, 5], [2, 1]) == moved - {(5, 5)}
    # at an end and one before the other one, where a step of 2 reaches the end
    assert near(space, [0, 8], [2, 2]) == {(a, b) for a in (0, 2) for b in (6, 8, 9)} - {(0, 8)}


@pytest.mark.parametrize(("count", "tried"), [(4, 3), (9, 8), (10, 8), (30, 8)])
def test_neighbours_of_a_list_are_its_other_values(count, tried):
    space = Space.of([listed("a", *map(float, range(count)))], ())
    neighbours = near(space, [1], [1])
    assert len(neighbours) == tried
    assert (1,) not in neighbours


def test_some_pairs_of_many_decisions():
    for count, pairs in ((12, 66), (13, 72)):
        space = Space.of([listed(f"x{number}", 0.0, 1.0, 2.0, ordered=True) for number in range(count)], ())
        assert len(near(space, [1] * count, [1] * count)) == 2 * count + 4 * pairs


def test_better_candidates_have_less_energy():
    def of(goal, slack=1.0, allowed=True):
        space = Space.of([between("a", 0.0, 1.0)], ())
        if not allowed:
            space = type("No", (), {"allows": lambda self, c: False, "excess": lambda self, c: slack})()
        tried = Exact(lambda a: goal, lambda a: slack)
        tried.extend([(0.5,)], 128)
        return _energy(tried, space, (0.5,), 128)

    assert of(5.0) == -5
    missed = [of(5.0, slack) for slack in (-0.1, -3.0, -1e6)]
    order = [of(5.0), of(-1e90), *missed, *(of(5.0, by, allowed=False) for by in (0.0, 2.0))]
    assert order == sorted(order)
    assert len({*order}) == len(order)
    assert math.isfinite(of(math.nan))
    assert of(5.0, -0.1) < of(math.nan) <= of(5.0, 0.0, allowed=False)


@pytest.mark.parametrize(
    ("slack", "beyond"),
    [
        (Measured(3.0), 3.0),
        (Measured(-2.0), -2.0),
        (Measured(math.nan), -1e6),
        (Measured(1.0, np.zeros(0), math.inf), -1e6),
        (Measured(3.0, np.zeros(4), 0.5), 6 - MARGIN),
        (Measured(3.0, np.array([1.0, -1.0])), 3 / 2 - MARGIN),  # √(2 · 2/1)
    ],
)
def test_by_how_many_errors_a_requirement_holds(slack, beyond):
    assert _beyond_margin(slack) == pytest.approx(beyond)
