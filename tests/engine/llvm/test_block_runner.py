"""Whole blocks in one native call give what blocks give step by step, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from committed_books import BOOKS

pytest.importorskip("llvmlite")

from simulated import simulated

from xlmc.engine.engine import BlockMemory
from xlmc.engine.llvm import block_runner, phase
from xlmc.engine.llvm.loop import compile_loop
from xlmc.engine.llvm.machine import NativeLoop
from xlmc.engine.llvm.program import JitProgram
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling.run_spec import model_runner
from xlmc.montecarlo.model.forecast_filters import FilteringProgram
from xlmc.montecarlo.model.loading import load

BLOCK = 4096
UNIT = {"low": 0, "high": 1}
GIVEN = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3")}
CELLS = {
    "A1": 1.0,
    "A2": 1.0,
    "A3": 1.0,
    "B1": "=A1*A2+SQRT(A3)",
    "B2": "=IF(A1>0.5,A2,A3+1)",
    "B3": "=B1^2-SIN(B2)",
    "C1": "=B1>0.6",
    "C2": "=A1-A2",
    "C3": "=SINH(A1+1)",
    "C4": "=1/MAX(0,A1-0.00005)",
    "C5": "=A1>0.9999",
    "C6": "=1/(A1-2)>-1",
    "C7": "=2>1",
    "C8": "=2<1",
    "C9": "=1-1.5",
    "C10": "=1>0",
}
NORMAL = GIVEN | {"A2": {"cell": "A2", "distribution": "Normal", "mean": 0.5, "std_dev": 0.2}}
BELOW = {"cell": "C2", "at_least": -0.5, "below": 0.5}
OWN = {"o": {"cell": "C1", "only_for": ("x", "y")}, "p": BELOW | {"only_for": ("x",)}}
"""Filters of some forecasts only."""

MODELS = {
    "forecasts late, early and drawn": (GIVEN, {"x": "B3", "y": "B1", "z": "A1"}, {"f": "C1", "g": BELOW}),
    "other distributions": (NORMAL, {"x": "B3", "y": "B1", "z": "A2"}, {"f": "C1", "g": BELOW}),
    "no filters": (GIVEN, {"x": "B3"}, {}),
    "few accepted": (GIVEN, {"x": "B3"}, {"f": "C5"}),
    "none rejected": (GIVEN, {"x": "B3"}, {"f": "C6"}),
    "some always true": (GIVEN, {"x": "B3"}, {"t": "C7", "f": "C1", "u": "C10", "g": BELOW}),
    "all always true": (GIVEN, {"x": "B3"}, {"t": "C7"}),
    "some always the same": (GIVEN, {"c": "C9", "x": "B3", "d": "C9"}, {"f": "C1", "g": BELOW}),
    "logical forecasts": (GIVEN, {"x": "C5", "y": "C1", "z": "C10"}, {"f": "C1", "g": BELOW}),
    "filters of some forecasts only": (GIVEN, {"x": "B3", "y": "B3", "z": "B3"}, {"f": "C1", "g": BELOW, **OWN}),
    "filters of some forecasts alone": (GIVEN, {"x": "B3", "y": "C9", "z": "B3"}, OWN),
    "one of them always true": (GIVEN, {"x": "B3"}, {"f": "C1", "o": {"cell": "C7", "only_for": ("x",)}}),
    "many filters": (GIVEN, {"x": "B3"}, {f"f{i}": {"cell": "C2", "at_least": i / 20 - 1} for i in range(16)}),
}
IN_VECTORS = "forecasts late, early and drawn"
DRAWN_ELSEWHERE = ("forecasts late, early and drawn", "no filters", "few accepted", "filters of some forecasts only")
"""Whose draws are also made outside of the native call."""


@pytest.fixture(autouse=True)
def one_trial_after_another(side_by_side):
    """A whole block calls the same loops, whichever these are; those that take one trial are compiled sooner."""
    with side_by_side(0):
        yield


def ran(model, whole, blocks=range(5, 7), *, inputs=True, draws_given=False):
    runner = model_runner(model, model.program("jit"), "jit", 7, BLOCK)
    assert runner._run_whole is not None
    if draws_given:
        take_draws(runner)
    if not whole:
        runner._run_whole = None
    return [runner.run(Task(block * BLOCK, BLOCK, False, inputs)) for block in blocks]


def take_draws(runner):
    """Let the sampler make the draws, as if they were more than an offset plus a factor times a uniform."""
    sampler = runner._sampler
    runner._run_whole = runner._evaluator.block_runner(sampler.names, sampler.draw, None)


def native(runner):
    """What runs its whole blocks, without what discards trials of some forecasts."""
    return getattr(runner._run_whole, "run", runner._run_whole)


def bits(block):
    tally = block.tally
    counts = [counts.tolist() for counts in (tally.rejected, tally.only, tally.together)]
    arrays = [block.accepted.tolist(), [v.tobytes() for v in block.forecasts]]
    drawn = [(name, values.tobytes()) for name, values in block.draws.items()]
    faults = block.faults, tally.errors, tally.by_error, block.invalid, block.lost
    return block.trials, counts, arrays, drawn, faults, [*filter(None, block.discards)]


@pytest.mark.parametrize("name", MODELS)
def test_a_whole_block_is_the_block(book, side_by_side, name):
    """With inputs kept and without, and cut anywhere; of some models with given draws, too. One is in vectors."""
    model, ways = book(CELLS, *MODELS[name]), [False, *([True] if name in DRAWN_ELSEWHERE else [])]
    if name == IN_VECTORS:
        with side_by_side(2):
            model.program("jit")  # which is kept
    for inputs in (True, False):
        expected = list(map(bits, ran(model, False, inputs=inputs)))
        for draws_given in ways:
            whole = ran(model, True, inputs=inputs, draws_given=draws_given)
            assert list(map(bits, whole)) == expected
            assert all(bool(block.draws) is inputs for block in whole)
    for draws_given in ways:
        _check_first_trials(model, draws_given)


def _check_first_trials(model, draws_given):
    """Chunks have 2048 trials: these end at the first one, within one, at an end of one, and just behind it."""
    runners = {whole: model_runner(model, model.program("jit"), "jit", 7, BLOCK) for whole in (True, False)}
    runners[False]._run_whole = None
    if draws_given:
        take_draws(runners[True])
    for trials in (1, 63, 2047, 2048, 2049, 4095, BLOCK):
        for block, inputs in ((0, True), (3, False)):
            task = Task(block * BLOCK, trials, block == 0, inputs)
            result, expected = (runners[whole].run(task) for whole in (True, False))
            assert bits(result) == bits(expected), (trials, block)
            assert (result.prior is None) == (expected.prior is None) == (block > 0)
            for key, values in (expected.prior or {}).items():
                assert values.tobytes() == result.prior[key].tobytes(), (trials, key)
    assert native(runners[True])._careful == 0


def test_trials_behind_those_that_count_are_not_counted(book):
    """The last chunk has trials that the run does not: what the filters reject of them is not told."""
    model = book(CELLS, GIVEN, {"x": "B3"}, {"f": "C1", "g": BELOW})
    few, more = (simulated(model, trials, seed=3, engine="jit") for trials in (1_000, 100_000))
    again = simulated(model, 1_000, seed=3, engine="numpy")
    assert few.accepted == again.accepted < more.accepted
    assert few.tally.rejected.tolist() == again.tally.rejected.tolist()
    assert few.trial_index.tolist() == more.trial_index[: few.accepted].tolist()


MAY_HAVE_NO_ANSWER = (
    "crossing-pedestrian",
    "motorcycle",
    "motorcycle-head-on",
    "pedestrian",
    "project",
    "time-distance",
    "warranty",
)
"""Books some of whose answers are #N/A where a length was not measured: their blocks are run in parts."""

