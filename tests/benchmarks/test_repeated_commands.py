from __future__ import annotations

import json

import pytest
from repeated_commands import KINDS, RESULTS, Case, repeated

GOAL = (("Trials", 20_000), ("Precision %", 10), ("Precision of", "mean"))

CASES = {
    "a goal rejects evidence, and its command says so": (
        Case("evidence", 'the "red" car\'s $5.xlsx', (("Trials", 4_000),), ("-n", "3000", "--precision", "3%")),
        ["--trials 3000", "--evidence rejection"],
    ),
    "the default replaces what the workbook says": (
        Case(
            "evidence",
            "my book.xlsx",
            (*GOAL, ("Sampling", "mc"), ("Engine", "jit"), ("Seed", "=3*4"), ("Evidence", "rejection")),
            ("--trials", "1000", "--evidence", "weights", "--engine", "numpy", "--sampling", "lhs"),
        ),
        ["--seed 12", "--evidence weights", "--engine numpy", "--sampling lhs"],
    ),
    "a limit, accepted trials and no search": (
        Case("rare", "-n.xlsx", (("Until accepted", 50), ("Rare", "never"), ("Trials", "=20*1000")), ("--in-place",)),
        ["./-n.xlsx", "--trials 20000 --until-accepted 50", "--rare never"],
    ),
}


@pytest.mark.parametrize(("case", "parts"), CASES.values(), ids=CASES)
def test_the_recorded_command_gives_the_fingerprint(case, parts):
    result = repeated(case)
    assert result is not None
    assert result["same"], result["command"]
    for part in parts:
        assert part in result["command"]


def test_the_committed_runs_all_gave_it():
    result = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert (result["runs"], result["same"], result["other"]) == (200, 200, [])
    assert set(result["kinds"]) == set(KINDS)
