"""A session without sockets, files or threads: what it tells, and that its numbers are those of `xlmc simulate`."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from datetime import datetime, timedelta
from itertools import chain, repeat

import numpy as np
import openpyxl
import pytest
from live_books import (
    CASE,
    book_of_dates,
    book_of_decisions,
    book_of_readings,
    book_with_decisions,
    change,
    edited,
    rows_of,
    settle,
    short_case,
    simple,
    small,
    type_in,
    wide_book,
    with_column,
)
from openpyxl.worksheet.table import Table

from xlmc.analysis.results.statements.sentences import statements
from xlmc.errors import XlmcError
from xlmc.montecarlo.columns.column_store import on_disk
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.outputs.live.adjusted_scenarios import adjustments_of, scenario_of
from xlmc.outputs.live.adjustments import NONE, PARTS, Adjustments
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.live.frames import matrix_of, pair_of
from xlmc.outputs.live.hand_over import page_of
from xlmc.outputs.live.jobs import MOVING_TRIALS, Outcome, SupersededError
from xlmc.outputs.live.kinds import in_kind
from xlmc.outputs.live.protocol import PageMessage, written
from xlmc.outputs.live.session import Session
from xlmc.outputs.live.single_step import Step
from xlmc.outputs.live.what_changed import what_changed
from xlmc.outputs.live.window_book import assumption_rows, correlation_rows, decision_rows, filter_rows, solve_rows

FRICTION = "Chevrolet post-impact deceleration"

SCENARIOS = {
    "ranges, wider, narrower and below zero": {
        (FRICTION, "Low"): 0.7,
        (FRICTION, "High"): 0.8,
        ("Chevrolet impact centre y", "Low"): -18.0,
        ("Chevrolet impact centre y", "High"): -9.5,
        ("Chevrolet weight", "Low"): 6600.0,
        ("Nissan weight", "High"): 3600.0,
    },
    "one value": {("Orientation of tangent", "Low"): 101.0, ("Orientation of tangent", "High"): 101.0},
    "all of it": {
        (FRICTION, "High"): 1.05,
        ("Nissan weight", "Frozen"): True,
        ("Chevrolet weight", "Frozen"): True,
        ("Nissan impact speed", "Above"): 2.0,
        ("Restitution, tangential", "At most"): 0.3,
    },
}
KEYS = {"Low": "low", "High": "high", "Frozen": "frozen", "At most": "at_most", "Above": "above"}


def done(session, job, clock=lambda: 0.0, messages=lambda share: None):
    """What is told of a job that is run, or given up."""
    try:
        return session.finish(job, job.run(lambda: session.wanted(job), messages, clock))
    except SupersededError:
        return session.superseded(job)


def until(session, stage):
    """Do all that comes before a stage; its job."""
    while (job := session.job()).stage != stage:
        done(session, job)
    return job


def seen(names, tab="charts", first="", second="", *, trial=0, fits=False):
    pair = {"first": first, "second": second}
    return {"forecasts": names, "chosen": names, "tab": tab, **pair, "trial": trial, "fits": fits}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """The case study with fewer trials: its file and its model."""
    path = short_case(tmp_path_factory.mktemp("case") / "case.xlsx")
    return path, load(path)


def test_at_rest_the_numbers_are_those_of_simulate_with_the_same_numbers_in_the_workbook(case, tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)  # which come before those at rest
    path, model = case
    session, typed, rows = Session(model), openpyxl.load_workbook(path), rows_of(model)
    filters = {each.name for each in model.filters}
    for name, changes in SCENARIOS.items():
        session.receive(PageMessage("reset", {"of": "assumption", "name": ""}))
        for (row, heading), value in changes.items():
            of = "filter" if row in filters else "assumption"
            session.receive(change(row, KEYS[heading], value, of=of))
        settle(session)
        before = type_in(typed, rows, changes)
        typed.save(tmp_path / "edited.xlsx")
        for cell, value in before:
            cell.value = value
        expected = simulate(load(tmp_path / "edited.xlsx"))
        assert session.rest.accepted == expected.accepted, name
        for forecast, values in expected.forecasts.items():
            assert session.rest.forecasts[forecast].tobytes() == values.tobytes(), (name, forecast)
        assert session.rest.tally.rejected.tolist() == expected.tally.rejected.tolist(), name


@pytest.mark.parametrize("way", ["", "rejection", "weights"])
def test_evidence_is_used_as_simulate_uses_it(model_of, way, monkeypatch):
    """Weights, asked for or chosen by the rule on the first trials: at rest and while a handle moves."""
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 5_000)
    evidence = {"edr": {"cell": "B1", "reading": 1.1, "error": "normal", "std_dev": 0.05}}
    inputs = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}, "v": {"cell": "A2", "low": 0.0, "high": 1.0}}
    model = model_of({"A1": 0.5, "A2": 0.5, "B1": "=A1*A2"}, inputs, {"x": "B1", "y": "A1"}, {}, evidence=evidence)
    settings = replace(model.definitions.settings, trials=10_000, evidence=way)
    model = model.changed(model.workbook, replace(model.definitions, settings=settings))
    session = Session(model)
    for value in (1.0, 0.99):
        session.receive(change("u", "high", value))
        settle(session)
        expected = simulate(session._models.at_rest(session.adjustments), evidence=None)
        assert session.rest.settings == expected.settings
        assert (expected.weighting is None) == (way == "rejection")
        for name, values in expected.forecasts.items():
            assert session.rest.forecasts[name].tobytes() == values.tobytes()
            assert session.rest[name].mean == expected[name].mean
    session.receive(change("u", "high", 0.98, held=True))
    job = session.job()
    outcome = job.run(lambda: True, lambda share: None, lambda: 0.0)
    used = outcome.simulation.settings.evidence
    assert used == expected.settings.evidence
    state = session._models.at_rest(session.adjustments)
    expected = simulate(state, trials=moving, sampling="mc", evidence=used)
    for name, values in expected.forecasts.items():
        assert outcome.simulation.forecasts[name].tobytes() == values.tobytes()
    session.finish(job, outcome)
    for tab in ("matters", "pairs", "tables"):
        view = seen(["x"], tab, "x", "v", fits=True)
        session.receive(PageMessage("view", view))
        for message in settle(session):
            written(message)


def test_while_a_handle_moves_a_run_of_fifty_thousand_trials_comes_first(case):
    session = Session(case[1])
    settle(session)
    session.receive(change(FRICTION, "high", 0.9, held=True, seq=7))
    job = session.job()
    assert (job.stage, job.dragged) == ("moving", True)
    (frame,) = session.finish(job, job.run(lambda: True, lambda share: None, lambda: 0.0))
    assert (frame["stage"], frame["trials"], frame["seq"]) == ("moving", MOVING_TRIALS, 7)
    assert frame["shapes"][FRICTION]["high"] == pytest.approx(0.9, abs=1e-3)
    drawn = frame["forecasts"]["Chevrolet delta-V"]
    assert sum(drawn["bins"]["counts"]) + drawn["bins"]["below"] + drawn["bins"]["above"] == frame["accepted"]
    assert session.job().stage == "rest"


def test_the_newest_is_done_and_what_is_older_is_given_up(case):
    session = Session(case[1])
    settle(session)
    session.receive(change(FRICTION, "high", 0.9))
    moving = session.job()
    session.finish(moving, moving.run(lambda: True, lambda share: None, lambda: 0.0))
    old = session.job()
    session.receive(change(FRICTION, "high", 0.91))
    assert not session.wanted(old)
    with pytest.raises(SupersededError):
        old.run(lambda: session.wanted(old), lambda share: None, lambda: 0.0)
    settle(session)
    assert session.adjustments.assumptions[FRICTION] == {"high": 0.91}
    assert session.job() is None


def test_a_stopped_run_is_not_begun_again_until_something_changes(case):
    session = Session(case[1])
    session.receive(PageMessage("stop", {}))
    assert session.job() is None
    session.receive(change(FRICTION, "high", 0.9))
    assert session.job() is not None


def test_a_state_that_is_no_distribution_is_told_and_the_last_good_answer_stays(case):
    session = Session(case[1])
    settle(session)
    before = session.rest
    session.receive(change(FRICTION, "high", 0.1))
    (trouble,) = settle(session)
    assert trouble["kind"] == "trouble"
    assert "above High" in trouble["text"]
    assert "Inputs!" in trouble["text"]
    assert session.rest is before
    session.receive(change(FRICTION, "high", 0.9))
    messages = settle(session)
    assert [each["text"] for each in messages if each["kind"] == "trouble"] == [""]
    assert session.rest is not before


def test_a_value_of_the_workbook_is_no_change(case):
    session = Session(case[1])
    own = next(each for each in case[1].assumptions if each.name == FRICTION).parameters["high"]
    session.receive(change(FRICTION, "high", 0.9))
    assert session.adjustments
    session.receive(change(FRICTION, "high", own))
    assert not session.adjustments


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [("no such", "high", 1.0), (FRICTION, "mean", 1.0), (FRICTION, "frozen", 1.0), (FRICTION, "high", True)],
)
def test_what_the_workbook_does_not_have_cannot_be_set(case, name, key, value):
    with pytest.raises(XlmcError):
        Session(case[1]).receive(change(name, key, value))


def test_the_state_behind_and_the_difference_in_numbers(case):
    session = Session(case[1])
    settle(session)
    messages = session._last["frame "]["forecasts"]["Nissan delta-V"]
    assert messages["behind"] is None
    session.receive(change(FRICTION, "high", 0.85))
    settle(session)
    messages = session._last["frame "]["forecasts"]["Nissan delta-V"]
    assert messages["said"].startswith("Nissan delta-V: mean 22.9")
    assert " → " in messages["said"]
    assert sum(messages["behind"]["counts"]) <= messages["behind"]["trials"] == session.behind.accepted
    mean = {label: rest for label, *rest in messages["beside"]}["Mean"]
    assert mean[0].startswith(f"{session.rest['Nissan delta-V'].mean.value:.2f}"[:4])
    assert mean[1].startswith(f"{session.behind['Nissan delta-V'].mean.value:.2f}"[:4])
    session.receive(PageMessage("pin", {}))
    settle(session)
    assert session._last["frame "]["forecasts"]["Nissan delta-V"]["behind"] is None


def test_scenarios_are_kept_shown_and_dropped(case):
    session = Session(case[1])
    session.receive(change(FRICTION, "high", 0.85))
    session.receive(PageMessage("keep", {"name": " dry "}))
    assert session.stored == {"dry": Adjustments({FRICTION: {"high": 0.85}})}
    assert not session.unkept
    session.receive(PageMessage("show", {"name": ""}))
    assert not session.adjustments
    (state,) = session.receive(PageMessage("show", {"name": "dry"})).all
    assert state["shown"] == "dry"
    assert state["changes"] == [f"{FRICTION}: High 0.95 → 0.85"]
    session.receive(change(FRICTION, "high", 0.8))
    assert session.shown == ""
    assert session.unkept.assumptions == {FRICTION: {"high": 0.8}}
    session.receive(PageMessage("drop", {"name": "dry"}))
    assert session.stored == {}
    with pytest.raises(XlmcError):
        session.receive(PageMessage("show", {"name": "dry"}))


def test_what_was_not_kept_is_offered(case):
    lost = Adjustments().having("assumption", FRICTION, "high", 0.85).having("assumption", "gone", "high", 1.0)
    session = Session(case[1], {}, lost)
    (state,) = [each for each in session.greeting() if each["kind"] == "state"]
    assert state["offered"] == [f"{FRICTION}: High 0.95 → 0.85", "gone: high 1 (no longer in the workbook)"]
    assert session.unkept == lost
    session.receive(PageMessage("restore", {"take": True}))
    assert session.adjustments.assumptions == {FRICTION: {"high": 0.85}}


def test_a_workbook_that_was_saved_keeps_what_was_moved_and_says_what_changed(tmp_path):
    path = small(tmp_path / "case.xlsx")
    model = load(path)
    friction, _, distance = (each.name for each in model.assumptions)
    session = Session(model)
    session.receive(change(friction, "high", 0.85))
    session.receive(change(distance, "high", 66.0))
    settle(session)
    saved = load(edited(path, tmp_path / "saved.xlsx", {(distance, "High"): 66.0, (friction, "Low"): 0.65}))
    messages = session.replace_book(saved, what_changed(model, saved))
    (news,) = [each["text"] for each in messages if each["kind"] == "news"]
    assert f"{friction}: Low 0.6 → 0.65" in news
    assert f"{distance}: High 60 → 66" in news
    assert session.adjustments.assumptions == {friction: {"high": 0.85}}
    settle(session)
    now = next(each for each in session.rest.model.assumptions if each.name == friction)
    assert (now.parameters["low"], now.parameters["high"]) == (0.65, 0.85)


def test_all_tabs_are_made_of_the_run_at_rest(case):
    session = Session(case[1])
    names = [each.name for each in case[1].forecasts]
    for tab, first, second in (("matters", "", ""), ("tables", "", ""), ("pairs", FRICTION, names[1])):
        session.receive(PageMessage("view", seen(names[:1], tab, first, second, fits=True)))
        *sketched, part = [each for each in settle(session) if each["kind"] == "part"]
        assert {each["tab"] for each in (*sketched, part)} == {tab}
        if tab == "pairs":
            run = session.rest
            assert part["pair"]["x"][:5] == run.inputs[FRICTION][:5].tolist()
            assert part["pair"]["y"][:5] == run.forecasts[names[1]][:5].tolist()
            assert_quadrants(part["pair"]["quadrants"], run.inputs[FRICTION], run.forecasts[names[1]])
        else:
            assert names[0] in part["html"]


def test_dates_percentages_and_money_are_told_as_their_cells_show_them(tmp_path):
    model = load(book_of_dates(tmp_path / "case.xlsx"))
    session = Session(model)
    session.receive(PageMessage("view", seen(["end"], "step", trial=1)))
    (part,) = [each for each in settle(session) if each["kind"] == "part"]
    drawn = {name: float(values[1]) for name, values in session.rest.prior.items()}
    for text in (str(_EPOCH + timedelta(days=int(drawn["start"])))[:10], f"{100 * drawn['discount']:.6g} %"):
        assert f">{text}<" in part["html"]
    session.receive(change("start", "low", 46_060.0))
    session.receive(change("start", "base", 46_080.0))
    session.receive(change("discount", "high", 0.45))
    session.receive(change("price", "mean", 50_000.0))
    (state,) = session.receive(change("early", "at_most", 46_130.0, of="filter")).all
    assert state["changes"] == [
        "start: Low 2026-02-01 → 2026-02-07",
        "start: value 2026-03-01 → 2026-02-27",
        "discount: High 40 % → 45 %",
        "price: Mean $48,000 → $50,000",
        "early: at most 2026-03-29 → 2026-04-18",
    ]
    assert pair_of(session.rest, "end", "net price")["together"] == []  # a date and an amount of money have no axis
    start, discount, _ = state["assumptions"]
    assert [each["form"]["moment"] for each in (start, *start["numbers"], *state["filters"])] == ["day"] * 4
    assert (start["step"], state["filters"][0]["step"]) == (1.0, 1.0)
    assert (discount["form"]["factor"], discount["form"]["after"], discount["form"]["moment"]) == (100.0, " %", None)
    edited(tmp_path / "case.xlsx", tmp_path / "edited.xlsx", {("start", "Low"): 46_060.0, ("price", "Mean"): 5e4})
    messages = what_changed(model, load(tmp_path / "edited.xlsx"))
    assert messages == ["start: Low 2026-02-01 → 2026-02-07", "price: Mean $48,000 → $50,000"]


_EPOCH = datetime(1899, 12, 30)

VAST = {
    "a date": (book_of_dates, ("start", "low", "assumption")),
    "a limit that is a date": (book_of_dates, ("early", "at_most", "filter")),
    "a threshold that is a date": (book_of_dates, ("end", "threshold", "forecast")),
    "a normal error": (book_of_readings, ("witness", "std_dev", "filter")),
    "a lognormal error": (book_of_readings, ("marks", "percent", "filter")),
    "an error on both sides": (book_of_readings, ("at 40 ft", "plus_minus", "filter")),
    "a decision": (book_of_decisions, ("limit", "value", "decision")),
}


@pytest.mark.parametrize("value", [1e308, -1e308, 5e-324])
@pytest.mark.parametrize(("book", "of"), VAST.values(), ids=VAST)
def test_the_largest_numbers_are_answered(tmp_path, monkeypatch, book, of, value):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 500)
    session = Session(load(book(tmp_path / "case.xlsx")))
    name, key, kind = of
    messages = [*session.receive(change(name, key, value, of=kind)).all, *session.greeting()]
    for _ in range(8):
        if (job := session.job()) is not None:
            messages += done(session, job)
    assert session.adjustments
    assert all(written(each) for each in messages)


def test_what_meets_a_fault_of_xlmc_is_taken_back(case, monkeypatch):
    session = Session(case[1])
    session.receive(change(FRICTION, "low", 0.71))
    before = session.adjustments

    def fails(own, adjustments):
        if adjustments != before:
            raise ZeroDivisionError("a fault")
        return []

    monkeypatch.setattr("xlmc.outputs.live.session.filter_rows", fails)
    with pytest.raises(XlmcError, match="xlmc has failed, and takes this back: ZeroDivisionError: a fault"):
        session.receive(change(FRICTION, "high", 0.8))
    assert session.adjustments == before
    assert session.greeting()


@pytest.mark.parametrize("trial", [0, 1, 2, 3_000, 10**9])
def test_a_stepped_trial_is_the_workbook_with_its_draws_typed_in(case, tmp_path, trial):
    path, model = case
    session, names = Session(model), [each.name for each in model.forecasts]
    session.receive(PageMessage("view", seen(names, "step", trial=trial)))
    (part,) = [each for each in settle(session) if each["kind"] == "part"]
    run = session.rest
    kept = min(values.size for values in run.prior.values())
    assert (part["tab"], part["trial"], part["trials"]) == ("step", min(trial, kept - 1), kept)
    at = part["trial"]
    holds, values = Step(run.model).at(run.prior, at)
    typed = openpyxl.load_workbook(path)
    for row in ("Frozen", "Value"):
        changes = {(name, row): True if row == "Frozen" else float(drawn[at]) for name, drawn in run.prior.items()}
        type_in(typed, rows_of(model), changes)
    typed.save(tmp_path / "typed.xlsx")
    reference = load(tmp_path / "typed.xlsx").program("formulas").evaluator(1)
    assert [bool(column.values[0]) for column in reference.filters({}, 1)] == holds
    for forecast, column in zip(model.forecasts, reference.forecasts(np.arange(1)), strict=True):
        assert float(column.values[0]) == pytest.approx(values[forecast.cell], rel=1e-12), forecast.name
        assert forecast.name in part["html"]
    assert {*values} >= {*run.model.needed.graph.formulas}
    verdict = "is accepted" if all(holds) else "is rejected by"
    assert f"Trial {at + 1:,} {verdict}" in part["html"]


def test_the_trials_that_are_stepped_through_are_those_that_were_counted(case):
    session = Session(case[1])
    settle(session)
    run = session.rest
    step, accepted = Step(run.model), []
    for trial in range(200):
        holds, values = step.at(run.prior, trial)
        if all(holds):
            accepted.append([values[each.cell] for each in run.model.forecasts])
    assert 0 < len(accepted) < 200
    for number, forecast in enumerate(run.model.forecasts):
        shown = [values[number] for values in accepted]
        assert run.forecasts[forecast.name][: len(shown)].tolist() == shown, forecast.name


def test_what_matters_follows_while_a_handle_moves_unless_it_takes_long(case, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)
    session = Session(case[1])
    names = [each.name for each in case[1].forecasts]
    session.receive(PageMessage("view", seen(names, "matters")))
    settle(session)
    for number, (seconds, stages, sketched) in enumerate(
        [(0.01, ["moving", "sketch"], 1), (9.0, ["moving", "sketch"], 0), (9.0, ["moving"], 0)]
    ):
        session.receive(change(FRICTION, "high", 0.9 + number / 100, held=True))
        messages = []
        for stage in stages:
            job = session.job()
            assert job.stage == stage
            messages += done(session, job, chain([0.0], repeat(seconds if stage == "sketch" else 0.0)).__next__)
        assert [each["tab"] for each in messages if each["kind"] == "part"] == ["matters"] * sketched
    assert session.job().stage == "rest"


def test_all_that_is_told_is_json_without_numbers_that_are_none(tmp_path):
    session = Session(load(simple(tmp_path / "case.xlsx")))
    for message in (*session.greeting(), *settle(session), *session.greeting()):
        written(message)
    assert np.isfinite(session.rest.accepted)


def test_all_scenarios_are_compared_in_one_table(case):
    session = Session(case[1])
    settle(session)
    session.receive(change(FRICTION, "high", 0.85))
    session.receive(PageMessage("keep", {"name": "dry <b>road"}))
    session.receive(PageMessage("compare", {}))
    (part,) = [each for each in settle(session) if each["kind"] == "part"]
    assert part["tab"] == "scenarios"
    assert "dry &lt;b&gt;road" in part["html"]
    assert "as it is" in part["html"]
    expected = simulate(session._models.at_rest(session.adjustments))
    assert f"{expected.accepted:,}" in part["html"]


def assert_quadrants(message, x, y):
    """A quadrant's share is said as it is counted; of two medians each half of a quantity lies above its own."""
    shares = [float(each) for each in re.findall(r"(\d+\.\d) %", message)]
    both = 100.0 * np.mean((x > np.median(x)) & (y > np.median(y)))
    assert shares[0] == pytest.approx(both, abs=0.051)
    assert shares[0] + shares[1] == pytest.approx(50.0, abs=0.15)
    assert shares[0] + shares[2] == pytest.approx(50.0, abs=0.15)
    assert sum(shares) == pytest.approx(100.0, abs=0.21)
    assert message.count("(median)") == 2


