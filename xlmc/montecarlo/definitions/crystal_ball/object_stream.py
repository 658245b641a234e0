"""Objects as .NET's BinaryFormatter stores them: a stream of records becomes things, lists, texts and numbers.

Nothing is brought to life: an object is a name and its members. The stream is untrusted, so lengths, counts and depth
are bounded, and whatever breaks a rule raises `StreamError`.

Source: [MS-NRBF], .NET Remoting: Binary Format Data Structure.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from xlmc.montecarlo.number_text import count_text

__all__ = ["StreamError", "Thing", "read_stream"]

_MOST_ELEMENTS: Final = 2_000_000
"""Elements of arrays and members of objects in one stream: hundreds of times what a block of Crystal Ball holds."""

_DEEPEST: Final = 64
"""Objects within objects; a block of Crystal Ball has 2, as all but value types are referred to."""


class StreamError(ValueError):
    """The stream breaks a rule of the format."""


@dataclass(slots=True, eq=False)
class Thing:
    """An object: the full name of its class, and its members."""

    name: str
    members: dict[str, Any]

    @property
    def kind(self) -> str:
        """The last part of the class's name."""
        return self.name.rpartition(".")[2]


class _Reference(NamedTuple):
    """Stands for an object until all are read."""

    number: int


@dataclass(frozen=True, slots=True)
class _Empty:
    """A number of empty elements of an array."""

    count: int


_END: Final = object()


@dataclass(frozen=True, slots=True)
class _Described:
    """A class as the stream describes it: its members with their binary types and what these add."""

    name: str
    members: tuple[tuple[str, int, int], ...]


(
    _PRIMITIVE,
    _STRING,
    _OBJECT,
    _SYSTEM_CLASS,
    _CLASS,
    _OBJECT_ARRAY,
    _STRING_ARRAY,
    _PRIMITIVE_ARRAY,
) = range(8)
"""Binary types of members and elements."""

_FORMS: Final[Mapping[int, str]] = {
    1: "?", 2: "B", 6: "d", 7: "h", 8: "i", 9: "q", 10: "b", 11: "f", 12: "q", 13: "Q", 14: "H", 15: "I", 16: "Q",
}  # fmt: skip
"""Primitive types of a fixed length, as `struct` writes them."""

_DECIMAL, _TEXT = 5, 18


def read_stream(data: bytes) -> Any:
    """Return the root object of a stream, with all references resolved; they may form circles.

    Arrays are lists.

    Raises:
        StreamError: the stream breaks a rule, refers to an object that it does not hold, or goes on after its end.
    """
    return _Reader(data).root()


