from __future__ import annotations

import tempfile
from pathlib import Path

import pytest
from simulated import simulated

from xlmc.errors import SimulationError
from xlmc.montecarlo.columns import column_store
from xlmc.montecarlo.loop import disk_needed as module
from xlmc.montecarlo.loop.disk_needed import DiskNeeded

UNIT = {"low": 0, "high": 1}
TRIALS = 40_000


@pytest.fixture
def small_memory(monkeypatch):
    monkeypatch.setattr(column_store, "IN_MEMORY", 100_000)


@pytest.fixture
def model(book):
    """Half of the trials are accepted."""
    given = {name: {"cell": name, **UNIT} for name in ("A1", "A2")}
    return book({"A1": 0.5, "A2": 0.5, "B1": "=A1+A2", "B2": "=A1<0.5"}, given, {"x": "B1"}, {"f": "B2"})


def written(run):
    """Numbers in the files of the columns, those of the draws before filtering left out."""
    kept = run.trial_index.size + sum(values.size for values in run.forecasts.values())
    return kept + sum(values.size for values in run.inputs.values())


def announced(model, *given, **more):
    sentences = []
    return sentences, simulated(model, *given, tell=sentences.append, **more)


@pytest.mark.parametrize("inputs", [0, 5_000, None])
def test_what_is_said_is_what_is_written(model, small_memory, monkeypatch, inputs):
    result = []
    monkeypatch.setattr(DiskNeeded, "check", lambda needed: result.append(needed))
    sentences, run = announced(model, TRIALS, keep_inputs=inputs)
    (needed,) = result
    assert needed.stored == pytest.approx(written(run), rel=0.03)
    assert needed.sorted == pytest.approx(2 * run.accepted, rel=0.03)
    assert needed.bytes == 8 * (needed.stored + needed.sorted)
    assert needed.folder == Path(tempfile.gettempdir())
    assert sentences == [needed.sentence()]


def test_a_run_that_stays_in_memory_says_nothing(model, small_memory, monkeypatch):
    most = 2 * TRIALS  # all accepted, these would not stay in memory
    assert announced(model, 6_000, keep_inputs=0)[0] == []
    monkeypatch.setattr(column_store, "IN_MEMORY", 8 * 2 * most * 3 // 4)
    assert announced(model, most, keep_inputs=0)[0] == []


def test_a_goal_of_accepted_trials_says_how_many_there_will_be(model, small_memory):
    assert announced(model, TRIALS, until_accepted=1_000)[0] == []
    assert len(announced(model, TRIALS, until_accepted=9_000)[0]) == 1


def test_nobody_knows_how_long_a_run_with_another_goal_will_be(model, small_memory):
    assert announced(model, TRIALS, time_limit=60)[0] == []
    assert announced(model, TRIALS, precision="20%")[0] == []


def test_a_disk_with_too_little_room_refuses_the_run_before_it_starts(model, small_memory, monkeypatch):
    monkeypatch.setattr(module, "free_disk", lambda: (Path("small"), 300_000))
    message, begun = [], []
    with pytest.raises(SimulationError, match="The run needs about") as refused:
        simulated(model, TRIALS, tell=message.append, progress=begun.append)
    assert (message, begun) == ([], [])
    assert refused.value.where == "small"
    assert "TMPDIR" in str(refused.value)
    monkeypatch.setattr(module, "free_disk", lambda: (Path("large"), 3_000_000))
    simulated(model, TRIALS, tell=message.append)
    assert len(message) == 1


def test_the_first_trials_are_counted_and_change_no_bit(model, small_memory, monkeypatch):
    counted = announced(model, TRIALS)[1]
    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.disk_needed", lambda *_: None)
    plain = simulated(model, TRIALS)
    assert counted.trial_index.tolist() == plain.trial_index.tolist()
    assert counted.forecasts["x"].tobytes() == plain.forecasts["x"].tobytes()
    assert counted.tally.rejected.tolist() == plain.tally.rejected.tolist()


def test_the_sentence():
    needed = DiskNeeded(1_200_000_000, 50_000_000, Path("there"), 40_000_000_000)
    kept = "This run keeps about 1,200 million numbers and sorts 50 million: "
    assert needed.sentence() == f"{kept}about 10 GB on disk in there (free: 40 GB)."
    needed.check()
