"""What a person is told of a model before it is run, and words and names that messages need."""

from __future__ import annotations

import pytest

from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.model.keywords import assumption_named, forecast_named, keyword
from xlmc.montecarlo.model.model_notices import example_notices
from xlmc.montecarlo.model.plain_words import be, duration, list_of

UNIT = {"low": 0, "high": 1}
SAME = {"low": 1, "high": 1}
CELLS = {"A1": 1.0, "A2": 2.0, "B1": "=A1+1", "B2": "=A2*2", "B3": "=3", **{f"C{n}": f"=A2+{n}" for n in range(1, 8)}}


def said(model):
    return [str(notice) for notice in model.notices if "var" in str(notice)]


def at(row):
    return Cell("S", row, 1)


@pytest.mark.parametrize(
    ("assumptions", "forecasts", "message"),
    [
        ({"a": {"cell": "A1", **UNIT}}, {"x": "B1"}, []),
        (
            {"a": {"cell": "A1", **UNIT}},
            {"x": "B1", "y": "B2"},
            ["S!B2: The forecast 'y' does not vary: no assumption with a range reaches it"],
        ),
        (
            {"a": {"cell": "A1", **UNIT}},
            {"x": "B1", "y": "B2", "z": "B3"},
            ["S!B2: The forecasts 'y' and 'z' do not vary: no assumption with a range reaches them"],
        ),
        (
            {"a": {"cell": "A1", **UNIT}},
            {"x": "B1", **{f"c{n}": f"C{n}" for n in range(1, 5)}},
            ["S!C1: The forecasts 'c1', 'c2', 'c3' and 'c4' do not vary: no assumption with a range reaches them"],
        ),
        (
            {"a": {"cell": "A1", **UNIT}},
            {"x": "B1", **{f"c{n}": f"C{n}" for n in range(1, 7)}},
            [
                "S!C1: The forecasts 'c1', 'c2', 'c3', 'c4' and 2 more do not vary: no assumption with a range "
                "reaches them"
            ],
        ),
        (
            {"a": {"cell": "A1", **SAME}, "b": {"cell": "A2", **UNIT}},
            {"x": "B1", "y": "B2"},
            ["S!B1: The forecast 'x' does not vary: no assumption with a range reaches it"],
        ),
        (
            {"a": {"cell": "A1", **SAME}},
            {"x": "B1"},
            [
                "S!B1: Nothing varies: the range of every assumption that is drawn has a single value, so every trial "
                "gives the base case again"
            ],
        ),
        (
            {"a": {"cell": "A1", "frozen": True, **UNIT}},
            {"x": "B1"},
            [
                "S!B1: Nothing varies: no assumption is drawn, as when all are Frozen, so every trial gives the base "
                "case again"
            ],
        ),
    ],
)
def test_what_does_not_vary(book, assumptions, forecasts, message):
    model = book(CELLS, assumptions, forecasts)
    assert said(model) == message
    still = {str(cell)[2:] for cell in model.still}
    assert still <= set(forecasts.values())
    assert bool(still) is bool(message)


def test_a_filter_alone_reaches_no_forecast(book):
    model = book(CELLS, {"a": {"cell": "A1", **UNIT}}, {"y": "B2"}, {"f": {"cell": "B1", "above": 0}})
    (message,) = said(model)
    assert "no assumption that is drawn reaches a forecast" in message


def test_a_circle_is_followed_round(book):
    cells = {"A1": 1.0, "A2": 1.0, "B1": "=IF(A1>2,B2,A1)", "B2": "=IF(A1>2,3,B1+1)", "B3": "=A2"}
    both = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", **SAME}}
    assert {str(cell) for cell in book(cells, both, {"x": "B2", "y": "B3"}).still} == {"S!B3"}


