"""What was changed in the window, as plain values: set, set back, kept in a file, and fitted to a changed workbook."""

from __future__ import annotations

import json

import pytest
from live_books import book_of_decisions, book_of_readings

from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjustments import (
    NONE,
    PARTS,
    Adjustments,
    assumption_numbers,
    is_choice,
    is_own,
    measured_numbers,
    movable_limits,
    numbers_of,
    own_values,
)

OWN = Adjustments()
EACH = [
    ("assumption", "v", "mean", 31.0),
    ("filter", "possible", "at_most", 70.0),
    ("forecast", "speed", "threshold", 30.0),
    ("correlation", "v and t", "correlation", 0.5),
    ("decision", "limit", "value", 60.0),
    ("solve", "stops", "to", 30.0),
]


@pytest.fixture(scope="module")
def readings(tmp_path_factory):
    return load(book_of_readings(tmp_path_factory.mktemp("readings") / "readings.xlsx")).definitions


@pytest.fixture(scope="module")
def decisions(tmp_path_factory):
    return load(book_of_decisions(tmp_path_factory.mktemp("decisions") / "decisions.xlsx")).definitions


def test_nothing_is_changed():
    assert not OWN
    assert [*OWN.each()] == []


@pytest.mark.parametrize("row", EACH, ids=[row[0] for row in EACH])
def test_one_value_is_set_and_set_back(row):
    of, name, key, value = row
    changed = OWN.having(*row)
    assert changed
    assert [*changed.each()] == [row]
    assert getattr(changed, PARTS[of]) == {name: {key: value}}
    assert changed.having(of, name, key, value + 1) == OWN.having(of, name, key, value + 1)
    assert changed.having(of, name, key, None) == OWN
    assert changed.without(of, name) == OWN
    assert changed.without(of, "another") == changed


def test_other_values_and_rows_stay():
    changed = OWN.having("assumption", "v", "mean", 31.0).having("assumption", "t", "low", 1.0)
    changed = changed.having("assumption", "v", "std_dev", 3.0)
    assert changed.assumptions == {"v": {"mean": 31, "std_dev": 3}, "t": {"low": 1}}
    assert changed.having("assumption", "v", "mean", None).assumptions == {"v": {"std_dev": 3}, "t": {"low": 1}}
    assert changed.without("assumption", "v").assumptions == {"t": {"low": 1}}


def test_values_written_to_a_file_are_read_back():
    changed = OWN
    for row in EACH:
        changed = changed.having(*row)
    changed = changed.having("filter", "possible", "at_least", NONE).having("filter", "possible", "used", False)
    changed = changed.having("assumption", "t", "kind", "Normal").having("assumption", "t", "frozen", True)
    assert Adjustments.of_json(json.loads(json.dumps(changed.as_json()))) == changed


def test_a_file_of_an_earlier_version_has_assumptions_and_filters_alone():
    written = {"assumptions": {"v": {"mean": 31}}, "filters": {}}
    assert Adjustments.of_json(written) == OWN.having("assumption", "v", "mean", 31.0)
    for part in ("assumptions", "filters"):
        with pytest.raises(KeyError):
            Adjustments.of_json({each: {} for each in written if each != part})


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("mean", "none", "could not convert"),
        ("mean", "nan", "mean is nan"),
        ("mean", 1e999, "mean is inf"),
        ("kind", "Cauchy", "no kind 'Cauchy'"),
        ("kind", 3, "no kind 3"),
    ],
)
def test_a_file_with_something_else(key, value, message):
    with pytest.raises(ValueError, match=message):
        Adjustments.of_json({"assumptions": {"v": {key: value}}, "filters": {}})


def test_what_a_changed_workbook_no_longer_has_or_has_itself_is_dropped(readings):
    kept = OWN.having("assumption", "v", "mean", 31.0).having("filter", "possible", "at_most", NONE)
    changed = kept.having("assumption", "v", "std_dev", 4.0)  # as in the workbook
    changed = changed.having("assumption", "gone", "mean", 1.0).having("assumption", "t", "mean", 1.0)
    changed = changed.having("forecast", "distance", "threshold", NONE).having("filter", "gone", "at_most", 1.0)
    assert changed.only(readings) == kept


def test_a_number_of_another_kind_is_kept_with_its_kind(readings):
    other = OWN.having("assumption", "t", "kind", "Normal").having("assumption", "t", "mean", 2.1)
    assert other.only(readings) == other
    assert other.kind("assumption", "t") == "Normal"
    assert other.kind("filter", "t") is None
    assert other.kind("assumption", "v") is None
    assert other.having("assumption", "t", "kind", None).only(readings) == OWN


def test_another_kind_keeps_what_is_no_number_of_a_kind():
    given = {"mean": 2.1, "base": 2.0, "frozen": True, "band_low": 5.0, "kind": "Normal"}
    changed = Adjustments(assumptions={"t": given, "v": {"mean": 1.0}})
    kept = {"base": 2.0, "frozen": True, "band_low": 5.0}
    assert changed.in_kind("t", "Triangular").assumptions["t"] == {"kind": "Triangular", **kept}
    assert changed.in_kind("t", None).assumptions == {"v": {"mean": 1}, "t": kept}


