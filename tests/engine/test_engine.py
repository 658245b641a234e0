from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engine import BLANK_RESULT, TEXT_RESULT, Column, column_of
from xlmc.errors import ErrorCode
from xlmc.excel.functions.values import constant, from_objects


def test_a_value_as_a_column():
    items = np.array([1.5, True, "x", None, ErrorCode.NUM], object)
    column = column_of(from_objects(items), 5)
    assert column.values.tolist() == [1.5, 1.0, 0.0, 0.0, 0.0]
    assert column.codes.tolist() == [0, 0, TEXT_RESULT, BLANK_RESULT, ErrorCode.NUM]
    assert column.as_floats().tolist()[:2] == [1.5, 1.0]
    assert np.isnan(column.as_floats()[2:]).all()


@pytest.mark.parametrize(("item", "number"), [(2.5, 2.5), (True, 1.0), ("x", np.nan), (None, np.nan)])
def test_a_constant_fills_its_column(item, number):
    assert column_of(constant(item), 3).as_floats() == pytest.approx([number] * 3, nan_ok=True)


def test_no_codes_where_every_trial_counts():
    assert column_of(constant(1.0), 3).codes is None


def test_floats_are_the_columns_own():
    values = np.array([1.0, 2.0])
    floats = Column(values).as_floats()
    floats[0] = 9.0
    assert values[0] == 1.0


def test_codes_do_not_meet_those_of_errors():
    assert {TEXT_RESULT, BLANK_RESULT}.isdisjoint(set(ErrorCode))
