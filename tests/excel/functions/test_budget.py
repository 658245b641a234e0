"""Limits of what a formula may ask for: the limit itself is allowed, one more is not."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from xlmc.excel.functions import budget
from xlmc.excel.functions.budget import TooLargeError


@pytest.mark.parametrize(
    ("ask", "allowed", "refused", "message"),
    [
        (budget.ask_for_cells, (1, 1 << 23), (1, (1 << 23) + 1), "An array of 8,388,609 cells is too large"),
        (budget.ask_for_cells, (1 << 11, 1 << 12), (1 << 11, (1 << 12) + 1), "An array of 4,097 cells is too large"),
        (budget.ask_for_cells, (2, 1 << 11, 1 << 11), (2, 1 << 11, 2049), "2,048 rows and 2,049 columns"),
        (budget.ask_for_texts, (1 << 21,), ((1 << 21) + 1,), "2,097,153 texts in one array are too many"),
        (budget.ask_for_characters, (1 << 26,), ((1 << 26) + 1,), "have 67,108,865 characters together"),
        (budget.ask_for_work, (1 << 31,), ((1 << 31) + 1,), "takes 2,147,483,649 steps"),
        (budget.ask_for_reading, (1 << 11, 1 << 10), (1 << 11, (1 << 10) + 1), "2,048 rows and 1,025 columns"),
        (budget.ask_for_live, (1 << 28,), (257 << 20,), "take 257 MB: xlmc takes up to 256"),
        (budget.ask_for_live, (0,), ((1 << 28) + 1,), "take 256 MB"),
    ],
)
def test_the_limit_is_allowed_and_one_more_is_not(ask, allowed, refused, message):
    ask(*allowed)
    with pytest.raises(TooLargeError, match=message):
        ask(*refused)


def test_characters_are_counted_over_the_texts_of_an_array(monkeypatch):
    monkeypatch.setattr(budget, "MOST_CHARACTERS", 5)
    assert list(budget.count_characters(["ab", 7.0, None, "cde"])) == ["ab", 7.0, None, "cde"]
    with pytest.raises(TooLargeError, match="6 characters"):
        list(budget.count_characters(["ab", 7.0, "cdef"]))


def test_calls_are_counted_in_a_formula_and_in_a_workbook(monkeypatch):
    monkeypatch.setattr(budget, "MOST_CALLS", 3)
    monkeypatch.setattr(budget, "MOST_CALLS_TOGETHER", 5)
    count = budget.CallCount()
    count.ask_for(3)
    for _ in range(3):
        count.add()
    with pytest.raises(TooLargeError, match="The formula calls LAMBDAs more than 3 times"):
        count.add()
    count.next_formula()
    count.add()
    count.add()
    with pytest.raises(TooLargeError, match="The formulas of the workbook call LAMBDAs more than 5 times"):
        count.add()


@pytest.mark.parametrize(
    ("arrays", "size"),
    [
        ((None, None, None), 0),
        ((np.zeros(10), None, None), 80),
        ((np.zeros(10), np.zeros(10, np.uint8), None), 90),
        ((np.broadcast_to(0.0, 10), np.zeros(1, np.uint8), None), 9),
        ((np.zeros(2), None, np.array(["abc", ""], object)), 16 + 2 * 64 + 3),
    ],
)
def test_an_array_that_repeats_one_element_counts_as_that_element(arrays, size):
    assert budget.bytes_of(arrays) == size


def test_a_thread_writes_to_arrays_of_its_own():
    first, second = budget.work_arrays(5, 2)
    assert first.shape == second.shape == (5,)
    first[:], second[:] = 1.0, 2.0
    assert (first.sum(), second.sum()) == (5.0, 10.0)
    (again,) = budget.work_arrays(3, 1)
    assert np.shares_memory(again, first)
    (larger,) = budget.work_arrays(6, 1)
    assert larger.shape == (6,)
    others = []
    thread = threading.Thread(target=lambda: others.extend(budget.work_arrays(6, 1)))
    thread.start()
    thread.join()
    assert not np.shares_memory(others[0], larger)
