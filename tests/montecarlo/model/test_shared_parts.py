"""What a changed model may share: programs for wider ranges, and nodes where only numbers are others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.excel.address import Cell
from xlmc.montecarlo.model.shared_parts import asks_for_the_same, hull


@pytest.mark.parametrize(
    ("first", "second", "result"),
    [
        ((1.0, 3.0), (1.5, 2.0), (1.0, 3.0)),  # it holds already
        ((1.0, 3.0), (1.0, 3.0), (1.0, 3.0)),
        ((1.0, 3.0), (0.5, 3.0), (0.0, 5.5)),  # 2.5 wide, as much more on both sides, and not beyond 0
        ((1.0, 3.0), (2.0, 4.0), (0.0, 7.0)),
        ((10.0, 11.0), (9.0, 11.0), (7.0, 13.0)),
        ((-3.0, -1.0), (-3.0, -0.5), (-5.5, 0.0)),
        ((-3.0, -1.0), (-3.5, -1.0), (-6.0, 0.0)),
        ((-1.0, 1.0), (-1.0, 2.0), (-4.0, 5.0)),
        ((0.0, 1.0), (0.0, 2.0), (0.0, 4.0)),
        ((-1.0, 0.0), (-2.0, 0.0), (-4.0, 0.0)),
    ],
)
def test_a_range_that_was_moved_is_given_room(first, second, result):
    assert hull({"a": first, "b": (0.0, 1.0)}, {"a": second, "c": (0.0, 1.0)}) == {"a": result}


CELLS = {"A1": 1.0, "A2": 2.0, "A3": 0.5, "B1": "=A1+A2", "B2": "=A1*A2"}
GIVEN = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": "A3"}}


@pytest.fixture
def own(book):
    return book(CELLS, GIVEN, {"x": "B1"}, {"f": {"cell": "B2", "below": 1.0}}).definitions


def changed(definitions, name, **new):
    result = [replace(each, **new) if each.name == name else each for each in definitions.assumptions]
    return replace(definitions, assumptions=tuple(result))


CHANGES = {
    "nothing": (lambda d: d, True),
    "the range of an assumption": (lambda d: changed(d, "a", given={"low": 0.0, "high": 2.0}), True),
    "the family": (lambda d: changed(d, "a", distribution="Normal", given={"mean": 0.0, "std_dev": 1.0}), True),
    "the base of a drawn one": (lambda d: changed(d, "a", base=7.0), True),
    "the limit of a filter": (lambda d: replace(d, filters=(replace(d.filters[0], below=2.0),)), True),
    "the threshold": (lambda d: replace(d, forecasts=(replace(d.forecasts[0], threshold=1.0),)), True),
    "the central range": (lambda d: replace(d, forecasts=(replace(d.forecasts[0], central=0.9),)), True),
    "an assumption is frozen": (lambda d: changed(d, "a", frozen=True), False),
    "its cell": (lambda d: changed(d, "a", cell=Cell("S", 2, 1)), False),
    "its parameter's cell": (lambda d: changed(d, "b", given={"low": 0.0, "high": Cell("S", 1, 1)}), False),
    "one assumption less": (lambda d: replace(d, assumptions=d.assumptions[:1]), False),
    "the forecast's cell": (lambda d: replace(d, forecasts=(replace(d.forecasts[0], cell=Cell("S", 2, 2)),)), False),
    "no forecast": (lambda d: replace(d, forecasts=()), False),
    "no filter": (lambda d: replace(d, filters=()), False),
    "the limit is a cell": (lambda d: replace(d, filters=(replace(d.filters[0], below=Cell("S", 3, 1)),)), False),
    "a filter of one forecast": (lambda d: replace(d, forecast_filters=d.filters), False),
    "checks": (lambda d: replace(d, checks=(object(),)), False),
    "rewritten formulas": (lambda d: replace(d, rewritten=dict(d.rewritten)), False),
}


@pytest.mark.parametrize("what", CHANGES)
def test_only_numbers_may_be_others(own, what):
    change, same = CHANGES[what]
    assert asks_for_the_same(own, change(own), {"a", "b"}) is same


def test_the_base_of_one_that_is_not_drawn_counts(own):
    assert not asks_for_the_same(own, changed(own, "a", base=7.0), {"b"})
