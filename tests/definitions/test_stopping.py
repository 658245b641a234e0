from __future__ import annotations

import pytest

from xlmc.definitions.stopping import NO_GOAL, Precision, Stopping, stopping
from xlmc.errors import SimulationError


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, NO_GOAL),
        ({"accepted": 2}, Stopping(accepted=2)),
        ({"tolerance": "1%"}, Stopping(precision=Precision(0.01, True))),
        ({"tolerance": " 2.5 % "}, Stopping(precision=Precision(0.025, True))),
        ({"tolerance": "1e-3"}, Stopping(precision=Precision(0.001))),
        ({"tolerance": 3}, Stopping(precision=Precision(3.0))),
        ({"tolerance": 3, "numbers": "SD, p5"}, Stopping(precision=Precision(3.0, False, ("sd", "p5")))),
        ({"tolerance": 3, "numbers": ["mean", "mean"]}, Stopping(precision=Precision(3.0, False, ("mean",)))),
        ({"tolerance": 3, "confidence": "99%"}, Stopping(precision=Precision(3.0, confidence=0.99))),
        ({"tolerance": 3, "confidence": 90}, Stopping(precision=Precision(3.0, confidence=0.9))),
        ({"tolerance": 3, "confidence": 0.9}, Stopping(precision=Precision(3.0, confidence=0.9))),
        ({"digits": 2, "forecasts": "x"}, Stopping(digits=2, forecasts=("x",))),
        ({"digits": 1, "forecasts": ["x", "y"]}, Stopping(digits=1, forecasts=("x", "y"))),
        ({"seconds": "60s"}, Stopping(seconds=60.0)),
        ({"seconds": "5m"}, Stopping(seconds=300.0)),
        ({"seconds": "5 min"}, Stopping(seconds=300.0)),
        ({"seconds": "1h 30m 2.5s"}, Stopping(seconds=5402.5)),
        ({"seconds": "2H"}, Stopping(seconds=7200.0)),
        ({"seconds": 45}, Stopping(seconds=45.0)),
        ({"accepted": 9, "seconds": 1}, Stopping(accepted=9, seconds=1.0)),
    ],
)
def test_what_is_asked_for(given, expected):
    found = stopping(**given)
    assert found == expected
    assert found.has_goal == bool({"accepted", "tolerance", "digits"} & set(given))
    assert found.asked == bool(given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"accepted": 1}, "1 accepted trials were asked for"),
        ({"accepted": -5}, "-5 accepted trials were asked for"),
        ({"digits": 0}, "0 significant digits"),
        ({"digits": 7}, "7 significant digits"),
        ({"tolerance": "0%"}, "'0%' is no precision"),
        ({"tolerance": -1}, "'-1' is no precision"),
        ({"tolerance": "nan"}, "'nan' is no precision"),
        ({"tolerance": "inf"}, "'inf' is no precision"),
        ({"tolerance": "a lot"}, "'a lot' is no precision"),
        ({"tolerance": 1, "numbers": "median"}, "'median' is no number"),
        ({"tolerance": 1, "numbers": "p100"}, "'p100' is no number"),
        ({"tolerance": 1, "numbers": "p0"}, "'p0' is no number"),
        ({"tolerance": 1, "numbers": ""}, "'' is no number"),
        ({"tolerance": 1, "numbers": []}, "no number was named"),
        ({"tolerance": 1, "confidence": 100}, "'100' is no confidence"),
        ({"tolerance": 1, "confidence": "high"}, "'high' is no confidence"),
        ({"numbers": "mean"}, "how well numbers must be known is not said"),
        ({"confidence": 95}, "how well numbers must be known is not said"),
        ({"forecasts": "x"}, "forecasts to look at are named, but not what for"),
        ({"accepted": 5, "forecasts": "x"}, "forecasts to look at are named, but not what for"),
        ({"accepted": 5, "digits": 1}, "accepted trials and stable digits were both asked for"),
        ({"accepted": 5, "tolerance": 1}, "accepted trials and a precision were both asked for"),
        ({"seconds": 0}, "'0' is no time"),
        ({"seconds": -1}, "'-1' is no time"),
        ({"seconds": "soon"}, "'soon' is no time"),
        ({"seconds": ""}, "'' is no time"),
        ({"seconds": "5d"}, "'5d' is no time"),
    ],
)
def test_what_cannot_be_meant(given, message):
    with pytest.raises(SimulationError) as caught:
        stopping(**given)
    assert message in caught.value.message
    assert caught.value.hint