class _Reader:
    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0
        self._left = _MOST_ELEMENTS
        self._depth = 0
        self._objects: dict[int, Any] = {}
        self._made: list[Thing | list[Any]] = []
        self._classes: dict[int, _Described] = {}
        self._records: Mapping[int, Callable[[], Any]] = {
            1: self._again,
            4: lambda: self._described(library=False),
            5: lambda: self._described(library=True),
            6: self._string,
            7: self._array,
            8: lambda: self._primitive(self._byte()),
            9: lambda: _Reference(self._int()),
            10: lambda: None,
            11: lambda: _END,
            13: lambda: _Empty(self._byte()),
            14: lambda: _Empty(self._int()),
            15: self._primitives,
            16: lambda: self._objects_of(*self._numbered_length()),
            17: lambda: self._objects_of(*self._numbered_length()),
        }

    def root(self) -> Any:
        if self._byte() != 0:
            raise StreamError("it does not begin with a header")
        number, _, major, _ = (self._int() for _ in range(4))
        if major != 1:
            raise StreamError(f"it is of version {major}, not 1")
        while self._value() is not _END:
            pass
        if self._at != len(self._data):
            raise StreamError("it goes on after its end")
        self._resolve()
        return self._object(number)

    def _object(self, number: int) -> Any:
        if number not in self._objects:
            raise StreamError(f"it refers to the object {number}, which it does not hold")
        return self._objects[number]

    def _resolve(self) -> None:
        """Replace references to objects by the objects themselves."""
        for each in self._made:
            contents: Any = each.members if isinstance(each, Thing) else each
            for key, value in list(contents.items() if isinstance(contents, dict) else enumerate(contents)):
                if isinstance(value, _Reference):
                    contents[key] = self._object(value.number)

    # records

    def _value(self) -> Any:
        """Return the next record that is no library."""
        kind = self._byte()
        while kind == 12:
            self._int()
            self._text()
            kind = self._byte()
        if kind not in self._records:
            raise StreamError(f"it holds a record of kind {kind}")
        return self._records[kind]()

    def _element(self) -> Any:
        value = self._value()
        if value is _END or isinstance(value, _Empty):
            raise StreamError("a member is missing")
        return value

    def _described(self, library: bool) -> Thing:
        number, name, count = self._int(), self._text(), self._int()
        self._spend(count)
        names = [self._text() for _ in range(count)]
        kinds = [self._byte() for _ in range(count)]
        more = [self._more(kind) for kind in kinds]
        if library:
            self._int()
        described = _Described(name, tuple(zip(names, kinds, more, strict=True)))
        self._classes[number] = described
        return self._thing(number, described)

    def _again(self) -> Thing:
        number, known = self._int(), self._int()
        if known not in self._classes:
            raise StreamError(f"it does not describe the class of the object {number}")
        self._classes[number] = described = self._classes[known]
        return self._thing(number, described)

    def _thing(self, number: int, described: _Described) -> Thing:
        self._spend(len(described.members))
        thing = Thing(described.name, {})
        self._keep(number, thing)
        self._depth += 1
        if self._depth > _DEEPEST:
            raise StreamError("its objects are nested too deeply")
        for name, kind, more in described.members:
            thing.members[name] = self._primitive(more) if kind == _PRIMITIVE else self._element()
        self._depth -= 1
        return thing

    def _string(self) -> str:
        number, text = self._int(), self._text()
        self._keep(number, text)
        return text

    def _array(self) -> list[Any]:
        number, shape, rank = self._int(), self._byte(), self._int()
        if shape not in (0, 1) or rank != 1:
            raise StreamError("it holds an array of more than one dimension")
        length, kind = self._int(), self._byte()
        more = self._more(kind)
        if kind == _PRIMITIVE:
            return self._primitives_of(number, length, more)
        return self._objects_of(number, length)

    def _numbered_length(self) -> tuple[int, int]:
        return self._int(), self._int()

    def _primitives(self) -> list[Any]:
        number, length = self._numbered_length()
        return self._primitives_of(number, length, self._byte())

    def _primitives_of(self, number: int, length: int, kind: int) -> list[Any]:
        self._spend(length)
        if kind in _FORMS:
            size = struct.calcsize(f"<{_FORMS[kind]}")
            result = list(struct.unpack(f"<{length}{_FORMS[kind]}", self._take(length * size)))
        else:
            result = [self._primitive(kind) for _ in range(length)]
        self._keep(number, result)
        return result

    def _objects_of(self, number: int, length: int) -> list[Any]:
        self._spend(length)
        result: list[Any] = []
        self._keep(number, result)
        self._depth += 1
        if self._depth > _DEEPEST:
            raise StreamError("its objects are nested too deeply")
        while len(result) < length:
            each = self._value()
            if each is _END:
                raise StreamError("an array is cut short")
            if not isinstance(each, _Empty):
                result.append(each)
            elif 0 < each.count <= length - len(result):
                result += [None] * each.count
            else:
                raise StreamError(f"an array of {length} elements has {each.count} empty ones too many")
        self._depth -= 1
        return result

    def _keep(self, number: int, value: Any) -> None:
        """Keep what may be referred to; values within their owner have negative numbers, and nothing refers to them."""
        if number > 0 and number in self._objects:
            raise StreamError(f"it holds the object {number} twice")
        self._objects[number] = value
        if not isinstance(value, str):
            self._made.append(value)

    # values

    def _more(self, kind: int) -> int:
        """Return what a member's binary type adds: the primitive type, where it has one."""
        if kind in (_PRIMITIVE, _PRIMITIVE_ARRAY):
            return self._byte()
        if kind in (_SYSTEM_CLASS, _CLASS):
            self._text()
        if kind == _CLASS:
            self._int()
        elif kind > _PRIMITIVE_ARRAY:
            raise StreamError(f"it has a member of kind {kind}")
        return 0

    def _primitive(self, kind: int) -> Any:
        if kind in _FORMS:
            form = f"<{_FORMS[kind]}"
            return struct.unpack(form, self._take(struct.calcsize(form)))[0]
        if kind in (_DECIMAL, _TEXT):
            return self._text()
        raise StreamError(f"it holds a primitive value of type {kind}")

    def _text(self) -> str:
        """Return a text behind its length in bytes, seven bits a byte, the lowest first."""
        length = shift = 0
        while True:
            byte = self._byte()
            length |= (byte & 0x7F) << shift
            if byte < 0x80:
                break
            shift += 7
            if shift > 28:
                raise StreamError("the length of a text is too long")
        try:
            return self._take(length).decode()
        except UnicodeDecodeError:
            raise StreamError("a text is not UTF-8") from None

    def _int(self) -> int:
        value: int = struct.unpack("<i", self._take(4))[0]
        return value

    def _byte(self) -> int:
        return self._take(1)[0]

    def _take(self, length: int) -> bytes:
        start, end = self._at, self._at + length
        if length < 0 or end > len(self._data):
            raise StreamError("it is cut short")
        self._at = end
        return self._data[start:end]

    def _spend(self, count: int) -> None:
        """Take so many elements from what a stream may have."""
        if not 0 <= count <= self._left:
            raise StreamError(f"it claims {count_text(count)} elements")
        self._left -= count
