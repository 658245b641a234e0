"""A small campaign: whatever xlmc is given, it runs it, or says in words why not."""

from __future__ import annotations

from collections import Counter

import pytest
from fewer_sheets import SHORT, keep_sheets

SEED = 20261122
INPUTS = {"zip": 24, "formulas": 15, "tables": 20, "runs": 6, "blocks": 21, "old": 15}
INPUTS |= {"links": 15, "formats": 15, "types": 15, "recent": 25}
RAN = {"zip": 0.2, "formulas": 0.4, "tables": 0.2, "runs": 0.1, "blocks": 0.5, "old": 0.2}
RAN |= {"links": 0.3, "formats": 0.3, "types": 0.3, "recent": 0.2}
SECOND_READER = ("zip", "blocks", "links", "formats", "types")
"""Kinds whose inputs python-calamine reads, too."""


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("kind", INPUTS)
def test_every_input_runs_or_is_refused_in_words(kind, tmp_path, monkeypatch):
    from fuzzing import KINDS
    from fuzzing.child import judged
    from fuzzing.inputs import Reached

    if kind in SECOND_READER:
        pytest.importorskip("python_calamine")
    monkeypatch.chdir(tmp_path)
    keep_sheets(monkeypatch, *SHORT)  # tests/cli/test_hostile_names.py has whole books
    outcomes = [judged(kind, KINDS[kind], SEED, number, tmp_path) for number in range(INPUTS[kind])]
    assert {(o.number, o.finding.key, o.finding.detail) for o in outcomes if o.finding is not None} == set()
    assert max(outcome.seconds for outcome in outcomes) < 30
    assert max(outcome.memory for outcome in outcomes) < 1 << 30
    reached = Counter(outcome.reached for outcome in outcomes)
    assert reached[Reached.RAN] > RAN[kind] * INPUTS[kind]  # inputs that are all refused at the door would test little
    assert reached[Reached.REFUSED] > 0


@pytest.mark.parametrize("kind", INPUTS)
def test_an_input_is_a_function_of_its_seed_and_number(kind):
    from fuzzing import KINDS
    from fuzzing.inputs import generator

    made = [KINDS[kind].make(generator(kind, seed, 3)) for seed in (1, 1, 2)]
    assert made[0] == made[1]
    assert made[0] != made[2]
