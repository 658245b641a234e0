"""What a run keeps of its draws is what was drawn: a sampler of its own draws every trial again, block by block.

The arrays of a block are used again by the next one, and may lie in the columns of the run or be shared by the draws of
the accepted trials and those of all trials. What is kept must be none of them.
"""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from simulated import simulated

from xlmc.montecarlo.columns import column_store
from xlmc.montecarlo.definitions.stopping import stopping
from xlmc.montecarlo.simulation import simulate as module

UNIT = {"low": 0, "high": 1}
UNIFORM = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3")}
SHAPED = UNIFORM | {"A2": {"cell": "A2", "distribution": "Normal", "mean": 0.5, "std_dev": 0.2}}
DEPENDENT = UNIFORM | {"A3": {"cell": "A3", "low": "A1", "high": 2}}
CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1*A2+A3", "B2": "=1.5-1", "C1": "=A1<2", "C2": "=A1<0.7"}
CELLS |= {"C3": "=A1>2", "C4": "=A1<0.999"}
FORECASTS = {"x": "B1", "drawn": "A1", "same": "B2"}
CORRELATED = {("A1", "A2"): 0.5}
BOOKS = {
    "no filter": (UNIFORM, {}, {}),
    "a filter that rejects none": (UNIFORM, {"f": "C1"}, {}),
    "a filter that rejects some": (UNIFORM, {"f": "C2"}, {}),
    "a filter that rejects few": (UNIFORM, {"f": "C4", "g": "C1"}, {}),
    "a filter that rejects all": (UNIFORM, {"f": "C3"}, {}),
    "other distributions": (SHAPED, {}, {}),
    "other distributions, some rejected": (SHAPED, {"f": "C2"}, {}),
    "draws on which others depend": (DEPENDENT, {}, {}),
    "correlated": (UNIFORM, {"f": "C1"}, CORRELATED),
}
ENGINES = ["numpy", *(["jit"] if importlib.util.find_spec("llvmlite") else [])]
MOST = 5_000


@pytest.fixture(scope="module")
def cases(book):
    """Name -> a model, and the draws of its first trials: assumption -> (MOST,), from another sampler."""
    made = {}
    for name, (given, filters, correlations) in BOOKS.items():
        model = book(CELLS, given, FORECASTS, filters, correlations)
        drawn = book(CELLS, given, FORECASTS, filters, correlations).sampler(3, MOST, "numpy").draw(0)
        made[name] = model, {a.name: drawn[a.name].copy() for a in model.live}
    return made


def check(run, drawn, block, kept=None):
    """The draws of a run are those that were drawn, and so are the forecasts made of them."""
    accepted = run.trial_index
    for name, values in drawn.items():
        np.testing.assert_array_equal(run.inputs[name], values[accepted][:kept], name)
        prior = min(run.trials, -(-module.PRIOR_TRIALS // block) * block)
        np.testing.assert_array_equal(run.prior[name], values[:prior], name)
    np.testing.assert_array_equal(run.forecasts["drawn"], drawn["A1"][accepted])
    np.testing.assert_array_equal(run.forecasts["x"], (drawn["A1"] * drawn["A2"] + drawn["A3"])[accepted])
    np.testing.assert_array_equal(run.forecasts["same"], np.full(accepted.size, 0.5))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", BOOKS)
def test_kept_draws_are_those_that_were_drawn(cases, monkeypatch, engine, name):
    """Blocks shorter than a native chunk, and as long as one or two; ends within, at and behind a block."""
    model, drawn = cases[name]
    for block in (128, (2_048, 4_096)[[*BOOKS].index(name) % 2]):
        monkeypatch.setattr(module, "BLOCK", block)
        monkeypatch.setattr(module, "PRIOR_TRIALS", block + block // 2)
        for trials in {1, 65, block - 1, block, block + 1, min(2 * block + 7, MOST)}:
            for kept in (None, 0, 100) if trials == block + 1 else (None,):
                run = simulated(model, trials, 3, engine=engine, keep_inputs=kept)
                check(run, drawn, block, kept)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", BOOKS)
def test_wherever_blocks_run_and_columns_lie(cases, monkeypatch, engine, name):
    """Each way with each place of the columns in one of three books."""
    model, drawn = cases[name]
    monkeypatch.setattr(module, "BLOCK", 256)
    monkeypatch.setattr(module, "PRIOR_TRIALS", 1_000)
    ways = [
        {"jobs": 2},
        {"stopping": stopping(until_accepted=700)},
        {"jobs": 3, "stopping": stopping(until_accepted=700)},
    ]
    monkeypatch.setattr(column_store, "WRITTEN", 10_000)
    for at, in_memory in enumerate((column_store.IN_MEMORY, 20_000, 0), [*BOOKS].index(name)):
        monkeypatch.setattr(column_store, "IN_MEMORY", in_memory)
        way = ways[at % len(ways)]
        check(module.simulate(model, trials=MOST, seed=3, engine=engine, keep_inputs=None, **way), drawn, 256)


@pytest.mark.parametrize("engine", ENGINES)
def test_of_weighted_trials_all_are_kept(book, monkeypatch, engine):
    monkeypatch.setattr(module, "BLOCK", 256)
    reading = {"EDR": {"cell": "B1", "reading": 1, "error": "normal", "std_dev": 0.5}}
    model = book(CELLS, UNIFORM, FORECASTS, evidence=reading)
    drawn = model.sampler(3, 1_000, "numpy").draw(0)
    for jobs in (1, 2):
        run = module.simulate(model, trials=1_000, seed=3, engine=engine, evidence="weights", jobs=jobs)
        assert run.weighting is not None
        check(run, {name: drawn[name] for name in UNIFORM}, 256)
