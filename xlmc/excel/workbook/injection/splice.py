"""Change a part's XML where it is told to, and leave every other byte as it is.

Parsing a part and writing it anew loses what xlmc does not know: prefixes, `mc:Ignorable`, extensions, the order of
attributes. So `parse_spans` finds where each element stands, in bytes, and `SplicedXml` puts changes between them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.safe_xml import REPAIR, expat_parser, feed

__all__ = ["MAIN", "OFFICE_RELATIONSHIPS", "Element", "SplicedXml", "as_utf8", "cell_text", "parse_spans", "render"]

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE_RELATIONSHIPS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"


_START_TAG = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>""")
_DECLARED = re.compile(r"""\A(\s*<\?xml[^>]*?\sencoding\s*=\s*)(["'])([^"']*)["']""")
_MARKS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
_DEEPEST = 256
"""No part of a workbook nests anywhere near this deep; a hostile one could exhaust the stack."""


@dataclass(slots=True, eq=False)
class Element:
    """An element and where it stands: `start:inner` its start tag, `inner:close` its content, `close:end` its end tag.

    A self-closed element has inner = close = end. Names are `namespace local`, or `local` where there is no namespace;
    `text` is what stands directly in the element. Offsets are bytes.
    """

    name: str
    attributes: dict[str, str]
    start: int
    inner: int
    close: int = -1
    end: int = -1
    text: str = ""
    children: list[Element] = field(default_factory=list)

    @property
    def local(self) -> str:
        """The name without its namespace."""
        return self.name.rpartition(" ")[2]

    @property
    def namespace(self) -> str:
        """The namespace; otherwise empty."""
        return self.name.rpartition(" ")[0]

    def find_all(self, local: str) -> list[Element]:
        """Return the children of that local name in this element's own namespace, in order."""
        return [child for child in self.children if child.local == local and child.namespace == self.namespace]

    def find(self, local: str) -> Element | None:
        """Return the first element of `find_all`."""
        return next(iter(self.find_all(local)), None)

    def foreign(self, local: str) -> str | None:
        """Return the attribute of that local name in any namespace but none, such as `id` for `r:id`."""
        return next((value for name, value in self.attributes.items() if name.endswith(f" {local}")), None)

    def canonical(self) -> list[object]:
        """Return what the element says, whatever its prefixes, attribute order and layout: nested lists of text."""
        text = self.text if not self.children else self.text.strip()
        return [self.name, sorted(self.attributes.items()), text, [child.canonical() for child in self.children]]


def parse_spans(xml: bytes, part: str) -> Element:
    """Return the root of a UTF-8 part, every element with its byte offsets.

    Raises:
        WorkbookError: the part is not XML, declares a document type, or nests too deep.
    """
    parser = expat_parser()
    open_elements = [Element("", {}, 0, 0)]

    def start(name: str, attributes: dict[str, str]) -> None:
        if len(open_elements) > _DEEPEST:
            raise WorkbookError("elements nest too deep")
        at = parser.CurrentByteIndex
        match = _START_TAG.match(xml, at)
        assert match is not None  # expat has just read it
        element = Element(name, attributes, at, match.end())
        open_elements[-1].children.append(element)
        open_elements.append(element)

    def end(_: str) -> None:
        element = open_elements.pop()
        closed = xml[element.inner - 2 : element.inner] == b"/>"
        element.close = element.inner if closed else parser.CurrentByteIndex
        element.end = element.inner if closed else xml.index(b">", element.close) + 1

    def text(data: str) -> None:
        open_elements[-1].text += data

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, text
    feed(parser, xml, part)
    return open_elements[0].children[0]


def as_utf8(xml: bytes, part: str) -> bytes:
    """Return the same XML in UTF-8, its declaration put right; the same bytes where it is UTF-8 already.

    Raises:
        WorkbookError: the part is in an encoding that is unknown, or not the one it declares.
    """
    marked = _MARKS.get(xml[:2])
    match = _DECLARED.match(xml[:200].decode(marked or "latin-1", "replace").removeprefix("\ufeff"))
    encoding = marked or (match[3] if match else "utf-8")
    if encoding.lower() in ("utf-8", "utf8"):
        return xml
    try:
        return _DECLARED.sub(r"\1\2UTF-8\2", xml.decode(encoding).removeprefix("\ufeff")).encode()
    except (LookupError, UnicodeError) as error:
        raise WorkbookError(f"{part} is not in the encoding it declares ({error})", hint=REPAIR) from error


_TAG_NAME = re.compile(rb"""<([^\s/>"']+)""")
_ATTRIBUTE = re.compile(rb"""(?P<name>[^\s=/>"']+)\s*=\s*(?P<quoted>"[^"]*"|'[^']*')""")

