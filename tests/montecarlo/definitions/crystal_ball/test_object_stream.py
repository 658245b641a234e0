"""Streams of .NET's BinaryFormatter, written record by record as [MS-NRBF] lays them out."""

from __future__ import annotations

import struct

import pytest

from xlmc.montecarlo.definitions.crystal_ball import object_stream
from xlmc.montecarlo.definitions.crystal_ball.object_stream import StreamError, Thing, read_stream

END = b"\x0b"
NULL = b"\x0a"


def ints(*values):
    return struct.pack(f"<{len(values)}i", *values)


def text(value):
    data, length = value.encode(), b""
    size = len(data)
    while size >= 128:
        length, size = length + bytes([size & 127 | 128]), size >> 7
    return length + bytes([size]) + data


def stream(*records, root=1, major=1):
    return b"\0" + ints(root, -1, major, 0) + b"".join(records) + END


def string(number, value):
    return b"\x06" + ints(number) + text(value)


def reference(number):
    return b"\x09" + ints(number)


def described(number, name, members, values, library=None):
    """A class with its members as name -> (binary type, what it adds), and the values of the first object."""
    kind = b"\x04" if library is None else b"\x05"
    head = kind + ints(number) + text(name) + ints(len(members)) + b"".join(map(text, members))
    types = bytes(each for each, _ in members.values()) + b"".join(more for _, more in members.values())
    return head + types + (b"" if library is None else ints(library)) + values


def plain(value):
    if isinstance(value, Thing):
        return value.name, {key: plain(each) for key, each in value.members.items()}
    return [plain(each) for each in value] if isinstance(value, list) else value


PRIMITIVES = [
    (1, b"\x01", True), (2, b"\xc8", 200), (6, struct.pack("<d", 0.1), 0.1), (7, struct.pack("<h", -3), -3),
    (8, ints(-70000), -70000), (9, struct.pack("<q", -(2**40)), -(2**40)), (10, b"\xff", -1),
    (11, struct.pack("<f", 0.5), 0.5), (12, struct.pack("<q", 9), 9), (13, struct.pack("<Q", 2**63), 2**63),
    (14, struct.pack("<H", 65535), 65535), (15, struct.pack("<I", 2**32 - 1), 2**32 - 1),
    (16, struct.pack("<Q", 7), 7), (5, text("1.50"), "1.50"), (18, text("name"), "name"),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "data", "value"), PRIMITIVES)
def test_primitive_values(kind, data, value):
    """By themselves, as a member, and twice in an array of either record."""
    member = described(1, "N.C", {"x": (0, bytes([kind]))}, data)
    assert plain(read_stream(stream(member))) == ("N.C", {"x": value})
    assert read_stream(stream(b"\x0f" + ints(1, 2) + bytes([kind]) + data * 2)) == [value, value]
    array = b"\x07" + ints(1) + b"\0" + ints(1, 2) + bytes([0, kind]) + data * 2
    assert read_stream(stream(array)) == [value, value]
    assert read_stream(stream(b"\x08" + bytes([kind]) + data, string(1, "root"))) == "root"


def test_members_of_every_binary_type():
    members = {
        "text": (1, b""), "object": (2, b""), "system": (3, text("System.Guid")), "class": (4, text("N.D") + ints(9)),
        "objects": (5, b""), "texts": (6, b""), "bytes": (7, b"\x02"), "number": (0, b"\x08"),
    }  # fmt: skip
    values = string(2, "a") + NULL + NULL + reference(1) + b"\x10" + ints(3, 2) + reference(2) + NULL
    values += b"\x11" + ints(4, 1) + string(5, "b") + reference(6) + ints(42)
    records = described(1, "N.S.C", members, values, library=9), b"\x0f" + ints(6, 3) + b"\x02" + b"\1\2\3"
    root = read_stream(stream(b"\x0c" + ints(9) + text("Lib"), *records))
    assert (root.name, root.kind) == ("N.S.C", "C")
    assert root.members["class"] is root
    assert {key: each for key, each in root.members.items() if key != "class"} == {
        "text": "a", "object": None, "system": None, "objects": ["a", None], "texts": ["b"], "bytes": [1, 2, 3],
        "number": 42,
    }  # fmt: skip


def test_objects_of_a_class_that_is_described_already():
    """The second has the class of the first, the third that of the second; values within others are not referred to."""
    first = described(1, "P", {"x": (0, b"\x08"), "next": (2, b"")}, ints(1) + reference(3))
    second = b"\x01" + ints(3, 1) + ints(2) + (b"\x01" + ints(-7, 3) + ints(3) + NULL)
    assert plain(read_stream(stream(first, second))) == (
        "P", {"x": 1, "next": ("P", {"x": 2, "next": ("P", {"x": 3, "next": None})})},
    )  # fmt: skip
    twice = b"\x10" + ints(5, 2) + (b"\x01" + ints(-7, 1) + ints(8) + NULL) * 2
    assert plain(read_stream(stream(first.replace(reference(3), NULL), twice, root=5)))[0][1]["x"] == 8