EQUATIONS = {name: path for name, path in BOOKS.items() if not name.endswith("-si")}
"""An edition in other units has the equations of its template."""


@pytest.mark.parametrize(("number", "path"), [*enumerate(EQUATIONS.values())], ids=EQUATIONS)
def test_examples_and_templates_are_computed_in_loops_and_in_whole_blocks(number, path, monkeypatch):
    """Some of their filters wait until they are needed: until then they are always true.

    Loops that take one trial after another are compiled sooner, and are called in the same way. Every fourth book is
    compiled; of the others it is only seen that they would be.
    """
    compiled = number % 4 == 0
    of_loops = (
        (lambda *given: compile_loop(*given[:6], side_by_side=0)) if compiled else (lambda *_: NativeLoop(0, None))
    )
    monkeypatch.setattr(phase, "compile_loop", of_loops)
    if not compiled:
        monkeypatch.setattr(block_runner, "compile_kernel", lambda *_: NativeLoop(0, None))
    model = load(path)
    program = model.program("jit")
    program = program._program if isinstance(program, FilteringProgram) else program
    assert isinstance(program, JitProgram)
    whole = model_runner(model, model.program("jit"), "jit", 7, BLOCK)._run_whole is not None
    assert whole == (path.stem not in MAY_HAVE_NO_ANSWER)
    if compiled and whole:
        assert list(map(bits, ran(model, True, range(5, 6)))) == list(map(bits, ran(model, False, range(5, 6))))