def test_pairs_of_the_first_trials_alone_say_so(readings, monkeypatch):
    session = Session(readings[1])
    settle(session)
    whole = pair_of(session.rest, "speed", "distance")
    assert whole["looked"] == whole["accepted"] == whole["trials"] == session.rest.accepted
    assert "% of the trials; only the first" in whole["quadrants"]
    monkeypatch.setattr("xlmc.outputs.live.frames._POINTS", 20)
    part = pair_of(session.rest, "speed", "distance")
    assert (part["looked"], part["accepted"], part["trials"]) == (1_000, session.rest.accepted, 1_000)
    assert "% of the first 1,000 accepted trials; only the first" in part["quadrants"]


def test_a_matrix_of_pairs_says_what_the_pairs_say(readings):
    session = Session(readings[1])
    settle(session)
    session.receive(PageMessage("view", seen(["speed", "distance"], "pairs", "speed", "distance")))
    (part,) = (each for each in settle(session) if each["kind"] == "part")
    matrix, pair = part["matrix"], part["pair"]
    assert matrix["names"] == ["speed", "distance"]
    assert matrix["limits"][0] == 35.0
    assert matrix["said"][0] == "speed 35 mph (threshold)"
    (cell,) = matrix["cells"]
    assert cell["correlation"] == pytest.approx(pair["correlation"])
    assert f"{cell['above']:.1f} % of the trials" in pair["quadrants"]
    assert matrix["points"][0] == session.rest.forecasts["speed"][:300].tolist()
    assert (matrix["left"], matrix["looked"], matrix["accepted"]) == (0, session.rest.accepted, session.rest.accepted)
    assert written(part)
    assert matrix_of(session.rest, ["speed"]) is None


