"""Texts of a table are put in order once; keys it does not have come where they would without that."""

from __future__ import annotations

import gc
import random
import weakref

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions import ordering
from xlmc.excel.functions.lookup.picked_cells import column_of, turn
from xlmc.excel.functions.ordering import to_ordered
from xlmc.excel.functions.values import TEXT, Value, from_objects

WRITTEN = ["", "a", "A", "co-op", "coop", "é", "ef", "#", "Zz", "10", "9", "b*", "~", "it's", "its", "İ", "ß", "SS"]


def _value(rows):
    return from_objects(np.array(rows, object))


def _column(items):
    return _value([[[item] for item in items]])


def _ranks(ordered):
    """Numbers as they are; texts as places among those of all values, and the text of each place."""
    of_texts = [np.where(each.kinds == TEXT, each.order, np.nan) for each in ordered]
    places = sorted({place for orders in of_texts for place in orders.ravel().tolist() if place == place})
    texts = [
        {each.text(place) for each, orders in zip(ordered, of_texts, strict=True) if place in orders}
        for place in places
    ]
    orders = [
        [places.index(o) if k == TEXT else o for o, k in zip(each.order.flat, each.kinds.flat, strict=True)]
        for each in ordered
    ]
    return orders, [each.kinds.tolist() for each in ordered], texts


@pytest.mark.parametrize("seed", range(40))
def test_the_order_is_that_of_all_texts_at_once(seed, monkeypatch):
    draw = random.Random(seed)
    cells = [draw.choice([*WRITTEN, 3.0, True, None, ErrorCode.NA]) for _ in range(20)]
    keys = [draw.choice([*WRITTEN, "new", "NEW", "a!", "zzz", 4.0, None]) for _ in range(6)]
    table, wanted = _column(cells), _value(keys)
    kept = _ranks(to_ordered(wanted, table))
    again = _ranks(to_ordered(_value(keys), table))
    monkeypatch.setattr(ordering, "_is_kept", lambda value: False)
    anew = _ranks(to_ordered(wanted, table))
    assert kept == again == anew


def test_a_table_is_put_in_order_once(monkeypatch):
    calls = []
    true_key = ordering.order_key
    monkeypatch.setattr(ordering, "order_key", lambda text: calls.append(text) or true_key(text))
    table = _column([f"item {i}" for i in range(100)])
    for i in range(50):
        to_ordered(_value([f"Item {i}"]), table)
    assert len(calls) == 100
    to_ordered(_value(["none such"]), table)
    assert calls[100:] == ["none such"]


def test_many_new_keys_stand_between_the_texts_of_a_table():
    table = _column([f"item {i:03d}" for i in range(0, 200, 2)])
    keys = _value([f"item {i:03d}" for i in range(1, 200, 2)])
    wanted, result = to_ordered(keys, table)
    assert wanted.order[:, 0].tolist() == [place + 0.5 for place in range(100)]
    assert result.order[0].tolist() == list(range(100))
    assert [wanted.text(place) for place in wanted.order[:, 0]] == keys.texts.tolist()
    assert to_ordered(_value(["another"]), table)[1] is result


def test_columns_and_turned_tables_are_shared_and_let_go():
    table = _value([[["a", 1.0], ["b", 2.0]]])
    assert column_of(table, 0) is column_of(table, 0)
    assert column_of(table, 1).numbers.tolist() == [[[1.0], [2.0]]]
    assert turn(table) is turn(table)
    varied = Value(np.ones((2, 3, 1)), np.zeros((1, 1, 1), np.uint8))
    assert column_of(varied, 0) is not column_of(varied, 0)
    gone = weakref.ref(column_of(table, 0))
    del table
    gc.collect()
    assert gone() is None
