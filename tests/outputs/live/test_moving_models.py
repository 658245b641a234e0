"""States that move, and what is kept between them; at rest stands what the edited workbook gives."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from live_books import CASE, book_with_decisions, change, settle, wide_book

from xlmc.errors import XlmcError
from xlmc.excel.workbook.injection.cell_edit import with_contents
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.model.applied_changes import edits
from xlmc.montecarlo.model.loading import build_model, load
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.outputs.live.adjusted_scenarios import changes_of
from xlmc.outputs.live.adjustments import LIMITS, Adjustments
from xlmc.outputs.live.moving_models import KnownModels
from xlmc.outputs.live.protocol import PageMessage
from xlmc.outputs.live.session import Session

FRICTION, WEIGHT = "Chevrolet post-impact deceleration", "Nissan weight"
TRIALS = 3_000
SEQUENCES, STEPS = (3, 18), 9
"""Seeds, and moves of each: together they try each kind of move."""


def short(model):
    """With fewer trials."""
    settings = replace(model.definitions.settings, trials=TRIALS)
    return model.changed(model.workbook, replace(model.definitions, settings=settings))


@pytest.fixture(scope="module")
def case():
    return short(load(CASE))


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    """Uniform, normal and triangular assumptions, and filters that reject half: soon read, soon run."""
    return load(wide_book(tmp_path_factory.mktemp("mixed") / "mixed.xlsx", assumptions=6, forecasts=2, most=19.0))


def state(**values):
    result = Adjustments()
    for key, value in values.items():
        result = result.having("assumption", FRICTION, key, value)
    return result


def assert_same(result, expected, about):
    assert (result.trials, result.accepted, result.block) == (expected.trials, expected.accepted, expected.block), about
    assert result.tally.rejected.tolist() == expected.tally.rejected.tolist(), about
    for mine, theirs in ((result.forecasts, expected.forecasts), (result.inputs, expected.inputs)):
        assert list(mine) == list(theirs), about
        assert all(mine[name].tobytes() == theirs[name].tobytes() for name in mine), about


def test_while_it_moves_a_held_assumption_needs_no_other_formulas(case):
    known = KnownModels(case, TRIALS)
    for adjustments in (state(frozen=True), state(frozen=True, base=0.71), state(frozen=True, high=0.9)):
        moving = known.moving(adjustments)
        assert moving.model.lowering is case.lowering
        result = simulate(moving.model, trials=TRIALS, sampling="mc", own_runner=moving.runner(1_024))
        expected = simulate(known.at_rest(adjustments), trials=TRIALS, sampling="mc")
        assert set(result.inputs[FRICTION]) == {adjustments.assumptions[FRICTION].get("base", case_base(case))}
        assert {name: values.tobytes() for name, values in result.forecasts.items()} == {
            name: values.tobytes() for name, values in expected.forecasts.items()
        }
        assert moving.base.keys() == expected.forecasts.keys()


def case_base(model):
    return next(each.base for each in model.assumptions if each.name == FRICTION)


DECIDED = (
    Adjustments().having("decision", "limit", "value", 40.0),
    Adjustments().having("decision", "limit", "value", 60.0),
    Adjustments().having("decision", "limit", "value", 60.0).having("assumption", "v", "high", 0.75),
    Adjustments().having("decision", "lanes", "value", 2.0).having("filter", "possible", "used", value=False),
    Adjustments().having("assumption", "v", "high", 0.75),
    Adjustments().having("decision", "lanes", "value", 4.0).having("assumption", "u", "frozen", value=True),
    Adjustments().having("decision", "limit", "value", 70.0).having("decision", "lanes", "value", 2.0),
)


DECISIONS = {
    "formulas alone read them": ({}, True),
    "a parameter reads one": ({"high": "=M!A3/30"}, False),
    "one is a text": ({"listed": True, "more": {"C1": "dry"}}, False),
    "one says which cell is read": ({"more": {"B1": "=A3*A1+A4^2+SUM(OFFSET(A1,0,0,A4,1))"}}, False),
    "much depends on them alone": (
        {"more": {f"D{n}": f"=SIN(A3*{n})/99" for n in range(1, 99)} | {"B1": "=A3*A1+SUM(D1:D98)"}},
        False,
    ),
}


@pytest.mark.parametrize(("given", "shared"), DECISIONS.values(), ids=DECISIONS)
def test_while_decisions_move_the_numbers_are_those_of_the_edited_workbook(tmp_path, given, shared):
    own = load(book_with_decisions(tmp_path / "case.xlsx", **given))
    known, nodes = KnownModels(own, TRIALS), set()
    for adjustments in DECIDED:
        moving = known.moving(adjustments)
        result = simulate(moving.model, trials=TRIALS, sampling="mc", own_runner=moving.runner(1_024))
        expected = simulate(edited(own, changes_of(own.definitions, adjustments)), trials=TRIALS, sampling="mc")
        assert result.trial_index.tobytes() == expected.trial_index.tobytes(), adjustments
        for name, values in expected.forecasts.items():
            assert result.forecasts[name].tobytes() == values.tobytes(), (name, adjustments)
        base = KnownModels(own, TRIALS)._with_typed(adjustments.typed_part()).moving(adjustments.untyped_part()).base
        assert moving.base == base
        if adjustments.decisions and not adjustments.filters:
            nodes.add(id(moving.model.lowering))
    assert (len(nodes) == 1) == shared


def test_models_with_the_same_assumptions_held_share_their_nodes(case):
    known = KnownModels(case, TRIALS)
    frozen = state(frozen=True)
    first = known.at_rest(frozen.having("assumption", WEIGHT, "high", 3_600.0))
    second = known.at_rest(frozen.having("assumption", WEIGHT, "high", 3_700.0))
    assert first.lowering is second.lowering is not case.lowering
    for number in range(6):
        known.at_rest(state(frozen=True, base=0.7 + number / 100))
    assert len(known._holding) <= 5


def test_what_decides_more_than_draws_is_made_anew(model_of):
    """The cell of a switch that a formula reads; a group that is correlated; data of its own."""
    cells = {"A1": 0.5, "A2": 2.0, "B1": "=A1+A2"}
    unit = {"cell": "A1", "low": 0.0, "high": 1.0}
    other = {"cell": "A2", "low": 1.0, "high": 3.0}
    model = model_of(cells, {"u": unit, "v": other}, {"x": "B1"}, correlations={("u", "v"): 0.5})
    frozen = Adjustments().having("assumption", "u", "frozen", value=True)
    assert KnownModels(model, TRIALS).moving(frozen).model.lowering is not model.lowering


@pytest.mark.parametrize("seed", SEQUENCES)
def test_after_any_moves_the_numbers_at_rest_are_those_of_the_edited_workbook(mixed, seed, monkeypatch):
    """Drags, typed numbers, frozen switches, bands, limits, scenarios, a workbook that is saved meanwhile."""
    monkeypatch.setattr("xlmc.outputs.live.session.MOVING_TRIALS", 1_000)  # which come before those at rest
    case = short(mixed)
    chance, session, compared = random.Random(seed), Session(case), 0
    for step in range(STEPS):
        try:
            _move(session, case, chance)
        except XlmcError:
            continue  # there is no scenario of that name yet
        if chance.random() < 0.4:
            continue  # the next move comes before this state is at rest
        settle(session)
        if session._problem is not None:
            session.receive(PageMessage("reset", {"of": "assumption", "name": ""}))
            continue
        expected = simulate(short(edited(mixed, changes_of(case.definitions, session.adjustments))))
        assert_same(session.rest, expected, (seed, step, session.adjustments))
        compared += 1
    assert compared > STEPS // 4


def edited(own, changes):
    """The model of the workbook with the changes typed into its cells, written and read again."""
    parts, (cells, _) = dict(own.workbook.parts), edits(own, changes)
    for cell, value in cells.items():
        part = own.workbook.sheets[cell.sheet].part
        parts[part] = with_contents(parts[part], part, cell.sheet, {(cell.row, cell.column): value})
    return build_model(read_workbook(package_bytes(parts), own.path.name), own.path)


def _move(session, model, chance):
    kind, row, limited = chance.random(), chance.choice(model.live), chance.choice(model.filters)
    if kind < 0.4:
        key = chance.choice([key for key in ("low", "high", "mean") if key in row.parameters])
        middle = row.parameters[key]
        for part in range(chance.randint(1, 3)):
            value = middle + abs(middle) * chance.uniform(-0.1, 0.1)
            session.receive(change(row.name, key, value, held=part < 2))
            _some_work(session, chance)
    elif kind < 0.55:
        session.receive(change(row.name, "frozen", chance.choice([True, False, None])))
    elif kind < 0.6:
        session.receive(change(row.name, "base", row.base * chance.uniform(0.95, 1.05)))
    elif kind < 0.65:
        session.receive(change(row.name, "band_low", chance.choice([0.0, 5.0])))
    elif kind < 0.8:
        key = chance.choice([key for key in LIMITS if getattr(limited, key) is not None])
        for _ in range(chance.randint(1, 3)):
            limit = getattr(limited, key) + chance.uniform(-0.1, 0.1)
            session.receive(change(limited.name, key, limit, of="filter", held=True))
            _some_work(session, chance)
    elif kind < 0.86:
        session.receive(PageMessage("keep", {"name": chance.choice("ab")}))
    elif kind < 0.92:
        session.receive(PageMessage("show", {"name": chance.choice(["", "a", "b"])}))
    elif kind < 0.96:
        session.receive(PageMessage("reset", {"of": "assumption", "name": row.name}))
    else:
        session.replace_book(short(load(model.path)), [])


def _some_work(session, chance):
    """The next run, or none: a newer move may come first."""
    job = session.job()
    if job is not None and chance.random() < 0.6:
        session.finish(job, job.run(lambda: True, lambda share: None, lambda: 0.0))
