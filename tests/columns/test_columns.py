from __future__ import annotations

import numpy as np
import pytest

from xlmc.columns import ColumnStore, column_store, on_disk

TYPES = {"x": np.dtype(np.float64), "n": np.dtype(np.int64), "never": np.dtype(np.float64)}
NAMES = {"speed": "x", "trial": "n", "none": "never"}


def filled(blocks):
    keeper, expected = ColumnStore(TYPES), {"speed": [], "trial": [], "none": []}
    rng = np.random.default_rng(1)
    for _ in range(blocks):
        size = int(rng.integers(0, 400))
        x, n = rng.normal(size=size), rng.integers(0, 9, size)
        expected["speed"] += x.tolist()
        expected["trial"] += n.tolist()
        keeper.add("x", x)
        keeper.add("n", n)
        keeper.settle()
    return keeper.columns(NAMES), expected


@pytest.mark.parametrize("blocks", [0, 1, 30])
@pytest.mark.parametrize("in_memory", [0, 5000, 1 << 27])
def test_columns_are_what_was_added(monkeypatch, blocks, in_memory):
    monkeypatch.setattr(column_store, "IN_MEMORY", in_memory)
    monkeypatch.setattr(column_store, "WRITTEN", 3000)
    found, expected = filled(blocks)
    assert list(found) == ["speed", "trial", "none"]
    assert len(found) == 3
    for name, values in expected.items():
        assert found[name].tolist() == values
        assert found[name].dtype == TYPES[NAMES[name]]
    assert on_disk(found["speed"]) == (16 * len(expected["speed"]) > in_memory)


def test_every_column_of_a_keeper_may_be_asked_for_twice():
    keeper = ColumnStore(TYPES)
    keeper.add("x", np.ones(3))
    keeper.add("x", np.zeros(1))
    assert keeper.columns({"a": "x"})["a"].tolist() == keeper.columns({"b": "x"})["b"].tolist() == [1, 1, 1, 0]