def test_a_matrix_is_not_made_while_a_handle_moves(readings):
    session = Session(readings[1])
    settle(session)
    session.receive(PageMessage("view", seen(["speed", "distance"], "pairs", "speed", "distance")))
    session.receive(change("t", "high", 2.6, held=True))
    (part,) = (each for each in done(session, until(session, "moving")) if each["kind"] == "part")
    assert part["pair"]["first"] == "speed"
    assert "matrix" not in part


def test_quadrants_are_those_of_a_threshold_where_there_is_one(readings):
    session = Session(readings[1])
    settle(session)
    message = pair_of(session.rest, "speed", "distance")["quadrants"]
    x, y = session.rest.forecasts["speed"], session.rest.forecasts["distance"]
    assert message.startswith("Above speed 35 mph (threshold) and above distance ")
    still = Session(readings[1])
    still.receive(change("t", "frozen", True))
    still.receive(change("v", "frozen", True))
    settle(still)
    assert pair_of(still.rest, "speed", "distance")["quadrants"] == ""
    only_second = 100.0 * np.mean((y > np.median(y)) & (x <= 35.0))
    assert f"only the second {only_second:.1f} %" in message


def test_the_usual_variants_are_scenarios(case):
    session = Session(case[1])
    session.receive(PageMessage("variants", {}))
    names = [*session.stored]
    assert names[:2] == ["every range half as wide", "every range one and a half times as wide"]
    assert "Restitution, tangential at most 0.125 (half)" in names
    narrow = session.stored["every range half as wide"].assumptions
    assert narrow[FRICTION] == {"low": 0.6875, "high": 0.8625}
    assert len(narrow) == len(case[1].live)