@pytest.mark.parametrize(("family", "heavy"), [("Cauchy", True), ("Normal", False)])
def test_a_mean_that_does_not_exist_is_told(book, family, heavy):
    given = {"location": 0, "scale": 1} if heavy else {"mean": 0, "std_dev": 1}
    model = book(CELLS, {"a": {"cell": "A1", "distribution": family, **given}}, {"x": "B1"})
    assert any("'a' (Cauchy) has no finite mean" in str(notice) for notice in model.notices) is heavy
    if heavy:
        cut = {**given, "lower_cutoff": -9, "upper_cutoff": 9}
        model = book(CELLS, {"a": {"cell": "A1", "distribution": family, **cut}}, {"x": "B1"})
        assert not any("finite mean" in str(notice) for notice in model.notices)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["tape", "Exemplary", "an example"], None),
        (["tape", " EXAMPLE: write"], "Source still says \"Example\": 'b'. Write"),
        (["Example", "example of"], "2 sources still say \"Example\": 'a', 'b'. Write"),
        (["Example"] * 4, "4 sources still say \"Example\": 'a', 'b', 'c', 'd'. Write"),
        (["Example"] * 6, "6 sources still say \"Example\": 'a', 'b', 'c', 'd' and 2 more. Write"),
    ],
)
def test_sources_that_a_template_left(texts, message):
    result = example_notices((repr("abcdef"[i]), at(i + 1), text) for i, text in enumerate(texts))
    if message is None:
        assert result == []
        return
    (notice,) = result
    assert message in str(notice)
    assert notice.where == at(next(i for i, text in enumerate(texts) if text.strip().lower().startswith("example")) + 1)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["a"], "a"),
        (["a", "b"], "a and b"),
        (["a", "b", "c"], "a, b and c"),
        ("wxyz", "w, x, y and z"),
    ],
)
def test_lists(words, text):
    assert list_of(list(words)) == text


def test_verbs():
    assert [be(n) for n in (0, 1, 2)] == ["were", "was", "were"]


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (60, "1 min"),
        (59.5, "59.5 s"),
        (61, "1 min 1 s"),
        (3600, "1 h"),
        (3599, "59 min 59 s"),
        (5400, "1 h 30 min"),
        (3661, "1 h 1 min 1 s"),
        (7201, "2 h 1 s"),
        (0.5, "0.5 s"),
        (0, ""),
    ],
)
def test_durations(seconds, text):
    assert duration(seconds) == text


@pytest.mark.parametrize(
    ("name", "key"),
    [("Nissan delta-V, mph", "nissan_delta_v_mph"), (" a__b ", "a_b"), ("Straße 2", "strasse_2"), ("%", "")],
)
def test_keywords(name, key):
    assert keyword(name) == key


@pytest.fixture
def named(book):
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "A4": 1.0, "B1": "=A1+A2+A3"}
    given = {name: {"cell": f"A{n}", **UNIT} for n, name in enumerate(("Road friction", "road-friction", "x"), 1)}
    return book(cells, given | {"idle": {"cell": "A4", **UNIT}}, {"Speed at impact": "B1"})


def test_names_that_people_type(named):
    assert assumption_named(named, "ROAD friction") == "Road friction"
    assert assumption_named(named, "road-Friction") == "road-friction"
    assert assumption_named(named, "X") == "x"
    assert assumption_named(named, "idle") == "idle"
    assert forecast_named(named, " speed at IMPACT") == "Speed at impact"


@pytest.mark.parametrize(
    ("name", "drawn", "message"),
    [
        ("road_friction", False, "'road_friction' may be 'Road friction' or 'road-friction'"),
        ("idel", False, "There is no assumption 'idel'"),
        ("idle", True, "No assumption that is drawn is called 'idle'. They are 'Road friction', 'road-friction', 'x'"),
    ],
)
def test_names_that_are_none(named, name, drawn, message):
    with pytest.raises(SimulationError, match=message):
        assumption_named(named, name, drawn=drawn)


def test_a_forecast_that_is_none(named):
    with pytest.raises(SimulationError, match="There is no forecast 'speed_at_impact'"):
        forecast_named(named, "speed_at_impact")
