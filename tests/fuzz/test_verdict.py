"""What counts as a finding."""

from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError, FormulaError, SimulationError, WorkbookError
from xlmc.excel.workbook.reader import read_workbook


def verdict(error):
    from fuzzing.verdict import of_error

    try:
        raise error
    except type(error) as raised:
        result = of_error(raised)
    return None if result is None else result.key


@pytest.mark.parametrize(
    "error",
    [
        WorkbookError("The file is empty", where="case.xlsx"),
        FormulaError("A reference is needed here", where="S!F1", text='ROW("x")'),
        DefinitionError("S!A1: Low is blank.\nS!A2: Low is blank"),
        SimulationError("There is no engine 'x'", hint="choose numpy"),
    ],
)
def test_a_message_with_a_place_is_fine(error):
    assert verdict(error) is None


@pytest.mark.parametrize(
    ("error", "key"),
    [
        (WorkbookError(" ", where="case.xlsx"), "is empty"),
        (WorkbookError("The file is empty"), "has no place"),
        (DefinitionError("S!A1: Low is blank.\nHigh is blank"), "has no place"),
        (WorkbookError("The cell shares formula None", where="S!A1"), "speaks of Python"),
        (WorkbookError("it is <xlmc.errors.ErrorCode object at 0x7f>", where="S!A1"), "speaks of Python"),
        (WorkbookError("it holds array([1.0])", where="S!A1"), "speaks of Python"),
    ],
)
def test_a_message_that_helps_nobody_is_a_finding(error, key):
    assert verdict(error) == f"message {key}: outside xlmc"


def test_a_finding_is_told_by_the_innermost_place_in_xlmc():
    from fuzzing.verdict import of_error

    with pytest.raises(TypeError) as raised:
        read_workbook(5)
    result = of_error(raised.value)
    assert result.key.startswith("TypeError at excel/workbook/reader.py:read_workbook:")
    assert "TypeError: " in result.detail
