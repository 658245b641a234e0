"""The sheets that XlsxWriter built, read from their own workbook and carried over to the user's.

Each sheet is rewritten for its new package: its styles renumbered, its texts inside its cells, its pointers to other
parts. XlsxWriter's XML has one fixed form (`<c r="A1" s="3" t="s"><v>0</v></c>`, `<` and `>` always escaped in texts
and attributes), so patterns that start at a `<` cannot mistake text for markup, and large sheets take one fast pass.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape, unescape
from typing import Final

from xlmc.excel.workbook.injection.book_edit import SheetName
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.part_numbers import TableNumbers, rename_in_formula
from xlmc.excel.workbook.injection.splice import Element, SplicedXml, parse_spans
from xlmc.excel.workbook.injection.styles_merge import StyleMap
from xlmc.excel.workbook.package import Relationship, relationships, relative_target, rels_part

__all__ = [
    "BuiltBook",
    "BuiltSheet",
    "Carrier",
    "Renames",
    "at_home",
    "read_built",
    "rename_in_xml",
    "shared_items",
    "with_differential",
]

_CELL = re.compile(rb'<c r="([A-Z]+[0-9]+)"(?: s="([0-9]+)")?( t="s"><v>([0-9]+)</v>)?')
_STYLE = re.compile(rb' s="([0-9]+)"')
_SHARED = re.compile(rb' t="s"><v>([0-9]+)</v>')
_STYLED_ROW = re.compile(rb'<row\b[^>]*? s="')
_ROW_STYLE = re.compile(rb'(<row\b[^>]*? s=")([0-9]+)')
_COLUMN_STYLE = re.compile(rb'(<col\b[^>]*? style=")([0-9]+)')
_METADATA = re.compile(rb'<c r="[A-Z]+[0-9]+"[^>]* [cv]m="')
_SELECTED = re.compile(rb'(<sheetView\b[^>]*?) tabSelected="1"')
_TAG = re.compile(rb"<[^<>]+>")
_DIFFERENTIAL = re.compile(rb'((?: d|D)xfId=")([0-9]+)')
_ITEM = re.compile(rb"<si>(.*?)</si>", re.DOTALL)
_FORMULA = re.compile(
    rb"(<(?:\w+:)?(?:f|formula|formula1|formula2|calculatedColumnFormula|totalsRowFormula)(?: [^>]*)?>)([^<]*)(?=</)"
)
_LOCATION = re.compile(rb'(<(?:hyperlink|xdr:sp)\b[^>]*? (?:location|textlink)=")([^"]*)')

_AT_ONCE: Final = 1 << 19


@dataclass(frozen=True, slots=True)
class Renames:
    """New names of sheets and tables by their folded old names."""

    sheets: Mapping[str, str] = field(default_factory=dict)
    tables: Mapping[str, str] = field(default_factory=dict)

    def formula(self, text: str) -> str:
        """Return the formula, or link target, with the new names."""
        return rename_in_formula(text, self.sheets, self.tables)


def at_home(xml: bytes, strings: Sequence[bytes], styles: StyleMap) -> bytes:
    """Return the sheet with its styles in the user's numbers, its texts inline, and its tab not selected.

    Args:
        xml: a worksheet as XlsxWriter writes it.
        strings: the built workbook's `shared_items`.
        styles: where the built styles are now.

    Raises:
        ValueError: a cell has metadata (dynamic arrays, pictures in cells), which cannot be carried over.
    """
    if (b' cm="' in xml or b' vm="' in xml) and _METADATA.search(xml):  # the pattern looks at every cell
        raise ValueError("result sheets must not hold dynamic array formulas or pictures in cells")
    head, data, rest = xml.partition(b"<sheetData")
    body, end, tail = rest.partition(b"</sheetData>")
    head = _COLUMN_STYLE.sub(_put_number(styles.cells), _SELECTED.sub(rb"\1", head))
    body = _cells(body, strings, styles.cells)
    return b"".join([head, data, body, end, with_differential(tail, styles)])


def with_differential(xml: bytes, styles: StyleMap) -> bytes:
    """Return the XML with every `dxfId`, `dataDxfId`, … in the user's numbers."""
    number = _put_number(styles.differential)
    return _TAG.sub(lambda tag: _DIFFERENTIAL.sub(number, tag[0]) if b"xfId=" in tag[0] else tag[0], xml)


