from __future__ import annotations

import pytest

from xlmc.address import parse_address
from xlmc.definitions.model import Forecast
from xlmc.definitions.stopping import NO_GOAL, stopping
from xlmc.errors import SimulationError
from xlmc.run.stopping import chosen_rule, may_end_early, refuse_other_sampling

CELL = parse_address("A1", "S")
FORECASTS = [Forecast("Delta-V", CELL, CELL), Forecast("Speed", CELL, CELL, central=0.9)]


@pytest.mark.parametrize(
    ("asked", "key", "named"),
    [
        ({"until_accepted": 5}, "accepted", "5 trials"),
        ({"precision": "1%"}, "precision", "of Delta-V and Speed"),
        ({"precision": 1, "precision_of": "sd", "forecasts": " speed"}, "precision", "sd of Speed was"),
        ({"adaptive": 2, "forecasts": ["SPEED", "delta-v", "Speed"]}, "adaptive", "Speed and Delta-V were"),
    ],
)
def test_the_rule_that_was_asked_for(asked, key, named):
    rule = chosen_rule(stopping(**asked), FORECASTS)
    assert rule.key == key
    assert named in rule.goal


def test_none_where_the_run_is_to_run_its_trials():
    assert chosen_rule(NO_GOAL, FORECASTS) is None
    assert chosen_rule(stopping(time_limit=5), FORECASTS) is None


def test_an_unknown_forecast():
    with pytest.raises(SimulationError, match="there is no forecast 'Delta V'") as caught:
        chosen_rule(stopping(precision=1, forecasts="Delta V"), FORECASTS)
    assert caught.value.hint == "choose from 'Delta-V', 'Speed'"


def test_without_forecasts():
    with pytest.raises(SimulationError, match="no forecast whose precision"):
        chosen_rule(stopping(precision=1), [])


@pytest.mark.parametrize("asked", [{"until_accepted": 5}, {"precision": 1}, {"adaptive": 1}, {"time_limit": 1}])
def test_trials_that_belong_together_are_not_parted(asked):
    for sampling in ("lhs", "sobol"):
        assert not may_end_early(sampling)
        refuse_other_sampling(sampling, NO_GOAL)
        with pytest.raises(SimulationError, match=f"a run with {sampling} sampling cannot end before"):
            refuse_other_sampling(sampling, stopping(**asked))
    refuse_other_sampling("mc", stopping(**asked))
