from __future__ import annotations

import json

import compare
import figures
import numpy as np
import peers
import pytest
import tables
from accuracy import TRUTH, errors
from line_up import line_up

CONTESTANTS = ("xlmc/numpy", "hand/NumPy", "formulas")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    parts = "rates", "scaling", "accuracy"
    given = ["--quick", "--books", "case-study", "--contestants", *CONTESTANTS, "--parts", *parts]
    assert compare.main([*given, "--output", str(folder)]) == folder
    return folder


def found(results, part):
    return json.loads((results / f"{part}.json").read_text(encoding="utf-8"))["found"]


def test_contestants_agree_on_the_case_study(results):
    records = found(results, "rates")["case-study"]
    assert set(records) == set(CONTESTANTS)
    for name, record in records.items():
        assert record["absent"] is None, name
        assert record["differs"] == [], name
        assert record["checked"] >= 1
        assert record["rate"] > 0


def test_ratios_are_of_the_same_round(results):
    records = found(results, "rates")["case-study"]
    ours, hand = records["xlmc/numpy"], records["hand/NumPy"]
    assert ours["to xlmc/numpy"] == hand["to hand/NumPy"] == 1
    assert ours["to hand/NumPy"] == pytest.approx(ours["rates"][0] / hand["rates"][0])


def test_accuracy_has_a_curve_for_everyone(results):
    curves = found(results, "accuracy")
    assert set(curves) == set(CONTESTANTS)
    assert curves["formulas"]["by rate"]
    assert curves["formulas"]["errors"] == curves["xlmc/numpy"]["errors"]
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
    books = "case-study", "skid"
    given = ["--quick", "--parts", "rates", "--contestants", "xlmc/numpy", label, "--books", *books]
    compare.main([*given, "--output", str(tmp_path)])
    for book in books:
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
