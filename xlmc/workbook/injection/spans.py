"""Where each element of a part's XML stands, in bytes, so that a change can be made there and nowhere else."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from xlmc.errors import WorkbookError
from xlmc.workbook.safe_xml import REPAIR, expat_parser, feed

__all__ = ["Element", "as_utf8", "parse_spans"]

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
        """The namespace; empty where there is none."""
        return self.name.rpartition(" ")[0]

    def find_all(self, local: str) -> list[Element]:
        """The children of that local name in this element's own namespace, in order."""
        return [child for child in self.children if child.local == local and child.namespace == self.namespace]

    def find(self, local: str) -> Element | None:
        """The first of `find_all`."""
        return next(iter(self.find_all(local)), None)

    def foreign(self, local: str) -> str | None:
        """The attribute of that local name in any namespace but none, such as `id` for `r:id`."""
        return next((value for name, value in self.attributes.items() if name.endswith(f" {local}")), None)

    def canonical(self) -> list[object]:
        """What the element says, whatever its prefixes, attribute order and layout: nested lists of text."""
        text = self.text if not self.children else self.text.strip()
        return [self.name, sorted(self.attributes.items()), text, [child.canonical() for child in self.children]]


def parse_spans(xml: bytes, part: str) -> Element:
    """The root of a UTF-8 part, every element with its byte offsets.

    Raises:
        WorkbookError: the part is not XML, declares a document type, or nests too deep.
    """
    parser = expat_parser()
    open_elements = [Element("", {}, 0, 0)]

    def start(name: str, attributes: dict[str, str]) -> None:
        if len(open_elements) > _DEEPEST:
            raise WorkbookError("its elements nest too deep")
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
    """The same XML in UTF-8, its declaration put right; the same bytes where it is UTF-8 already.

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
