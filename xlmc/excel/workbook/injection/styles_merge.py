"""Add the styles of a built workbook to those of the user's, whose own keep their numbers.

A cell's style is a number: its index in `cellXfs`, an entry of which again gives indices in `fonts`, `fills`,
`borders` and a number format. In each of these lists an entry is found, or added behind the others. What the user's
workbook has already is used again, so repeated runs add nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass

from xlmc.excel.workbook.injection.splice import MAIN, Element, SplicedXml, parse_spans, render
from xlmc.excel.workbook.injection.strict import STRICT_MAIN
from xlmc.excel.workbook.number_formats import BUILT_IN

__all__ = [
    "PLAIN",
    "StyleMap",
    "merge_styles",
    "same_styles",
]

_PARTS_OF_A_STYLE = {"fontId": "fonts", "fillId": "fills", "borderId": "borders"}
_FLAGS = {"numFmtId": "applyNumberFormat", "fontId": "applyFont", "fillId": "applyFill", "borderId": "applyBorder"}


@dataclass(frozen=True, slots=True)
class StyleMap:
    """New numbers by old: `cells` for a cell's, row's or column's style, `differential` for `dxfId`."""

    cells: tuple[int, ...]
    differential: tuple[int, ...]


PLAIN = (
    f'<styleSheet xmlns="{MAIN}">'
    '<fonts count="1"><font><sz val="11"/><name val="Calibri"/><family val="2"/></font></fonts>'
    '<fills count="2"><fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill>'
    '</fills><borders count="1"><border><left/><right/><top/><bottom/><diagonal/></border></borders>'
    '<cellStyleXfs count="1"><xf numFmtId="0" fontId="0" fillId="0" borderId="0"/></cellStyleXfs><cellXfs count="1">'
    '<xf numFmtId="0" fontId="0" fillId="0" borderId="0" xfId="0"/></cellXfs><cellStyles count="1">'
    '<cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles></styleSheet>'
).encode()
"""The styles of a workbook that has none."""


def same_styles(styles: bytes) -> StyleMap:
    """Return the map for a workbook that takes over the built styles as they are."""
    root = parse_spans(styles, "styles")
    sizes = (len(_style_entries(root, "cellXfs")), len(_style_entries(root, "dxfs")))
    return StyleMap(*(tuple(range(size)) for size in sizes))


def merge_styles(
    styles: bytes, part: str, built: bytes, beyond: Callable[[int], Collection[int]] = lambda _: ()
) -> tuple[bytes, StyleMap]:
    """Return the user's styles part with the built styles added, and where they now are.

    Args:
        styles: the user's part.
        part: its name, for messages.
        built: the part of the result sheets.
        beyond: gives the style numbers, from one on, that the user's cells name. A cell whose style is not there is
            shown in the default one, and is so still: no new style gets its number.

    Raises:
        WorkbookError: the styles part is not XML.
    """
    document, source = SplicedXml(styles, part), parse_spans(built, "styles of the result sheets")
    formats = _NumberFormats(document, source)
    lists = {name: _StyleList(document, name) for name in (*_PARTS_OF_A_STYLE.values(), "cellXfs", "dxfs")}
    indices = {name: _indices(lists[name], source) for name in _PARTS_OF_A_STYLE.values()}
    normal = _normal(document.root)
    lists["cellXfs"].pass_over(beyond)
    cells = [_cell_style(style, indices, formats, normal) for style in _style_entries(source, "cellXfs")]
    differential = [_differential(style, formats) for style in _style_entries(source, "dxfs")]
    result = StyleMap(
        cells=tuple(lists["cellXfs"].index_of(entry) for entry in cells),
        differential=tuple(lists["dxfs"].index_of(entry) for entry in differential),
    )
    for numbered in (formats.list, *lists.values()):  # in the schema's order
        numbered.write()
    return document.result(), result


