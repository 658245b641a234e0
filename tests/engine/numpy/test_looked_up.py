"""What is looked up has the bits of what is computed, and errs where that does."""

from __future__ import annotations

from itertools import cycle

import numpy as np
import pytest
from simulated import simulated
from table_books import CELLS, GIVEN, TABLE, TRIALS, outcome_of, some_book

from xlmc.engine.graph.nodes import Apply
from xlmc.engine.graph.trial_sets import ALL_TRIALS
from xlmc.engine.numpy import numpy_engine
from xlmc.excel.functions.math import trigonometry


@pytest.fixture(params=[True, False])
def tangents(request, monkeypatch):
    """Whether sines and cosines of one angle are computed by tangents, as where these are fast."""
    monkeypatch.setattr(trigonometry, "BY_TANGENTS", request.param)


def runs(model):
    return [outcome_of(simulated(model, trials, 5)) for trials in (1, 2_049)]


@pytest.mark.parametrize(("number", "tangents"), [*zip(range(6), cycle([True, False]))], indirect=["tangents"])
def test_the_bits_of_random_books_are_the_same(book, monkeypatch, tangents, number):
    """The first four of these books have every function and every lookup of `table_books`."""
    result = runs(some_book(book, number))
    with monkeypatch.context() as computing:
        computing.setattr(numpy_engine, "find_looked_up", lambda *_: {})
        assert result == runs(some_book(book, number))


def looked_up(model):
    program = model.program("numpy")
    return [model.lowering.dag.nodes[node].function.name for node in sorted(program._looked_up)], program


def test_sine_and_cosine_of_an_angle_of_the_table_are_looked_up(book, tangents):
    cells = CELLS | {"B1": "=VLOOKUP(A1,$K$1:$P$9,3)/100", "B2": "=ATAN(B1)", "B3": "=COS(B2)*A2+SIN(B2)"}
    model = book(cells, GIVEN, {"x": "B3"})
    names, program = looked_up(model)
    assert sorted(names) == ["ATAN", "COS", "SIN"]
    nodes, placement = model.lowering.dag.nodes, program._placement
    computed = {nodes[node].function.name for node in placement.members(ALL_TRIALS) if isinstance(nodes[node], Apply)}
    assert {"a lookup", "COS", "SIN"} <= computed
    assert not computed & {"ATAN", "/", "The cell found"}


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        ("=LN(VLOOKUP(A1,$K$1:$P$9,5))", "a row gives an error"),
        ("=VLOOKUP(A1,$K$1:$P$9,6)^3", "a row gives a number too small"),
        ("=SQRT(VLOOKUP(A1,$K$1:$P$9,4))", "a root takes no longer than a pick"),
        ("=EXP(VLOOKUP(A1,$K$1:$P$9,4)*A2)", "another number varies"),
        ("=LN(2+COS(VLOOKUP(A1,$K$1:$P$9,4)))", "whether it is one of a pair decides the bits of a cosine"),
    ],
)
def test_what_is_computed_in_every_trial(book, formula, why):
    names, _ = looked_up(book(CELLS | {"B1": formula}, GIVEN, {"x": "B1"}))
    assert set(names) <= {"COS"}, why


def test_a_row_that_errs_errs_in_its_trials_alone(book):
    model = book(CELLS | {"B1": "=LN(VLOOKUP(A1,$K$1:$P$9,5))"}, GIVEN, {"x": "B1"})
    run = simulated(model, TRIALS, 5)
    row = np.minimum(run.inputs["a"].astype(int), 8)
    numbers = np.array([TABLE[f"O{each + 1}"] for each in range(9)])[row]
    np.testing.assert_array_equal(np.isnan(run.forecasts["x"]), numbers <= 0)


def test_blocks_are_as_large_as_they_were(book):
    """Where more values wait than a largest block has room for, nothing is looked up: a block would be another one."""
    many = {f"B{row}": f"=EXP(VLOOKUP(A1,$K$1:$P$9,3)/{row}+A2)*A2" for row in range(1, 140)}
    cells = CELLS | many | {"C1": "=EXP(VLOOKUP(A1,$K$1:$P$9,3))+A2"}
    forecasts = {f"f{row}": f"B{row}" for row in range(1, 140)} | {"x": "C1"}
    names, program = looked_up(book(cells, GIVEN, forecasts))
    assert names == []
    assert program.largest_block < 1 << 15