@pytest.mark.parametrize(
    ("elements", "length", "expected"),
    [
        (b"\x0d\x03", 3, [None] * 3),
        (b"\x0e" + ints(2) + string(2, "x"), 3, [None, None, "x"]),
        (string(2, "x") + b"\x0d\x02", 3, ["x", None, None]),
        (b"\x0d\x01" + b"\x0d\x01", 2, [None, None]),
        (b"", 0, []),
        (b"\x08\x08" + ints(4), 1, [4]),
    ],
)
def test_empty_elements(elements, length, expected):
    assert read_stream(stream(b"\x10" + ints(1, length) + elements)) == expected
    assert read_stream(stream(b"\x11" + ints(1, length) + elements)) == expected
    other = b"\x07" + ints(1) + b"\x01" + ints(1, length) + b"\x02" + elements
    assert read_stream(stream(other)) == expected


@pytest.mark.parametrize("length", [0, 1, 127, 128, 300, 2**14, 2**14 - 1])
def test_texts_of_any_length(length):
    assert read_stream(stream(string(1, "x" * length))) == "x" * length


def test_a_circle():
    root = read_stream(stream(b"\x10" + ints(1, 2) + reference(1) + string(2, "é")))
    assert root[0] is root
    assert root[1] == "é"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"\x01" + stream(string(1, "x"))[1:], "does not begin with a header"),
        (stream(string(1, "x"), major=2), "version 2, not 1"),
        (stream(string(1, "x")) + b"\0", "goes on after its end"),
        (stream(string(2, "x")), "the object 1, which it does not hold"),
        (stream(b"\x10" + ints(1, 1) + reference(8)), "the object 8, which it does not hold"),
        (stream(b"\x03"), "a record of kind 3"),
        (stream(b"\x01" + ints(2, 9)), "does not describe the class of the object 2"),
        (stream(string(1, "x"), string(1, "x")), "the object 1 twice"),
        (stream(b"\x10" + ints(1, 2) + string(2, "x")), "an array is cut short"),
        (stream(b"\x10" + ints(1, 2) + b"\x0d\x03"), "an array of 2 elements has 3 empty ones too many"),
        (stream(b"\x10" + ints(1, 2) + b"\x0d\x00"), "an array of 2 elements has 0 empty ones too many"),
        (stream(b"\x10" + ints(1, 2) + NULL + b"\x0e" + ints(2)), "has 2 empty ones too many"),
        (stream(b"\x10" + ints(1, -1)), "it claims"),
        (stream(b"\x0f" + ints(1, 2_000_001) + b"\x02"), "it claims 2,000,001 elements"),
        (stream(b"\x10" + ints(1, 2_000_001)), "it claims 2,000,001 elements"),
        (stream(described(1, "C", {"x": (2, b"")}, END)), "a member is missing"),
        (stream(described(1, "C", {"x": (2, b"")}, b"\x0d\x01")), "a member is missing"),
        (stream(described(1, "C", {"x": (8, b"")}, NULL)), "a member of kind 8"),
        (stream(described(1, "C", {"x": (0, b"\x03")}, NULL)), "a primitive value of type 3"),
        (stream(b"\x07" + ints(1) + b"\x02" + ints(1, 1) + b"\x02" + NULL), "more than one dimension"),
        (stream(b"\x07" + ints(1) + b"\x00" + ints(2, 1) + b"\x02" + NULL), "more than one dimension"),
        (stream(b"\x06" + ints(1) + b"\x01\xff"), "not UTF-8"),
        (stream(b"\x06" + ints(1) + b"\xff" * 5 + b"\x01"), "the length of a text is too long"),
        (stream(b"\x06" + ints(1) + b"\x7fx"), "cut short"),
        (stream(string(1, "x"))[:-1], "cut short"),
        (b"", "cut short"),
    ],
)
def test_broken_streams(data, message):
    with pytest.raises(StreamError, match=message):
        read_stream(data)


def nested(depth, array):
    if array:
        inner = b"".join(b"\x10" + ints(number, 1) for number in range(1, depth))
        return stream(inner + b"\x10" + ints(depth, 0))
    first = described(1, "C", {"x": (2, b"")}, b"")
    return stream(first + b"".join(b"\x01" + ints(number, 1) for number in range(2, depth + 1)) + NULL)


@pytest.mark.parametrize("array", [True, False])
def test_objects_within_objects(array):
    """64 of them at most; those beside each other count anew."""
    read_stream(nested(64, array))
    with pytest.raises(StreamError, match="nested too deeply"):
        read_stream(nested(65, array))
    beside = b"".join(b"\x10" + ints(number, 0) for number in range(2, 100))
    assert len(read_stream(stream(b"\x10" + ints(1, 98) + beside))) == 98
    things = described(2, "C", {}, b"") + b"".join(b"\x01" + ints(number, 2) for number in range(3, 100))
    assert len(read_stream(stream(b"\x10" + ints(1, 98) + things))) == 98


def test_elements_of_all_parts_count_together(monkeypatch):
    """Two arrays of 3, and a class of 2 members, which count where it is described and in each object."""
    monkeypatch.setattr(object_stream, "_MOST_ELEMENTS", 10)
    two = {"x": (0, b"\x02"), "y": (0, b"\x02")}
    parts = b"\x0f" + ints(1, 3) + b"\x02abc", b"\x10" + ints(2, 3) + b"\x0d\x03", described(3, "C", two, b"ab")
    assert read_stream(stream(*parts)) == [97, 98, 99]
    with pytest.raises(StreamError, match="it claims 1 "):
        read_stream(stream(*parts, b"\x0f" + ints(4, 1) + b"\x02a"))
