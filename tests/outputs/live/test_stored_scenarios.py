"""What outlives a window: nothing that was kept is lost, whatever becomes of the workbook, the file, another window."""

from __future__ import annotations

import json
import os
import stat

import openpyxl
import pytest
from live_books import settle, small

from xlmc.errors import WorkbookError
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.library import Library
from xlmc.outputs.live.protocol import PageMessage
from xlmc.outputs.live.session import Session
from xlmc.outputs.live.stored_scenarios import Keeper, _merged


def changed(name, key="high", value=0.9, of="assumption"):
    return Adjustments().having(of, name, key, value)


@pytest.fixture
def book(tmp_path):
    return small(tmp_path / "case.xlsx")


@pytest.fixture
def keeper(tmp_path):
    return Keeper(tmp_path / "state" / "xlmc" / "live")


STRANGE = {
    "an assumption that is gone": changed("renamed since", "high", 3.0),
    "a parameter of another distribution": changed("friction", "std_dev", 0.1),
    "a switch of one that is gone": changed("removed", "frozen", True),
    "a filter that is gone": changed("no such filter", "at_most", 2.0, of="filter"),
    "a limit that a filter has not": changed("friction", "below", 2.0, of="filter"),
}


@pytest.mark.parametrize("strange", STRANGE.values(), ids=[*STRANGE])
def test_a_kept_state_of_another_workbook_is_shown_with_what_no_longer_fits(book, strange):
    model = load(book)
    fits = changed(model.assumptions[0].name, "frozen", True)
    session = Session(model, {"old": strange, "whole": fits}, strange)
    (state,) = [each for each in session.greeting() if each["kind"] == "state"]
    shown = {each["name"]: each["changes"] for each in state["scenarios"]}
    assert "(no longer in the workbook)" in shown["old"][0]
    assert "(no longer in the workbook)" in state["offered"][0]
    assert "(no longer" not in shown["whole"][0]
    session.receive(PageMessage("show", {"name": "old"}))
    session.receive(PageMessage("compare", {}))
    messages = settle(session)
    assert [each["text"] for each in messages if each["kind"] == "trouble" and each["text"]] == []
    session.receive(PageMessage("restore", {"take": True}))
    settle(session)
    assert session.stored["old"] == strange


def test_a_workbook_that_loses_an_assumption_keeps_what_was_set_of_it(book):
    """The state that no longer fits is offered again, and fits again when the assumption is back."""
    session = Session(load(book))
    name = session.own.assumptions[0].name
    session.receive(
        PageMessage("set", {"of": "assumption", "name": name, "key": "frozen", "value": True, "held": False, "seq": 1})
    )
    before = session.adjustments
    made = openpyxl.load_workbook(book)
    for row in made.worksheets[0].iter_rows():
        for cell in row:
            if cell.value == name:
                cell.value = "another name"
    made.save(book)
    session.replace_book(load(book), [])
    assert not session.adjustments
    assert session.offered == before


def holding(number):
    held = b'{"assumptions": {"a": {"low": %b}}, "filters": {}}' % number
    return b'{"scenarios": {"x": %b}, "unkept": {"assumptions": {}, "filters": {}}}' % held


@pytest.mark.parametrize(
    "content",
    [
        b"{",
        b"[]",
        b'{"scenarios": 5, "unkept": {}}',
        b"\xff\xfe",
        b"[" * 100_000,
        *map(holding, [b"NaN", b"Infinity", b'"-inf"', b"1" + b"0" * 400, b"[1]", b"null"]),
    ],
)
def test_a_damaged_file_is_set_aside_and_told(book, keeper, content):
    keeper.keep(book, {"a": changed("x")}, Adjustments())
    (file,) = keeper._folder.glob("*.json")
    file.write_bytes(content)
    with pytest.raises(WorkbookError, match="set aside as"):
        keeper.scenarios(book)
    (aside,) = keeper._folder.glob("*.damaged1.json")
    assert aside.read_bytes() == content
    assert keeper.scenarios(book) == ({}, Adjustments())


@pytest.mark.parametrize("content", [b"{", b"[]", b'{"books": 5}', b'{"books": {"a": 1}}'])
def test_a_damaged_list_of_workbooks_is_set_aside_and_told_on_the_page(keeper, content):
    keeper.make_folder()
    (keeper._folder / "recent.json").write_bytes(content)
    library = Library(keeper)
    assert library.recent() == []
    assert "set aside as" in library.trouble
    assert (keeper._folder / "recent.damaged1.json").read_bytes() == content


LONG = json.dumps({"books": ["x" * 300, "y/" * 3_000, "\ud800.xlsx"]})


@pytest.mark.parametrize("content", ['{"books": [5, null, "\\u0000", "gone.xlsx"]}', '{"books": []}', "{}", LONG])
def test_entries_that_are_no_workbooks_are_left_out(keeper, content):
    keeper.make_folder()
    (keeper._folder / "recent.json").write_text(content, encoding="utf-8")
    assert keeper.recent() == []