def test_the_part_that_is_typed_first():
    changed = OWN
    for row in EACH:
        changed = changed.having(*row)
    assert [of for of, *_ in changed.typed_part().each()] == ["decision", "solve"]
    assert [of for of, *_ in changed.untyped_part().each()] == ["assumption", "filter", "forecast", "correlation"]


@pytest.mark.parametrize(
    ("given", "frozen", "numbers"),
    [
        ({"frozen": True, "base": 31.0, "mean": 30.5}, {"frozen": True, "base": 31}, {}),
        ({"base": 31.0, "mean": 30.5}, {}, {"mean": 30.5}),  # drawn: its value has no effect
        ({"frozen": False, "mean": 30.5}, {}, {"mean": 30.5}),
    ],
)
def test_what_is_held_and_what_is_drawn(readings, given, frozen, numbers):
    changed = Adjustments(assumptions={"v": given})
    assert changed.frozen_part(readings).assumptions.get("v", {}) == frozen
    assert changed.numbers(readings).assumptions.get("v", {}) == numbers


@pytest.mark.parametrize(
    ("name", "given", "frozen", "numbers"),
    [
        ("possible", {"used": False, "at_most": 70.0}, {"used": False}, {}),
        ("possible", {"used": True, "at_most": 70.0}, {}, {"at_most": 70}),
        ("possible", {"at_most": 70.0}, {}, {"at_most": 70}),
        ("doubtful", {"used": True, "reading": 60.0}, {"used": True}, {"reading": 60}),
        ("doubtful", {"reading": 60.0}, {}, {}),
    ],
)
def test_which_rows_are_used(readings, name, given, frozen, numbers):
    changed = Adjustments(filters={name: given})
    assert changed.frozen_part(readings).filters.get(name, {}) == frozen
    assert changed.numbers(readings).filters.get(name, {}) == numbers


def test_forecasts_and_correlations_are_numbers(readings):
    changed = OWN.having(*EACH[2]).having(*EACH[3])
    assert changed.numbers(readings) == changed
    assert not changed.frozen_part(readings)


@pytest.mark.parametrize(
    ("of", "name", "values"),
    [
        ("filter", "possible", {"at_least": 0, "at_most": 80, "used": True}),
        ("filter", "laser", {"reading": 30, "percent": 12, "resolution": 0.5, "used": True}),
        ("filter", "doubtful", {"reading": 55, "std_dev": 8, "used": False}),
        ("filter", "gone", {}),
        ("forecast", "speed", {"threshold": 35, "central": 51}),
        ("forecast", "distance", {"threshold": None, "central": 90}),
        ("forecast", "gone", {}),
        ("correlation", "v and t", {}),
        ("decision", "limit", {}),
        ("solve", "stops", {}),
        ("assumption", "gone", {}),
        (
            "assumption", "t",
            {"kind": "Uniform", "low": 1.5, "high": 2.5, "band_low": 0, "band_high": 100, "base": 2, "frozen": False},
        ),
        (
            "assumption", "v",
            {
                "kind": "Normal", "mean": 30, "std_dev": 4, "lower_cutoff": 20, "upper_cutoff": 38,
                "band_low": 0, "band_high": 100, "base": 30, "frozen": False,
            },
        ),
    ],
)  # fmt: skip
def test_what_a_workbook_says_of_a_row(readings, of, name, values):
    assert own_values(readings, of, name) == values


def test_what_a_workbook_says_of_decisions_and_of_what_is_solved_for(decisions):
    assert own_values(decisions, "decision", "limit") == {"value": 50}
    assert own_values(decisions, "solve", "stops") == {"to": 40, "low": 0}
    assert "kind" not in own_values(decisions, "assumption", "friction")  # a formula says what it is
    of_kind = own_values(decisions, "assumption", "reaction", "Triangular")
    assert {key: of_kind[key] for key in ("low", "likeliest", "high")} == {"low": 1, "likeliest": 1.5, "high": 2}


@pytest.mark.parametrize(
    ("of", "name", "value", "fits"),
    [
        ("decision", "road", 1.0, True),
        ("decision", "road", 3.0, False),
        ("decision", "road", 0.5, False),
        ("decision", "road", None, True),
        ("decision", "limit", 33.0, True),
        ("filter", "road", 3.0, True),
    ],
)
def test_a_decision_among_texts_has_one_of_them(decisions, of, name, value, fits):
    assert is_choice(decisions, of, name, value) is fits


@pytest.mark.parametrize(
    ("value", "own", "same"), [(1.0, 1.0, True), (1.0, 2.0, False), (NONE, None, True), (NONE, 1.0, False)]
)
def test_a_value_is_what_the_workbook_says(value, own, same):
    assert is_own(value, own) is same


def test_numbers_of_rows(readings):
    v, t = readings.assumptions
    assert assumption_numbers(t) == {"low": ("Low", 1.5), "high": ("High", 2.5)}
    assert assumption_numbers(v)["lower_cutoff"] == ("Lower cutoff", 20)
    assert movable_limits(readings.filters[0]) == {"at_least": 0, "at_most": 80}
    assert movable_limits(next(each for each in readings.filters if each.name == "laser")) == {}
    assert measured_numbers(readings.evidence[1]) == {"reading": 30, "percent": 12, "resolution": 0.5}
    assert numbers_of({"at_most": NONE, "at_least": 3}) == {"at_most": None, "at_least": 3.0}
