from __future__ import annotations

import pickle

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.lazy_sheets import dynamic_array_marks, naming_file

NUMBER = '<sheetData><row r="1"><c r="A1"><v>5</v></c></row></sheetData>'
BROKEN = "<sheetData><row"


def test_tabs_in_order(book):
    sheets = book({"Zebra": NUMBER, "Ant": ""}).sheets
    assert list(sheets) == ["Zebra", "Ant"]
    assert len(sheets) == 2
    assert repr(sheets) == "<sheets Zebra, Ant>"


def test_a_sheet_is_parsed_once(book):
    sheets = book({"One": NUMBER}).sheets
    assert sheets["One"] is sheets["One"]


def test_a_broken_sheet_complains_when_asked_for_and_not_before(book):
    result = book({"Good": NUMBER, "Broken": BROKEN})
    assert "Broken" in result.sheets
    assert result.content(Cell("Good", 1, 1)).value == 5.0
    with pytest.raises(WorkbookError, match=r"sheet2\.xml is not well-formed XML") as caught:
        result.content(Cell("Broken", 1, 1))
    assert caught.value.where == "book.xlsx"


def test_a_cell_that_complains_keeps_its_place(book):
    result = book({"One": NUMBER.replace("5", "five")})
    with pytest.raises(WorkbookError, match="holds 'five'") as caught:
        result.sheet_named("one")
    assert caught.value.where == "One!A1"


def test_unknown_sheets(book):
    result = book({"One": NUMBER})
    assert "Two" not in result.sheets
    assert result.sheets.get("Two") is None
    assert result.sheet_named("Two") is None
    assert result.content(Cell("Two", 1, 1)).value is None


def test_shared_strings_are_read_when_a_sheet_is(book):
    result = book({"One": NUMBER}, strings=["<t>a"])
    with pytest.raises(WorkbookError, match=r"sharedStrings\.xml is not well-formed"):
        result.sheets["One"]


def test_it_can_go_to_another_process(book):
    result = pickle.loads(pickle.dumps(book({"One": NUMBER}).sheets))
    assert result["One"].cells[1, 1].value == 5.0


def test_sheets_that_mention_a_word_are_found_without_parsing(book):
    sheets = book({"One": NUMBER, "Two": "<f>Rand()", "Three": BROKEN, "Four": "<f>RAND"}).sheets
    assert list(sheets.mentioning([b"rand", b"risk"])) == ["Two", "Four"]


@pytest.mark.parametrize(("where", "message"), [(None, "book.xlsx"), ("Sheet1!B7", "Sheet1!B7")])
def test_a_complaint_without_a_place_gets_the_file(where, message):
    with pytest.raises(WorkbookError, match="What is wrong") as caught, naming_file("book.xlsx"):
        raise WorkbookError("what is wrong", where=where, hint="what to do")
    assert (caught.value.where, caught.value.hint) == (message, "what to do")


ARRAY = '<ext><d:dynamicArrayProperties xmlns:d="urn:xda" fDynamic="{}" fCollapsed="0"/></ext>'
SPILLS, DOES_NOT = (f"<bk><extLst>{ARRAY.format(flag)}</extLst></bk>" for flag in "10")


def metadata(types, future, cells):
    names = "".join(f'<metadataType name="{name}"/>' for name in types)
    blocks = ["".join(f'<rc t="{t}" v="{v}"/>' for t, v in block) for block in cells]
    records = "".join(f"<bk>{block}</bk>" for block in blocks)
    return (
        '<metadata xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
        f"<metadataTypes>{names}</metadataTypes>{future}<cellMetadata>{records}</cellMetadata></metadata>"
    ).encode()


XLDAPR = '<futureMetadata name="XLDAPR">{}</futureMetadata>'.format
RICH = '<futureMetadata name="XLRICHVALUE"><bk/></futureMetadata>'


@pytest.mark.parametrize(
    ("types", "future", "cells", "marks"),
    [
        (["XLDAPR"], XLDAPR(SPILLS), [[(1, 0)]], {"1"}),
        (["XLDAPR"], XLDAPR(DOES_NOT), [[(1, 0)]], set()),
        (["XLDAPR"], XLDAPR(DOES_NOT + SPILLS), [[(1, 0)], [(1, 1)]], {"2"}),
        (["XLRICHVALUE", "XLDAPR"], RICH + XLDAPR(SPILLS), [[(1, 0)], [(2, 0)], [(1, 0), (2, 0)]], {"2", "3"}),
        (["XLRICHVALUE"], RICH, [[(1, 0)]], set()),
        ([], "", [], set()),
    ],
)
def test_marks(types, future, cells, marks):
    assert dynamic_array_marks(metadata(types, future, cells), "xl/metadata.xml") == marks


def test_sheets_that_hold_texts_are_found_without_parsing(book):
    row = '<sheetData><row r="1"><c r="A1" s="2" t="s"><v>{}</v></c><c r="B1" t="s"><v>{}</v></c></row></sheetData>'
    sheets = {
        "Both": row.format(2, 0),
        "One": row.format(2, 1),
        "Numbers": "<sheetData><row><c><v>0</v></c><c><v>2</v></c></row></sheetData>",
        "Inline": "<sheetData><row><c t='inlineStr'><is><t>key</t></is></c><c t='str'><v>other key</v></c></row>",
        "Broken": BROKEN,
    }
    result = book(sheets, strings=["<t>other key</t>", "<t>a</t>", "<t>key</t>"]).sheets
    assert result.holding(["key", "other key"]) == ["Both", "Inline"]


def test_other_parts_of_the_same_structure(book):
    sheets = book({"One": NUMBER}).sheets
    assert sheets["One"].cells[1, 1].value == 5.0
    part = sheets.part("One")
    other = sheets.with_parts({**sheets._parts, part: sheets._parts[part].replace(b"<v>5<", b"<v>6<")})
    assert other["One"].cells[1, 1].value == 6.0
    assert sheets["One"].cells[1, 1].value == 5.0
