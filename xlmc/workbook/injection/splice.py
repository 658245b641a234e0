"""Change a part's XML at named places and leave every other byte as it is.

Parsing a part and writing it anew loses what xlmc does not know: prefixes, `mc:Ignorable`, extensions, the order of
attributes. Here changes are spliced into the bytes between the elements that `spans` has found.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from html import escape

from xlmc.workbook.injection.spans import Element, as_utf8, parse_spans

__all__ = ["SplicedXml", "render"]

_TAG_NAME = re.compile(rb"""<([^\s/>"']+)""")
_ATTRIBUTE = re.compile(rb"""(?P<name>[^\s=/>"']+)\s*=\s*(?P<quoted>"[^"]*"|'[^']*')""")

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
        """Give an attribute without a prefix a value, in place or as a new last attribute."""
        quoted = _quoted(value).encode()
        for match in self._attributes(element):
            if match["name"] == attribute.encode():
                self._edits.append((*match.span("quoted"), quoted))
                return
        at = element.inner - (2 if self.xml[element.inner - 2 : element.inner] == b"/>" else 1)
        self._edits.append((at, at, b" " + attribute.encode() + b"=" + quoted))

    def prefix(self, element: Element) -> str:
        """The element's own prefix with its colon, as the part writes it; empty for the default namespace."""
        name = self._tag_name(element).decode()
        return name[: name.rfind(":") + 1]

    def prefix_of(self, namespace: str) -> str | None:
        """The prefix (without colon) the root element binds to the namespace, if it binds one."""
        for match in self._attributes(self.root):
            if match["name"].startswith(b"xmlns:") and match["quoted"][1:-1] == namespace.encode():
                return match["name"].removeprefix(b"xmlns:").decode()
        return None

    def result(self) -> bytes:
        """The part with all changes made."""
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
    """An element as text: `tag` with its prefix, attributes in order, `content` XML already (None: self-closed)."""
    pairs = "".join(f" {name}={_quoted(value)}" for name, value in attributes.items())
    return (f"<{tag}{pairs}/>" if content is None else f"<{tag}{pairs}>{content}</{tag}>").encode()


def _quoted(value: object) -> str:
    return '"' + escape(str(value), quote=False).translate(_IN_ATTRIBUTES) + '"'