@pytest.mark.parametrize(
    ("forecasts", "filters", "in_room"),
    [
        ({"x": "B3", "y": "B1", "z": "A1"}, {}, {"x", "y", "z"}),
        ({"x": "B3", "again": "B3", "c": "C9"}, {}, {"x"}),
        ({"x": "B3", "y": "B1"}, {"t": "C7"}, {"x", "y"}),
        ({"x": "B3", "y": "B1"}, {"o": {"cell": "C1", "only_for": ("y",)}}, {"x"}),
        ({"x": "B3"}, {"f": "C6"}, set()),
    ],
)
def test_where_all_trials_are_kept_they_are_written_to_the_room(book, forecasts, filters, in_room):
    model = book(CELLS, GIVEN, forecasts, filters)
    runner = model_runner(model, model.program("jit"), "jit", 7, BLOCK)
    for block in (5, 6):
        rows = np.empty((len(forecasts) + len(GIVEN), BLOCK))
        draws = dict(zip(GIVEN, rows[len(forecasts) :], strict=True))
        memory = BlockMemory(np.empty(BLOCK, np.int64), dict(draws), list(rows[: len(forecasts)]))
        task = Task(block * BLOCK, BLOCK, False)
        result = runner.borrow(task, lambda memory=memory: memory)
        assert bits(result) == bits(runner.run(task))
        result = runner.borrow(task, lambda memory=memory: memory)
        there = zip(forecasts, result.forecasts, memory.forecasts, strict=False)
        assert {name for name, column, memory in there if np.shares_memory(column, memory)} == in_room
        assert np.shares_memory(result.accepted, memory.accepted) is bool(in_room)


def test_a_block_that_ends_early_asks_for_no_room(book):
    """There may be none for the trials behind those that count."""
    model = book(CELLS, GIVEN, {"x": "B3"}, {})
    runner = model_runner(model, model.program("jit"), "jit", 7, BLOCK)
    for trials in (1, 2048, BLOCK - 1):
        assert runner.borrow(Task(0, trials, False), pytest.fail).trials == trials


def test_correlated_draws(book):
    model = book(CELLS, GIVEN, {"x": "B3"}, {"f": "C1"}, correlations={("A1", "A2"): 0.7})
    assert list(map(bits, ran(model, True))) == list(map(bits, ran(model, False)))


LARGE = {"cell": "C4", "at_least": 2}


@pytest.mark.parametrize("filters", [{"f": "C1"}, {"f": LARGE}, {"f": "C1", "o": LARGE | {"only_for": ("x",)}}])
def test_a_block_in_which_a_trial_errs_is_the_block(book, filters):
    """One trial in 20,000 divides by zero: some blocks are run whole, in others a filter or a forecast is an error."""
    model = book(CELLS, GIVEN, {"x": "C4"}, filters)
    runner = model_runner(model, model.program("jit"), "jit", 7, BLOCK)
    whole = [runner.run(Task(block * BLOCK, BLOCK, False)) for block in range(24)]
    assert 0 < native(runner)._careful < native(runner)._runs
    assert list(map(bits, whole)) == list(map(bits, ran(model, False, range(24))))
    assert sum(block.lost for block in whole) > 0


def test_where_most_blocks_err_they_are_no_longer_tried(book):
    model = book(CELLS | {"C4": "=1/MAX(0,A1-0.5)"}, GIVEN, {"x": "C4"}, {"f": "C1"})
    runner = model_runner(model, model.program("jit"), "jit", 7, BLOCK)
    for block in range(20):
        runner.run(Task(block * BLOCK, BLOCK, False))
    assert native(runner)._runs == 2


@pytest.mark.parametrize(
    ("given", "forecasts", "filters"),
    [
        (GIVEN, {"x": "C3"}, {"f": "C1"}),  # SINH is NumPy's
        (GIVEN, {"x": "B3"}, {"f": "C1", "g": "C8"}),  # nothing is accepted
        (GIVEN | {"A2": {"cell": "A2", "low": 0, "high": "A1"}}, {"x": "B3"}, {"f": "C1"}),  # may err
        (GIVEN, {"x": "B3"}, {f"f{i}": {"cell": "C2", "at_least": i / 20 - 1} for i in range(17)}),
    ],
)
def test_what_is_not_run_in_whole_blocks(book, given, forecasts, filters):
    model = book(CELLS, given, forecasts, filters)
    assert model_runner(model, model.program("jit"), "jit", 7, BLOCK)._run_whole is None


def test_the_other_engines_run_step_by_step(book):
    model = book(CELLS, *MODELS["no filters"])
    assert model_runner(model, model.program("numpy"), "numpy", 7, BLOCK)._run_whole is None
