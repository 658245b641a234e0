"""Which numbers of an old workbook take the place of those that LibreOffice made of them."""

from __future__ import annotations

import math

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.workbook.other_formats.joined_package import _DifferenceError, _exact
from xlmc.excel.workbook.other_formats.old_workbook import OldSheet
from xlmc.excel.workbook.workbook import CellContent, Formula

AT = 3, 2
FORMULA = Formula("A1", *AT)


@pytest.mark.parametrize(
    ("number", "made", "exact"),
    [
        (0.3, 0.3, None),
        (0.1 + 0.2, 0.3, 0.1 + 0.2),
        (7.0, 7, None),
        (5.464683003382316e-21, 5.46468300338232e-21, 5.464683003382316e-21),
        (0.0, 0.0, None),
        (-1e300, -1e300, None),
    ],
)
def test_a_number_that_was_shortened_is_whole_again(number, made, exact):
    result = _exact(OldSheet("S", numbers={AT: number}), {AT: CellContent(made)}, True)
    assert result == ({} if exact is None else {AT: exact})


@pytest.mark.parametrize(
    ("number", "content"),
    [
        (0.3, CellContent(0.31)),
        (1.0, CellContent(1.0 + 1e-9)),
        (0.0, CellContent(1e-300)),
        (1.0, CellContent(True)),
        (1.0, CellContent("1")),
        (1.0, CellContent(None)),
        (5.0, CellContent(ErrorCode.NAME)),
        (0.3, CellContent(0.3, FORMULA)),
        (0.3, None),
    ],
)
def test_another_number_is_told_of(number, content):
    cells = {} if content is None else {AT: content}
    with pytest.raises(_DifferenceError, match=r"LibreOffice has made .* of the number") as caught:
        _exact(OldSheet("S", numbers={AT: number}), cells, True)
    assert str(caught.value.where) == "S!B3"


@pytest.mark.parametrize(
    ("saved", "made", "tells_logicals", "exact"),
    [
        (True, 1.0, True, True),
        (True, True, True, None),
        (False, 0.0, True, False),
        (False, True, True, False),
        (True, 1.0, False, None),  # an .ods says 1 of both
        (False, 1.0, False, False),
        (1.0, 1.0, True, None),
        (1.0, True, True, 1.0),
        (1.0, True, False, 1.0),
        (2 / 3, 0.666666666666667, True, 2 / 3),
        (5.0, ErrorCode.NAME, True, 5.0),
        (5.0, None, True, 5.0),
        (math.inf, 1.0, True, None),
        (math.nan, 1.0, True, None),
    ],
)
def test_the_result_of_a_formula_is_what_excel_saved(saved, made, tells_logicals, exact):
    result = _exact(OldSheet("S", results={AT: saved}), {AT: CellContent(made, FORMULA)}, tells_logicals)
    assert result == ({} if exact is None else {AT: exact})
    assert [type(each) for each in result.values()] == [type(exact)] * len(result)


@pytest.mark.parametrize(
    ("area", "lost"),
    [
        (None, True),
        ((3, 2, 3, 2), True),
        ((1, 1, 3, 2), False),
        ((3, 2, 9, 9), False),
        ((1, 1, 2, 2), True),
        ((3, 3, 9, 9), True),
    ],
)
def test_a_cell_without_a_formula_is_one_of_an_array_formula_or_lost(area, lost):
    sheet = OldSheet("S", results={AT: 2.5}, areas=[] if area is None else [area])
    if lost:
        with pytest.raises(_DifferenceError, match="has lost the formula of the cell"):
            _exact(sheet, {AT: CellContent(2.5)}, True)
    else:
        assert _exact(sheet, {AT: CellContent(2.0)}, True) == {AT: 2.5}
    with pytest.raises(_DifferenceError, match="has lost the formula of the cell"):
        _exact(sheet, {}, True)