def _indices(numbered: _StyleList, source: Element) -> list[int]:
    return [numbered.index_of(_StyleEntry.of(entry)) for entry in _style_entries(source, numbered.name)]


@dataclass(frozen=True, slots=True)
class _Normal:
    """The user's style `Normal`: its index (None in a part without styles) and its attributes."""

    index: str | None
    attributes: Mapping[str, str]


def _normal(root: Element) -> _Normal:
    styles = _style_entries(root, "cellStyleXfs")
    # Its name is in the user's language; its built-in number is not.
    named = [style for style in _style_entries(root, "cellStyles") if style.attributes.get("builtinId") == "0"]
    index = named[0].attributes.get("xfId", "0") if named else "0"
    if not index.isdecimal() or int(index) >= len(styles):
        return _Normal(None, {})
    return _Normal(index, styles[int(index)].attributes)


def _cell_style(
    built: Element, indices: Mapping[str, list[int]], formats: _NumberFormats, normal: _Normal
) -> _StyleEntry:
    """Put a built cell style into the user's numbers, resting on the user's Normal and saying where it
    departs from it.
    """
    entry = _StyleEntry.of(built)
    attributes = dict(entry.attributes)
    attributes["numFmtId"] = formats.number(attributes["numFmtId"])
    for name, numbered in _PARTS_OF_A_STYLE.items():
        attributes[name] = str(indices[numbered][int(attributes[name])])
    del attributes["xfId"]
    if normal.index is not None:
        attributes["xfId"] = normal.index
    differs = (flag for name, flag in _FLAGS.items() if attributes[name] != normal.attributes.get(name, "0"))
    return _StyleEntry(entry.local, attributes | dict.fromkeys(differs, "1"), entry.children)


def _differential(built: Element, formats: _NumberFormats) -> _StyleEntry:
    """Put a built conditional style, with its number format, into the user's numbers."""
    entry = _StyleEntry.of(built)
    return _StyleEntry(entry.local, entry.attributes, tuple(_renumbered(child, formats) for child in entry.children))


def _renumbered(child: _StyleEntry, formats: _NumberFormats) -> _StyleEntry:
    if child.local != "numFmt":
        return child
    number = formats.number(child.attributes["numFmtId"], child.attributes["formatCode"])
    return _StyleEntry(child.local, {**child.attributes, "numFmtId": number})


_ORDER = ("numFmts", "fonts", "fills", "borders", "cellStyleXfs", "cellXfs", "cellStyles", "dxfs", "tableStyles")
"""The order the schema wants; whatever else there may be stands behind them."""

_FIRST_CUSTOM_FORMAT = 164
_MOST_STYLES = 65_000
"""There are never more cell styles than Excel takes."""


@dataclass(frozen=True)
class _StyleEntry:
    """An element of a styles part: free of prefixes, so that it can be compared and written anywhere."""

    local: str
    attributes: Mapping[str, str]
    children: tuple[_StyleEntry, ...] = ()

    @classmethod
    def of(cls, element: Element) -> _StyleEntry:
        children = tuple(cls.of(child) for child in element.children)
        # An extension keeps its full name, so that it is never taken for one of the schema's own elements.
        own = element.namespace in (MAIN, STRICT_MAIN)
        return cls(element.local if own else element.name, element.attributes, children)

    def key(self) -> tuple[object, ...]:
        """Equal for entries that say the same."""
        return (self.local, tuple(sorted(self.attributes.items())), tuple(child.key() for child in self.children))

    def text(self, prefix: str) -> str:
        """Return the entry as XML with that prefix (and its colon) on every element.

        Raises:
            ValueError: the entry has an extension, which a built workbook's styles must not.
        """
        if " " in self.local:
            raise ValueError(f"no way to carry over {self.local!r} in a style")
        content = "".join(child.text(prefix) for child in self.children)
        return render(prefix + self.local, self.attributes, content or None).decode()


