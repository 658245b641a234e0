from __future__ import annotations

import re

import pytest

from xlmc.excel.workbook.inject import inject, original_hash
from xlmc.excel.workbook.injection.host import remove_result_sheets

BOOK = "xl/workbook.xml"


@pytest.fixture(scope="module")
def once(rich, results):
    return inject(rich, results)


def edited(parts, name, *changes):
    """The parts with text replaced in one of them; every change must hit."""
    text = parts[name].decode()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return {**parts, name: text.encode()}


def sheets_of(parts):
    return re.findall(r'<sheet name="([^"]*)"', parts[BOOK].decode())


def test_a_workbook_without_result_sheets_stays_byte_for_byte(rich):
    assert remove_result_sheets(rich) == rich


def test_a_sheet_the_person_renamed_is_theirs_now(once):
    renamed = edited(once, BOOK, ('name="Trials" sheetId', 'name="My trials" sheetId'))
    left = remove_result_sheets(renamed)
    assert sheets_of(left) == ["Scene", "Results", "Notes", "My trials"]
    assert "xl/worksheets/sheet6.xml" in left
    assert "xl/tables/table2.xml" in left
    assert '<definedName name="_xlmc_result" localSheetId="3" hidden="1">"Trials"' in left[BOOK].decode()


def test_a_sheet_the_person_copied_is_theirs(once):
    copied = edited(
        once,
        BOOK,
        ("</sheets>", '<sheet name="Trials (2)" sheetId="9" r:id="rId9000"/></sheets>'),
        ("</definedNames>", '<definedName name="_xlmc_result" localSheetId="6">"Trials"</definedName></definedNames>'),
    )
    assert sheets_of(remove_result_sheets(copied)) == ["Scene", "Results", "Notes", "Trials (2)"]


def test_a_sheet_moved_in_front_is_found_and_names_close_up(once):
    swapped = edited(
        once,
        BOOK,
        *[(f'localSheetId="{old}"', f'localSheetId="x{new}"') for old, new in ((0, 1), (3, 0), (1, 2), (2, 3))],
        ('localSheetId="x', 'localSheetId="'),
    )
    text = swapped[BOOK].decode()
    moved = re.search(r'<sheet name="Results \(2\)"[^>]*>', text)[0]
    swapped[BOOK] = text.replace(moved, "").replace("<sheets>", f"<sheets>{moved}").encode()
    left = remove_result_sheets(swapped)
    assert sheets_of(left) == ["Scene", "Results", "Notes"]
    assert '<definedName name="friction" localSheetId="0">Scene!' in left[BOOK].decode()
    assert '<definedName name="friction" localSheetId="2">Scene!' in left[BOOK].decode()


def test_the_window_no_longer_shows_a_sheet_that_is_gone(once):
    shown = edited(once, BOOK, ('firstSheet="2" activeTab="2"', 'firstSheet="3" activeTab="5"'))
    assert 'firstSheet="0" activeTab="0"' in remove_result_sheets(shown)[BOOK].decode()


def test_the_window_does_not_show_a_hidden_sheet_either(once):
    shown = edited(
        once, BOOK, ('activeTab="2"', 'activeTab="5"'), ('name="Scene" sheetId', 'name="Scene" state="hidden" sheetId')
    )
    assert 'activeTab="1"' in remove_result_sheets(shown)[BOOK].decode()


def test_a_part_the_users_sheets_share_stays(once):
    rels = "xl/drawings/_rels/drawing1.xml.rels"
    shared = edited(once, rels, ("../media/image1.png", "../media/image2.png"))
    left = remove_result_sheets(shared)
    assert "xl/media/image2.png" in left
    assert "xl/charts/chart2.xml" not in left


CHAIN = "xl/calcChain.xml"


def test_a_calculation_chain_that_names_result_cells_goes(once):
    resaved = edited(once, CHAIN, ("</calcChain>", '<c r="C3" i="4"/></calcChain>'))
    left = remove_result_sheets(resaved)
    assert CHAIN not in left
    assert "calcChain" not in left["[Content_Types].xml"].decode() + left["xl/_rels/workbook.xml.rels"].decode()


def test_any_other_calculation_chain_stays(once):
    assert CHAIN in remove_result_sheets(once)


@pytest.mark.parametrize(
    ("part", "change"),
    [
        (BOOK, (">0</definedName>", ">1</definedName>")),
        (BOOK, ('name="Scene" sheetId', 'name="Scenery" sheetId')),
        (BOOK, ("<calcPr ", '<calcPr iterate="1" ')),
        ("xl/_rels/workbook.xml.rels", ('Id="rId1" ', 'Id="rId777" ')),
        ("xl/worksheets/sheet1.xml", ("<v>12.5</v>", "<v>12.6</v>")),
        ("xl/drawings/drawing1.xml", ("Car 1", "Car 2")),
        ("xl/vbaProject.bin", ("bytes", "Bytes")),
    ],
)
def test_the_fingerprint_shows_a_change_of_the_users_parts(rich, once, part, change):
    assert original_hash(edited(rich, part, change)) != original_hash(rich)
    assert original_hash(edited(once, part, change)) != original_hash(rich)


@pytest.mark.parametrize(
    ("part", "change"),
    [
        (BOOK, ('windowWidth="16095"', 'windowWidth="9000"')),
        ("docProps/app.xml", ("Microsoft Excel", "Excel")),
        ("xl/worksheets/sheet6.xml", ("<v>31.5</v>", "<v>99</v>")),
        ("xl/styles.xml", ("DDEBF7", "FFFFFF")),
    ],
)
def test_the_fingerprint_does_not_depend_on_results_looks_and_windows(rich, once, part, change):
    assert original_hash(edited(once, part, change)) == original_hash(rich)


def test_the_fingerprint_does_not_depend_on_the_order_of_parts(rich):
    assert original_hash(dict(reversed(rich.items()))) == original_hash(rich)
