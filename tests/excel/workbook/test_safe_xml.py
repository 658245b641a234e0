import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.safe_xml import attribute, expat_parser, feed, is_true, tree, whole_number


def by_feed(xml, part):
    feed(expat_parser(), xml, part)


LAUGHS = b"""<!DOCTYPE lolz [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;">]><x>&c;</x>"""
REFUSED = {
    "entities": (LAUGHS, "A document type or entities are declared"),
    "a document type": (b"<!DOCTYPE x><x/>", "A document type or entities are declared"),
    "a file": (
        b'<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/hostname">]><x>&f;</x>',
        "A document type or entities are declared",
    ),
    "a document type in UTF-16": ("<!DOCTYPE x><x/>".encode("utf-16"), "A document type or entities are declared"),
    "a late document type": (
        b"<!--" + b" " * 100_000 + b"--><!DOCTYPE x><x/>",
        "A document type or entities are declared",
    ),
    "an unknown entity": (b"<x>&f;</x>", "not well-formed XML .*undefined entity"),
    "an open element": (b"<x><y></x>", "not well-formed XML .*mismatched tag"),
    "an end too early": (b"<x><y>", "not well-formed XML .*no element found"),
    "nothing": (b"", "not well-formed XML .*no element found"),
    "a strange encoding": (b'<?xml version="1.0" encoding="rot13"?><x/>', "not well-formed XML"),
    "bad bytes": (b"<x>\xff</x>", "not well-formed XML .*invalid token"),
}


@pytest.mark.parametrize("parse", [tree, by_feed])
@pytest.mark.parametrize(("xml", "message"), REFUSED.values(), ids=REFUSED)
def test_refused(parse, xml, message):
    with pytest.raises(WorkbookError, match=message) as caught:
        parse(xml, "xl/part.xml")
    assert caught.value.message.startswith("xl/part.xml")
    assert "repair" in caught.value.hint


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings(encoding):
    declared = f'<?xml version="1.0" encoding="{encoding.removesuffix("-sig")}"?><x>5 °</x>'
    assert tree(declared.encode(encoding), "p").text == "5 °"


def test_deep_nesting_is_no_trouble():
    root = tree(b"<x>" * 30_000 + b"</x>" * 30_000, "p")
    assert sum(1 for _ in root.iter()) == 30_000


def test_feed_gives_a_long_text_whole():
    pieces = []
    parser = expat_parser()
    parser.CharacterDataHandler = pieces.append
    feed(parser, b"<x>" + b"ab&amp;" * 50_000 + b"</x>", "p")
    assert "".join(pieces) == "ab&" * 50_000


def test_attribute_finds_the_one_with_a_namespace():
    element = tree(b'<x id="plain" xmlns:r="urn:r" r:id="rel" r:other="no"/>', "p")
    assert attribute(element, "id") == "rel"
    assert attribute(element, "missing") is None


@pytest.mark.parametrize(
    ("text", "truth"), [("1", True), ("true", True), ("0", False), ("false", False), (None, False)]
)
def test_is_true(text, truth):
    assert is_true(text) is truth


@pytest.mark.parametrize(
    ("text", "number"),
    [("0", 0), ("017", 17), ("999999999", 999_999_999), (None, None), ("", None), ("-1", None), ("9" * 5000, None)],
)
def test_whole_number(text, number):
    assert whole_number(text) == number
