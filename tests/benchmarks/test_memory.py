from __future__ import annotations

import memory


def test_long_runs_are_measured_in_processes_of_their_own():
    counts = (50_000, 150_000)
    found = memory.measure(counts, rounds=1)
    assert tuple(run["trials"] for run in found["runs"]) == counts
    for run in found["runs"]:
        assert 0 < run["accepted"] < run["trials"]
        assert 10_000_000 < run["before"] <= run["peak"]
    assert found["cost"] > 0
