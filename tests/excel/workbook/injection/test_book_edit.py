from __future__ import annotations

import re

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.book_edit import (
    NewSheet,
    add_pointers,
    add_sheets,
    drop_pointers,
    mark,
    marked_sheets,
    without_sheets,
)
from xlmc.excel.workbook.injection.result_sheet import SheetName
from xlmc.excel.workbook.injection.splice import SplicedXml, parse_spans

MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
OFFICE = 'xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"'
SHEETS = '<sheets><sheet name="A" sheetId="3" r:id="rId1"/><sheet name="B" sheetId="7" r:id="rId2"/></sheets>'
VIEWS = "<bookViews><workbookView/></bookViews>"
NEW = [
    NewSheet("R & D", "rId8", None, (SheetName("_xlnm.Print_Titles", "'R & D'!$1:$1"), mark("R & D"))),
    NewSheet("Hidden", "rId9", "hidden", (mark("Hidden"),)),
]


def book(rest="", sheets=SHEETS, namespaces=f"{MAIN} {OFFICE}"):
    return f"<workbook {namespaces}>{VIEWS}{sheets}{rest}</workbook>".encode()


def names_of(xml):
    return re.findall(r'<definedName name="([^"]*)"(?: localSheetId="(\d+)")?', xml.decode())


def taken_out(xml):
    document = SplicedXml(xml, "book")
    return without_sheets(document, marked_sheets(document.root, "book"))


@pytest.mark.parametrize(
    "rest",
    [
        "",
        '<calcPr calcId="1"/>',
        '<functionGroups/><externalReferences><externalReference r:id="rId4"/></externalReferences><calcPr/><extLst/>',
        '<definedNames><definedName name="a">1</definedName></definedNames><calcPr/>',
    ],
)
def test_added_and_taken_out_is_as_before(rest):
    assert taken_out(add_sheets(book(rest), "book", NEW)) == book(rest)


def test_sheets_get_the_next_numbers_and_keep_their_state():
    done = add_sheets(book(), "book", NEW).decode()
    assert '<sheet name="R &amp; D" sheetId="8" r:id="rId8"/>' in done
    assert '<sheet name="Hidden" sheetId="9" state="hidden" r:id="rId9"/></sheets>' in done


def test_numbers_beyond_the_last_are_taken_from_the_gaps():
    full = SHEETS.replace('"3"', '"65534"').replace('"7"', '"2"')
    assert re.findall(r'sheetId="(\d+)"', add_sheets(book(sheets=full), "book", NEW).decode()) == [
        "65534",
        "2",
        "1",
        "3",
    ]


def test_new_names_stand_in_order_behind_external_references():
    rest = '<externalReferences><externalReference r:id="rId4"/></externalReferences><calcPr/>'
    done = add_sheets(book(rest), "book", NEW)
    assert [child.local for child in parse_spans(done, "book").children] == [
        "bookViews",
        "sheets",
        "externalReferences",
        "definedNames",
        "calcPr",
    ]
    assert names_of(done) == [("_xlmc_result", "2"), ("_xlmc_result", "3"), ("_xlnm.Print_Titles", "2")]


def test_new_names_stand_among_those_there():
    names = ["_xlnm._FilterDatabase", "alpha", "_xlnm.Print_Titles", "zero"]
    present = "".join(f'<definedName name="{name}">1</definedName>' for name in names)
    done = names_of(add_sheets(book(f"<definedNames>{present}</definedNames>"), "book", NEW))
    assert [name for name, _ in done] == [
        "_xlnm._FilterDatabase",
        "_xlmc_result",
        "_xlmc_result",
        "alpha",
        "_xlnm.Print_Titles",
        "_xlnm.Print_Titles",
        "zero",
    ]


def test_an_empty_list_of_names_is_filled():
    done = add_sheets(book("<definedNames/><calcPr/>"), "book", NEW).decode()
    assert done.count("<definedNames") == 1
    assert len(names_of(done.encode())) == 3


def test_a_book_without_a_window_gets_one():
    done = add_sheets(book().replace(VIEWS.encode(), b""), "book", NEW)
    assert done == add_sheets(book(), "book", NEW)


def test_prefixes_are_those_of_the_book():
    namespaces = f"{MAIN.replace('xmlns', 'xmlns:x')} {OFFICE.replace('xmlns:r', 'xmlns:q')}"
    host = re.sub(r"<(/?)(\w)", r"<\1x:\2", book(namespaces=namespaces).decode()).replace("r:id", "q:id").encode()
    done = add_sheets(host, "book", NEW).decode()
    assert '<x:sheet name="Hidden" sheetId="9" state="hidden" q:id="rId9"/>' in done
    assert '<x:definedName name="_xlmc_result" localSheetId="3" hidden="1">"Hidden"</x:definedName>' in done
    assert taken_out(done.encode()) == host


def test_a_book_that_binds_the_prefix_elsewhere_is_given_it():
    local = SHEETS.replace(" r:id", f" {OFFICE} r:id")
    done = add_sheets(book(sheets=local, namespaces=MAIN), "book", NEW)
    sheet = parse_spans(done, "book").find("sheets").children[2]
    assert sheet.foreign("id") == "rId8"


def test_a_name_of_a_sheet_that_does_not_exist_does_not_become_ours():
    stray = '<definedNames><definedName name="_xlnm.Print_Area" localSheetId="2">A!$A$1</definedName></definedNames>'
    done = add_sheets(book(stray), "book", NEW)
    assert ("_xlnm.Print_Area", "4") in names_of(done)
    assert taken_out(done) == book(stray)


def test_a_workbook_without_sheets_is_refused():
    with pytest.raises(WorkbookError, match="no list of sheets"):
        add_sheets(book(sheets=""), "book", NEW)


POINTERS = (
    b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    b'<Relationship Id="rId3" Type="t" Target="a"/><Relationship Id="RID12" Type="t" Target="b"/>'
    b'<Relationship Id="Rabc" Type="t" Target="c"/></Relationships>'
)


def test_pointers_get_free_ids_and_go_again():
    done, ids = add_pointers(POINTERS, "rels", [("kind", "worksheets/sheet4.xml"), ("kind", "styles.xml")])
    assert ids == ["rId13", "rId14"]
    assert b'<Relationship Id="rId13" Type="kind" Target="worksheets/sheet4.xml"/>' in done
    assert drop_pointers(done, "rels", ids) == POINTERS


@pytest.mark.parametrize("name", ["Results", 'say "hi"', "O'Hara & sons"])
def test_marks_are_found_whatever_the_name(name):
    done = add_sheets(book(), "book", [NewSheet(name, "rId8", None, (mark(name),))])
    assert marked_sheets(parse_spans(done, "book"), "book") == [2]