def test_two_programs_on_one_workbook_take_nothing_from_each_other(book, keeper):
    first, second = keeper, Keeper(keeper._folder)
    for each in (first, second):
        each.scenarios(book)
    first.keep(book, {"a": changed("x", value=1.0)}, Adjustments())
    assert second.keep(book, {"b": changed("x", value=2.0)}, Adjustments()).keys() == {"a", "b"}
    assert first.keep(book, {"a": changed("x", value=1.0)}, Adjustments()).keys() == {"a", "b"}
    both = {"a": changed("x", value=1.0), "b": changed("x", value=2.0)}
    assert first.keep(book, {"b": both["b"]}, Adjustments()) == {"b": both["b"]}  # forgotten in the first
    assert second.keep(book, both, Adjustments()) == {"b": both["b"]}  # and so in the second, which did not change it
    first.keep(book, {"b": changed("x", value=3.0)}, Adjustments())
    result = second.keep(book, {"b": changed("x", value=4.0)}, Adjustments())
    assert sorted(each.assumptions["x"]["high"] for each in result.values()) == [3.0, 4.0]


def test_of_one_name_with_two_contents_both_are_kept_under_the_next_free_name():
    a, b, c, d = (changed("x", value=value) for value in (1.0, 2.0, 3.0, 4.0))
    assert _merged({}, {"s": a}, {"s": b}) == {"s": a, "s (2)": b}
    assert _merged({}, {"s": a, "s (2)": c}, {"s": b}) == {"s": a, "s (2)": c, "s (3)": b}
    assert _merged({}, {"s": a}, {"s": b, "s (2)": d}) == {"s": a, "s (2)": d, "s (3)": b}
    assert _merged({}, {"s": a}, {"s": a}) == {"s": a}
    assert _merged({"s": a}, {"s": a}, {"s": b}) == {"s": b}  # changed in the other window alone
    assert _merged({"s": a}, {"s": b}, {"s": a}) == {"s": b}
    assert _merged({"s": a}, {"s": a}, {}) == {}  # forgotten in the other
    assert _merged({"s": a}, {}, {"s": a}) == {}
    assert _merged({"s": a}, {"s": b}, {}) == {"s": b}


def test_a_lock_of_a_program_that_died_does_not_hold_for_ever(book, keeper, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.stored_scenarios._PATIENCE", 0.05)
    keeper.keep(book, {"a": changed("x")}, Adjustments())
    (file,) = keeper._folder.glob("*.json")
    file.with_suffix(".lock").touch()
    keeper.keep(book, {"b": changed("x")}, Adjustments())
    assert keeper.scenarios(book)[0].keys() == {"b"}


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
@pytest.mark.parametrize("action", ["keep", "opened", "drop"])
def test_the_folder_is_its_owners_alone_whatever_makes_it(book, keeper, action):
    before = os.umask(0)
    try:
        if action == "keep":
            keeper.keep(book, {"a": changed("x")}, Adjustments())
        elif action == "opened":
            keeper.opened(book)
        else:
            Library(keeper).take("case.xlsx", book.read_bytes())
    finally:
        os.umask(before)
    folders = [keeper._folder, *(path for path in keeper._folder.rglob("*") if path.is_dir())]
    assert {stat.S_IMODE(path.stat().st_mode) for path in folders} == {0o700}


def test_what_is_written_is_read_again(book, keeper):
    named = {"ä": changed("x"), "b": changed("f", "at_most", 0.25, of="filter")}
    keeper.keep(book, named, changed("y"))
    assert keeper.scenarios(book) == (named, changed("y"))
    (file,) = keeper._folder.glob("*.json")
    assert json.loads(file.read_text(encoding="utf-8"))["book"] == str(book)


def test_many_large_scenarios_are_read_back_and_too_many_are_not_written(tmp_path, monkeypatch):
    """A file of more than 4 MB was cut when it was read, and set aside as damaged."""
    keeper, book = Keeper(tmp_path / "state"), tmp_path / "book.xlsx"
    large = Adjustments({f"assumption {n}": {"low": float(n), "high": n + 0.123456789} for n in range(300)})
    kept = {f"scenario {n}": large for n in range(200)}
    keeper.keep(book, kept, Adjustments())
    (path,) = (tmp_path / "state").glob("*.json")
    assert path.stat().st_size > 4 << 20
    assert Keeper(tmp_path / "state").scenarios(book) == (kept, Adjustments())
    monkeypatch.setattr("xlmc.outputs.live.stored_scenarios._MOST_BYTES", path.stat().st_size)
    with pytest.raises(WorkbookError, match="there are too many"):
        keeper.keep(book, {**kept, "one more": large}, Adjustments())
    assert Keeper(tmp_path / "state").scenarios(book) == (kept, Adjustments())
    assert [each.suffix for each in (tmp_path / "state").iterdir()] == [".json"]
