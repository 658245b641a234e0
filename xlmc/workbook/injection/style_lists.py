"""The numbered lists of a styles part (`fonts`, `cellXfs`, …): find an entry, or add it behind the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from xlmc.workbook.injection.namespaces import MAIN
from xlmc.workbook.injection.spans import Element
from xlmc.workbook.injection.splice import SplicedXml, render

__all__ = ["NumberFormats", "StyleEntry", "StyleList", "style_entries"]

_ORDER = ("numFmts", "fonts", "fills", "borders", "cellStyleXfs", "cellXfs", "cellStyles", "dxfs", "tableStyles")
"""The order the schema wants; whatever else there may be stands behind them."""

_FIRST_CUSTOM_FORMAT = 164


@dataclass(frozen=True)
class StyleEntry:
    """An element of a styles part: free of prefixes, so that it can be compared and written anywhere."""

    local: str
    attributes: Mapping[str, str]
    children: tuple[StyleEntry, ...] = ()

    @classmethod
    def of(cls, element: Element) -> StyleEntry:
        children = tuple(cls.of(child) for child in element.children)
        # An extension keeps its full name, so that it is never taken for one of the schema's own elements.
        return cls(element.local if element.namespace == MAIN else element.name, element.attributes, children)

    def key(self) -> tuple[object, ...]:
        """Equal for entries that say the same."""
        return (self.local, tuple(sorted(self.attributes.items())), tuple(child.key() for child in self.children))

    def text(self, prefix: str) -> str:
        """The entry as XML with that prefix (and its colon) on every element.

        Raises:
            ValueError: the entry has an extension, which a built workbook's styles must not.
        """
        if " " in self.local:
            raise ValueError(f"no way to carry over {self.local!r} in a style")
        content = "".join(child.text(prefix) for child in self.children)
        return render(prefix + self.local, self.attributes, content or None).decode()


class StyleList:
    """One numbered list of the user's styles part: entries there already, and new ones behind them."""

    def __init__(self, document: SplicedXml, name: str) -> None:
        self.name = name
        self._document = document
        self._element = document.root.find(name)
        self._new: list[StyleEntry] = []
        entries = style_entries(document.root, name)
        self._size = len(entries)
        self._places = {StyleEntry.of(entry).key(): place for place, entry in enumerate(entries)}

    def place(self, entry: StyleEntry) -> int:
        """Where the entry is, added if it is new."""
        place = self._places.setdefault(entry.key(), self._size)
        if place == self._size:
            self._new.append(entry)
            self._size += 1
        return place

    def write(self) -> None:
        """Splice the new entries in, in a list of their own where the part has none."""
        if not self._new:
            return
        root = self._document.root
        prefix = self._document.prefix(root)
        content = "".join(entry.text(prefix) for entry in self._new)
        if self._element is not None:
            self._document.append(self._element, content.encode())
            self._document.set(self._element, "count", self._size)
            return
        self._insert(root, render(prefix + self.name, {"count": self._size}, content))

    def _insert(self, root: Element, fragment: bytes) -> None:
        earlier = _ORDER[: _ORDER.index(self.name)]
        own = (child for child in root.children if child.namespace == root.namespace)
        behind = next((child for child in own if child.local not in earlier), None)
        if behind is None:
            self._document.append(root, fragment)
        else:
            self._document.before(behind, fragment)


class NumberFormats:
    """Number formats: built-in ones keep their number, others are found by their code or get a free number."""

    def __init__(self, document: SplicedXml, source: Element) -> None:
        self.list = StyleList(document, "numFmts")
        root = document.root
        self._codes = {e.attributes["numFmtId"]: _code(e) for e in style_entries(source, "numFmts")}
        self._numbers = {_code(e): _number(e) for e in style_entries(root, "numFmts")}
        # A style may name a format that nothing defines; defining it now would change the user's cells.
        used = [_number(e) for name in ("numFmts", "cellXfs", "cellStyleXfs") for e in style_entries(root, name)]
        self._next = max([_FIRST_CUSTOM_FORMAT - 1, *used]) + 1

    def number(self, built: str, code: str | None = None) -> str:
        """The number of a built workbook's format; `code` where the format says it itself."""
        if int(built) < _FIRST_CUSTOM_FORMAT:
            return built
        code = code or self._codes[built]
        if code not in self._numbers:
            self._numbers[code] = self._next
            self.list.place(StyleEntry("numFmt", {"numFmtId": str(self._next), "formatCode": code}))
            self._next += 1
        return str(self._numbers[code])


def style_entries(root: Element, name: str) -> list[Element]:
    """The entries of one list of a styles part, in order; none where there is no such list."""
    holder = root.find(name)
    return [child for child in holder.children if child.namespace == root.namespace] if holder else []


def _number(entry: Element) -> int:
    text = entry.attributes.get("numFmtId", "")
    return int(text) if text.isdecimal() else 0


def _code(entry: Element) -> str:
    return entry.attributes.get("formatCode", "")