def shared_items(xml: bytes | None) -> list[bytes]:
    """Return the contents of a built workbook's shared strings (`<t>…</t>`, or runs of rich text), in order."""
    return [] if xml is None else _ITEM.findall(xml)


def rename_in_xml(xml: bytes, renames: Renames) -> bytes:
    """Return a built part with the new names of sheets and tables in its formulas, links and text boxes."""
    if not renames.sheets and not renames.tables:
        return xml

    def new(match: re.Match[bytes]) -> bytes:
        text = renames.formula(unescape(match[2].decode()))
        return match[1] + escape(text, quote=False).replace('"', "&quot;").encode()

    return _LOCATION.sub(new, _FORMULA.sub(new, xml))


def _cells(body: bytes, strings: Sequence[bytes], cells: Sequence[int]) -> bytes:
    styled_rows = _STYLED_ROW.search(body) is not None
    if not cells[0] and b"</f>" not in body and b"</is>" not in body and not styled_rows:
        return b"".join(_plain_cells(rows, strings, cells) for rows in _in_parts(body))
    if styled_rows:
        body = _ROW_STYLE.sub(_put_number(cells), body)
    # A cell without a style has the built workbook's first one, which need not be the user's first.
    style = [b' s="%d"' % number if number else b"" for number in cells]

    def new(match: re.Match[bytes]) -> bytes:
        reference, old, shared, index = match.groups()
        start = b'<c r="%b"%b' % (reference, style[int(old or 0)])
        return start if shared is None else b'%b t="inlineStr"><is>%b</is>' % (start, strings[int(index)])

    return _CELL.sub(new, body)


def _in_parts(body: bytes) -> Iterator[bytes]:
    """Return the rows in parts of about `_AT_ONCE` bytes: the pieces of cells take many times the memory of
    the text.
    """
    start = 0
    while start < len(body):
        end = body.find(b"</row>", start + _AT_ONCE)
        stop = len(body) if end < 0 else end + len(b"</row>")
        yield body[start:stop]
        start = stop


def _plain_cells(body: bytes, strings: Sequence[bytes], cells: Sequence[int]) -> bytes:
    """Do the same as `_cells`, in one cut, for rows in which only tags of cells can hold ` s="`: they have no styles of
    their own, no formulas and no inline texts.

    A cell without a style needs none: the built workbook's first one is the user's first.
    """
    pieces = _STYLE.split(body)
    new = {number: b' s="%d"' % cells[int(number)] if cells[int(number)] else b"" for number in set(pieces[1::2])}
    pieces[1::2] = [new[number] for number in pieces[1::2]]
    return _SHARED.sub(lambda text: b' t="inlineStr"><is>%b</is>' % strings[int(text[1])], b"".join(pieces))


def _put_number(numbers: Sequence[int]) -> Callable[[re.Match[bytes]], bytes]:
    return lambda match: match[1] + b"%d" % numbers[int(match[2])]


@dataclass(frozen=True, slots=True)
class BuiltSheet:
    """A worksheet as built. `type` is the relationship type that leads to it, `state` is None if it is visible."""

    name: str
    part: str
    type: str
    state: str | None
    names: tuple[SheetName, ...]


@dataclass(frozen=True, slots=True)
class BuiltBook:
    """A built workbook. `strings` are the contents of its shared strings, as XML."""

    parts: Mapping[str, bytes]
    sheets: tuple[BuiltSheet, ...]
    styles: bytes
    strings: tuple[bytes, ...]


def read_built(parts: Mapping[str, bytes]) -> BuiltBook:
    """Return the built workbook of a package.

    Raises:
        ValueError: it has names for the whole workbook, which might be the user's own, or chart sheets, to which no
            name can belong.
    """
    role = roles(parts)
    assert role.styles is not None  # XlsxWriter always writes styles
    pointers = relationships(parts, role.workbook)
    root = parse_spans(parts[role.workbook], role.workbook)
    sheets, names = root.find("sheets"), root.find("definedNames")
    assert sheets is not None
    strings = next((parts[pointer.target] for pointer in pointers.values() if pointer.kind == "sharedStrings"), None)
    return BuiltBook(
        parts=parts,
        sheets=tuple(_sheet(element, index, names, pointers) for index, element in enumerate(sheets.children)),
        styles=parts[role.styles],
        strings=tuple(shared_items(strings)),
    )


