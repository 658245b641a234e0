from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.engine.engine import BLANK_RESULT, TEXT_RESULT, Column
from xlmc.errors import ErrorCode
from xlmc.montecarlo.loop.blocks import FilterTally, ModelRunner, Task, _tally, fault_text

BLOCK = 24
CODES = (0, 0, 0, 0, int(ErrorCode.DIV0), int(ErrorCode.NA), TEXT_RESULT, BLANK_RESULT)


class Draws:
    """A sampler whose draws are given."""

    def __init__(self, values):
        self.values = values

    def draw(self, start):
        return self.values


class Columns:
    """An evaluator whose columns are given."""

    def __init__(self, filters, forecasts):
        self._filters, self._forecasts = filters, forecasts
        self.asked = None

    def filters(self, inputs, n):
        return self._filters

    def forecasts(self, survivors):
        self.asked = survivors.tolist()
        picked = []
        for column in self._forecasts:
            codes = None if column.codes is None else column.codes[survivors]
            picked.append(Column(column.values[survivors], codes))
        return picked


@st.composite
def columns(draw, count, values):
    made = []
    for _ in range(draw(count)):
        numbers = np.array(draw(st.lists(values, min_size=BLOCK, max_size=BLOCK)), float)
        codes = draw(st.none() | st.lists(st.sampled_from(CODES), min_size=BLOCK, max_size=BLOCK))
        made.append(Column(numbers, None if codes is None else np.array(codes, np.uint8)))
    return made


CASES = st.fixed_dictionaries(
    {
        "filters": columns(st.integers(0, 3), st.sampled_from((0.0, 1.0, 1.0, 1.0))),
        "forecasts": columns(st.integers(1, 2), st.floats(-1, 1)),
        "draws": st.lists(st.sampled_from((0.5, 0.5, 0.5, np.nan)), min_size=BLOCK, max_size=BLOCK),
        "trials": st.integers(1, BLOCK),
    }
)


def code(column, trial):
    return 0 if column.codes is None else int(column.codes[trial])


def worked(case, start=0, keep_prior=False, keep_inputs=True):
    draws = {"a": np.arange(float(BLOCK)), "b": np.array(case["draws"])}
    evaluator = Columns(case["filters"], case["forecasts"])
    runner = ModelRunner(Draws(draws), evaluator, BLOCK, len(case["forecasts"]), frozenset({"b"}))
    return runner.run(Task(start, case["trials"], keep_prior, keep_inputs)), evaluator, draws


@settings(max_examples=200)
@given(CASES)
def test_the_accounting_is_that_of_a_recount(case):
    block, _, draws = worked(case)
    filters, forecasts, trials = case["filters"], case["forecasts"], case["trials"]
    fails = [{t for t in range(trials) if code(f, t) or f.values[t] == 0} for f in filters]
    kept = [t for t in range(trials) if not any(t in rejected for rejected in fails)]
    without_draw = {t for t in range(trials) if np.isnan(draws["b"][t])}
    invalid = {t for t in without_draw if any(code(f, t) for f in (*filters, *(forecasts if t in kept else ())))}
    accepted = [t for t in kept if t not in invalid]
    undecided = {
        t
        for t in range(trials)
        if any(code(f, t) for f in filters) and not any(f.values[t] == 0 and not code(f, t) for f in filters)
    }
    assert block.accepted.tolist() == accepted
    assert block.tally.rejected.tolist() == [len(rejected) for rejected in fails]
    assert block.tally.only.tolist() == [
        sum(all((t in other) is (other is rejected) for other in fails) for t in rejected) for rejected in fails
    ]
    assert block.tally.together.tolist() == [[len(one & other) for other in fails] for one in fails]
    assert block.tally.errors == [Counter(fault_text(code(f, t)) for t in range(trials) if code(f, t)) for f in filters]
    assert block.tally.by_error == len(undecided)
    assert block.invalid == ({"b": len(invalid)} if invalid else {})
    faults = [Counter(fault_text(code(f, t)) for t in accepted if code(f, t)) for f in forecasts]
    assert block.faults == faults
    assert block.lost == len(invalid | undecided | {t for t in accepted if any(code(f, t) for f in forecasts)})
    assert block.trials == trials


