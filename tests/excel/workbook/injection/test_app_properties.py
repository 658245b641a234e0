from __future__ import annotations

import re

import pytest

from xlmc.excel.workbook.injection.app_properties import list_sheets, unlist_sheets


def listing(groups, sizes=None):
    """docProps/app.xml with these groups of titles: heading -> titles."""
    titles = [title for group in groups.values() for title in group]
    variant = "<vt:variant>{}</vt:variant>"
    pairs = "".join(
        variant.format(f"<vt:lpstr>{heading}</vt:lpstr>") + variant.format(f"<vt:i4>{len(group)}</vt:i4>")
        for heading, group in groups.items()
    )
    return (
        '<Properties xmlns="http://schemas.openxmlformats.org/officeDocument/2006/extended-properties" '
        'xmlns:vt="http://schemas.openxmlformats.org/officeDocument/2006/docPropsVTypes"><Application>x</Application>'
        f'<HeadingPairs><vt:vector size="{2 * len(groups)}" baseType="variant">{pairs}</vt:vector></HeadingPairs>'
        f'<TitlesOfParts><vt:vector size="{sizes or len(titles)}" baseType="lpstr">'
        + "".join(f"<vt:lpstr>{title}</vt:lpstr>" for title in titles)
        + "</vt:vector></TitlesOfParts></Properties>"
    ).encode()


GERMAN = {"Arbeitsblätter": ["Szene", "A &amp; B"], "Benannte Bereiche": ["Szene!Drucktitel", "null"]}
MORE = {**GERMAN, "Arbeitsblätter": ["Szene", "A &amp; B", "Results", "R &amp; D"]}


def test_sheets_are_listed_behind_the_others():
    assert list_sheets(listing(GERMAN), "app", ["szene", "A & B"], ["Results", "R & D"]) == listing(MORE)


def test_and_taken_off_again():
    present = ["Szene", "A & B", "Results", "R & D"]
    assert unlist_sheets(listing(MORE), "app", present, ["Results", "R & D"]) == listing(GERMAN)


def test_named_ranges_of_a_removed_sheet_go_with_it():
    saved = {"Worksheets": ["Scene", "Results"], "Named Ranges": ["Results!Print_Titles", "'R 2'!x", "zero"]}
    done = unlist_sheets(listing(saved), "app", ["Scene", "Results"], ["Results"])
    assert done == listing({"Worksheets": ["Scene"], "Named Ranges": ["'R 2'!x", "zero"]})


def test_a_group_without_titles_goes():
    saved = {"Worksheets": ["Scene", "R 2"], "Named Ranges": ["'R 2'!Print_Titles"]}
    done = unlist_sheets(listing(saved), "app", ["Scene", "R 2"], ["R 2"])
    assert done == listing({"Worksheets": ["Scene"]})


CHARTS_FIRST = {"Charts": ["Picture"], "Worksheets": ["Scene"]}
STALE = {
    "no list": b"<Properties xmlns='u'><Application>x</Application></Properties>",
    "does not add up": listing(GERMAN).replace(b"<vt:i4>2</vt:i4>", b"<vt:i4>3</vt:i4>", 1),
    "not a number": listing(GERMAN).replace(b"<vt:i4>2</vt:i4>", b"<vt:i4>two</vt:i4>", 1),
    "odd headings": re.sub(rb"<vt:variant><vt:i4>2</vt:i4></vt:variant></vt:vector>", b"</vt:vector>", listing(GERMAN)),
    "other sheets": listing({"Worksheets": ["Tabelle1"]}),
    "empty": listing({}),
}


@pytest.mark.parametrize("xml", STALE.values(), ids=list(STALE))
def test_a_list_that_was_stale_before_stays(xml):
    assert list_sheets(xml, "app", ["Szene"], ["Results"]) == xml
    assert unlist_sheets(xml, "app", ["Szene", "Results"], ["Results"]) == xml


def test_the_group_that_names_the_sheets_is_the_one():
    done = list_sheets(listing(CHARTS_FIRST), "app", ["Scene"], ["Results"])
    assert done == listing({"Charts": ["Picture"], "Worksheets": ["Scene", "Results"]})
