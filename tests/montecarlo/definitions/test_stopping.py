from __future__ import annotations

import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.stopping import NO_GOAL, AcceptedTrials, Precision, StableDigits, Stopping, stopping


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, NO_GOAL),
        ({"until_accepted": 2}, Stopping(AcceptedTrials(2))),
        ({"precision": "1%"}, Stopping(Precision(0.01, True))),
        ({"precision": " 2.5 % "}, Stopping(Precision(0.025, True))),
        ({"precision": "1e-3"}, Stopping(Precision(0.001))),
        ({"precision": 3}, Stopping(Precision(3.0))),
        ({"precision": 3, "precision_of": "SD, p5"}, Stopping(Precision(3.0, False, ("sd", "p5")))),
        ({"precision": 3, "precision_of": ["mean", "mean"]}, Stopping(Precision(3.0, False, ("mean",)))),
        ({"precision": 3, "confidence": "99%"}, Stopping(Precision(3.0, confidence=0.99))),
        ({"precision": 3, "confidence": 90}, Stopping(Precision(3.0, confidence=0.9))),
        ({"precision": 3, "confidence": 0.9}, Stopping(Precision(3.0, confidence=0.9))),
        ({"adaptive": 2, "forecasts": "x"}, Stopping(StableDigits(2), forecasts=("x",))),
        ({"adaptive": 1, "forecasts": ["x", "y"]}, Stopping(StableDigits(1), forecasts=("x", "y"))),
        ({"time_limit": "60s"}, Stopping(seconds=60.0)),
        ({"time_limit": "5m"}, Stopping(seconds=300.0)),
        ({"time_limit": "5 min"}, Stopping(seconds=300.0)),
        ({"time_limit": "1h 30m 2.5s"}, Stopping(seconds=5402.5)),
        ({"time_limit": "2H"}, Stopping(seconds=7200.0)),
        ({"time_limit": 45}, Stopping(seconds=45.0)),
        ({"until_accepted": 9, "time_limit": 1}, Stopping(AcceptedTrials(9), seconds=1.0)),
    ],
)
def test_what_is_asked_for(given, expected):
    result = stopping(**given)
    assert result == expected
    assert result.has_goal == bool({"until_accepted", "precision", "adaptive"} & set(given))
    assert result.asked == bool(given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"until_accepted": 1}, "1 accepted trials were asked for"),
        ({"until_accepted": -5}, "-5 accepted trials were asked for"),
        ({"adaptive": 0}, "0 significant digits"),
        ({"adaptive": 7}, "7 significant digits"),
        ({"precision": "0%"}, "'0%' is not a precision"),
        ({"precision": -1}, "'-1' is not a precision"),
        ({"precision": "nan"}, "'nan' is not a precision"),
        ({"precision": "inf"}, "'inf' is not a precision"),
        ({"precision": "a lot"}, "'a lot' is not a precision"),
        ({"precision": 1, "precision_of": "median"}, "'median' is not a number"),
        ({"precision": 1, "precision_of": "p100"}, "'p100' is not a number"),
        ({"precision": 1, "precision_of": "p0"}, "'p0' is not a number"),
        ({"precision": 1, "precision_of": ""}, "'' is not a number"),
        ({"precision": 1, "precision_of": []}, "no number was named"),
        ({"precision": 1, "confidence": 100}, "'100' is not a confidence level"),
        ({"precision": 1, "confidence": "high"}, "'high' is not a confidence level"),
        ({"precision_of": "mean"}, "no precision was given"),
        ({"confidence": 95}, "no precision was given"),
        ({"forecasts": "x"}, "orecasts are named, and no precision or stable digits are asked for of them"),
        (
            {"until_accepted": 5, "forecasts": "x"},
            "orecasts are named, and no precision or stable digits are asked for of them",
        ),
        ({"until_accepted": 5, "adaptive": 1}, "accepted trials and stable digits were both asked for"),
        ({"until_accepted": 5, "precision": 1}, "accepted trials and a precision were both asked for"),
        ({"time_limit": 0}, "'0' is not a length of time"),
        ({"time_limit": -1}, "'-1' is not a length of time"),
        ({"time_limit": "soon"}, "'soon' is not a length of time"),
        ({"time_limit": ""}, "'' is not a length of time"),
        ({"time_limit": "5d"}, "'5d' is not a length of time"),
    ],
)
def test_what_cannot_be_meant(given, message):
    with pytest.raises(SimulationError) as caught:
        stopping(**given)
    assert message in caught.value.message
    assert caught.value.hint


def test_too_many_accepted_trials_are_refused_with_what_to_give():
    with pytest.raises(SimulationError) as caught:
        stopping(until_accepted=10**12 + 1)
    assert caught.value.hint == "Give 2 to 1,000,000,000,000"


def test_what_no_goal_has_is_a_mistake_of_the_program():
    with pytest.raises(TypeError, match="unexpected keyword argument 'boredom'"):
        stopping(until_accepted=5, boredom=5)


def test_whole_numbers_stay_whole():
    assert type(stopping(until_accepted=1e4).goal.number) is int
