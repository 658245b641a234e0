from __future__ import annotations

import itertools

import pytest

from xlmc.definitions.stopping import AcceptedTrials
from xlmc.run.stopping import Stopped, Watch
from xlmc.run.stopping.accepted import UntilAccepted
from xlmc.run.stopping.wording import duration


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
    found = watch(block_of_trials, rule=UntilAccepted(AcceptedTrials(10)), trials=50, seconds=5.0, interrupted_after=4)
    assert (found[0], found[1].by) == (5, "accepted")
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