class _StyleList:
    """One numbered list of the user's styles part: entries there already, and new ones behind them."""

    def __init__(self, document: SplicedXml, name: str) -> None:
        self.name = name
        self._document = document
        self._element = document.root.find(name)
        self._new: list[_StyleEntry] = []
        entries = _style_entries(document.root, name)
        self._size = len(entries)
        self._known = {_StyleEntry.of(entry).key(): index for index, entry in enumerate(entries)}

    def index_of(self, entry: _StyleEntry) -> int:
        """Return the index of the entry, which is added if it is new."""
        index = self._known.setdefault(entry.key(), self._size)
        if index == self._size:
            self._new.append(entry)
            self._size += 1
        return index

    def pass_over(self, beyond: Callable[[int], Collection[int]]) -> None:
        """Have default entries up to the last number, from the size on, that a cell names without there being one."""
        numbers = [number for number in beyond(self._size) if number < _MOST_STYLES]
        missing = max(numbers, default=self._size - 1) + 1 - self._size
        self._new += [_StyleEntry("xf", dict.fromkeys(("numFmtId", *_PARTS_OF_A_STYLE), "0"))] * missing
        self._size += missing

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


class _NumberFormats:
    """Number formats: built-in ones keep their number, others are found by their code or get a free number.

    A workbook may define the number of a built-in format anew; that one is then looked for by its code, too.
    """

    def __init__(self, document: SplicedXml, source: Element) -> None:
        self.list = _StyleList(document, "numFmts")
        root = document.root
        self._codes = {e.attributes["numFmtId"]: _code(e) for e in _style_entries(source, "numFmts")}
        self._defined = _defined_formats(root)
        self._numbers = {code: number for number, codes in self._defined.items() if len(codes) == 1 for code in codes}
        # A style may name a format that nothing defines; defining it now would change the user's cells.
        holders = [root.find(name) for name in ("numFmts", "cellXfs", "cellStyleXfs")]
        used = [_number(entry) for holder in holders if holder for entry in _descendants(holder)]
        self._next = max([_FIRST_CUSTOM_FORMAT - 1, *used]) + 1

    def number(self, built: str, code: str | None = None) -> str:
        """Return the number of a built workbook's format; `code` where the format says it itself."""
        if int(built) < _FIRST_CUSTOM_FORMAT and not self._is_redefined(int(built)):
            return built
        code = code or self._codes.get(built) or BUILT_IN[int(built)]
        if code not in self._numbers:
            self._numbers[code] = self._next
            self.list.index_of(_StyleEntry("numFmt", {"numFmtId": str(self._next), "formatCode": code}))
            self._next += 1
        return str(self._numbers[code])

    def _is_redefined(self, built: int) -> bool:
        code = BUILT_IN.get(built)
        return code is not None and self._defined.get(built, {code}) != {code}


def _defined_formats(root: Element) -> dict[int, set[str]]:
    """Return the codes of each number of a format; a number that is defined twice, or in several forms, may have
    several.
    """
    result: dict[int, set[str]] = {}
    holder = root.find("numFmts")
    for entry in _descendants(holder) if holder else ():
        if entry.attributes.get("numFmtId", "").isdecimal():
            result.setdefault(_number(entry), set()).add(_code(entry))
    return result


def _style_entries(root: Element, name: str) -> list[Element]:
    """Return the entries of one list of a styles part, in order; none where there is no such list.

    Each child is one entry, whatever its name: an `mc:AlternateContent` holds one style in several forms.
    """
    holder = root.find(name)
    return list(holder.children) if holder else []


def _descendants(element: Element) -> Iterator[Element]:
    for child in element.children:
        yield child
        yield from _descendants(child)


def _number(entry: Element) -> int:
    text = entry.attributes.get("numFmtId", "")
    return int(text) if text.isdecimal() else 0


def _code(entry: Element) -> str:
    return entry.attributes.get("formatCode", "")
