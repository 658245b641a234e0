"""Blocks without a simulation; Ctrl-C as a program that was started in the foreground takes it."""

from __future__ import annotations

import signal
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest


@pytest.fixture(autouse=True)
def usual_handler():
    """A shell that starts the tests in the background lets them ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@dataclass(frozen=True)
class Seen:
    """What a rule sees of a block."""

    trials: int
    accepted: np.ndarray
    forecasts: list


@pytest.fixture(scope="session")
def block():
    """`block(values, …)`: a block in which every trial is accepted, with the values of each forecast."""

    def make(*columns, start=0):
        columns = [np.asarray(column, np.float64) for column in columns]
        return Seen(columns[0].size, np.arange(start, start + columns[0].size), columns)

    return make


@pytest.fixture(scope="session")
def block_of_trials():
    """`block_of_trials(100, [103, 107])`: 10 trials from the 100th on, of which these are accepted."""

    def make(start, accepted, trials=10):
        return Seen(trials, np.array(accepted, np.int64), [np.zeros(len(accepted))])

    return make


def joined(columns, place):
    return np.concatenate(columns[place])


@pytest.fixture(scope="session")
def run_rule():
    """`run_rule(rule, blocks)`: blocks are taken until the rule ends the run; how many, and the columns by then."""

    def run(rule, blocks):
        columns, start = {}, 0
        for number, seen in enumerate(blocks, 1):
            assert rule.counting(seen, start) == seen.trials
            start += seen.trials
            for place, column in enumerate(seen.forecasts):
                columns.setdefault(place, []).append(column)
            if rule.reached(seen, partial(joined, columns)):
                return number, [joined(columns, place) for place in columns]
        return None, [joined(columns, place) for place in columns]

    return run