_UNWRITABLE = re.compile("_(?=x[0-9A-Fa-f]{4}_)|[\\x00-\\x08\\x0b-\\x1f\\ufffe\\uffff]")
"""What begins an escape, and characters that XML cannot hold, or, as a carriage return, does not keep."""

_IN_ATTRIBUTES = str.maketrans({'"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"})


class SplicedXml:
    """A part's XML (as UTF-8), its element tree, and the changes asked for so far.

    Args:
        xml: the part, in any encoding that XML parts may have.
        part: its name, for messages.

    Raises:
        WorkbookError: the part is not XML, declares a document type, or has an unknown encoding.
    """

    def __init__(self, xml: bytes, part: str) -> None:
        self.xml = as_utf8(xml, part)
        self.root = parse_spans(self.xml, part)
        self._edits: list[tuple[int, int, bytes]] = []
        self._appended: dict[int, tuple[Element, list[bytes]]] = {}

    def before(self, element: Element, fragment: bytes) -> None:
        """Put the fragment in front of the element."""
        self._edits.append((element.start, element.start, fragment))

    def after(self, element: Element, fragment: bytes) -> None:
        """Put the fragment behind the element."""
        self._edits.append((element.end, element.end, fragment))

    def append(self, element: Element, fragment: bytes) -> None:
        """Put the fragment at the end of the element's content, behind what was appended before."""
        self._appended.setdefault(id(element), (element, []))[1].append(fragment)

    def remove(self, element: Element) -> None:
        """Take the element out."""
        self._edits.append((element.start, element.end, b""))

    def write_text(self, element: Element, text: str) -> None:
        """Replace the content of an element that is not self-closed."""
        self._edits.append((element.inner, element.close, escape(text, quote=False).encode()))

    def set(self, element: Element, attribute: str, value: object) -> None:
        """Give an attribute without a prefix a value, where it stands or as a new last attribute."""
        quoted = _quote(value).encode()
        for match in self._attributes(element):
            if match["name"] == attribute.encode():
                self._edits.append((*match.span("quoted"), quoted))
                return
        at = element.inner - (2 if self.xml[element.inner - 2 : element.inner] == b"/>" else 1)
        self._edits.append((at, at, b" " + attribute.encode() + b"=" + quoted))

    def prefix(self, element: Element) -> str:
        """Return the element's own prefix with its colon, as the part writes it; empty for the default namespace."""
        name = self._tag_name(element).decode()
        return name[: name.rfind(":") + 1]

    def prefix_of(self, namespace: str) -> str | None:
        """Return the prefix (without colon) the root element binds to the namespace, if it binds one."""
        for match in self._attributes(self.root):
            if match["name"].startswith(b"xmlns:") and match["quoted"][1:-1] == namespace.encode():
                return match["name"].removeprefix(b"xmlns:").decode()
        return None

    def result(self) -> bytes:
        """Return the part with all changes made."""
        edits = sorted([*self._edits, *self._append_edits()], key=lambda edit: edit[:2])
        pieces, at = [], 0
        for start, end, fragment in edits:
            pieces += [self.xml[at:start], fragment]
            at = end
        return b"".join([*pieces, self.xml[at:]])

    def _append_edits(self) -> Iterator[tuple[int, int, bytes]]:
        for element, fragments in self._appended.values():
            content = b"".join(fragments)
            if element.inner < element.end:
                yield element.close, element.close, content
            else:
                yield element.inner - 2, element.inner, b">" + content + b"</" + self._tag_name(element) + b">"

    def _attributes(self, element: Element) -> Iterator[re.Match[bytes]]:
        first = element.start + 1 + len(self._tag_name(element))
        return _ATTRIBUTE.finditer(self.xml, first, element.inner)

    def _tag_name(self, element: Element) -> bytes:
        match = _TAG_NAME.match(self.xml, element.start)
        assert match is not None  # the parser found a start tag here
        return match[1]


def render(tag: str, attributes: Mapping[str, object], content: str | None = None) -> bytes:
    """Write an element as text: `tag` with its prefix, attributes in order, `content` XML already (None:
    self-closed).
    """
    pairs = "".join(f" {name}={_quote(value)}" for name, value in attributes.items())
    return (f"<{tag}{pairs}/>" if content is None else f"<{tag}{pairs}>{content}</{tag}>").encode()


def cell_text(text: str) -> str:
    r"""Return a text as XML for a cell: what Excel would read as an escape, and what XML cannot hold, is escaped.

    >>> cell_text("a<b_x0041_\r")
    'a&lt;b_x005F_x0041__x000D_'
    """
    return escape(_UNWRITABLE.sub(lambda match: f"_x{ord(match[0]):04X}_", text), quote=False)


def _quote(value: object) -> str:
    return '"' + escape(str(value), quote=False).translate(_IN_ATTRIBUTES) + '"'
