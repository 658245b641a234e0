from __future__ import annotations

import pytest

from xlmc.montecarlo.distributions.spelling import did_you_mean, nearest, plain


@pytest.mark.parametrize("text", ["Std dev", "std_dev", " STD-DEV ", "StdDev", "std \t dev"])
def test_spellings_of_one_name(text):
    assert plain(text) == "stddev"


def test_different_names_stay_different():
    assert plain("Range %") != plain("Range")


@pytest.mark.parametrize(
    ("text", "result"),
    [("Triangel", "Triangular"), ("unifrom", "Uniform"), ("nomal", "Normal"), ("xyz", None), ("", None)],
)
def test_nearest(text, result):
    assert nearest(text, ["Uniform", "Normal", "Triangular", "Trapezoid"]) == result


def test_nearest_can_be_strict():
    assert nearest("Lower", ["Low"], closeness=0.9) is None


def test_hint_names_one_or_lists_all():
    assert did_you_mean("Unform", ["Normal", "Uniform"]) == "Did you mean Uniform?"
    assert did_you_mean("xyz", ["Normal", "Uniform"]) == "Use one of Normal, Uniform"


def test_a_hint_is_one_line():
    assert did_you_mean("xyz", ["initial\nspeed", "weight"]) == "Use one of initial speed, weight"
    assert did_you_mean("inital speed", ["initial\nspeed", "weight"]) == "Did you mean initial speed?"
