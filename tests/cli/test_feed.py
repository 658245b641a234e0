"""`xlmc simulate --feed`, and how such a run is recorded, saved and repeated."""

from __future__ import annotations

import json
import shlex

import pytest
from committed_books import BOOKS
from fewer_sheets import SHORT, keep_few_trials, keep_sheets

import xlmc as library
from xlmc.excel.workbook.reader import read_workbook

FEEDS = {
    "Speed at the end of the skid": "intersection-momentum.xlsx!Chevrolet impact speed",
    "Surface 1 friction": "intersection-momentum.xlsx!Chevrolet post-impact deceleration",
}
TYPED = [part for mine, theirs in FEEDS.items() for part in ("--feed", f"{mine}={theirs}")]


@pytest.fixture(autouse=True)
def _books(tmp_path, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    keep_few_trials(monkeypatch)
    for name in ("skid-100-ft", "intersection-momentum"):
        (tmp_path / f"{name}.xlsx").write_bytes(BOOKS[name].read_bytes())


@pytest.fixture
def fed(xlmc, tmp_path):
    """`fed(…)`: a run of the skid with the speed and the friction of the impact."""
    return lambda *more: xlmc("simulate", "skid-100-ft.xlsx", "-n", 5_000, *TYPED, *more)


def test_a_fed_run_says_so_and_is_repeated_from_its_record(xlmc, fed, tmp_path):
    done = fed("-o", "results.xlsx", "--json", "results.json", "--save-run", "kept.xlmcrun")
    assert done.code == 0
    assert "takes 'Chevrolet impact speed' of intersection-momentum.xlsx in each trial" in done.err
    record = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["record"]
    rows = record["feeds"]["rows"]
    sha256 = read_workbook(tmp_path / "intersection-momentum.xlsx").sha256
    assert [row["sha256"] for row in rows] == [sha256, sha256]
    for path in ("results.xlsx", "kept.xlmcrun"):
        again = xlmc("replay", path)
        assert (again.code, "to the last bit" in again.out) == (0, True)
    repeated = xlmc(*shlex.split(record["run"]["repeat"])[1:], "-o", "again.xlsx", "--json", "again.json")
    assert repeated.code == 0
    other = json.loads((tmp_path / "again.json").read_text(encoding="utf-8"))["record"]
    assert other["run"]["fingerprint"] == record["run"]["fingerprint"]


def test_a_replay_asks_for_the_books_and_refuses_others(xlmc, fed, tmp_path):
    fed("-o", "results.xlsx")
    away = tmp_path / "away" / "intersection-momentum.xlsx"
    away.parent.mkdir()
    (tmp_path / "intersection-momentum.xlsx").rename(away)
    missing = xlmc("replay", "results.xlsx")
    assert missing.code == 2
    assert "the workbook 'intersection-momentum.xlsx', which fed the run, is not beside it" in missing.err
    assert xlmc("replay", "results.xlsx", "--book", away).code == 0
    away.write_bytes(BOOKS["intersection"].read_bytes())
    other = xlmc("replay", "results.xlsx", "--book", away)
    assert other.code == 2
    assert "is not the workbook that fed the run" in other.err


def test_python_gives_the_numbers_of_the_command(xlmc, fed, tmp_path):
    fed("-o", "results.xlsx", "--json", "results.json")
    feeds = {mine: f"{tmp_path}/{theirs}" for mine, theirs in FEEDS.items()}
    run = library.load(tmp_path / "skid-100-ft.xlsx", feeds=feeds).simulate(5_000)
    found = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["forecasts"]
    assert found[0]["statistics"]["mean"]["value"] == run[found[0]["name"]].mean.value
    assert run.model.forecasts[-1].name == "Surface 1 friction"


@pytest.mark.parametrize(
    ("typed", "message"),
    [("no equals sign", "is not written as one"), ("x=missing.xlsx!y", "there is no such file")],
)
def test_what_cannot_be_fed_is_one_message(xlmc, typed, message):
    done = xlmc("simulate", "skid-100-ft.xlsx", "--feed", typed)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert message in done.err


@pytest.mark.parametrize("ending", ["", ".html"])
def test_a_workbook_that_feeds_is_never_replaced(fed, tmp_path, ending):
    before = (tmp_path / "intersection-momentum.xlsx").read_bytes()
    target = "intersection-momentum.xlsx"
    if ending:
        (tmp_path / f"link{ending}").symlink_to(tmp_path / target)
        target = f"link{ending}"
    refused = fed("-o", target, "--overwrite")
    assert refused.code == 2
    assert "this is the file that is read" in refused.err
    assert (tmp_path / "intersection-momentum.xlsx").read_bytes() == before
