"""What two small books share, and the shortest list of steps that brings them together."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from simulated import simulated

from xlmc.analysis.studies.comparison.causes import (
    Step,
    Variations,
    _narrowed,
    cause_of,
    inputs_of,
    steps_between,
)
from xlmc.montecarlo.model.model import CompiledModel

TRIALS = 300
U = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}


@pytest.fixture
def run(book):
    """`run(inputs, filters, units=…)`: a book of u, v and w in A1 to A3 whose forecast is their sum, and its run."""

    def make(inputs, filters=None, units="", base=None):
        cells = {"A1": 0.5, "A2": 0.5, "A3": 0.5, **(base or {}), "B1": "=A1+A2+A3"}
        made = book(cells, inputs, {"sum": "B1"}, filters or {})
        assumptions = tuple(replace(each, units=units) for each in made.definitions.assumptions)
        definitions = replace(made.definitions, assumptions=assumptions)
        return simulated(CompiledModel(made.workbook, definitions, Path("book.xlsx")), TRIALS, 1)

    return make


def v(low=0.0, high=1.0, **more):
    return {"v": {"cell": "A2", "low": low, "high": high, **more}}


def w(low=0.0, high=1.0, **more):
    return {"w": {"cell": "A3", "low": low, "high": high, **more}}


def test_equal_books_are_alike(run):
    first, second = run(U | v()), run(U | v())
    inputs = inputs_of(first, second)
    assert inputs.alike == ("u", "v")
    assert (inputs.unlike, inputs.frozen_differently, inputs.drawn, inputs.filters) == ((), (), ((), ()), ((), ()))
    assert steps_between(inputs, first, second) == ()


def test_assumptions_that_differ(run):
    inputs = inputs_of(run(U | v()), run(U | v(high=2.0)))
    assert inputs.alike == ("u",)
    ((unlike),) = inputs.unlike
    assert (unlike.name, unlike.first, unlike.second) == ("v", "Uniform: Low 0, High 1", "Uniform: Low 0, High 2")


@pytest.mark.parametrize(
    ("first", "second", "alike"),
    [
        ((("m", 1.0)), (("cm", 100.0)), True),
        ((("m", 1.0)), (("cm", 101.0)), False),
        ((("m", 1.0)), (("s", 1.0)), False),
        ((("m", 1.0)), (("m", 1.0 + 1e-12)), True),  # rounding of units
    ],
)
def test_draws_are_compared_in_one_unit(run, first, second, alike):
    made = [run({"u": {"cell": "A1", "low": 0.0, "high": high}}, units=units) for units, high in (first, second)]
    inputs = inputs_of(*made)
    assert (inputs.alike == ("u",)) is alike
    assert bool(inputs.unlike) is not alike


def test_what_only_one_book_draws_or_holds(run):
    first, second = run(U | v() | w(frozen=True)), run(U | v(frozen=True))
    inputs = inputs_of(first, second)
    assert inputs.drawn == (("v",), ())
    ((held),) = inputs.frozen_differently
    assert (held.name, held.first, held.second) == ("v", "Uniform: Low 0, High 1", "held at 0.5")
    assert inputs_of(second, first).drawn == ((), ("v",))
    assert steps_between(inputs, first, second) == (Step("assumption", 0, "v"),)


@pytest.mark.parametrize(("base", "same"), [(0.5, True), (0.5 + 1e-12, True), (0.6, False)])
def test_values_that_both_hold(run, base, same):
    inputs = inputs_of(run(U | v(frozen=True)), run(U | v(frozen=True), base={"A2": base}))
    assert (inputs.frozen_differently == ()) is same
    assert inputs.drawn == ((), ())


def test_filters_of_one_book(run):
    keeps, rejects = {"cell": "B1", "at_most": 9.0}, {"cell": "B1", "at_most": 1.0}
    first, second = run(U, {"wide": keeps, "both": rejects, "own": rejects}), run(U, {"both": rejects, "wide": rejects})
    inputs = inputs_of(first, second)
    assert inputs.filters == (("wide", "own"), ("wide",))
    # a filter that rejects nothing is no step
    assert steps_between(inputs, first, second) == (Step("filter", 0, "own"), Step("filter", 1, "wide"))


def test_a_distribution_is_swapped_in_one_unit_and_from_no_cell(run):
    first, second = run(U | v()), run(U | v(high=2.0))
    assert steps_between(inputs_of(first, second), first, second) == (Step("distribution", 1, "v"),)
    other = run(U | v(high=2.0), units="m")
    assert steps_between(inputs_of(first, other), first, other) == ()
    of_cell = run(U | v(high="A1"))
    assert steps_between(inputs_of(of_cell, second), of_cell, second) == ()
    assert steps_between(inputs_of(second, of_cell), second, of_cell) == (Step("distribution", 1, "v"),)


def test_what_a_step_is_called():
    assert [Step("filter", 0, "f").word, Step("filter", 0, "f", True).word] == ["filter", "evidence"]


def test_runs_after_steps_are_made_once(run):
    first = run(U | v(), {"low": {"cell": "B1", "at_most": 1.2}})
    second = run(U | v(high=2.0) | w())
    asked = []

    def again(model, name):
        asked.append(name)
        return simulated(model, TRIALS, 1)

    variations = Variations(first, second, again)
    assert variations.pair([]) == (first, second)
    steps = [Step("filter", 0, "low"), Step("assumption", 1, "w"), Step("distribution", 1, "v")]
    mine, theirs = variations.pair(steps)
    assert asked == ["book.xlsx without 'low'", "book.xlsx without 'v', 'w'"]
    assert mine.accepted == TRIALS
    assert theirs.inputs["v"].tolist() == mine.inputs["v"].tolist()
    assert theirs.forecasts["sum"] == pytest.approx(mine.forecasts["sum"])
    assert variations.pair(steps[:1])[0] is mine
    assert len(asked) == 2


F, G, A, B = (Step("filter", 0, "f"), Step("filter", 1, "g"), Step("assumption", 0, "a"), Step("distribution", 1, "b"))


@pytest.mark.parametrize(
    ("needed", "cause"),
    [
        ({F}, (F,)),
        ({F, G}, (F, G)),
        ({A}, (A,)),
        ({A, B}, (A, B)),
        ({F, A}, (F, A)),
        ({F, A, B}, (F, A, B)),
    ],
)
def test_the_shortest_list_of_steps(needed, cause):
    assert {*cause_of([F, G, A, B], lambda steps: 1.0 + len(needed - {*steps}))} == {*cause}


def test_nothing_helps():
    assert cause_of([F, A], lambda steps: 1.01) == ()
    assert cause_of([], lambda steps: 0.0) == ()


def test_filters_come_before_all_else():
    assert cause_of([A, F], lambda steps: 0.5) == (F,)
    assert cause_of([A, B, F], lambda steps: 0.5 if {*steps} & {A, B} else 2.0) in ((A,), (B,))


def test_the_most_effective_step_is_added_first_and_needless_ones_are_left_out():
    """Alone a leaves least, but b and f together need no a."""
    steps = [Step("assumption", 0, name) for name in "abc"]
    a, b, c = steps
    alone = {frozenset([a]): 2.0, frozenset([b]): 3.0, frozenset([c]): 4.0, frozenset(): 9.0}
    left = {**alone, frozenset([a, b]): 1.5, frozenset([b, c]): 0.9, frozenset([a, c]): 1.5, frozenset(steps): 0.5}
    assert cause_of(steps, lambda some: left[frozenset(some)]) == (b, c)


@pytest.mark.parametrize("needed", [{3}, {3, 40}, {0, 25, 49}])
def test_many_steps_are_narrowed_to_twenty(needed):
    steps = [Step("assumption", 0, str(number)) for number in range(50)]
    names = {str(each) for each in needed}
    asked = []

    def left(some):
        asked.append(len(some))
        return 1.0 if names <= {each.name for each in some} else 1.1

    narrowed = _narrowed(steps, left)
    assert len(narrowed) <= 20
    assert names <= {each.name for each in narrowed}
    assert asked[0] == 25  # halves first
    assert _narrowed(steps[:20], left) == steps[:20]
    assert {each.name for each in cause_of(steps, left)} == names


def test_steps_that_are_all_needed_stay():
    steps = [Step("assumption", 0, str(number)) for number in range(21)]
    assert _narrowed(steps, lambda some: 1.0 if len(some) == 21 else 1.1) == steps
