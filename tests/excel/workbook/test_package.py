import contextlib
import hashlib
import io
import struct
import warnings
import zipfile
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import Limits, hash_parts, read_parts, relationships, rels_part

PARTS = {"[Content_Types].xml": b"<Types/>", "xl/b.xml": b"<b/>", "xl/a.bin": b"\0\1\2", "xl/empty": b""}


def packed(*entries, method=zipfile.ZIP_STORED):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", method) as package, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # zipfile warns of the doubles that some tests want
        for name, content in entries:
            package.writestr(name, content)
    return data.getvalue()


GOOD = packed(*PARTS.items(), method=zipfile.ZIP_DEFLATED)


def test_parts_keep_their_order_and_bytes():
    assert list(read_parts(GOOD).items()) == list(PARTS.items())


def test_folders_are_no_parts():
    assert list(read_parts(packed(("xl/", b""), ("xl/a.xml", b"<a/>")))) == ["xl/a.xml"]


REFUSED = {
    "nothing": (b"", "The file is empty"),
    "text": (b"a,b\n1,2\n", "not an Excel workbook"),
    "an .xls": (bytes.fromhex("D0CF11E0A1B11AE1") + b"Workbook", "old Excel workbook"),
    "a password": (
        bytes.fromhex("D0CF11E0A1B11AE1") + bytes(504) + "EncryptedPackage".encode("utf-16-le"),
        "The workbook is encrypted",
    ),
    "a cut": (GOOD[: len(GOOD) // 2], "The file is damaged"),
    "a changed byte": (packed(("a.xml", b"<speed/>")).replace(b"<speed/>", b"<spend/>", 1), "Bad CRC-32"),
    "a double": (packed(("xl/a.xml", b"1"), ("xl/a.xml", b"2")), "holds the part 'xl/a.xml' twice"),
    "a double in another case": (packed(("xl/a.xml", b"1"), ("XL/A.xml", b"2")), "holds the part 'XL/A.xml' twice"),
    "a parent": (packed(("../a.xml", b"")), "unsafe name '../a.xml'"),
    "a parent inside": (packed(("xl/../../a.xml", b"")), "unsafe name"),
    "a root": (packed(("/etc/a.xml", b"")), "unsafe name '/etc/a.xml'"),
    "a backslash": (packed(("xl\\..\\a.xml", b"")), "unsafe name"),
    "an empty step": (packed(("xl//a.xml", b"")), "unsafe name"),
    "another packing": (packed(("a.xml", b"a" * 99), method=zipfile.ZIP_LZMA), "a way Excel does not use"),
}


@pytest.mark.parametrize(("data", "message"), REFUSED.values(), ids=REFUSED)
def test_refused_with_a_reason_and_advice(data, message):
    with pytest.raises(WorkbookError, match=message) as caught:
        read_parts(data)
    assert caught.value.hint


JUST_ENOUGH = Limits(entries=4, part=8, total=15)


def test_within_limits():
    assert read_parts(GOOD, JUST_ENOUGH) == PARTS


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        (replace(JUST_ENOUGH, entries=3), "holds 4 parts; xlmc reads up to 3"),
        (replace(JUST_ENOUGH, part=7), r"The part '\[Content_Types\].xml' unpacks to more"),
        (replace(JUST_ENOUGH, total=14), "The file unpacks to more"),
    ],
)
def test_beyond_limits(limits, message):
    with pytest.raises(WorkbookError, match=message):
        read_parts(GOOD, limits)


def test_a_zip_bomb_is_known_by_its_ratio():
    bomb = packed(("xl/worksheets/sheet1.xml", bytes(1 << 20)), method=zipfile.ZIP_DEFLATED)
    assert read_parts(bomb, Limits(ratio_from=1 << 20))
    with pytest.raises(WorkbookError, match="packed more than 250 times, as a zip bomb is"):
        read_parts(bomb, Limits(ratio_from=(1 << 20) - 1))


def test_a_zip_password_is_named():
    data = bytearray(packed(("a.xml", b"<a/>")))
    directory = data.index(b"PK\1\2")
    data[directory + 8] |= 1  # general purpose flags
    with pytest.raises(WorkbookError, match=r"The part 'a.xml' is encrypted"):
        read_parts(bytes(data))


def test_a_size_that_lies_is_damage():
    data = bytearray(packed(("a.xml", b"a" * 100_000), method=zipfile.ZIP_DEFLATED))
    directory = data.index(b"PK\1\2")
    struct.pack_into("<I", data, directory + 24, 10)  # the size it claims to unpack to
    with pytest.raises(WorkbookError, match="damaged"):
        read_parts(bytes(data))


@given(st.lists(st.tuples(st.integers(0, len(GOOD) - 1), st.integers(0, 255)), min_size=1, max_size=8))
def test_damage_is_told_and_never_a_traceback(changes):
    data = bytearray(GOOD)
    for place, byte in changes:
        data[place] = byte
    with contextlib.suppress(WorkbookError):
        assert set(read_parts(bytes(data)).values()) <= set(PARTS.values())


@pytest.mark.parametrize(
    ("part", "expected"),
    [("", "_rels/.rels"), ("xl/workbook.xml", "xl/_rels/workbook.xml.rels"), ("book.xml", "_rels/book.xml.rels")],
)
def test_rels_part(part, expected):
    assert rels_part(part) == expected


TARGETS = [
    ("worksheets/sheet1.xml", "xl/worksheets/sheet1.xml"),
    ("../docProps/app.xml", "docProps/app.xml"),
    ("/xl/styles.xml", "xl/styles.xml"),
    ("./styles.xml", "xl/styles.xml"),
    ("STYLES.XML", "xl/styles.xml"),
    ("media/the%20scene.png", "xl/media/the scene.png"),
    ("media/100%25.png", "xl/media/100%25.png"),
    ("../../../missing.xml", "missing.xml"),
]
STORED = [
    "xl/worksheets/sheet1.xml", "docProps/app.xml", "xl/styles.xml", "xl/media/the scene.png", "xl/media/100%25.png",
]  # fmt: skip


@pytest.mark.parametrize(("target", "name"), TARGETS)
def test_targets_are_names_of_parts(rels, target, name):
    parts = dict.fromkeys(STORED, b"") | {"xl/_rels/Workbook.xml.rels": rels(("a", "thing", target)).encode()}
    result = relationships(parts, "xl/workbook.xml")["a"]
    assert (result.target, result.kind, result.external) == (name, "thing", False)


def test_external_targets_are_left_as_they_are(rels):
    parts = {
        "xl/_rels/a.xml.rels": rels(("l", "externalLinkPath", "file:///C:/Other%20book.xlsx", "External")).encode()
    }
    result = relationships(parts, "xl/a.xml")["l"]
    assert (result.target, result.external) == ("file:///C:/Other%20book.xlsx", True)


def test_a_part_without_rels_has_none():
    assert relationships(PARTS, "xl/b.xml") == {}


def test_hash_is_what_its_docstring_says():
    spelt = b"a\0" + (2).to_bytes(8, "big") + b"xy" + b"b\0" + (0).to_bytes(8, "big")
    assert hash_parts({"b": b"", "a": b"xy"}) == hashlib.sha256(spelt).hexdigest()


contents = st.dictionaries(st.text(max_size=3), st.binary(max_size=3), max_size=4)


@given(contents, contents)
def test_hash_tells_parts_apart_and_ignores_their_order(first, second):
    assert hash_parts(first) == hash_parts(dict(reversed(first.items())))
    assert (hash_parts(first) == hash_parts(second)) == (first == second)
