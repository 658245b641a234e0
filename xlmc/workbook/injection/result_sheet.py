"""A sheet built by XlsxWriter, made at home in another workbook: its styles renumbered, its texts inside its cells.

XlsxWriter's XML has one fixed form (`<c r="A1" s="3" t="s"><v>0</v></c>`, `<` and `>` always escaped in texts and
attributes), so patterns that start at a `<` cannot mistake text for markup, and large sheets take one fast pass.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape, unescape

from xlmc.workbook.injection.sheet_names import renamed
from xlmc.workbook.injection.styles_merge import StyleMap

__all__ = ["Renames", "at_home", "renamed_in", "shared_items", "with_differential"]

_CELL = re.compile(rb'<c r="([A-Z]+[0-9]+)"(?: s="([0-9]+)")?( t="s"><v>([0-9]+)</v>)?')
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
_PLACE = re.compile(rb'(<(?:hyperlink|xdr:sp)\b[^>]*? (?:location|textlink)=")([^"]*)')


@dataclass(frozen=True, slots=True)
class Renames:
    """New names of sheets and tables by their folded old names."""

    sheets: Mapping[str, str] = field(default_factory=dict)
    tables: Mapping[str, str] = field(default_factory=dict)

    def formula(self, text: str) -> str:
        """The formula, or link target, with the new names."""
        return renamed(text, self.sheets, self.tables)


def at_home(xml: bytes, strings: Sequence[bytes], styles: StyleMap) -> bytes:
    """The sheet with its styles in the user's numbers, its texts inline, and its tab not selected.

    Args:
        xml: a worksheet as XlsxWriter writes it.
        strings: the built workbook's `shared_items`.
        styles: where the built styles are now.

    Raises:
        ValueError: a cell has metadata (dynamic arrays, pictures in cells), which cannot be carried over.
    """
    if _METADATA.search(xml):
        raise ValueError("result sheets must not hold dynamic array formulas or pictures in cells")
    head, data, rest = xml.partition(b"<sheetData")
    body, end, tail = rest.partition(b"</sheetData>")
    head = _COLUMN_STYLE.sub(_numbered(styles.cells), _SELECTED.sub(rb"\1", head))
    body = _cells(_ROW_STYLE.sub(_numbered(styles.cells), body), strings, styles.cells)
    return b"".join([head, data, body, end, with_differential(tail, styles)])


def with_differential(xml: bytes, styles: StyleMap) -> bytes:
    """The XML with every `dxfId`, `dataDxfId`, … in the user's numbers."""
    number = _numbered(styles.differential)
    return _TAG.sub(lambda tag: _DIFFERENTIAL.sub(number, tag[0]) if b"xfId=" in tag[0] else tag[0], xml)


def shared_items(xml: bytes | None) -> list[bytes]:
    """The contents of a built workbook's shared strings (`<t>…</t>`, or runs of rich text), in order."""
    return [] if xml is None else _ITEM.findall(xml)


def renamed_in(xml: bytes, renames: Renames) -> bytes:
    """A built part with the new names of sheets and tables in its formulas, links and text boxes."""
    if not renames.sheets and not renames.tables:
        return xml

    def new(match: re.Match[bytes]) -> bytes:
        text = renames.formula(unescape(match[2].decode()))
        return match[1] + escape(text, quote=False).replace('"', "&quot;").encode()

    return _PLACE.sub(new, _FORMULA.sub(new, xml))


def _cells(body: bytes, strings: Sequence[bytes], cells: Sequence[int]) -> bytes:
    # A cell without a style has the built workbook's first one, which need not be the user's first.
    style = [b' s="%d"' % place if place else b"" for place in cells]

    def new(match: re.Match[bytes]) -> bytes:
        reference, old, shared, index = match.groups()
        start = b'<c r="%b"%b' % (reference, style[int(old or 0)])
        return start if shared is None else b'%b t="inlineStr"><is>%b</is>' % (start, strings[int(index)])

    return _CELL.sub(new, body)


def _numbered(places: Sequence[int]) -> Callable[[re.Match[bytes]], bytes]:
    return lambda match: match[1] + b"%d" % places[int(match[2])]
