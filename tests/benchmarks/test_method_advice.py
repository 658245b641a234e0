from __future__ import annotations

import json

import pytest
from method_advice import BOOKS, PAGE, RESULTS, faults, other_today, table

RECORDS = json.loads(RESULTS.read_text(encoding="utf-8"))


def test_the_committed_advice_does_not_change_with_the_seed():
    assert faults(RECORDS) == []
    assert set(RECORDS) <= set(BOOKS)


def test_the_page_shows_the_committed_records():
    assert table(RECORDS) in PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("changed", "fault"),
    [
        ({"recommended": "lhs"}, "recommends ['lhs', 'mc']"),
        ({"recommended": None}, "recommends ['None', 'mc']"),
        ({"never": ["mc"]}, "says that ['mc'] never come to it"),
        ({"cheapest": ["taylor-1"]}, "no method is among the cheapest with every seed"),
    ],
)
def test_what_counts_as_a_fault(changed, fault):
    sound = {"recommended": "mc", "trials": 1, "cheapest": ["mc", "lhs"], "seconds": {}, "never": [], "cannot tell": []}
    assert faults({"b": {"1": sound, "2": sound}}) == []
    assert faults({"b": {"1": sound, "2": {**sound, **changed}}}) == [f"b: {fault}"]


@pytest.mark.parametrize(
    ("seconds", "message"),
    [
        ({"mc": 0.2, "lhs": 0.15, "mc/jit": 0.01}, []),
        ({"mc": 2.0, "lhs": 1.9, "mc/jit": 0.5}, ["b, seed 1: mc/jit instead of mc"]),
        ({"mc": 2.0, "lhs": 0.9, "mc/jit": 0.5}, ["b, seed 1: lhs instead of mc"]),
        ({}, []),
    ],
)
def test_what_the_present_rule_would_recommend(seconds, message):
    assert other_today({"b": {"1": {"recommended": "mc", "seconds": seconds}}}) == message
