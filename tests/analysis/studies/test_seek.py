"""Goal seek at the base case."""

from __future__ import annotations

import numpy as np
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.errors import DefinitionError, SimulationError


@pytest.fixture
def book(tmp_path):
    """A plain workbook without any table: B3 = B1² + B2, B4 a jump, and B5 an error below 2."""
    rows = [
        ["x", 3],
        ["c", -4],
        ["y", "=B1^2+B2"],
        ["jump", "=IF(B1<1.3,-1,1)"],
        ["root", "=SQRT(B1-2)-1"],
        ["z", None],
    ]
    rows += [["of z", "=B6*2+1"], ["whole", "=ROUND(B1,0)"], ["is above", "=B1>1.5"]]
    path = tmp_path / "plain.xlsx"
    workbook_of({"Model": rows, "Other sheet": [["=Model!B3"]]}, {}).save(path)
    return path


@pytest.mark.parametrize(
    ("cell", "to", "by", "ends", "values"),
    [
        ("Model!B3", 0, "Model!B1", {}, [2, -2]),  # the nearest to 3 first
        ("Model!B3", 0, "Model!B1", {"low": -10, "high": 10}, [-2, 2]),
        ("Model!B3", 0, "Model!B1", {"low": 0, "high": 10}, [2]),
        ("Model!B3", 0, "Model!B1", {"low": 2, "high": 10}, [2]),
        ("'Other sheet'!A1", 5, "Model!B1", {}, [3, -3]),
        ("Model!B3", -5, "Model!B1", {}, []),
        ("Model!B3", 1e9, "Model!B2", {}, [1e9 - 9]),
        ("Model!B3", 1e13, "Model!B2", {}, []),  # beyond 10¹² times its size
        ("Model!B4", 0, "Model!B1", {}, []),
        ("Model!B5", 0, "Model!B1", {}, [3]),
        ("Model!B7", 5, "Model!B6", {}, [2]),  # from a blank cell
    ],
)
def test_values_are_those_of_the_closed_form(book, cell, to, by, ends, values):
    result = xlmc.seek(book, cell, to, by, **ends)
    assert result.values == pytest.approx(values, rel=1e-13)
    assert result.value == pytest.approx(values[0], rel=1e-13) if values else result.value is None
    assert result.answers == pytest.approx([to] * len(values), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(
    ("cell", "to", "low", "high", "flat"),
    [
        ("Model!B8", 5, 0, 10, [(4.5, 5.5)]),
        ("Model!B9", 1, 0, 10, [(1.5, 10)]),
        ("Model!B9", 0, 0, 10, [(0, 1.5)]),
        ("Model!B3", 5, -10, 10, []),
    ],
)
def test_a_range_in_which_the_cell_has_the_value_is_told_by_its_ends(book, cell, to, low, high, flat):
    """As finely as the range is scanned: a part in a thousand of it."""
    result = xlmc.seek(book, cell, to, "Model!B1", low=low, high=high)
    assert np.allclose(np.reshape(result.throughout, (-1, 2)), np.reshape(flat, (-1, 2)), atol=(high - low) / 1000)
    assert result.values.size == 2
    assert result.answers == pytest.approx([to, to])


def test_the_curve_passes_the_value(book):
    result = xlmc.seek(book, "Model!B3", 0, "Model!B1", low=0, high=10)
    at, answers = result.curve
    assert np.allclose(answers, at**2 - 4)
    assert (result.base, result.base_answer) == (3.0, 5.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("Model!B3", 0, "Model!B4"), "Model!B4 holds a formula"),
        (("Model!B3", 0, "Model!B6"), "Model!B3 does not depend on Model!B6"),
        (("Model!B1", 0, "Model!B1"), None),
        (("B3", 0, "Model!B1"), "'B3' names no sheet"),
        (("Nowhere!B3", 0, "Model!B1"), "Nowhere"),
        (("speed", 0, "Model!B1"), "'speed' names no cell"),
    ],
)
def test_cells_that_are_none_are_refused(book, arguments, message):
    if message is None:
        assert xlmc.seek(book, *arguments).value == 0.0  # a cell is what it is
        return
    with pytest.raises(DefinitionError, match=message):
        xlmc.seek(book, *arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"low": 1}, "Only one end"),
        ({"low": 2, "high": 1}, "The range from 2 to 1 is none"),
        ({"low": 0, "high": float("inf")}, "is none"),
    ],
)
def test_ranges_that_are_none_are_refused(book, options, message):
    with pytest.raises(SimulationError, match=message):
        xlmc.seek(book, "Model!B3", 0, "Model!B1", **options)


def test_assumptions_stand_at_their_base_values_and_may_be_varied(tmp_path):
    heads = ["Name", "Value", "Low", "High"]
    sheets = {
        "Inputs": [heads, ["a", 2, 1, 3], ["b", 5, 1, 9]],
        "Model": [["Name", "Value"], ["y", "=Inputs!B2*Inputs!B3+Inputs!B6"]],
    }
    path = tmp_path / "book.xlsx"
    workbook_of(sheets, {"xlmc_assumptions": "Inputs!A1:D3", "xlmc_forecasts": "Model!A1:B2"}).save(path)
    assert xlmc.seek(path, "Model!B2", 12, "Inputs!B3").values == pytest.approx([6])
    assert xlmc.seek(path, "Model!B2", 12, "Inputs!B6").values == pytest.approx([2])


def test_rows_of_tables_are_named_as_well(tmp_path):
    sheets = {
        "In": [["Name", "Value", "Low", "High"], ["Wet drag", 0.5, 0, 1]],
        "Out": [["Name", "Value"], ["Speed", "=In!B2*8"]],
    }
    path = tmp_path / "rows.xlsx"
    workbook_of(sheets, {"xlmc_assumptions": "In!A1:D2", "xlmc_forecasts": "Out!A1:B2"}).save(path)
    result = xlmc.seek(path, "speed", 2, "Wet drag", low=0, high=1)
    assert (str(result.cell), str(result.by), result.value) == ("Out!B2", "In!B2", 0.25)
    with pytest.raises(DefinitionError, match="Did you mean Speed"):
        xlmc.seek(path, "Sped", 2, "Wet drag")
