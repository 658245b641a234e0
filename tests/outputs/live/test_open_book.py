"""The file beside the window: saved by rename, half-written, with a mistake; and what is written beside it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import shutil
import time

import pytest
from fewer_sheets import SHORT, keep_sheets, leave_out_fits
from live_books import change, edited, small
from simulated import simulated

from xlmc.analysis.results.saved import open_run
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.open_book import Window


@pytest.fixture
def book(tmp_path):
    return small(tmp_path / "case.xlsx")


@pytest.fixture
def soon_settled(monkeypatch):
    """A file that cannot be read is taken for faulty after a tenth of a second, and not after two."""
    monkeypatch.setattr("xlmc.outputs.live.open_book._SETTLING", (0.0, 0.1))


def saved_as_excel_does(source, book):
    """Written under another name, and then renamed."""
    waiting = book.with_name("~WRD0001.tmp")
    shutil.copy(source, waiting)
    os.replace(waiting, book)


def first_number(state):
    row = next(each for each in state["assumptions"] if each["status"] == "drawn")
    return row["name"], row["numbers"][-1]


def test_a_workbook_that_is_saved_is_run_again_and_what_changed_is_said(running, book, tmp_path):
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        before = window.next("rest")
        value = number["value"] * 1.5  # far enough for a sentence of 5,000 trials to show it
        other = edited(book, tmp_path / "other.xlsx", {(name, number["heading"]): value})
        saved_as_excel_does(other, book)
        news = window.next("news")
        after = window.next("rest")
        assert f"{name}: {number['heading']}" in news["text"]
        assert after["sentences"] != before["sentences"]


def test_the_usual_variants_are_kept(running, book):
    server = running(book=book)
    with server.window(server.library.only) as window:
        window.next("state")
        window.say("variants")
        names = {each["name"] for each in window.next("state")["scenarios"]}
        assert "every range half as wide" in names
    kept, _ = server.library.keeper.scenarios(book)
    assert kept.keys() == names


def test_a_half_written_or_faulty_workbook_leaves_the_last_good_answer(running, book, tmp_path, soon_settled):
    server = running(book=book)
    whole = book.read_bytes()
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.next("rest")
        book.write_bytes(whole[: len(whole) // 2])
        trouble = window.next("trouble", lambda message: message["about"] == "book" and message["text"])
        assert "case.xlsx" in trouble["text"]
        source = small(tmp_path / "source.xlsx")
        faulty = edited(source, tmp_path / "faulty.xlsx", {(name, number["heading"]): "much"})
        saved_as_excel_does(faulty, book)
        trouble = window.next("trouble", lambda message: message["about"] == "book" and "!" in message["text"])
        assert number["heading"] in trouble["text"]
        with server.window(server.library.only) as other:
            assert other.next("rest")["sentences"]
            assert other.next("trouble", lambda message: message["about"] == "book")["text"] == trouble["text"]
        saved_as_excel_does(source, book)
        assert window.next("trouble", lambda message: message["about"] == "book")["text"] == ""


def test_a_workbook_that_cannot_be_read_at_first_is_shown_once_it_can(running, tmp_path, soon_settled):
    book = tmp_path / "case.xlsx"
    book.write_bytes(b"PK half")
    server = running(book=book)
    with server.window(server.library.only) as window:
        assert window.next("trouble")["text"]
        saved_as_excel_does(small(tmp_path / "source.xlsx"), book)
        assert window.next("rest")["sentences"]


def test_what_is_changed_outlives_the_window(running, book):
    first = running(book=book)
    with first.window(first.library.only) as window:
        name, number = first_number(window.next("state"))
        window.next("rest")
        window.say("set", **change(name, number["key"], number["value"] * 1.01).fields)
        window.next("rest", lambda message: message["version"] == 1)
        window.say("keep", name="faster")
        window.next("state", lambda message: message["scenarios"])
        window.say("set", **change(name, number["key"], number["value"] * 1.02, seq=2).fields)
        window.next("rest", lambda message: message["version"] == 2)
    second = running(book=book)
    with second.window(second.library.only) as window:
        state = window.next("state")
        assert [each["name"] for each in state["scenarios"]] == ["faster"]
        assert state["offered"]
        window.say("restore", take=True)
        assert window.next("rest", lambda message: message["version"] == 1)
        assert window.heard_last("state")["changes"] == state["offered"]


def test_a_number_that_was_set_just_before_the_end_is_kept(running, book, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.open_book._KEPT_AFTER", 600.0)
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.say("set", **change(name, number["key"], number["value"] * 1.01).fields)
        window.next("state", lambda message: message["changes"])
        assert server.library.keeper.scenarios(book) == ({}, Adjustments())
    server.server.end()
    server.ended()
    _, unkept = server.library.keeper.scenarios(book)
    assert unkept == Adjustments().having("assumption", name, number["key"], number["value"] * 1.01)


def test_a_number_is_kept_when_its_window_is_closed(running, book, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.open_book._KEPT_AFTER", 600.0)
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.say("set", **change(name, number["key"], number["value"] * 1.01).fields)
        window.next("state", lambda message: message["changes"])
    end = time.monotonic() + 60
    while not server.library.keeper.scenarios(book)[1]:
        assert time.monotonic() < end
        time.sleep(0.05)


def test_numbers_are_kept_once_none_was_set_for_a_moment(running, book):
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.say("set", **change(name, number["key"], number["value"] * 1.01, held=True).fields)
        end = time.monotonic() + 60
        while not server.library.keeper.scenarios(book)[1]:
            assert time.monotonic() < end
            time.sleep(0.05)


def test_results_are_written_beside_the_workbook_and_changes_into_it(running, book, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    leave_out_fits(monkeypatch)
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.next("rest")
        for what, ending in (("book", ".xlsx"), ("page", ".html"), ("json", ".json"), ("run", ".xlmcrun")):
            window.say("save", what=what)
            text = window.next("news")["text"]
            assert text == f"Written: {book.with_name(f'case-results{ending}')}"
            assert book.with_name(f"case-results{ending}").exists()
        kept = open_run(book.with_name("case-results.xlmcrun"))
        again = simulated(load(book))
        for forecast, values in again.forecasts.items():
            assert kept.forecasts[forecast].tobytes() == values.tobytes()
        window.say("set", **change(name, number["key"], number["value"] * 1.01).fields)
        window.next("rest", lambda message: message["version"] == 1)
        window.say("save", what="run")
        assert window.next("news")["text"] == f"Written: {book.with_name('case-changed-results.xlmcrun')}"
        window.say("save", what="into")
        assert window.next("news")["text"].endswith("The workbook as it was: case-before.xlsx")
        assert window.next("news", lambda message: "was saved" in message["text"])
        assert window.heard_last("state")["changes"] == []


def test_studies_are_asked_of_the_state_that_is_shown(running, book):
    server = running(book=book)
    with server.window(server.library.only) as window:
        name, number = first_number(window.next("state"))
        window.next("rest")
        window.say("set", **change(name, number["key"], number["value"] * 1.5).fields)
        window.next("rest", lambda message: message["version"] == 1)
        window.say("study", what="screen", other="")
        messages = window.next("study", lambda message: message["state"] != "running", seconds=120.0)
        assert messages["of"].startswith(f"{name}: ")
        assert messages["state"] == "done"
        window.say("study", what="verify", other="")
        messages = window.next("study")  # tests/outputs/live/test_browser.py waits for its end
        assert (messages["what"], messages["state"], messages["of"]) == ("verify", "running", "")
        window.say("cancel")
        assert window.next("study", lambda message: message["state"] != "running")["state"] == "cancelled"
    assert [each.name for each in book.parent.glob("*.xlsx")] == ["case.xlsx"]


def test_what_waits_for_a_window_that_sleeps_does_not_grow():
    async def waiting():
        window = Window()
        for number in range(500):
            window.put({"kind": "moved", "of": "assumption", "name": f"a{number % 3}", "key": "low", "value": number})
            for kind, more in (("frame", {}), ("rest", {}), ("part", {"tab": ("matters", "tables")[number % 2]})):
                window.put({"kind": kind, "version": number, **more})
            window.put({"kind": "news", "text": f"news {number}", "link": ""})
            window.put({"kind": "trouble", "about": "save", "text": str(number)})
        result = []
        with contextlib.suppress(TimeoutError):
            while True:
                result.append(json.loads(await asyncio.wait_for(window.next(), 0.01)))
        return result

    results = asyncio.run(waiting())
    assert len(results) == 3 + 1 + 1 + 2 + 20 + 1
    assert {each["value"] for each in results if each["kind"] == "moved"} == {497, 498, 499}
    assert {each["version"] for each in results if each["kind"] == "part"} == {498, 499}
    assert [each["text"] for each in results if each["kind"] == "news"] == [f"news {n}" for n in range(480, 500)]
    assert [each["text"] for each in results if each["kind"] == "trouble"] == ["499"]