def test_a_band_of_a_distribution_is_a_range_of_its_percentiles(case):
    session = Session(case[1])
    session.receive(change(FRICTION, "band_high", 50.0))
    settle(session)
    other = Session(case[1])
    other.receive(change(FRICTION, "high", 0.775))
    settle(other)
    assert session.rest.inputs[FRICTION].max() < 0.775
    drawn, expected = session.rest.inputs[FRICTION], other.rest.inputs[FRICTION]
    assert np.allclose(drawn, expected, rtol=1e-12)


MOVED = {
    "a reading with a tolerance": [("filter", "at 40 ft", "reading", 33.0)],
    "its tolerance": [("filter", "at 40 ft", "plus_minus", 2.0)],
    "an instrument": [("filter", "laser", "reading", 31.0), ("filter", "laser", "percent", 9.0)],
    "its resolution": [("filter", "laser", "resolution", 2.0)],
    "a reading with a normal error": [("filter", "witness", "reading", 66.0), ("filter", "witness", "std_dev", 6.0)],
    "a lognormal one": [("filter", "marks", "reading", 64.0), ("filter", "marks", "percent", 30.0)],
    "at least": [("filter", "camera", "reading", 29.0), ("filter", "camera", "plus_minus", 0.25)],
    "one that was not used": [("filter", "doubtful", "used", True), ("filter", "doubtful", "reading", 57.0)],
    "one that is not used now": [("filter", "witness", "used", False), ("filter", "witness", "reading", 57.0)],
    "a cutoff that goes": [("assumption", "v", "upper_cutoff", NONE)],
    "both go": [("assumption", "v", "upper_cutoff", NONE), ("assumption", "v", "lower_cutoff", NONE)],
    "a limit that goes": [("filter", "possible", "at_most", NONE), ("assumption", "t", "high", 3.0)],
    "a threshold": [("forecast", "distance", "threshold", 70.0), ("forecast", "speed", "threshold", NONE)],
    "a central range": [("forecast", "speed", "central", 95.0), ("filter", "at 40 ft", "reading", 33.0)],
}
HEADINGS = {
    "reading": "Reading",
    "plus_minus": "±",
    "percent": "Percent",
    "resolution": "Resolution",
    "std_dev": "Std dev",
    "used": "Use",
    "upper_cutoff": "Upper cutoff",
    "lower_cutoff": "Lower cutoff",
    "at_most": "At most",
    "high": "High",
    "threshold": "Threshold",
    "central": "Range %",
}


@pytest.fixture(scope="module")
def readings(tmp_path_factory):
    path = book_of_readings(tmp_path_factory.mktemp("readings") / "case.xlsx")
    return path, load(path)


@pytest.mark.parametrize("moved", MOVED.values(), ids=MOVED)
def test_further_handles_give_what_the_edited_workbook_gives(readings, tmp_path, moved, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 3_000)
    path, model = readings
    session = Session(model)
    settle(session)
    for of, name, key, value in moved:
        session.receive(change(name, key, value, of=of))
    typed = {(name, HEADINGS[key]): None if value == NONE else value for _, name, key, value in moved}
    copy = load(edited(path, tmp_path / "edited.xlsx", typed))
    settle(session)
    expected = simulate(copy, evidence=session.rest.settings.evidence)
    assert expected.accepted > 50
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    assert session.rest.tally.rejected.tolist() == expected.tally.rejected.tolist()
    for forecast, values in expected.forecasts.items():
        assert session.rest.forecasts[forecast].tobytes() == values.tobytes(), forecast
    assert [text.text for text in statements(session.rest)] == [text.text for text in statements(expected)]
    state = session.at_rest()
    assert state.changes
    assert page_of(state)  # which is of a copy with these changes typed into it, compared to the last bit
    session.receive(PageMessage("keep", {"name": "kept"}))
    again = Adjustments.of_json(json.loads(json.dumps(session.stored["kept"].as_json())))
    assert again == session.adjustments
    assert scenario_of(model.definitions, "kept", again) == scenario_of(model.definitions, "kept", session.adjustments)
    assert adjustments_of(model.definitions, scenario_of(model.definitions, "kept", again)) is not None

    stage = "rest" if moved[0][0] == "forecast" else "moving"  # how answers are stated changes no trial
    session.receive(PageMessage("show", {"name": ""}))
    if stage == "moving":
        done(session, until(session, stage))
    session.receive(PageMessage("show", {"name": "kept"}))
    result = until(session, stage).run(lambda: True, lambda share: None, lambda: 0.0).simulation
    expected = simulate(copy, trials=result.trials, sampling="mc", evidence=result.settings.evidence)
    assert result.trials in (moving, 4_000)
    assert result.trial_index.tobytes() == expected.trial_index.tobytes()
    session.receive(PageMessage("undo", {}))
    assert len(session.adjustments.as_json()["filters"]) <= 2


@pytest.mark.parametrize(
    ("columns", "handles"),
    [
        ({"witness Reading": 61.0, "witness std dev": 8.0}, {"witness": {"reading": 61.0, "std_dev": 8.0}}),
        ({"at 40 ft ±": 2.0, "witness Use": "no"}, {"at 40 ft": {"plus_minus": 2.0}, "witness": {"used": False}}),
        ({"possible At most": 70}, {"possible": {"at_most": 70.0}}),
        ({"possible At most": "none"}, {"possible": {"at_most": NONE}}),
        ({"t High": 3.0, "v Upper cutoff": "none"}, {"t": {"high": 3.0}, "v": {"upper_cutoff": NONE}}),
        ({"t High": 2.9, "t": "0.5 to 3"}, {"t": {"low": 0.5, "high": 3.0}}),
        ({"speed Threshold": 36, "speed Range %": 95}, {"speed": {"threshold": 36.0, "central": 95.0}}),
        ({"t Distribution": "Uniform"}, None),
        ({"M!C5": 1.0}, None),
    ],
)
def test_a_scenario_headed_by_what_has_a_handle_can_be_shown(readings, tmp_path, columns, handles):
    """What is typed into the cells of a row is the same as what its handles do, to the last bit."""
    book = openpyxl.load_workbook(readings[0])
    sheet = book.create_sheet("Scenarios")
    sheet.append(["Name", *columns])
    sheet.append(["other", *columns.values()])
    sheet.add_table(Table(displayName="xlmc_scenarios", ref=f"A1:{chr(65 + len(columns))}2"))
    book.save(tmp_path / "case.xlsx")
    session = Session(load(tmp_path / "case.xlsx"))
    (row,) = session.greeting()[1]["scenarios"]
    assert row["shows"] is (handles is not None)
    if handles is None:
        return
    session.receive(PageMessage("show", {"name": "other"}))
    result = session.adjustments.as_json()
    assert {name: each for part in result.values() for name, each in part.items()} == handles
    settle(session)
    (scenario,) = session.own.definitions.scenarios
    expected = simulate(applied(session.own, scenario.changes), evidence=None)
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    for name, values in expected.forecasts.items():
        assert session.rest.forecasts[name].tobytes() == values.tobytes()


KINDS_MOVED = {
    "ends become a mean": ("t", "Normal", {}),
    "a mean becomes ends": ("v", "Uniform", {}),
    "its numbers are moved": ("t", "Normal", {"mean": 2.1, "std_dev": 0.4}),
    "of positive numbers": ("v", "Lognormal", {"std_dev": 3.0}),
}
COLUMNS = {"low": "Low", "high": "High", "mean": "Mean", "std_dev": "Std dev", "location": "Location"}


