"""Filters and evidence that are used or not: by the column Use of the workbook, in scenarios, and in the window."""

from __future__ import annotations

import json

import openpyxl
import pytest
from live_books import change, settle
from openpyxl.worksheet.table import Table

from xlmc.errors import DefinitionError
from xlmc.montecarlo.definitions.scenarios import Limits, Scenario, Switched
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.outputs.live.adjusted_scenarios import adjustments_of
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.live.hand_over import edited_state, write_changes
from xlmc.outputs.live.session import Session
from xlmc.outputs.live.what_changed import what_changed
from xlmc.outputs.live.window_book import filter_rows

USED = {"fast": None, "slow": "no", "own": True, "camera": None, "recorder": False}
"""What stands under Use: three filters, the last of one forecast only, and two rows of evidence."""


def book_at(path, used=USED, *, column=True, scenarios=()):
    """A workbook with two assumptions, two answers, three filters and two rows of evidence."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "S"

    def table(name, top, rows, drop=None):
        rows = [[cell for head, cell in zip(rows[0], row, strict=True) if head != drop] for row in rows]
        for r, row in enumerate(rows):
            for c, value in enumerate(row):
                sheet.cell(top + r, 1 + c, value)
        last = f"{chr(64 + len(rows[0]))}{top + len(rows) - 1}"
        sheet.add_table(Table(displayName=name, ref=f"A{top}:{last}"))

    off = None if column else "Use"
    table("xlmc_assumptions", 1, [["Name", "Value", "Low", "High"], ["v", 30, 20, 40], ["w", 3, 1, 5]])
    table("xlmc_forecasts", 5, [["Name", "Value"], ["speed", "=B2+B3"], ["energy", "=B2*B3"]])
    filters = [
        ["Name", "Cell", "At least", "At most", "Because", "Only for", "Use"],
        ["fast", "=B6", 25, None, "seen", None, used["fast"]],
        ["slow", "=B2", None, 38, "seen", None, used["slow"]],
        ["own", "=B3", None, 4, "seen", "energy", used["own"]],
    ]
    table("xlmc_filters", 10, filters, off)
    evidence = [
        ["Name", "Cell", "Reading", "Error", "Plus or minus", "Std dev", "Source", "Use"],
        ["camera", "=B7", 90, None, 40, None, "video", used["camera"]],
        ["recorder", "=B6", 34, "Normal", None, 2, "file", used["recorder"]],
    ]
    table("xlmc_evidence", 16, evidence, off)
    table("xlmc_settings", 21, [["Setting", "Value"], ["Trials", 4_000]])
    if scenarios:
        table("xlmc_scenarios", 26, list(scenarios))
    book.save(path)
    return path


def assert_same(result, expected):
    assert result.trial_index.size > 20
    assert result.trial_index.tolist() == expected.trial_index.tolist()
    for name, values in expected.forecasts.items():
        assert result.forecasts[name].tobytes() == values.tobytes(), name
    assert result.tally.rejected.tolist() == expected.tally.rejected.tolist()
    assert result.tally.only.tolist() == expected.tally.only.tolist()


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    return load(book_at(tmp_path_factory.mktemp("switches") / "book.xlsx"))


SWITCHED = [
    {"fast": False},
    {"slow": True},
    {"own": False},
    {"camera": False},
    {"recorder": True},
    {"fast": False, "slow": True, "recorder": True, "camera": False},
    dict.fromkeys(USED, True),
    dict.fromkeys(USED, False),
]


@pytest.mark.parametrize("column", [True, False])
@pytest.mark.parametrize("switched", SWITCHED, ids=lambda each: " ".join(f"{k}={v:d}" for k, v in each.items()))
def test_the_window_gives_what_the_workbook_gives_with_this_in_its_column(tmp_path, monkeypatch, switched, column):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)
    before = USED if column else dict.fromkeys(USED)  # without the column every row is used
    session = Session(load(book_at(tmp_path / "book.xlsx", before, column=column)))
    for name, used in switched.items():
        session.receive(change(name, "used", used, of="filter"))
    session.receive(change("w", "high", 4.5))
    settle(session)
    edited = book_at(tmp_path / "edited.xlsx", {**before, **switched})
    book = openpyxl.load_workbook(edited)
    book["S"]["D3"] = 4.5
    book.save(edited)
    expected = simulate(load(edited), evidence=None)
    assert_same(session.rest, expected)
    rows = {each["name"]: each["used"] for each in filter_rows(session.own, session.adjustments)}
    assert rows == {name: switched.get(name, before[name] not in ("no", False)) for name in USED}
    session.receive(change("w", "high", 4.5, held=True))
    session.receive(change("w", "high", 4.4, held=True))
    job = session.job()
    outcome = job.run(lambda: True, lambda share: None, lambda: 0.0)
    book["S"]["D3"] = 4.4
    book.save(edited)
    way = outcome.simulation.settings.evidence
    assert_same(outcome.simulation, simulate(load(edited), trials=1_000, evidence=way))


def test_switches_are_told_kept_and_undone(own):
    session = Session(own)
    settle(session)
    session.receive(change("fast", "used", False, of="filter"))
    session.receive(change("recorder", "used", True, of="filter"))
    assert in_words(own.definitions, session.adjustments) == ["fast: not used", "recorder: used"]
    session.receive(change("fast", "used", True, of="filter"))
    assert in_words(own.definitions, session.adjustments) == ["recorder: used"]
    assert type(session.adjustments).of_json(session.adjustments.as_json()) == session.adjustments
    made = session._models.at_rest(session.adjustments)
    session.receive(change("recorder", "used", False, of="filter"))
    assert not session.adjustments
    assert [each.name for each in made.filters] == ["fast", "camera", "recorder"]


def test_the_models_of_a_switch_are_made_once(own):
    session = Session(own)
    session.receive(change("fast", "used", False, of="filter"))
    first = session._models.moving(session.adjustments)
    session.receive(change("w", "high", 4.0, held=True))
    second = session._models.moving(session.adjustments)
    assert first.reusing is second.reusing
    assert first.model.lowering is second.model.lowering


def test_a_changed_limit_of_a_row_that_is_off_waits_until_it_is_on(own):
    session = Session(own)
    session.receive(change("slow", "at_most", 33.0, of="filter"))
    settle(session)
    assert session.rest.accepted == simulate(own, evidence=None).accepted
    session.receive(change("slow", "used", True, of="filter"))
    settle(session)
    expected = applied(own, [Switched("slow", True), Limits("slow", {"at_most": 33.0})])
    assert_same(session.rest, simulate(expected, evidence=None))


def test_changes_are_typed_into_the_column_or_it_is_named(tmp_path):
    path = book_at(tmp_path / "book.xlsx")
    session = Session(load(path))
    session.receive(change("fast", "used", False, of="filter"))
    session.receive(change("recorder", "used", True, of="filter"))
    settle(session)
    write_changes(session.at_rest(), path, into=False)
    written = load(tmp_path / "book-changed.xlsx")
    assert {name: used for name, (_, used) in written.definitions.switches.items()} == {
        "fast": False, "slow": False, "own": True, "camera": True, "recorder": True,
    }  # fmt: skip
    assert_same(simulate(written, evidence=None), session.rest)
    without = load(book_at(tmp_path / "without.xlsx", dict.fromkeys(USED), column=False))
    session = Session(without)
    for name in ("fast", "camera"):
        session.receive(change(name, "used", False, of="filter"))
        with pytest.raises(DefinitionError, match=f"needs a column Use for '{name}', and the table has none"):
            edited_state(without, session.adjustments, "")
        session.receive(change(name, "used", True, of="filter"))


def test_a_save_that_switches_is_told(own, tmp_path):
    other = load(book_at(tmp_path / "book.xlsx", {**USED, "fast": "off", "slow": None, "recorder": True}))
    message = what_changed(own, other)
    assert sorted(each for each in message if "used" in each) == ["fast: not used", "recorder: used", "slow: used"]


def test_rows_that_are_off_are_listed_and_may_be_wrong(xlmc, tmp_path):
    path = book_at(tmp_path / "book.xlsx", {**USED, "own": "off"})
    book = openpyxl.load_workbook(path)
    book["S"]["D12"] = "forty"  # a limit of the row that is off
    book.save(path)
    outcome = xlmc("check", path)
    assert outcome.code == 0
    assert "not used: Use is off" in outcome.out
    assert "Filters that are not used, because Use is off: 'slow', 'own'" in " ".join(outcome.err.split())
    session = Session(load(path))
    session.receive(change("slow", "used", True, of="filter"))
    job = session.job()
    (message,) = session.finish(job, job.run(lambda: True, lambda share: None, lambda: 0.0))
    assert "S!D12" in message["text"]
    session.receive(change("slow", "used", False, of="filter"))
    settle(session)
    assert session.rest is not None
    book["S"]["B12"] = "=B6"  # another version of the first row
    book.save(path)
    assert xlmc("check", path).code == 0
    book["S"]["G11"] = "perhaps"
    book.save(path)
    outcome = xlmc("check", path)
    assert outcome.code == 2
    assert "S!G11: Use holds 'perhaps', neither TRUE nor FALSE" in " ".join(outcome.err.split())


def test_results_record_what_is_off_and_repeat(xlmc, tmp_path):
    path, results = book_at(tmp_path / "book.xlsx"), tmp_path / "r.xlsx"
    xlmc("simulate", path, "-o", results, "--json", tmp_path / "r.json", "--quiet")
    result = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert [each["name"] for each in result["filters"]] == ["fast", "camera"]
    rows = {each["name"]: each for each in result["record"]["filters"]["rows"]}
    assert (rows["slow"]["limits"], rows["slow"]["rejected"]) == ("not used: Use is off", None)
    assert xlmc("replay", results).code == 0
    book = openpyxl.load_workbook(results)
    book["S"]["G12"] = None
    book.save(results)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    assert "not used: Use is off" in outcome.out


@pytest.mark.parametrize("column", [True, False])
def test_scenarios_switch_rows(tmp_path, column):
    scenarios = [
        ["Name", "fast Use", "camera Use", "w"],
        ["no filter", False, None, None],
        ["no evidence", None, "off", None],
        ["neither", "no", False, "2 to 3"],
    ]
    used = USED if column else dict.fromkeys(USED)
    model = load(book_at(tmp_path / "book.xlsx", used, column=column, scenarios=scenarios))
    for scenario, switched in zip(
        model.definitions.scenarios, ({"fast": False}, {"camera": False}, {"fast": False, "camera": False}), strict=True
    ):
        expected = load(book_at(tmp_path / "edited.xlsx", {**used, **switched}))
        result = applied(model, scenario.changes)
        assert {each.name for each in result.filters} == {each.name for each in expected.filters}
        state = adjustments_of(model.definitions, scenario)
        assert {name: each["used"] for name, each in state.filters.items()} == switched
        if scenario.name != "neither":
            assert_same(simulate(result, trials=2_000), simulate(expected, trials=2_000))


def test_a_limit_of_a_row_that_is_off_is_refused_in_a_scenario(own):
    with pytest.raises(DefinitionError, match="'slow' is not used, so that its limits do not matter"):
        applied(own, Scenario("x", (Limits("slow", {"at_most": 30.0}),)).changes)
    with pytest.raises(DefinitionError, match="There is no filter or evidence 'nope'"):
        applied(own, [Switched("nope", False)])
