from __future__ import annotations

import json
import math
import re

import jsonschema
import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.statements.pairs import pairs_of
from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.api import Simulation
from xlmc.errors import WorkbookError
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.json_document import (
    NO_ERROR,
    NO_VALUE,
    SCHEMA,
    STATISTICS,
    UNBOUNDED,
    document,
    estimate_json,
    save_json,
)


@pytest.fixture(scope="session")
def validator():
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.fixture(scope="session")
def runs(run, none_accepted, one_accepted, make, small_book):
    correlated = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"},
        [make.uniform("a", "A1", 0.0, 1.0), make.uniform("b", "A2", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1", asked=(0.5, math.inf))],
    )
    model = load(small_book)
    return {
        "a run": run,
        "nothing accepted": none_accepted,
        "one trial": one_accepted,
        "no base case": correlated,
        "errors in cells": simulated(model),
        "Latin hypercube": simulated(model, sampling="lhs"),
        "until accepted": simulated(model, until_accepted=50),
        "too few accepted": simulated(model, 30, until_accepted=100),
        "some draws": simulated(model, keep_inputs=10),
    }


KINDS = (
    "a run",
    "nothing accepted",
    "one trial",
    "no base case",
    "errors in cells",
    "Latin hypercube",
    "until accepted",
    "too few accepted",
    "some draws",
)


@pytest.mark.parametrize("kind", KINDS)
def test_the_document_keeps_to_its_schema(runs, validator, kind):
    text = json.dumps(document(runs[kind], command="xlmc simulate"), allow_nan=False)
    validator.validate(json.loads(text))


def changes():
    """What is wrong in a document: a path to it, and what stands there."""
    return [
        (("version",), 2),
        (("forecasts", 0, "statistics", "mean", "value"), "12"),
        (("forecasts", 0, "statistics", "mean", "value"), None),  # without a reason
        (("forecasts", 0, "statistics", "mean", "reason"), "because"),  # without need
        (("forecasts", 0, "statistics", "mode"), 3.0),
        (("forecasts", 0, "trials"), -1),
        (("forecasts", 0, "more"), 1),
        (("filters", 0, "rejected"), 1.5),
        (("trials", "ended_by"), "boredom"),
        (("record", "run", "repeat"), ["xlmc"]),
    ]


@pytest.mark.parametrize(("path", "value"), changes())
def test_the_schema_refuses_what_is_no_document(run, validator, path, value):
    result = json.loads(json.dumps(document(run)))
    inner = result
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(result)


def test_every_statistic_is_there_to_the_last_bit(run):
    result = json.loads(json.dumps(document(run)))
    for each in result["forecasts"]:
        expected = run[each["name"]].statistics
        assert each["trials"] == expected.trials
        for name in STATISTICS:
            assert_same(each["statistics"][name], getattr(expected, name))
        assert [p["percent"] for p in each["percentiles"]] == list(expected.percentiles)
        for percentile, estimate in zip(each["percentiles"], expected.percentiles.values(), strict=True):
            assert_same(percentile, estimate)
        for end, estimate in zip(("low", "high"), expected.central, strict=True):
            assert_same(each["central_range"][end], estimate)
        if each["certainty"] is not None:
            assert_same(each["certainty"]["probability_above"], expected.probability_above)
    assert [each["certainty"] is None for each in result["forecasts"]] == [False, True]
    assert_same(result["trials"]["acceptance"], run.acceptance)


def assert_same(reported, estimate):
    numbers = (estimate.value, estimate.error, *(estimate.interval or (None, None)))
    for key, number in zip(("value", "error", "low", "high"), numbers, strict=True):
        assert reported[key] == (None if number is None or not math.isfinite(number) else number), key


def test_the_filters_account_for_every_trial(run):
    result = document(run)
    assert result["trials"]["run"] == run.trials
    rejected = {each["name"]: each for each in result["filters"]}
    assert rejected["root"]["rejected"] == run.tally.rejected[0]
    assert rejected["root"]["also_by"] == {"narrow": run.tally.together[0, 1]}
    assert rejected["root"]["errors"] == sum(run.tally.errors[0].values()) > 0
    assert rejected["narrow"]["because"] == "=measured"
    by_any = sum(each["only"] for each in result["filters"]) + rejected["root"]["also_by"]["narrow"]
    assert run.trials - run.accepted == by_any


def test_assumptions_before_and_after(run):
    drawn = {each["name"]: each for each in document(run)["assumptions"]}
    assert [each["status"] for each in drawn.values()] == ["drawn", "drawn", "not needed", "frozen"]
    width = drawn["width"]
    assert width["prior"]["mean"]["value"] == pytest.approx(np.mean(run.prior["width"]), rel=1e-14)
    assert width["accepted"]["mean"]["value"] == pytest.approx(np.mean(run.inputs["width"]), rel=1e-14)
    assert drawn["idle"]["prior"] is drawn["held"]["accepted"] is None


def test_the_record_is_the_record(run):
    assert document(run, command="typed")["record"] == make_record(run, "typed").as_dict()


def test_warnings_and_notices(none_accepted):
    result = document(none_accepted)
    assert result["warnings"] == none_accepted.warnings != []
    assert [notice["message"] for notice in result["notices"]] == [n.message for n in none_accepted.notices]


@pytest.mark.parametrize(
    ("estimate", "reason"),
    [
        (Estimate(1.0, 0.5, (0.0, 2.0)), None),
        (Estimate(math.nan), NO_VALUE),
        (Estimate(math.inf, 1.0, (0.0, math.inf)), NO_VALUE),
        (Estimate(1.0), NO_ERROR),
        (Estimate(1.0, 0.5, (-math.inf, 2.0)), UNBOUNDED),
        (Estimate(np.float64(1.0), np.float64(0.5), (np.float64(0.0), np.float64(2.0))), None),
    ],
)
def test_what_is_no_number_is_null_with_a_reason(estimate, reason):
    reported = estimate_json(estimate)
    json.dumps(reported, allow_nan=False)
    assert reported.get("reason") == reason
    assert (reason is not None) == (None in reported.values())


def test_it_is_written_whole_in_utf8(run, tmp_path):
    path = tmp_path / "run.json"
    assert save_json(run, path) == path
    result = json.loads(path.read_text("utf-8"))
    assert re.fullmatch(
        json.loads(SCHEMA.read_text(encoding="utf-8"))["properties"]["seal"]["pattern"], result.pop("seal")
    )
    assert result == json.loads(json.dumps(document(run)))
    before = path.read_bytes()
    Simulation(run).save_json(path)
    assert path.read_bytes() == before


@pytest.mark.parametrize("name", ["book.xlsx", "run", "no/run.json"])
def test_where_it_cannot_be_written(run, tmp_path, name):
    with pytest.raises(WorkbookError):
        Simulation(run).save_json(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_statements_certainties_pairs_and_sensitivities_are_those_of_python(run):
    results = json.loads(json.dumps(document(run)))
    assert results["statements"] == [{"forecast": s.forecast, "kind": s.kind, "text": s.text} for s in statements(run)]
    for each, result in zip(results["forecasts"], run.results.values(), strict=True):
        for reported, certainty in zip(each["certainties"], certainties(result), strict=True):
            assert (reported["kind"], reported["words"]) == (certainty.kind, certainty.words)
            assert (reported["low"] is None) == math.isinf(certainty.low)
            assert_same(reported["share"], certainty.share)
    [reported], [pair] = results["pairs"], pairs_of(run)
    assert (reported["first"], reported["second"], reported["limits"]) == ("area", "difference", list(pair.limits))
    assert_same(reported["correlation"], pair.correlation)
    expected = sensitivities(run)
    assert results["sensitivity"]["examined"] == expected.examined
    for reported, each in zip(results["sensitivity"]["forecasts"], expected.forecasts, strict=True):
        assert [i["assumption"] for i in reported["influences"]] == [i.assumption for i in each.influences] != []
        assert_same(reported["influences"][0]["rank_correlation"], each.influences[0].rank_correlation)
        assert reported["bars"][0]["answers"] == list(each.bars[0].answers)
    for reported, limit in zip(results["sensitivity"]["filter_limits"], expected.filter_limits, strict=True):
        assert [point["limit"] for point in reported["points"]] == [point.limit for point in limit.points]