def test_rows_and_shapes_that_are_kept_are_those_that_are_made_anew(readings):
    path, model = readings
    session = Session(model)
    settle(session)
    moves = [
        change("v", "mean", 31.0),
        change("t", "high", 2.7),
        change("v", "upper_cutoff", 37.0),
        change("v", "frozen", True),
        change("v", "base", 33.0),
        change("v", "frozen", False),
        change("t", "kind", "Normal"),
        change("t", "mean", 2.1),
        change("v", "mean", None),
        PageMessage("undo", {}),
        change("t", "band_low", 20.0),
        PageMessage("reset", {"of": "assumption", "name": "t"}),
    ]
    for sent in moves:
        (state,) = session.receive(sent).all
        frame = next_frame(session)
        fresh = Session(load(path))
        fresh.adjustments = session.adjustments
        first = next_frame(fresh)
        assert state["assumptions"] == assumption_rows(fresh.own, session.adjustments), sent
        assert frame["shapes"] == first["shapes"], sent


def next_frame(session):
    """The charts that are told next."""
    while True:
        for each in done(session, session.job()):
            if each["kind"] == "frame":
                return each


@pytest.mark.parametrize(("name", "kind", "numbers"), KINDS_MOVED.values(), ids=KINDS_MOVED)
def test_another_kind_of_distribution_gives_what_the_edited_workbook_gives(
    readings, tmp_path, monkeypatch, name, kind, numbers
):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 2_000)
    path, _ = readings
    if kind == "Lognormal":  # a table needs a column for every number
        path = with_column(path, tmp_path / "wider.xlsx", "Location")
    model = load(path)
    session = Session(model)
    settle(session)
    first = session.rest
    session.receive(change(name, "kind", kind))
    for key, value in numbers.items():
        session.receive(change(name, key, value))
    (row,) = (each for each in assumption_rows(model, session.adjustments) if each["name"] == name)
    shown = {each["key"]: each["value"] for each in row["numbers"]}
    assert row["kind"] == kind
    assert numbers.items() <= shown.items()
    typed = {(name, heading): None for heading in ("Low", "High", "Mean", "Std dev", "Lower cutoff", "Upper cutoff")}
    typed |= {(name, COLUMNS[key]): value for key, value in shown.items()} | {(name, "Distribution"): kind}
    copy = load(edited(path, tmp_path / "edited.xlsx", typed))
    result = until(session, "moving").run(lambda: True, lambda share: None, lambda: 0.0).simulation
    expected = simulate(copy, trials=moving, sampling="mc", evidence=result.settings.evidence)
    assert result.trial_index.tobytes() == expected.trial_index.tobytes()
    settle(session)
    expected = simulate(copy, evidence=None)
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    for forecast, values in expected.forecasts.items():
        assert session.rest.forecasts[forecast].tobytes() == values.tobytes(), forecast
    state = session.at_rest()
    assert f"→ {kind}" in state.changes[0]
    assert page_of(state)  # which is of a copy with these changes typed into it, compared to the last bit
    session.receive(PageMessage("keep", {"name": "kept"}))
    again = Adjustments.of_json(json.loads(json.dumps(session.stored["kept"].as_json())))
    assert again == session.adjustments
    assert adjustments_of(model.definitions, scenario_of(model.definitions, "kept", again)) == again
    for _ in range(2 + len(numbers)):
        session.receive(PageMessage("undo", {}))
    settle(session)
    assert not session.adjustments
    assert session.rest.trial_index.tobytes() == first.trial_index.tobytes()


def test_an_assumption_gets_its_own_kind_back_with_its_own_numbers(readings):
    session = Session(readings[1])
    for kind in ("Triangular", "Normal"):
        session.receive(change("t", "kind", kind))
    assert session.adjustments == Adjustments({"t": {"kind": "Normal"}})
    assert in_words(session.own.definitions, session.adjustments) == ["t: kind Uniform → Normal"]
    with pytest.raises(XlmcError, match="'low' to be set"):
        session.receive(change("t", "low", 1.0))
    session.receive(change("t", "frozen", True))
    session.receive(change("t", "kind", None))
    assert session.adjustments == Adjustments({"t": {"frozen": True}})
    for value in ("none", True, 3.0):
        with pytest.raises(XlmcError, match="'kind' to be set"):
            session.receive(change("t", "kind", value))
    with pytest.raises(ValueError, match="no kind"):
        Adjustments.of_json({"assumptions": {"t": {"kind": "Uniforn"}}, "filters": {}})


def test_ends_and_moments_stay_where_a_kind_can_keep_them(readings):
    t = next(each for each in readings[1].assumptions if each.name == "t")  # uniform from 1.5 to 2.5
    assert in_kind(t, "Triangular").given == {"low": 1.5, "likeliest": 2.0, "high": 2.5}
    assert in_kind(t, "BetaPERT").given == {"low": 1.5, "likeliest": 2.0, "high": 2.5}
    assert in_kind(t, "Normal").given == {"mean": 2.0, "std_dev": pytest.approx(1 / math.sqrt(12), abs=1e-3)}
    assert in_kind(t, "Lognormal").given == {"location": 0.0, **in_kind(t, "Normal").given}
    below = t.with_numbers({"low": -1.0, "high": 1.0})
    assert in_kind(below, "Lognormal").given["location"] == -3.0
    assert in_kind(t, "Uniform") is t


@pytest.fixture(scope="module", params=["list", "matrix"])
def tied(request, tmp_path_factory):
    """A workbook with a correlation, and the cells that hold it."""
    folder = tmp_path_factory.mktemp("tied")
    path = with_column(book_of_readings(folder / "narrow.xlsx"), folder / "case.xlsx", "Frozen")
    book = openpyxl.load_workbook(path)
    sheet = book.create_sheet("Tied")
    if request.param == "list":
        lines, name, cells = [["First", "Second", "Correlation"], ["t", "v", 0.5]], "xlmc_correlations", ["C2"]
    else:
        lines = [["Names", "v", "t"], ["v", 1.0, 0.5], ["t", 0.5, 1.0]]
        name, cells = "xlmc_correlation_matrix", ["C2", "B3"]
    for line in lines:
        sheet.append(line)
    sheet.add_table(Table(displayName=name, ref=f"A1:C{len(lines)}"))
    book.save(path)
    return path, load(path), cells


@pytest.mark.parametrize("value", [-0.7, 0.0, 1.0])
def test_another_correlation_gives_what_the_edited_workbook_gives(tied, tmp_path, monkeypatch, value):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 2_000)
    path, model, cells = tied
    session = Session(model)
    settle(session)
    ((name, shown),) = ((each["name"], each["value"]) for each in correlation_rows(model, session.adjustments))
    assert shown == 0.5
    session.receive(change(name, "correlation", value, of="correlation"))
    session.receive(change("t", "high", 2.6))
    book = openpyxl.load_workbook(edited(path, tmp_path / "edited.xlsx", {("t", "High"): 2.6}))
    for cell in cells:
        book["Tied"][cell] = value
    book.save(tmp_path / "edited.xlsx")
    copy = load(tmp_path / "edited.xlsx")
    result = until(session, "moving").run(lambda: True, lambda share: None, lambda: 0.0).simulation
    expected = simulate(copy, trials=moving, sampling="mc", evidence=result.settings.evidence)
    assert result.trial_index.tobytes() == expected.trial_index.tobytes()
    settle(session)
    expected = simulate(copy, evidence=None)
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    for forecast, values in expected.forecasts.items():
        assert session.rest.forecasts[forecast].tobytes() == values.tobytes(), forecast
    state = session.at_rest()
    assert f"{name}: correlation 0.5 → {value:g}" in [each.replace("\u2212", "-") for each in state.changes]
    assert page_of(state)  # which is of a copy with these changes typed into it, compared to the last bit
    again = Adjustments.of_json(json.loads(json.dumps(session.adjustments.as_json())))
    assert again == session.adjustments
    assert adjustments_of(model.definitions, scenario_of(model.definitions, "kept", again)) == again

    session.receive(change("t", "frozen", True))  # what is frozen is not correlated
    settle(session)
    assert page_of(session.at_rest())
    session.receive(change("t", "frozen", False))
    session.receive(change("possible", "used", False, of="filter"))
    settle(session)
    assert page_of(session.at_rest())
    session.receive(change(name, "correlation", 1.5, of="correlation"))
    messages = settle(session)
    (trouble,) = (each["text"] for each in messages if each["kind"] == "trouble" and each["text"])
    assert "must lie between -1 and 1" in trouble
    session.receive(PageMessage("reset", {"of": "correlation", "name": name}))
    assert not session.adjustments.correlations


