from __future__ import annotations

import json

import numpy as np
import pytest

from xlmc.report.figure import figures_of
from xlmc.report.page.payload import payload, payload_text

EVIL = "</script><img src=x onerror=alert(1)>&amp;<!--\u2028"


def test_the_trials_are_those_of_the_run(run, payload_of):
    found = payload_of(run)
    assert [each["name"] for each in found["forecasts"]] == list(run.results)
    for each in found["forecasts"]:
        result = run[each["name"]]
        counts = np.ones(len(each["values"]), int) if each["counts"] is None else each["counts"]
        assert np.repeat(each["values"], counts).tolist() == result.sample.x.tolist()
        assert each["gaps"] is None
        assert each["trials"] == result.values.size
        low, high = result.central()
        assert (each["range"]["low"], each["range"]["high"]) == (low.value, high.value)
        assert each["range"]["share"] == 0.51


def test_bins_are_those_of_the_sheet(run, opened, payload_of):
    sheet = opened(run)["Bins"]
    found = payload_of(run)["forecasts"]
    for number, each in enumerate(found):
        rows = sheet.iter_rows(min_row=6, min_col=7 * number + 1, max_col=7 * number + 6, values_only=True)
        rows = [row for row in rows if isinstance(row[1], (int, float))]
        assert each["bins"]["edges"] == [*(row[1] for row in rows), rows[-1][2]]
        assert each["bins"]["counts"] == [row[5] for row in rows]
        assert sum(each["bins"]["counts"]) + each["bins"]["below"] + each["bins"]["above"] == each["trials"]


def test_marks_and_overlays(run, payload_of):
    found = payload_of(run)
    area, difference = found["forecasts"]
    assert [mark["label"] for mark in area["marks"]] == ["Mean", "Base case", "Threshold"]
    assert [mark["value"] for mark in area["marks"]] == [run["area"].mean.value, 16.0, 16.0]
    assert [mark["label"] for mark in difference["marks"]] == ["Mean", "Base case"]
    assert found["overlays"] == [[0, 1]]  # both in ft


@pytest.mark.parametrize("name", ["none_accepted", "one_accepted"])
def test_few_trials_make_few_charts(request, payload_of, name):
    found = payload_of(request.getfixturevalue(name))
    assert [each["trials"] for each in found["forecasts"]] == ([] if name == "none_accepted" else [1])
    assert found["overlays"] == []


def test_a_large_run_has_gaps_but_exact_ends(make, payload_of):
    cells = {"A1": 0.5, "B1": "=A1*A1", "B2": "=A1*3"}
    forecasts = [make.forecast("square", "B1", threshold=0.3), make.forecast("triple", "B2")]
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=50_000)
    each = payload_of(run)["forecasts"][0]
    result = run["square"]
    assert len(each["values"]) == 20_003
    assert max(each["gaps"]) <= 2
    for end in (each["range"]["low"], each["range"]["high"], 0.3):
        place = each["values"].index(end)
        upto = sum(each["gaps"][:place]) + sum(each["counts"][: place + 1])
        assert upto == np.count_nonzero(result.values <= end)


def test_nothing_in_it_can_end_the_script(make):
    forecasts = [make.forecast(EVIL, "B1", units=EVIL)]
    run = make.simulate({"A1": 0.5, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], forecasts, trials=50)
    figures = figures_of(run)
    text = payload_text(run, figures)
    assert not set("<>&\u2028\u2029") & set(text)
    assert json.loads(text) == payload(run, figures)
    assert json.loads(text)["forecasts"][0]["name"] == EVIL
