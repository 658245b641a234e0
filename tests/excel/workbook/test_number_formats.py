from __future__ import annotations

import io
from zipfile import ZipFile

import openpyxl
import pytest
from openpyxl.styles.numbers import BUILTIN_FORMATS, is_date_format

from xlmc.excel.workbook.number_formats import NumberFormat, cell_formats

NOT_KEPT = {12, 13, 48}
"""Fractions and powers in steps of three, which are shown as General."""


def _read(code: str) -> str:
    book = openpyxl.Workbook()
    book.active["B7"] = 1
    book.active["B7"].number_format = code
    file = io.BytesIO()
    book.save(file)
    with ZipFile(file) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    return cell_formats(parts, "xl/workbook.xml", [(sheet, "B7")])[sheet, "B7"]


@pytest.mark.parametrize("number", sorted(set(BUILTIN_FORMATS) - NOT_KEPT))
def test_a_format_that_a_file_names_by_its_number(number):
    code, read = BUILTIN_FORMATS[number], _read(BUILTIN_FORMATS[number])
    assert is_date_format(read) is is_date_format(code)
    assert ("h" in read, "yy" in read) == ("h" in code, "yy" in code)
    if not is_date_format(code):
        assert NumberFormat.of(read) == NumberFormat.of(code.partition("_)_(")[0])  # openpyxl's 44 has no semicolons
        assert ("$" in read) == ("$" in code)


@pytest.mark.parametrize("number", sorted(NOT_KEPT))
def test_other_formats_are_general(number):
    assert _read(BUILTIN_FORMATS[number]) == "General"


def test_cells_are_found_in_any_order():
    book = openpyxl.Workbook()
    places = [f"{column}{row}" for row in (1, 2, 11, 21) for column in ("A", "B", "AB")]
    for index, place in enumerate(places):
        book.active[place] = index
        book.active[place].number_format = f'0" no. {index}"'
    file = io.BytesIO()
    book.save(file)
    with ZipFile(file) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    expected = {(sheet, place): f'0" no. {index}"' for index, place in enumerate(places)} | {(sheet, "C3"): "General"}
    for asked in ([*places, "C3"], [*reversed(places), "C3"], ["C3", *places[5:], *places[:6]]):
        assert cell_formats(parts, "xl/workbook.xml", [(sheet, place) for place in asked]) == expected


def test_a_format_of_the_file_comes_before_its_number():
    assert _read('0.0" mph"') == '0.0" mph"'
