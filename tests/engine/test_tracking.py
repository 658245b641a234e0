"""The careful path: in portions where memory is short, and what is measured of arrays."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine import tracking
from xlmc.engine.tracking import TrackingEvaluator, array_bytes, fitting_block
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.budget import MOST_LIVE, TooLargeError

CELLS = {"A1": 1.0, "B1": "=A1*2", "B2": "=1/A1", "B3": '=IF(A1>1,"big",A1)', "C1": "=B1+B2", "F1": "=A1>0"}
DRAWS = np.array([2.0, 0.0, -1.0, 4.0, 0.5])


@pytest.fixture
def evaluator(lower):
    """`evaluator(filters, forecasts)`: of the cells above, by their addresses."""

    def make(filters, forecasts, cells=CELLS):
        lowering, targets = lower(cells, ["A1"], [*filters, *forecasts])
        nodes = [lowering.target(target) for target in targets]
        return TrackingEvaluator(lowering.dag, nodes[: len(filters)], nodes[len(filters) :])

    return make


def plain(column):
    codes = np.zeros(column.values.size) if column.codes is None else column.codes
    return [
        value if code == 0 else int(code) for value, code in zip(column.values.tolist(), codes.tolist(), strict=True)
    ]


def texts(column):
    return None if column.texts is None else column.texts.tolist()


def short_of_memory(monkeypatch, most):
    """Blocks of more than so many trials do not fit."""
    original = tracking._Part.run

    def run(self, values, inputs):
        n = max([*(each.size for each in inputs.values()), *(each.shape[0] for each in values.values())])
        if n > most:
            raise TooLargeError("too much", hint="none")
        original(self, values, inputs)

    monkeypatch.setattr(tracking._Part, "run", run)


@pytest.mark.parametrize("most", [99, 5, 4, 2, 1])
def test_portions_give_what_a_whole_block_gives(evaluator, monkeypatch, most):
    made = evaluator(["F1"], ["C1", "B3", "F1"])
    short_of_memory(monkeypatch, most)
    (passed,) = made.filters({"A1": DRAWS}, 5)
    assert plain(passed) == [1.0, 0.0, 0.0, 1.0, 1.0]
    total, text, again = made.forecasts(np.array([0, 3, 4]))
    assert plain(total) == [4.5, 8.25, 3.0]
    assert texts(text)[:2] == ["big", "big"]
    assert plain(again) == [1.0, 1.0, 1.0]


@pytest.mark.parametrize("most", [99, 2, 1])
def test_errors_and_texts_of_all_portions(evaluator, monkeypatch, most):
    made = evaluator(["F1"], ["B2", "B3"])
    short_of_memory(monkeypatch, most)
    list(made.filters({"A1": DRAWS}, 5))
    errors, text = made.forecasts(np.arange(5))
    assert plain(errors) == [0.5, int(ErrorCode.DIV0), -1.0, 0.25, 2.0]
    assert [each or None for each in texts(text)] == ["big", None, None, "big", None]


def test_a_single_trial_that_does_not_fit_is_an_error_of_its_cell(evaluator, monkeypatch):
    made = evaluator(["F1"], ["C1"])
    short_of_memory(monkeypatch, 0)
    with pytest.raises(FormulaError, match="Too much"):
        made.filters({"A1": DRAWS}, 5)


def test_forecasts_alone_may_be_short(evaluator, monkeypatch):
    made = evaluator(["F1"], ["C1"])
    assert plain(made.filters({"A1": DRAWS}, 5)[0]) == [1.0, 0.0, 0.0, 1.0, 1.0]
    short_of_memory(monkeypatch, 2)
    assert plain(made.forecasts(np.array([0, 3, 4]))[0]) == [4.5, 8.25, 3.0]


def test_a_fault_names_its_cell(evaluator, monkeypatch):
    def refuse(node, values):
        raise FormulaError("not this", hint="none")

    made = evaluator(["F1"], ["C1"])
    monkeypatch.setattr(tracking, "evaluate_node", refuse)
    with pytest.raises(FormulaError, match="S!F1"):
        made.filters({"A1": DRAWS}, 5)


def test_values_are_dropped_when_nothing_reads_them_any_more(lower):
    lowering, targets = lower(CELLS | {"D1": "=C1^2", "E1": "=D1+B1"}, ["A1"], ["E1"])
    (node,) = (lowering.target(target) for target in targets)
    values = dict(TrackingEvaluator(lowering.dag, [], [node])._constants)
    known = set(values)
    dag = lowering.dag
    tracking._Part(dag, dag.upstream([node]), {node}).run(values, {"A1": DRAWS})
    assert set(values) - known == {node}


@pytest.mark.parametrize(
    ("cells", "least", "most"),
    [
        ({"Z1": "=A1*2"}, 0, 0),
        ({"Z1": '=A1&"x"'}, 1, 1000),
        ({"Z1": "=SUM(SEQUENCE(A1+2000)*A1)"}, 2001 * 8, 2001 * 200),
        ({"Z1": "=SUM(SEQUENCE(3)*A1)"}, 0, 0),
    ],
)
def test_bytes_of_arrays_in_one_trial(lower, cells, least, most):
    lowering, targets = lower({"A1": 1.0, **cells}, ["A1"], ["Z1"])
    nodes = [lowering.target(target) for target in targets]
    every = range(len(lowering.dag.nodes))
    assert least <= array_bytes(lowering, [], nodes, every) <= most


def test_arrays_too_large_for_one_trial(lower, monkeypatch):
    lowering, targets = lower({"A1": 1.0, "Z1": '=A1&"x"'}, ["A1"], ["Z1"])
    short_of_memory(monkeypatch, 0)
    nodes = [lowering.target(target) for target in targets]
    assert array_bytes(lowering, [], nodes, range(len(lowering.dag.nodes))) == MOST_LIVE


@pytest.mark.parametrize(
    ("block", "arrays", "numbers", "fits"),
    [
        (1024, 0, 8, 1024), (1024, 1 << 16, 8, 1024), (1024, (1 << 16) + 1, 8, 512), (1024, 1 << 20, 8, 64),
        (1024, 1 << 40, 8, 1), (1, 1 << 40, 8, 1), (1024, 0, MOST_LIVE // 256, 256), (1024, 0, MOST_LIVE, 1),
        (1024, 0, MOST_LIVE // 1024, 1024),
    ],
)  # fmt: skip
def test_blocks_that_fit(block, arrays, numbers, fits):
    assert fitting_block(block, arrays, numbers) == fits
