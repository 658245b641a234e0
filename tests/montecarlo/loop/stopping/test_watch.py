from __future__ import annotations

import itertools
import signal
import threading

import pytest

from xlmc.errors import SimulationError
from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.stopping import NO_GOAL, AcceptedTrials, stopping
from xlmc.montecarlo.loop.stopping import (
    Interruption,
    Stopped,
    Watch,
    chosen_rule,
    may_end_early,
    refuse_other_sampling,
)
from xlmc.montecarlo.loop.stopping.rule import UntilAccepted
from xlmc.montecarlo.model.plain_words import duration


def watch(block_of_trials, *, rule=None, trials=100, seconds=None, interrupted_after=10**9):
    """What ends a run of 10 trials a second, one block each, of which every fifth trial is accepted."""
    clock = itertools.count()
    watching = Watch(rule, trials, seconds, lambda: float(next(clock)))
    for number in itertools.count():
        start = 10 * number
        block = block_of_trials(start, [start, start + 5])
        stopped = watching.after(block, None, interrupted=number >= interrupted_after)
        if stopped is not None:
            return number + 1, stopped
    return None


def test_it_runs_its_trials(block_of_trials):
    assert watch(block_of_trials) == (10, Stopped("trials", "all trials were run"))


def test_the_time_ends_it(block_of_trials):
    blocks, stopped = watch(block_of_trials, seconds=3.0)
    assert (blocks, stopped) == (3, Stopped("time", "the time limit of 3 s was reached"))
    assert stopped.reached


def test_the_goal_ends_it(block_of_trials):
    blocks, stopped = watch(block_of_trials, rule=UntilAccepted(AcceptedTrials(6)))
    assert (blocks, stopped.by, stopped.sentence, stopped.reached) == (3, "accepted", "6 trials were accepted", True)


@pytest.mark.parametrize(
    ("more", "by", "limit"),
    [
        ({"trials": 50}, "trials", "the limit of 50 trials was reached"),
        ({"seconds": 2.0}, "time", "the time limit of 2 s was reached"),
        ({"interrupted_after": 4}, "interruption", "it was interrupted"),
    ],
)
def test_a_limit_ends_it_before_its_goal(block_of_trials, more, by, limit):
    _, stopped = watch(block_of_trials, rule=UntilAccepted(AcceptedTrials(1000)), **more)
    assert stopped.by == by
    assert not stopped.reached
    assert stopped.sentence == f"{limit} before 1,000 trials were accepted"


def test_the_goal_comes_first_where_several_end_it_at_once(block_of_trials):
    result = watch(block_of_trials, rule=UntilAccepted(AcceptedTrials(10)), trials=50, seconds=5.0, interrupted_after=4)
    assert (result[0], result[1].by) == (5, "accepted")
    assert watch(block_of_trials, trials=50, seconds=5.0, interrupted_after=4)[1].by == "trials"


def test_how_much_is_done(block_of_trials):
    watching = Watch(UntilAccepted(AcceptedTrials(8)), 1000, None, lambda: 0.0)
    watching.after(block_of_trials(0, [0, 5]), None)
    assert watching.share == 0.25
    watching = Watch(None, 40, None, lambda: 0.0)
    watching.after(block_of_trials(0, [0, 5]), None)
    assert watching.share == 0.25
    times = iter([0.0, 1.0, 3.0])
    watching = Watch(None, 10**6, 4.0, lambda: next(times))
    watching.after(block_of_trials(0, []), None)
    assert watching.share == 0.75


@pytest.mark.parametrize(("seconds", "words"), [(1, "1 s"), (90, "1 min 30 s"), (7200, "2 h"), (0.25, "0.25 s")])
def test_durations(seconds, words):
    assert duration(seconds) == words


def feed(rule, blocks):
    """The trials that count, and those of them accepted, when the rule ends the run."""
    trials = accepted = 0
    for block in blocks:
        counting = rule.counting(block, trials)
        kept = type(block)(counting, block.accepted[block.accepted < trials + counting], block.forecasts)
        trials, accepted = trials + counting, accepted + kept.accepted.size
        if rule.reached(kept, None):
            return trials, accepted
    return None


BLOCKS = [(0, [3, 7]), (10, []), (20, [20, 21, 29]), (30, [30]), (40, list(range(40, 50)))]


@pytest.mark.parametrize(
    ("wanted", "trials"), [(2, 8), (3, 21), (4, 22), (5, 30), (6, 31), (7, 41), (15, 49), (16, 50)]
)
def test_the_run_ends_with_the_trial_that_was_waited_for(block_of_trials, wanted, trials):
    assert feed(UntilAccepted(AcceptedTrials(wanted)), [block_of_trials(*given) for given in BLOCKS]) == (
        trials,
        wanted,
    )


def test_too_few_end_nothing(block_of_trials):
    assert feed(UntilAccepted(AcceptedTrials(17)), [block_of_trials(*given) for given in BLOCKS]) is None


def test_how_far_it_is(block_of_trials):
    rule = UntilAccepted(AcceptedTrials(8))
    assert rule.share == 0.0
    feed(rule, [block_of_trials(*given) for given in BLOCKS[:2]])
    assert rule.share == 0.25
    assert rule.goal == "8 trials were accepted"
    assert UntilAccepted(AcceptedTrials(10**6)).goal == "1,000,000 trials were accepted"


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
    with pytest.raises(SimulationError, match="There is no forecast 'Delta V'") as caught:
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
        with pytest.raises(SimulationError, match=f"A run with {sampling} sampling cannot end before"):
            refuse_other_sampling(sampling, stopping(**asked))
    refuse_other_sampling("mc", stopping(**asked))


def press():
    signal.raise_signal(signal.SIGINT)


def test_the_first_is_noted_where_there_is_something_to_keep():
    with Interruption(wanted=True) as interruption:
        interruption.keeping = True
        assert not interruption.asked
        press()
        assert interruption.asked
        with pytest.raises(KeyboardInterrupt):
            press()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_with_nothing_to_keep_it_is_an_error_at_once():
    with Interruption(wanted=True), pytest.raises(KeyboardInterrupt):
        press()


def test_where_it_is_not_wanted_nothing_changes():
    with Interruption(wanted=False) as interruption:
        interruption.keeping = True
        with pytest.raises(KeyboardInterrupt):
            press()


def test_where_it_is_ignored_it_stays_so():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with Interruption(wanted=True) as interruption:
        interruption.keeping = True
        press()
        assert not interruption.asked
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_other_threads_hear_no_signals():
    result = []

    def enter():
        with Interruption(wanted=True):
            result.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert result == [signal.default_int_handler]