@pytest.fixture(scope="module")
def decided(tmp_path_factory):
    """A workbook of decisions and a solved cell: its file and its model."""
    path = book_of_decisions(tmp_path_factory.mktemp("decided") / "case.xlsx")
    return path, load(path)


def typed_into(path, target, cells):
    """The workbook with other contents of some cells of a sheet: name -> content."""
    book = openpyxl.load_workbook(path)
    for (sheet, cell), value in cells.items():
        book[sheet][cell] = value
    book.save(target)
    return load(target)


@pytest.mark.parametrize(
    ("of", "name", "key", "value", "cell", "words"),
    [
        pytest.param("decision", "limit", "value", 60.0, ("M", "A3"), "limit: value 50 → 60", id="decision"),
        pytest.param("decision", "grip", "value", 2.5, ("M", "C1"), "grip: value 2 → 2.5", id="one-a-parameter-reads"),
        pytest.param("decision", "road", "value", 1.0, ("M", "D1"), "road: value dry → wet", id="text"),
        pytest.param("solve", "stops", "to", 30.0, ("T", "C19"), "stops: To 40 → 30", id="target"),
        pytest.param("solve", "stops", "low", 18.0, ("T", "E19"), "stops: Low 0 → 18", id="end-of-the-range"),
    ],
)
def test_a_decision_and_a_solved_cell_give_what_the_edited_workbook_gives(
    decided, tmp_path, monkeypatch, of, name, key, value, cell, words
):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 1_000)
    path, model = decided
    session = Session(model)
    settle(session)
    session.receive(change(name, key, value, of=of, held=True))
    session.receive(change("reaction", "high", 2.2))
    assert openpyxl.load_workbook(path)[cell[0]][cell[1]].value is not None
    content = "wet" if name == "road" else value
    copy = typed_into(path, tmp_path / "edited.xlsx", {cell: content, ("T", "E2"): 2.2})
    result = until(session, "moving").run(lambda: True, lambda share: None, lambda: 0.0).simulation
    expected = simulate(copy, trials=moving, sampling="mc")
    assert result.trial_index.tobytes() == expected.trial_index.tobytes()
    settle(session)
    expected = simulate(copy)
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    for forecast, values in expected.forecasts.items():
        assert session.rest.forecasts[forecast].tobytes() == values.tobytes(), forecast
    assert words in session.at_rest().changes
    assert page_of(session.at_rest())  # which is of a copy with these changes typed into it, compared to the last bit
    again = Adjustments.of_json(json.loads(json.dumps(session.adjustments.as_json())))
    assert again == session.adjustments
    assert adjustments_of(model.definitions, scenario_of(model.definitions, "kept", again)) == again
    assert what_changed(model, copy) == ["reaction: High 2 → 2.2", words]

    session.receive(change("friction", "frozen", True))
    session.receive(change("possible", "at_most", 27.0, of="filter"))
    session.receive(change("possible", "used", False, of="filter"))
    settle(session)
    assert page_of(session.at_rest())
    session.receive(PageMessage("reset", {"of": of, "name": name}))
    settle(session)
    assert not session.adjustments.typed_part()
    assert page_of(session.at_rest())


def test_rows_of_decisions_and_solved_cells(decided):
    model = decided[1]
    changed = Adjustments().having("decision", "limit", "value", 60.0).having("solve", "stops", "to", 30.0)
    limit, grip, road = decision_rows(model, changed)
    assert (road["choices"], road["numbers"][0]["value"]) == (["dry", "wet", "ice"], 0.0)
    assert limit["numbers"][0] | {"value": 60.0, "own": 50.0, "cell": "", "drags": True} == limit["numbers"][0]
    assert (limit["says"], limit["tried"], limit["step"], limit["changed"]) == (
        "tried: 30 to 70 in steps of 10",
        [30.0, 40.0, 50.0, 60.0, 70.0],
        10.0,
        True,
    )
    assert (grip["tried"], grip["step"], grip["changed"]) == ([1.9, 2.0, 2.5], 0.01, False)
    (stops,) = solve_rows(model, changed)
    assert [(each["value"], each["cell"]) for each in stops["numbers"]] == [(30.0, ""), (0.0, ""), (None, "T!F19")]
    assert stops["says"] == "M!A4 is solved for in each trial, so that M!B1 equals To, the last of several values"


def test_a_number_that_a_formula_gives_a_solved_cell_cannot_be_typed(decided):
    session = Session(decided[1])
    with pytest.raises(XlmcError, match="no solve 'stops' with 'high'"):
        session.receive(change("stops", "high", 30.0, of="solve"))


@pytest.mark.parametrize("value", [3.0, 0.5, -1.0, 1e300])
def test_a_decision_among_texts_has_no_other_value(decided, value):
    session = Session(decided[1])
    with pytest.raises(XlmcError, match="no decision 'road' with 'value'"):
        session.receive(change("road", "value", value, of="decision"))
    assert not Adjustments(decisions={"road": {"value": value}}).only(decided[1].definitions)


def test_a_scenario_of_the_workbook_that_decides_is_shown(decided, tmp_path):
    path, _ = decided
    book = openpyxl.load_workbook(path)
    sheet = book.create_sheet("S")
    for line in (["Name", "M!A3", "stops To"], ["wide", 60.0, 30.0], ["text", "high", None]):
        sheet.append(line)
    sheet.add_table(Table(displayName="xlmc_scenarios", ref="A1:C3"))
    book.save(tmp_path / "case.xlsx")
    model = load(tmp_path / "case.xlsx")
    session = Session(model)
    assert [each["shows"] for each in session.greeting()[1]["scenarios"]] == [True, False]
    session.receive(PageMessage("show", {"name": "wide"}))
    assert session.adjustments.typed_part() == Adjustments(
        decisions={"limit": {"value": 60.0}}, solves={"stops": {"to": 30.0}}
    )


def test_what_matters_does_not_tell_a_decision_as_an_assumption(tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)
    session = Session(load(book_with_decisions(tmp_path / "case.xlsx")))
    session.receive(PageMessage("view", seen(["sum", "way"], "matters")))
    messages = settle(session)
    for sent in (change("limit", "value", 60.0, of="decision"), change("limit", "value", None, of="decision")):
        session.receive(sent)
        messages += settle(session)
    parts = [each for each in messages if each["kind"] == "part"]
    assert {each["version"] for each in parts} == {0, 1, 2}
    assert not [each for each in parts if "decided" in each["html"]]


@pytest.mark.parametrize("solves", [True, False])
def test_draws_are_kept_for_one_state_of_decisions(decided, monkeypatch, tmp_path, solves):
    """So that memory is bounded whichever decision is moved."""
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)
    session = Session(decided[1] if solves else load(book_with_decisions(tmp_path / "case.xlsx")))
    for value in (60.0, 40.0, None):
        session.receive(change("limit", "value", value, of="decision"))
        until(session, "moving").run(lambda: True, lambda share: None, lambda: 0.0)
        mine = session._models
        typed = [each for each in (mine._typed and mine._typed[1], mine._deciding) if each is not None]
        kept = [bool(runner._runners) for models in (mine, *typed) for runner in models._runners.values()]
        assert sum(kept) == 1


