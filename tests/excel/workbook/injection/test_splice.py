from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.splice import SplicedXml, as_utf8, parse_spans, render

TEXT = (
    '<?xml version="1.0" encoding="{}"?>\n<a xmlns="u" k=">"><!-- <b/> --><b/><c d=\'1\'>é<e></e></c><b x="1"/></a>\n'
)


def with_every_edit(xml):
    document = SplicedXml(xml, "part")
    first, last = document.root.find_all("b")
    c = document.root.find("c")
    document.append(first, b"<z/>")
    document.append(document.root, b"<w/>")
    document.append(first, b"<y/>")
    document.set(first, "q", '"<\n')
    document.set(last, "x", 2)
    document.set(c, "d", 7)
    document.write_text(c.find("e"), "h&")
    document.before(c, b"<before/>")
    document.after(c, b"<after/>")
    return document.result()


EDITED = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<a xmlns="u" k=">"><!-- <b/> --><b q="&quot;&lt;&#10;"><z/><y/></b>'
    '<before/><c d="7">é<e>h&amp;</e></c><after/><b x="2"/><w/></a>\n'
)


@pytest.mark.parametrize(
    "encoding", ["UTF-8", "utf-8", "UTF-16", "utf-16-le", "utf-16-be", "iso-8859-1", "windows-1252"]
)
def test_edits_land_where_they_should_in_every_encoding(encoding):
    xml = TEXT.format(encoding).encode(encoding)
    assert with_every_edit(xml).decode().replace("utf-8", "UTF-8") == EDITED


def test_a_byte_order_mark_stays():
    assert with_every_edit(b"\xef\xbb\xbf" + TEXT.format("UTF-8").encode()) == b"\xef\xbb\xbf" + EDITED.encode()


def test_without_edits_nothing_changes():
    xml = b"<a  b = '1'\n>\r\n<c />&#65;<![CDATA[<x>]]></a>"
    assert SplicedXml(xml, "part").result() == xml


def test_elements_go():
    document = SplicedXml(b"<a><b/> <c>x</c></a>", "part")
    document.remove(document.root.children[1])
    assert document.result() == b"<a><b/> </a>"


def test_prefixes_are_known():
    document = SplicedXml(b'<x:a xmlns:x="u" xmlns:r="v"><b xmlns="w"/></x:a>', "part")
    assert document.prefix(document.root) == "x:"
    assert document.prefix(document.root.children[0]) == ""
    assert (document.prefix_of("v"), document.prefix_of("w")) == ("r", None)


def test_elements_of_another_namespace_are_not_found():
    root = parse_spans(b'<a xmlns="u" xmlns:m="v"><m:b/><b r:id="7" xmlns:r="q" id="8"/></a>', "part")
    assert [element.attributes["id"] for element in root.find_all("b")] == ["8"]
    assert root.find("b").foreign("id") == "7"
    assert root.find("c") is None


def test_canonical_form_does_not_see_layout():
    one = parse_spans(b'<a xmlns="u" x="1" y="2">\n <b> t </b>\n</a>', "part")
    other = parse_spans(b'<p:a xmlns:p="u" y="2" x="1"><p:b> t </p:b></p:a>', "part")
    different = parse_spans(b'<a xmlns="u" x="1" y="2"><b>t</b></a>', "part")
    assert one.canonical() == other.canonical() != different.canonical()


@pytest.mark.parametrize(
    ("xml", "message"),
    [
        (b"<a><b></a>", "not well-formed"),
        (b"", "not well-formed"),
        (b'<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>', "document type"),
        (b"<a>" * 300 + b"</a>" * 300, "nest too deep"),
        (b'<?xml version="1.0" encoding="klingon"?><a/>', "encoding"),
        ('<?xml version="1.0" encoding="utf-16"?><a/>'.encode("utf-16")[:-1], "encoding"),
    ],
)
def test_what_is_not_xml_is_refused(xml, message):
    with pytest.raises(WorkbookError, match=message):
        SplicedXml(xml, "part")


def test_utf8_stays_as_it_is():
    xml = "<a>é</a>".encode()
    assert as_utf8(xml, "part") is xml


NAMES = st.text("abc", min_size=1, max_size=3)
VALUES = st.text(
    st.sampled_from("ab<>&\"'\n\t é€\u2028😀")
    | st.characters(exclude_categories=["Cc", "Cs"], exclude_characters="\ufffe\uffff")
)


@given(NAMES, VALUES, VALUES)
def test_what_is_set_is_read_back(name, old, new):
    xml = b"<r>" + render("e", {"first": '>"', name: old}) + b"<e/></r>"
    document = SplicedXml(xml, "part")
    document.set(document.root.children[0], name, new)
    document.set(document.root.children[1], name, new)
    done = parse_spans(document.result(), "part")
    assert done.children[0].attributes == {"first": '>"', name: new}
    assert done.children[1].attributes == {name: new}
