from __future__ import annotations

import json

import books
import compare
import figures
import numpy as np
import peers
import pytest
import rates
import tables
from accuracy import TRUTH, errors
from contestants import formulas_model
from line_up import line_up

from xlmc.montecarlo.loop.scheduling.processes import IdlePool, idle_pool
from xlmc.montecarlo.model.loading import load

CONTESTANTS = ("xlmc/numpy", "hand/NumPy")
PEER = "formulas"
"""One that answers given trials only; what it would measure takes seconds, so its record is written here."""


@pytest.fixture(scope="module")
def results(tmp_path_factory, at_hand):
    folder = tmp_path_factory.mktemp("results")
    given = ["--quick", "--books", "case-study", "--contestants", *CONTESTANTS, "--output", str(folder), "--parts"]
    ended = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compare, "draw", lambda _: None)
        patch.setattr(IdlePool, "end", lambda pool: ended.append(pool))  # the next process would cost half a second
        assert compare.main([*given, "rates", "scaling"]) == folder
    assert ended == [idle_pool]  # before the run that is to start its process anew
    path = folder / "rates.json"
    measured = json.loads(path.read_text(encoding="utf-8"))
    records = measured["found"]["case-study"]
    records[PEER] = {**records["hand/NumPy"], "family": "peer", "rate": 50.0}
    path.write_text(json.dumps(measured), encoding="utf-8")
    compare.main([*given, "accuracy"])
    return folder


def found(results, part):
    return json.loads((results / f"{part}.json").read_text(encoding="utf-8"))["found"]


def test_contestants_agree_on_the_case_study(results):
    records = found(results, "rates")["case-study"]
    assert set(records) == {*CONTESTANTS, PEER}
    for name, record in records.items():
        assert record["absent"] is None, name
        assert record["differs"] == [], name
        assert record["checked"] >= 1
        assert record["rate"] > 0


@pytest.mark.parametrize("name", ["skid", "wide"])
def test_the_package_formulas_gives_the_same_forecasts(name, tmp_path):
    """In this process: one forecast, and several."""
    path = tmp_path / f"{name}.xlsx"
    if name == "skid":
        books.write_skid(path)
    else:
        books.write_wide(path, 3, 2)
    task = rates.task_of(name, path, 0)
    assert len(task.check) == rates.CHECK
    assert len(task.forecasts) == (1 if name == "skid" else 2)
    given = {a.name: column for a, column in zip(load(path).live, np.transpose(task.check), strict=True)}
    truth = np.transpose(list(load(path).function(given).values()))
    assert rates.differing(task, formulas_model.prepare(task).answers(task.check), truth) == []


def test_ratios_are_of_the_same_round(results):
    records = found(results, "rates")["case-study"]
    ours, hand = records["xlmc/numpy"], records["hand/NumPy"]
    assert ours["to xlmc/numpy"] == hand["to hand/NumPy"] == 1
    assert ours["to hand/NumPy"] == pytest.approx(ours["rates"][0] / hand["rates"][0])


def test_accuracy_has_a_curve_for_everyone(results):
    curves = found(results, "accuracy")
    assert set(curves) == {*CONTESTANTS, PEER}
    assert [name for name, curve in curves.items() if curve["by rate"]] == [PEER]
    assert curves[PEER]["errors"] == curves["xlmc/numpy"]["errors"]
    assert curves[PEER]["seconds"] == [trials / 50 for trials in curves[PEER]["trials"]]
    for curve in curves.values():
        assert np.shape(curve["errors"]) == (len(curve["trials"]), 4)


def test_errors_are_root_mean_squares():
    answers = np.stack([TRUTH + 3.0, TRUTH - 4.0])
    np.testing.assert_allclose(errors(answers), np.sqrt(12.5))


def test_scaling_has_two_numbers_of_jobs(results):
    assert set(found(results, "scaling")) == {"xlmc/numpy"}
    assert set(found(results, "scaling")["xlmc/numpy"]["ratios"]) == {"2", "2 anew", "two programs"}
    assert all(ratio > 0 for ratio in found(results, "scaling")["xlmc/numpy"]["ratios"].values())


def test_figures_are_drawn(results):
    for name in ("speed-against-accuracy.png", "rates.png"):
        assert (results / name).read_bytes().startswith(b"\x89PNG")


def test_every_contestant_has_a_style(tmp_path):
    entries, absent = line_up(tmp_path, ("numpy", "formulas"), tmp_path)
    assert {entry.name for entry in entries if "case-study" in entry.books} <= set(figures.STYLES)
    assert [reason.partition(":")[0] for reason in absent] == ["IronCalc", "formualizer"]


@pytest.mark.parametrize("name", peers.PEERS)
def test_peers_agree_on_the_case_study(name, tmp_path):
    if name in peers.missing():
        pytest.skip(f"{name} is not installed: benchmarks/compare.py --install")
    label = {"ironcalc": "IronCalc"}.get(name, name)
    names = "case-study", "skid"
    given = ["--quick", "--parts", "rates", "--contestants", "xlmc/numpy", label, "--books", *names]
    compare.main([*given, "--output", str(tmp_path)])
    for book in names:
        record = found(tmp_path, "rates")[book][label]
        assert record["absent"] is None
        assert record["differs"] == []


def test_tables_stand_between_their_markers(results):
    page = "".join(f"before\n<!-- {name} -->\nold\n<!-- /{name} -->\nafter\n" for name in ("machine", *tables.TABLES))
    new = tables.filled(page, results)
    assert new.count("old") == len(tables.TABLES) - 3
    assert "NumPy" in new
    assert tables.filled(new, results) == new
    with pytest.raises(ValueError, match="no markers"):
        tables.filled("nothing", results)


def test_the_page_shows_the_committed_results():
    text = tables.PAGE.read_text(encoding="utf-8")
    assert all((compare.RESULTS / f"{name}.json").exists() for name in tables.TABLES)
    assert tables.filled(text, compare.RESULTS) == text