def _sheet(element: Element, index: int, names: Element | None, pointers: Mapping[str, Relationship]) -> BuiltSheet:
    name, pointer = element.attributes["name"], pointers[element.foreign("id") or ""]
    if pointer.kind != "worksheet":
        raise ValueError(f"the result sheet {name!r} must be a worksheet")
    state = element.attributes.get("state")
    return BuiltSheet(name, pointer.target, pointer.type, state, tuple(_names_of(names, index)))


def _names_of(names: Element | None, index: int) -> Iterator[SheetName]:
    for element in names.children if names else ():
        attributes = element.attributes
        if "localSheetId" not in attributes:
            raise ValueError(f"the name {attributes['name']!r} must belong to one result sheet")
        if attributes["localSheetId"] == str(index):
            yield SheetName(attributes["name"], element.text, hidden=attributes.get("hidden") == "1")


_AXIS: Final = re.compile(rb"<c:(catAx|dateAx)>.*?</c:\1>", re.DOTALL)
_BEHIND_AXIS_FORMAT: Final = re.compile(rb"<c:(majorTickMark|minorTickMark|tickLblPos) ")
_GENERAL: Final = b'<c:numFmt formatCode="General" sourceLinked="1"/>'


@dataclass(frozen=True, slots=True)
class Carrier:
    """All that is new about the built parts: `names` and `types` (content types) by their old part names."""

    built: BuiltBook
    names: Mapping[str, str]
    types: Mapping[str, str]
    styles: StyleMap
    renames: Renames
    tables: TableNumbers

    def parts(self) -> dict[str, bytes]:
        """Return the new parts, each followed by its rels part."""
        carried = {}
        for old, new in self.names.items():
            carried[new] = self._rewrite(old)
            if rels_part(old) in self.built.parts:
                carried[rels_part(new)] = self._pointers(old)
        return carried

    def _rewrite(self, part: str) -> bytes:
        xml = self.built.parts[part]
        match self.types[part].rpartition(".")[2]:
            case "worksheet+xml":
                return rename_in_xml(at_home(xml, self.built.strings, self.styles), self.renames)
            case "table+xml":
                return rename_in_xml(with_differential(self._table(part), self.styles), self.renames)
            case "chart+xml":
                return rename_in_xml(_with_axis_format(xml), self.renames)
            case "drawing+xml":
                return rename_in_xml(xml, self.renames)
            case _:
                return xml

    def _table(self, part: str) -> bytes:
        document = SplicedXml(self.built.parts[part], part)
        document.set(document.root, "id", self.tables.ids[part])
        for attribute in ("name", "displayName"):
            name = document.root.attributes[attribute]
            document.set(document.root, attribute, self.tables.names.get(name.casefold(), name))
        return document.result()

    def _pointers(self, part: str) -> bytes:
        document = SplicedXml(self.built.parts[rels_part(part)], rels_part(part))
        targets = relationships(self.built.parts, part)
        for element in document.root.children:
            target = targets[element.attributes["Id"]].target
            raw = element.attributes["Target"]
            if raw.startswith("#"):  # a link within the workbook
                document.set(element, "Target", "#" + self.renames.formula(raw[1:]))
            elif target in self.names:
                document.set(element, "Target", relative_target(self.names[part], self.names[target]))
        return document.result()


def _with_axis_format(xml: bytes) -> bytes:
    """Return the chart with a number format on every category axis: Excel writes one always, and some programs want it.

    Only the axes are looked at: a chart is one of XlsxWriter's, and mostly numbers.
    """
    return _AXIS.sub(lambda axis: _format_axis(axis[0]), xml)


def _format_axis(axis: bytes) -> bytes:
    if b"<c:numFmt " in axis:
        return axis
    return _BEHIND_AXIS_FORMAT.sub(lambda behind: _GENERAL + behind[0], axis, count=1)
