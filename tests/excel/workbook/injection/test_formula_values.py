"""Cached values put into a sheet: which bytes change, and that a fingerprint does not see them."""

from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.workbook.injection.formula_values import with_values, without_formula_values

SHEET = "<worksheet xmlns='m'><sheetData><row r='2'>{}</row></sheetData></worksheet>"

CASES = {
    '<c r="B2" s="3"><f>A1</f><v>1</v></c>': {
        2.5: '<c r="B2" s="3"><f>A1</f><v>2.5</v></c>',
        "a<&b": '<c r="B2" s="3" t="str"><f>A1</f><v>a&lt;&amp;b</v></c>',
        True: '<c r="B2" s="3" t="b"><f>A1</f><v>1</v></c>',
        ErrorCode.NA: '<c r="B2" s="3" t="e"><f>A1</f><v>#N/A</v></c>',
        1e300: '<c r="B2" s="3"><f>A1</f><v>1e+300</v></c>',
    },
    '<c r="B2" t="str" s="3"><f>A1</f><v>x</v></c>': {
        3.0: '<c r="B2" t="n" s="3"><f>A1</f><v>3</v></c>',
        "y": '<c r="B2" t="str" s="3"><f>A1</f><v>y</v></c>',
    },
    '<c r="B2"><f t="shared" si="0"/></c>': {3.0: '<c r="B2"><f t="shared" si="0"/><v>3</v></c>'},
    '<c r="B2"><f>A1</f><v/></c>': {3.0: '<c r="B2"><f>A1</f><v>3</v></c>'},
    '<c r="A2"><v>9</v></c><c><f>A1</f><v>1</v></c>': {3.0: '<c r="A2"><v>9</v></c><c><f>A1</f><v>3</v></c>'},
    '<c r="C2"><f>A1</f><v>1</v></c>': {3.0: '<c r="C2"><f>A1</f><v>1</v></c>'},
}


@pytest.mark.parametrize(("before", "value"), [(before, value) for before, result in CASES.items() for value in result])
def test_a_value(before, value):
    xml = with_values(SHEET.format(before).encode(), "sheet1.xml", {(2, 2): value})
    assert xml.decode() == SHEET.format(CASES[before][value])


def test_a_prefix_is_kept():
    sheet = "<x:worksheet xmlns:x='m'><x:sheetData><x:row><x:c><x:f>A1</x:f></x:c></x:row></x:sheetData></x:worksheet>"
    xml = with_values(sheet.encode(), "sheet1.xml", {(1, 1): 3.0}).decode()
    assert "<x:c><x:f>A1</x:f><x:v>3</x:v></x:c>" in xml


@pytest.mark.parametrize("before", CASES)
def test_a_fingerprint_does_not_see_values_beside_such_functions(before):
    marked = f'<c r="Z2"><f>_xll.RiskMean(A1)</f></c>{before}'
    sheet = SHEET.format(marked).encode()
    for value in CASES[before]:
        changed = with_values(sheet, "sheet1.xml", {(2, 2): value})
        assert without_formula_values({"xl/worksheets/sheet1.xml": changed}) == without_formula_values(
            {"xl/worksheets/sheet1.xml": sheet}
        )


def test_a_fingerprint_sees_typed_values_and_formulas():
    base = '<c r="Z2"><f>CB.GetForeStatFN(A1,2)</f></c><c r="A2"><v>{}</v></c><c r="B2"><f>{}</f><v>1</v></c>'
    seen = {
        without_formula_values({"s.xml": SHEET.format(base.format(*pair)).encode()})["s.xml"]
        for pair in ((1, "A1"), (2, "A1"), (1, "A2"))
    }
    assert len(seen) == 3


def test_other_books_are_left_alone():
    parts = {"xl/worksheets/sheet1.xml": SHEET.format('<c r="B2"><f>RAND()</f><v>1</v></c>').encode()}
    assert without_formula_values(parts) == parts
