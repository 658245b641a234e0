"""Filters that no trial can break, by what is constant and by the ranges of the assumptions."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.model.certain_filters import breakable

CELLS = {
    "A1": 0.5,
    "B1": "=A1*2",
    "C1": "=1=1",
    "C2": "=2",
    "C3": '="yes"',
    "C4": "=1=2",
    "C5": "=0",
    "C6": "=1/0",
}
UNIFORM = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}
NORMAL = {"u": {"cell": "A1", "distribution": "Normal", "mean": 0.5, "std_dev": 0.1}}


@pytest.mark.parametrize(
    ("asked", "may_break"),
    [
        ("C1", False),
        ("C2", False),
        ("C3", True),
        ("C4", True),
        ("C5", True),
        ("C6", True),
        ({"cell": "B1", "at_least": 0.0}, False),
        ({"cell": "B1", "above": 0.0}, True),
        ({"cell": "B1", "above": -0.1}, False),
        ({"cell": "B1", "at_most": 2.0}, False),
        ({"cell": "B1", "below": 2.0}, True),
        ({"cell": "B1", "below": 2.1}, False),
        ({"cell": "B1", "at_least": 0.0, "at_most": 1.9}, True),
        ({"cell": "C2", "at_least": 2.0}, False),
        ({"cell": "C2", "at_least": 2.1}, True),
    ],
    ids=str,
)
def test_a_filter_may_be_broken_unless_all_numbers_that_lead_to_it_hold(book, asked, may_break):
    model = book(CELLS, UNIFORM, {"x": "B1"}, {"f": asked})
    assert [each.name for each in breakable(model)] == ["f"] * may_break


def test_a_distribution_without_ends_may_break_any_limit(book):
    model = book(CELLS, NORMAL, {"x": "B1"}, {"f": {"cell": "B1", "below": 1e9}})
    assert [each.name for each in breakable(model)] == ["f"]


def test_evidence_is_asked_though_every_trial_agrees_with_it(book):
    reading = {"cell": "B1", "reading": 1.0, "plus_minus": 5.0}
    model = book(CELLS, UNIFORM, {"x": "B1"}, {}, None, {"e": reading})
    (filter_,) = model.filters
    assert (filter_.at_least, filter_.at_most) == (-4.0, 6.0)
    assert breakable(model) == (filter_,)
