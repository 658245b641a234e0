from __future__ import annotations

import pytest

from xlmc.definitions.stopping import AcceptedTrials
from xlmc.run.stopping.accepted import UntilAccepted


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
