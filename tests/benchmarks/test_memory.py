from __future__ import annotations

import memory
import pytest


def test_a_run_is_measured_in_a_process_of_its_own():
    run = memory._measured(50_000, 1, "numpy", 1)
    assert run["trials"] == 50_000
    assert 0 < run["accepted"] < run["trials"]
    assert 10_000_000 < run["before"] <= run["peak"]
    assert run["seconds"] > 0


def test_ratios_are_of_the_longest_run_to_the_shortest(monkeypatch):
    """Costs of the same round, of which the median counts."""
    seconds = iter([1.0, 30.0, 2.0, 22.0, 4.0, 40.0])  # a short run and a long one, round by round
    asked = []

    def measured(trials, times, engine, jobs):
        asked.append((trials, times, engine, jobs))
        return {"trials": trials, "accepted": trials // 2, "seconds": next(seconds), "before": 100, "peak": 3 * trials}

    monkeypatch.setattr(memory, "_measured", measured)
    result = memory.measure((100, 1_000), "jit", 2, rounds=3)
    assert asked == [(100, 10, "jit", 2), (1_000, 1, "jit", 2)] * 3
    assert [run["seconds"] for run in result["runs"]] == [2.0, 30.0]
    assert result["cost"] == pytest.approx(1.1)
    assert result["memory"] == 10.0