def test_trials_and_seed_give_what_a_workbook_with_these_settings_gives(readings, tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", moving := 2_000)
    path, model = readings
    session = Session(model)
    settle(session)
    first = session.rest
    assert session.greeting()[1]["run"] == {"trials": 4_000, "seed": 999, "own": [4_000, 999], "changed": False}
    session.receive(change("witness", "reading", 60.0, of="filter"))
    (messages,) = session.receive(PageMessage("run", {"trials": 6_000, "seed": 7})).all
    assert messages["run"] == {"trials": 6_000, "seed": 7, "own": [4_000, 999], "changed": True}
    result = until(session, "moving").run(lambda: True, lambda share: None, lambda: 0.0).simulation
    book = openpyxl.load_workbook(edited(path, tmp_path / "edited.xlsx", {("witness", "Reading"): 60.0}))
    sheet = book["T"]
    table = sheet.tables["xlmc_settings"]
    bottom = int(table.ref.rpartition("B")[2]) + 1
    table.ref = f"{table.ref.partition(':')[0]}:B{bottom}"
    sheet.cell(bottom - 1, 2, 6_000)
    sheet.cell(bottom, 1, "Seed")
    sheet.cell(bottom, 2, 7)
    book.save(tmp_path / "edited.xlsx")
    copy = load(tmp_path / "edited.xlsx")
    assert (copy.definitions.settings.trials, copy.definitions.settings.seed) == (6_000, 7)
    expected = simulate(copy, trials=moving, sampling="mc", evidence=result.settings.evidence)
    assert result.trial_index.tobytes() == expected.trial_index.tobytes()
    settle(session)
    expected = simulate(copy, evidence=None)
    for name, values in expected.forecasts.items():
        assert session.rest.forecasts[name].tobytes() == values.tobytes()
    assert session.rest.trial_index.tobytes() == expected.trial_index.tobytes()
    assert "6,000" in page_of(session.at_rest())  # which is of a copy, run with these, and compared to the last bit

    with pytest.raises(XlmcError, match="trials"):
        session.receive(PageMessage("run", {"trials": 0, "seed": 7}))
    session.receive(PageMessage("undo", {}))
    session.receive(PageMessage("undo", {}))
    settle(session)
    assert session.asked == RunOptions()
    assert session.rest.trial_index.tobytes() == first.trial_index.tobytes()
    session.receive(PageMessage("redo", {}))
    session.receive(PageMessage("redo", {}))
    assert (session.asked.trials, session.asked.seed) == (6_000, 7)
    session.replace_book(copy, [])
    assert session.asked == RunOptions()  # the workbook says it now


def test_readings_are_moved_without_another_program(readings):
    """Draws and quantities are kept: a reading that moves is only compared with them."""
    session = Session(readings[1])
    settle(session)
    runners = []
    for reading in (31.5, 32.0, 32.5):
        for name in ("at 40 ft", "witness"):
            session.receive(change(name, "reading", reading * (1 + (name == "witness")), of="filter"))
        runners.append(session._models.moving(session.adjustments).reusing)
    assert runners[0] is runners[1] is runners[2]


def test_what_cannot_be_taken_away_is_refused(readings):
    session = Session(readings[1])
    session.receive(change("possible", "at_most", NONE, of="filter"))
    before = session.adjustments
    for of, name, key, message in (
        ("filter", "possible", "at_least", "would have no limit"),
        ("filter", "at 40 ft", "reading", "'reading' to be set"),
        ("assumption", "v", "mean", "'mean' to be set"),
        ("forecast", "speed", "central", "'central' to be set"),
    ):
        with pytest.raises(XlmcError, match=message):
            session.receive(change(name, key, NONE, of=of))
    assert session.adjustments == before
    off = Adjustments(filters={"possible": {"used": False}})
    (row,) = (each for each in filter_rows(session.own, off) if each["name"] == "possible")
    assert row["says"] == "not used: Use is off"
    (row,) = (each for each in filter_rows(session.own, before) if each["name"] == "possible")
    assert row["says"] == "keeps at least 0"
    assert [(each["key"], each["value"], each["own"], each["cell"]) for each in row["limits"]] == [
        ("at_least", 0.0, 0.0, ""),
        ("at_most", None, 80.0, ""),
    ]
    session.receive(change("possible", "at_most", 0.0, of="filter"))  # 0 is a limit, none is not
    assert session.adjustments != before
    assert in_words(session.own.definitions, session.adjustments) == ["possible: at most 80 → 0"]
    assert in_words(session.own.definitions, before) == ["possible: at most 80 → none"]


@pytest.mark.parametrize(
    ("of", "name", "key", "value", "message"),
    [
        ("filter", "laser", "percent", 100.0, "Percent (100) of 'laser' must be below 100"),
        ("filter", "at 40 ft", "plus_minus", 0.0, "The error of 'at 40 ft' is 0"),
        ("filter", "marks", "reading", -1.0, "has no logarithm"),
        ("filter", "witness", "std_dev", -2.0, "is negative"),
        ("forecast", "speed", "central", 100.0, "must be above 1 and below 100"),
    ],
)
def test_numbers_that_are_no_error_of_a_reading_are_said_and_can_be_mended(readings, of, name, key, value, message):
    session = Session(readings[1])
    settle(session)
    session.receive(change(name, key, value, of=of))
    messages = settle(session)
    assert message in next(each["text"] for each in messages if each["kind"] == "trouble" and each["text"])
    session.receive(PageMessage("undo", {}))
    settle(session)
    assert session.at_rest().run is session.rest


def test_files_of_scenarios_before_forecasts_had_handles_are_read():
    old = {"assumptions": {"v": {"mean": 31.0}}, "filters": {"f": {"at_most": 2.0}}}
    assert Adjustments.of_json(old).as_json() == {**{part: {} for part in PARTS.values()}, **old}
    with pytest.raises(ValueError, match="none"):
        Adjustments.of_json({"assumptions": {"v": {"mean": "none"}}, "filters": {}})


def test_evidence_has_no_limit_to_be_moved(tmp_path):
    """A uniform error keeps what lies between two numbers, but these come from the reading."""
    book = openpyxl.load_workbook(CASE)
    sheet = book.create_sheet("Readings")
    for row in (["Name", "Cell", "Reading", "Error", "Plus or minus"], ["EDR", "=Model!D54", 12, "Uniform", 1]):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_evidence", ref="A1:E2"))
    book.save(tmp_path / "evidence.xlsx")
    model = load(tmp_path / "evidence.xlsx")
    session = Session(model)
    (row,) = (each for each in filter_rows(model, session.adjustments) if each["name"] == "EDR")
    assert [each["key"] for each in row["limits"]] == ["reading", "plus_minus"]
    assert row["says"] == "reads 12, uniform (Plus or minus 1): from 11 to 13"
    with pytest.raises(XlmcError, match="no filter 'EDR' with 'at_most' to be set"):
        session.receive(change("EDR", "at_most", 14.0, of="filter"))
    session.receive(PageMessage("variants", {}))
    assert any("Restitution" in name for name in session.stored)
    assert not any("EDR" in name for name in session.stored)


def test_a_tab_that_fails_is_told_once_and_tried_again_with_the_next_state(case):
    session = Session(case[1])
    settle(session)
    session.receive(PageMessage("view", seen([], "tables")))
    messages = []
    while (job := session.job()) is not None:
        failed = job.stage == "part"
        messages += session.finish(job, Outcome(problem="no") if failed else job.run(lambda: True, print, lambda: 0.0))
        assert len(messages) < 10
    assert [each["text"] for each in messages if each["kind"] == "trouble"] == ["no"]
    session.receive(change(FRICTION, "high", 0.9))
    messages = settle(session)
    assert [each["text"] for each in messages if each["kind"] == "trouble" and each["about"] == "part"] == [""]
    assert any(each["kind"] == "part" and each["tab"] == "tables" for each in messages)


def test_a_state_that_is_not_possible_cannot_be_saved_and_that_is_said(case):
    session = Session(case[1])
    settle(session)
    session.receive(change(FRICTION, "high", 0.1))
    settle(session)
    with pytest.raises(XlmcError, match=r"This state cannot be run: .*above High"):
        session.at_rest()
    session.receive(change(FRICTION, "high", 0.9))
    settle(session)
    assert session.at_rest().run is session.rest


def test_a_scenario_that_is_not_possible_is_one_row_of_the_comparison(case):
    session = Session(case[1])
    session.receive(change(FRICTION, "high", 0.85))
    session.receive(PageMessage("keep", {"name": "dry"}))
    session.receive(change(FRICTION, "high", 0.1))
    session.receive(PageMessage("keep", {"name": "crossed"}))
    session.receive(PageMessage("compare", {}))  # also where the state that is shown is not possible itself
    (part,) = [each for each in settle(session) if each["kind"] == "part"]
    html = part["html"]
    assert html.count("Not possible: ") == 1
    assert "In the scenario &#x27;crossed&#x27;" in html
    assert html.count(">dry<") == 1 + len(case[1].forecasts)
    assert session.job() is None


@pytest.mark.parametrize("stage", ["part", "compare"])
def test_long_work_is_given_up_for_a_move_and_taken_up_again(case, stage, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)
    session = Session(case[1])
    names = [each.name for each in case[1].forecasts]
    session.receive(change(FRICTION, "high", 0.85))
    session.receive(PageMessage("keep", {"name": "dry"}))
    if stage == "part":
        session.receive(PageMessage("view", seen(names[:2], "matters")))
    else:
        session.receive(PageMessage("compare", {}))
    job, shares = until(session, stage), []

    def messages(share):
        shares.append(share)
        if len(shares) == 2:
            session.receive(change(FRICTION, "high", 0.9, held=True))

    (over,) = done(session, job, messages=messages)
    assert over["stage"] == "over"
    assert len(shares) == 2
    assert 0.0 <= shares[0] < shares[1] <= 1.0
    assert session.job().stage == "moving"
    (part,) = [each for each in settle(session) if each["kind"] == "part"][-1:]
    assert part["tab"] == {"part": "matters", "compare": "scenarios"}[stage]


def test_what_a_person_stops_is_not_begun_again_until_something_changes(case):
    session = Session(case[1])
    names = [each.name for each in case[1].forecasts]
    session.receive(PageMessage("view", seen(names[:1], "tables")))
    job = until(session, "part")
    session.receive(PageMessage("stop", {}))
    (over,) = done(session, job)
    assert over["stage"] == "stopped"
    assert session.job() is None
    for view in (seen(names[:1]), seen(names[:1], "tables")):  # the tab is closed, and opened again
        session.receive(PageMessage("view", view))
    assert any(each["kind"] == "part" for each in settle(session))


def test_a_tab_that_is_closed_is_not_made(case):
    session = Session(case[1])
    names = [each.name for each in case[1].forecasts]
    session.receive(PageMessage("view", seen(names[:1], "matters")))
    job = until(session, "part")
    session.receive(PageMessage("view", seen(names[:1], "tables")))
    assert not session.wanted(job)
    assert [each["tab"] for each in settle(session) if each["kind"] == "part"] == ["tables"]


def test_tabs_are_of_the_forecasts_that_are_chosen(case):
    session = Session(case[1])
    first, *others = [each.name for each in case[1].forecasts]
    for tab in ("matters", "tables"):
        session.receive(PageMessage("view", seen([first], tab)))
        *_, part = [each["html"] for each in settle(session) if each["kind"] == "part"]
        assert f"<h3>{first}</h3>" in part
        assert not any(f"<h3>{name}</h3>" in part for name in others)
        assert f"Of 1 of {1 + len(others)} answers" in part


def test_a_mean_of_few_accepted_trials_is_marked(tmp_path):
    session = Session(load(wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)))
    settle(session)
    assert not session._last["frame "]["few"]
    (values,) = session.rest.forecasts.values()
    session.receive(change("Plausible 1", "at_least", float(values.max()), of="filter"))
    settle(session)
    assert session.rest.accepted == 1
    assert session._last["frame "]["few"]


