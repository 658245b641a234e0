"""`xlmc simulate --feed`, and how such a run is recorded, saved and repeated."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import openpyxl
import pytest
from committed_books import BOOKS
from fewer_sheets import SHORT, keep_few_trials, keep_sheets
from openpyxl.worksheet.table import Table

import xlmc as library
from xlmc.errors import WorkbookError
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
    assert "The workbook 'intersection-momentum.xlsx', which fed the run, is not beside it" in missing.err
    assert xlmc("replay", "results.xlsx", "--book", away).code == 0
    away.write_bytes(BOOKS["intersection"].read_bytes())
    other = xlmc("replay", "results.xlsx", "--book", away)
    assert other.code == 2
    assert "is not the workbook that fed the run" in other.err


def test_python_gives_the_numbers_of_the_command(xlmc, fed, tmp_path):
    fed("-o", "results.xlsx", "--json", "results.json")
    feeds = {mine: f"{tmp_path}/{theirs}" for mine, theirs in FEEDS.items()}
    run = library.load(tmp_path / "skid-100-ft.xlsx", feeds=feeds).simulate(5_000)
    result = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["forecasts"]
    assert result[0]["statistics"]["mean"]["value"] == run[result[0]["name"]].mean.value
    assert run.model.forecasts[-1].name == "Surface 1 friction"


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        ("no equals sign", "cannot be read"),
        ("x=missing.xlsx!y", "There is no such file"),
        ("x=skid-100-ft.xlsx!y", "skid-100-ft.xlsx: This is the workbook that is run, and it cannot feed itself"),
        ("x=./skid-100-ft.xlsx!y", "skid-100-ft.xlsx: This is the workbook that is run, and it cannot feed itself"),
        (f"{TYPED[1]},{TYPED[3]}", "holds two. Give --feed once for each"),
        (f"skid-100.xlsx!{TYPED[1]}", "No workbook of this run is called 'skid-100.xlsx', so it cannot be fed. Did"),
    ],
    ids=["no equals sign", "no file", "itself", "itself by another path", "two in one", "a misspelt first book"],
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
    assert "This is the file that is read" in refused.err
    assert (tmp_path / "intersection-momentum.xlsx").read_bytes() == before


def test_the_workbook_that_is_run_may_be_named_in_a_feed(xlmc, fed):
    assert fed("-o", "plain.json").code == 0
    named = [part if part == "--feed" else f"skid-100-ft.xlsx!{part}" for part in TYPED]
    assert xlmc("simulate", "skid-100-ft.xlsx", "-n", 5_000, *named, "-o", "named.json").code == 0
    result = [json.loads(Path(f"{name}.json").read_text(encoding="utf-8"))["forecasts"] for name in ("plain", "named")]
    assert result[0] == result[1]


WRITERS = {
    "save": (".xlsx", lambda run, path: run.save(path, overwrite=True)),
    "save_page": (".html", lambda run, path: run.save_page(path, overwrite=True)),
    "keep": (".xlmcrun", lambda run, path: run.keep(path, overwrite=True)),
    "extract": (".csv", lambda run, path: run.extract(path, overwrite=True)),
    "save_json": (".json", lambda run, path: run.save_json(path, overwrite=True)),
    "save_report": (".docx", lambda run, path: run.save_report(path, overwrite=True)),
}


@pytest.mark.parametrize(("ending", "write"), WRITERS.values(), ids=WRITERS)
def test_python_never_replaces_a_workbook_that_feeds(tmp_path, ending, write):
    other = tmp_path / "intersection-momentum.xlsx"
    before = other.read_bytes()
    feeds = {mine: f"{tmp_path}/{theirs}" for mine, theirs in FEEDS.items()}
    run = library.load(tmp_path / "skid-100-ft.xlsx", feeds=feeds).simulate(500)
    path = other if ending == ".xlsx" else tmp_path / f"link{ending}"
    if path != other:
        path.hardlink_to(other)
    with pytest.raises(WorkbookError, match="This is the file that is read"):
        write(run, path)
    assert other.read_bytes() == before
    free = tmp_path / f"free{ending}"
    assert write(run, free) == free


def test_a_page_never_replaces_the_workbook_of_the_run_beside_it(tmp_path):
    first, second = (library.load(tmp_path / f"{name}.xlsx") for name in ("skid-100-ft", "intersection-momentum"))
    (tmp_path / "page.html").hardlink_to(tmp_path / "intersection-momentum.xlsx")
    with pytest.raises(WorkbookError, match="This is the file that is read"):
        first.simulate(500).save_page(tmp_path / "page.html", beside=second.simulate(500), overwrite=True)


def small_book(path, name):
    """A workbook whose answer is its one assumption, plus 1."""
    book = openpyxl.Workbook()
    for row in (("Name", "Value", "Low", "High", "", "Name", "Cell"), (name, 1, 0, 2, "", "Out", "=A4")):
        book.active.append(row)
    book.active["A4"] = "=B2+1"
    book.active.add_table(Table(displayName="xlmc_assumptions", ref="A1:D2"))
    book.active.add_table(Table(displayName="xlmc_forecasts", ref="F1:G2"))
    book.save(path)


CIRCLES = {
    "two": (["a.xlsx!p=b.xlsx!Out", "B.xlsx!q=a.xlsx!Out"], "a.xlsx → b.xlsx → a.xlsx"),
    "one": (["a.xlsx!p=a.xlsx!Out"], "a.xlsx → a.xlsx"),
    "three": (
        ["a.xlsx!p=b.xlsx!Out", "b.xlsx!q=c.xlsx!Out", "c.xlsx!r=a.xlsx!Out"],
        "a.xlsx → c.xlsx → b.xlsx → a.xlsx",
    ),
}


@pytest.mark.parametrize(("feeds", "circle"), CIRCLES.values(), ids=CIRCLES)
def test_books_that_feed_each_other_in_a_circle_are_named(xlmc, tmp_path, feeds, circle):
    """No word of Excel's iterative calculation: the circle is one of books."""
    for path, name in (("run", "x"), ("a", "p"), ("b", "q"), ("c", "r")):
        small_book(tmp_path / f"{path}.xlsx", name)
    typed = [part for feed in ("x=a.xlsx!Out", *feeds) for part in ("--feed", feed)]
    done = xlmc("simulate", "run.xlsx", *typed)
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert f"The workbooks feed each other in a circle: {circle}. Leave out one of the feeds" in done.err
    assert "iterative" not in done.err
