"""Sentences of the recommendation, for studies that need no run."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from xlmc.analysis.studies.methods.recommendation import _names, _once_text, _unknown_text, _upwards


def curve(name, errors="once"):
    return SimpleNamespace(method=SimpleNamespace(name=name, errors=errors))


@pytest.mark.parametrize(
    ("methods", "expected"),
    [
        ([], []),
        ([("Taylor", "no"), ("bounds", "unknown")], []),
        ([("Taylor", "yes"), ("bounds", "no")], ["Taylor is near enough, and needs no draws at all"]),
        ([("Taylor", "yes"), ("bounds", "yes")], ["Taylor and bounds are near enough, and need no draws at all"]),
    ],
)
def test_methods_that_need_no_draws(methods, expected):
    result = _once_text([(curve(name), SimpleNamespace(reaches=reaches)) for name, reaches in methods])
    assert result == [f"{text}; only the reference shows that." for text in expected]


@pytest.mark.parametrize(("names", "text"), [("a", "a"), ("ab", "a and b"), ("abc", "a, b and c")])
def test_lists_of_methods(names, text):
    assert _names([curve(name) for name in names]) == text


@pytest.mark.parametrize(
    ("trials", "rounded"), [(1.0, 1), (9.4, 10), (99.0, 99), (101.0, 110), (100.0, 100), (383_000.0, 390_000)]
)
def test_trials_are_rounded_up_to_two_digits(trials, rounded):
    assert _upwards(trials) == rounded


@pytest.mark.parametrize(
    ("errors", "text"),
    [("independent", "too few of them gave a number for the mean of x"), ("floor", "more trials do not remove all")],
)
def test_what_runs_cannot_tell(errors, text):
    assert text in _unknown_text(curve("it", errors), SimpleNamespace(statistic="mean", forecast="x"))