def test_several_numbers_at_once_are_one_state(case):
    session = Session(case[1])
    (state,) = session.receive(PageMessage("numbers", numbers(FRICTION, low=0.8, high=1.4))).all
    assert session.adjustments.assumptions == {FRICTION: {"low": 0.8, "high": 1.4}}
    assert session.version == 1
    assert state["undo"]
    with pytest.raises(XlmcError, match="to be set"):
        session.receive(PageMessage("numbers", numbers(FRICTION, low=0.7, mean=1.0)))
    assert session.adjustments.assumptions == {FRICTION: {"low": 0.8, "high": 1.4}}


def numbers(name, **values):
    return {"of": "assumption", "name": name, "values": values, "seq": 1}


def test_changes_are_undone_and_done_again(case):
    session = Session(case[1])

    def undo(kind="undo"):
        (state,) = session.receive(PageMessage(kind, {})).all
        return session.adjustments.assumptions.get(FRICTION), [*session.stored], (state["undo"], state["redo"])

    for value, held in ((0.86, True), (0.87, True), (0.87, False), (0.9, False)):  # one drag, and what was typed
        session.receive(change(FRICTION, "high", value, held=held))
    session.receive(PageMessage("keep", {"name": "a"}))
    session.receive(change(FRICTION, "high", 0.8))
    session.receive(PageMessage("keep", {"name": "a"}))
    session.receive(PageMessage("drop", {"name": "a"}))
    assert undo() == ({"high": 0.8}, ["a"], (True, True))
    assert session.stored["a"].assumptions[FRICTION] == {"high": 0.8}
    assert undo()[1] == ["a"]
    assert session.stored["a"].assumptions[FRICTION] == {"high": 0.9}
    assert undo() == ({"high": 0.9}, ["a"], (True, True))
    assert undo() == ({"high": 0.9}, [], (True, True))
    assert undo()[0] == {"high": 0.87}
    assert undo() == (None, [], (False, True))
    assert undo() == (None, [], (False, True))
    for _ in range(6):
        result = undo("redo")
    assert result == ({"high": 0.8}, [], (True, False))
    undo()
    session.receive(change(FRICTION, "high", 0.7))
    assert undo("redo") == ({"high": 0.7}, ["a"], (True, False))


def test_a_drag_that_is_given_up_leaves_nothing_to_undo(case):
    session = Session(case[1])
    (state,) = session.receive(change(FRICTION, "high", 0.9)).all
    assert state["undo"]
    session.receive(PageMessage("undo", {}))
    for value, held in ((0.86, True), (0.87, True), (0.95, False)):
        (messages,) = session.receive(change(FRICTION, "high", value, held=held)).all
    assert (messages["kind"], messages["undo"], messages["changes"]) == ("state", False, [])


def test_undoing_takes_nothing_away_that_another_window_kept(case):
    session = Session(case[1])
    session.receive(change(FRICTION, "high", 0.86))
    session.receive(PageMessage("keep", {"name": "mine"}))
    session.adopt({**session.stored, "theirs": Adjustments({FRICTION: {"high": 0.7}})})
    session.receive(PageMessage("undo", {}))
    assert [*session.stored] == ["theirs"]
    session.receive(PageMessage("redo", {}))
    assert {*session.stored} == {"mine", "theirs"}


def test_another_reading_and_another_threshold_in_a_saved_workbook_are_said(readings, tmp_path):
    path, model = readings
    saved = edited(path, tmp_path / "saved.xlsx", {("witness", "Reading"): 61.0, ("speed", "Threshold"): 36.0})
    assert what_changed(model, load(saved)) == [
        "witness: reads 62, normal (Std dev 9) → reads 61, normal (Std dev 9)",
        "speed: threshold 35 → 36",
    ]


def test_what_takes_more_memory_than_allowed_lies_on_disk_and_is_the_same(case):
    """Trials of runs at rest and of scenarios; draws are kept for the states that move now, and for no others."""
    large, small = (Session(case[1], memory=memory) for memory in (500, 1))
    for session in (large, small):
        session.receive(change(FRICTION, "high", 0.9))
        session.receive(PageMessage("keep", {"name": "dry"}))
        settle(session)
        session.receive(PageMessage("compare", {}))
        settle(session)
    for name, values in large.rest.forecasts.items():
        assert not on_disk(values)
        assert on_disk(small.rest.forecasts[name])
        assert small.rest.forecasts[name].tobytes() == values.tobytes()
    assert large._last["part scenarios"]["html"] == small._last["part scenarios"]["html"]

    group = large.own.groups[0].names[0] if large.own.groups else None
    held = next(each.name for each in large.own.live if each.base is not None and each.name not in (FRICTION, group))
    for key, value in (("frozen", True), ("high", 0.95), ("frozen", False), ("high", 0.92)):
        name = held if key == "frozen" else FRICTION
        large.receive(change(name, key, value, held=key == "high"))
        until(large, "moving").run(lambda: True, lambda share: None, lambda: 0.0)
        runners = large._models._runners.values()
        assert sum(bool(runner._runners) for runner in runners) == 1
