from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.stopping import LIMIT, stopping
from xlmc.montecarlo.rare.rare_switch import ALWAYS_FIRST, COSTLY_FROM, FIRST_LOOK, RareSwitch, rare_switch

UNIT = {"low": 0, "high": 1}


@pytest.fixture
def model(book):
    return book({"A1": 1.0}, {"a": {"cell": "A1", **UNIT}}, {"x": "A1"}, {"f": {"cell": "A1", "at_least": 0.5}})


def test_plain_trials_are_kept_while_they_will_do():
    looks = RareSwitch(10_000, LIMIT)
    assert not looks.should_search(FIRST_LOOK - 1, 0)
    assert not looks.should_search(FIRST_LOOK, 20)
    assert not looks.should_search(FIRST_LOOK + 1, 0), "the next look is at twice as many"
    assert not looks.should_search(2 * FIRST_LOOK, 40)
    assert looks.should_search(4 * FIRST_LOOK, 10)


def test_they_are_given_up_at_the_first_look_where_it_is_plain():
    assert RareSwitch(10_000, LIMIT).should_search(FIRST_LOOK + 5, 0)


def test_few_wanted_trials_are_waited_for():
    looks = RareSwitch(100, LIMIT)
    turns = [FIRST_LOOK << k for k in range(6) if looks.should_search(FIRST_LOOK << k, 0)]
    assert turns[0] == COSTLY_FROM, "100 · 2²³ is above a sixteenth of 10⁹"


@pytest.mark.parametrize(
    ("accepted", "searches"),
    [
        pytest.param(155, True, id="540 million plain trials"),
        pytest.param(1_100, True, id="67 million still, and 62.5 million for a search"),
        pytest.param(1_200, False, id="61 million still"),
    ],
)
def test_a_search_begins_where_plain_trials_still_need_more_than_it_may_take(accepted, searches):
    looks = RareSwitch(10_000, LIMIT)
    assert not looks.should_search(COSTLY_FROM // 2, accepted // 2), "before, the limit alone decides"
    assert looks.will_do(COSTLY_FROM, accepted)
    assert looks.should_search(COSTLY_FROM, accepted) is searches


def test_after_a_search_that_failed_there_is_no_other():
    looks = RareSwitch(10_000, LIMIT)
    looks.give_up()
    assert not looks.should_search(COSTLY_FROM, 155)


def test_no_search_where_none_is_possible():
    assert not RareSwitch(None, LIMIT).should_search(10 * FIRST_LOOK, 0)


def test_always_is_after_the_prior(model):
    settings = replace(model.definitions.settings, trials=LIMIT, stopping=stopping(until_accepted=10, rare="always"))
    looks = rare_switch(model, settings)
    assert looks.certain
    assert not looks.should_search(ALWAYS_FIRST - 1, 5)
    assert looks.should_search(ALWAYS_FIRST, ALWAYS_FIRST)


REFUSED = [
    ({}, {}, "but not how many trials"),
    ({"until_accepted": 5}, {"engine": "formulas"}, "engine numpy"),
    ({"until_accepted": 5}, {"trials": 100_000}, "the limit is 100,000"),
    ({"until_accepted": 10**7}, {}, "at most 1,000,000"),
]


@pytest.mark.parametrize(("asked", "other", "message"), REFUSED)
def test_a_search_that_cannot_be_made_is_refused(model, asked, other, message):
    usual = {"trials": LIMIT} | other
    settings = replace(model.definitions.settings, stopping=stopping(**asked, rare="always"), **usual)
    with pytest.raises(SimulationError, match=message):
        rare_switch(model, settings)


def test_without_filters_there_is_nothing_to_search_for(book):
    model = book({"A1": 1.0}, {"a": {"cell": "A1", **UNIT}}, {"x": "A1"}, {})
    settings = replace(model.definitions.settings, trials=LIMIT, stopping=stopping(until_accepted=5, rare="always"))
    with pytest.raises(SimulationError, match="no filters"):
        rare_switch(model, settings)
    settings = replace(settings, stopping=stopping(until_accepted=5))
    assert not rare_switch(model, settings).should_search(FIRST_LOOK, 0)


def test_too_many_assumptions_are_not_searched(book, monkeypatch):
    monkeypatch.setattr("xlmc.montecarlo.rare.rare_switch.MOST_ASSUMPTIONS", 0)
    model = book({"A1": 1.0}, {"a": {"cell": "A1", **UNIT}}, {"x": "A1"}, {"f": {"cell": "A1", "at_least": 0.5}})
    settings = replace(model.definitions.settings, trials=LIMIT, stopping=stopping(until_accepted=5))
    assert not rare_switch(model, settings).should_search(FIRST_LOOK, 0)


def test_only_three_ways():
    with pytest.raises(SimulationError, match="sometimes"):
        stopping(until_accepted=5, rare="sometimes")