@settings(max_examples=100)
@given(CASES)
def test_what_is_kept_is_that_of_the_accepted_trials(case):
    block, evaluator, draws = worked(case)
    kept = block.accepted
    assert block.draws["a"].tolist() == draws["a"][kept].tolist()
    for values, column in zip(block.forecasts, case["forecasts"], strict=True):
        expected = [np.nan if code(column, t) else column.values[t] for t in kept]
        assert np.array_equal(values, expected, equal_nan=True)
    assert evaluator.asked is None or len(evaluator.asked) >= len(kept)


def test_whole_blocks_are_evaluated_and_then_cut():
    sound = Column(np.ones(BLOCK))
    case = {"filters": [sound], "forecasts": [sound], "draws": [0.5] * BLOCK, "trials": 5}
    block, evaluator, _ = worked(case, start=100)
    assert evaluator.asked == list(range(BLOCK))
    assert block.accepted.tolist() == [100, 101, 102, 103, 104]


def test_without_survivors_no_forecast_is_evaluated():
    none = Column(np.zeros(BLOCK))
    case = {"filters": [none], "forecasts": [none, none], "draws": [0.5] * BLOCK, "trials": BLOCK}
    block, evaluator, _ = worked(case)
    assert evaluator.asked is None
    assert [values.size for values in block.forecasts] == [0, 0]
    assert block.tally.rejected.tolist() == [BLOCK]


def test_the_prior_is_that_of_all_trials():
    none = Column(np.zeros(BLOCK))
    case = {"filters": [none], "forecasts": [none], "draws": [0.5] * BLOCK, "trials": 7}
    block, _, draws = worked(case, keep_prior=True)
    assert block.prior["a"].tolist() == list(range(7))
    assert not np.shares_memory(block.prior["a"], draws["a"])
    assert worked(case)[0].prior is None


def test_accepted_draws_are_left_out_when_nobody_wants_them():
    sound = Column(np.ones(BLOCK))
    case = {"filters": [sound], "forecasts": [sound], "draws": [0.5] * BLOCK, "trials": 7}
    assert worked(case, keep_inputs=False)[0].draws == {}
    assert worked(case)[0].draws["a"].tolist() == list(range(7))


@given(st.integers(1, 12), st.integers(1, 200), st.sampled_from((0.02, 0.3, 0.9)), st.integers(0, 99))
def test_a_tally_of_many_filters_is_that_of_a_recount(filters, trials, share, seed):
    fails = np.random.default_rng(seed).random((filters, trials)) < share
    tally = _tally([Column(np.ones(trials))] * filters, list(fails), np.zeros(trials, bool))
    assert tally.rejected.tolist() == fails.sum(axis=1).tolist()
    assert tally.only.tolist() == (fails & (fails.sum(axis=0) == 1)).sum(axis=1).tolist()
    assert tally.together.tolist() == (fails.astype(int) @ fails.T.astype(int)).tolist()


def test_tallies_add_up():
    total, one = FilterTally.empty(2), FilterTally.empty(2)
    one.rejected += [3, 1]
    one.only += [2, 0]
    one.together += [[3, 1], [1, 1]]
    one.errors[1]["#NUM!"] += 1
    one.by_error = 1
    total.add(one)
    total.add(one)
    assert total.rejected.tolist() == [6, 2]
    assert total.only.tolist() == [4, 0]
    assert total.together.tolist() == [[6, 2], [2, 2]]
    assert total.errors == [Counter(), Counter({"#NUM!": 2})]
    assert total.by_error == 2
    assert one.rejected.tolist() == [3, 1]


@pytest.mark.parametrize(
    ("number", "text"), [(2, "#DIV/0!"), (6, "#NUM!"), (TEXT_RESULT, "text"), (BLANK_RESULT, "blank")]
)
def test_faults_in_words(number, text):
    assert fault_text(number) == text
