"""Add the styles of a built workbook to those of the user's, whose own keep their numbers.

A cell's style is a number: its place in `cellXfs`, an entry of which again names places in `fonts`, `fills`,
`borders` and a number format. What the user's workbook has already is used again, so repeated runs add nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from xlmc.workbook.injection.spans import Element, parse_spans
from xlmc.workbook.injection.splice import SplicedXml
from xlmc.workbook.injection.style_lists import NumberFormats, StyleEntry, StyleList, style_entries

__all__ = ["StyleMap", "merge_styles", "same_styles"]

_PARTS_OF_A_STYLE = {"fontId": "fonts", "fillId": "fills", "borderId": "borders"}
_FLAGS = {"numFmtId": "applyNumberFormat", "fontId": "applyFont", "fillId": "applyFill", "borderId": "applyBorder"}


@dataclass(frozen=True, slots=True)
class StyleMap:
    """New numbers by old: `cells` for a cell's, row's or column's style, `differential` for `dxfId`."""

    cells: tuple[int, ...]
    differential: tuple[int, ...]


def same_styles(styles: bytes) -> StyleMap:
    """The map for a workbook that takes over the built styles as they are."""
    root = parse_spans(styles, "styles")
    sizes = (len(style_entries(root, "cellXfs")), len(style_entries(root, "dxfs")))
    return StyleMap(*(tuple(range(size)) for size in sizes))


def merge_styles(styles: bytes, part: str, built: bytes) -> tuple[bytes, StyleMap]:
    """The user's styles part with the built styles added, and where they now are.

    Raises:
        WorkbookError: the styles part is not XML.
    """
    document, source = SplicedXml(styles, part), parse_spans(built, "styles of the result sheets")
    formats = NumberFormats(document, source)
    lists = {name: StyleList(document, name) for name in (*_PARTS_OF_A_STYLE.values(), "cellXfs", "dxfs")}
    places = {name: _place_all(lists[name], source) for name in _PARTS_OF_A_STYLE.values()}
    normal = _normal(document.root)
    cells = [_cell_style(style, places, formats, normal) for style in style_entries(source, "cellXfs")]
    differential = [_differential(style, formats) for style in style_entries(source, "dxfs")]
    found = StyleMap(
        cells=tuple(lists["cellXfs"].place(entry) for entry in cells),
        differential=tuple(lists["dxfs"].place(entry) for entry in differential),
    )
    for numbered in (formats.list, *lists.values()):  # in the schema's order
        numbered.write()
    return document.result(), found


def _place_all(numbered: StyleList, source: Element) -> list[int]:
    return [numbered.place(StyleEntry.of(entry)) for entry in style_entries(source, numbered.name)]


@dataclass(frozen=True, slots=True)
class _Normal:
    """The user's style `Normal`: its place (None in a part without styles) and its attributes."""

    place: str | None
    attributes: Mapping[str, str]


def _normal(root: Element) -> _Normal:
    styles = style_entries(root, "cellStyleXfs")
    # Its name is in the user's language; its built-in number is not.
    named = [style for style in style_entries(root, "cellStyles") if style.attributes.get("builtinId") == "0"]
    place = named[0].attributes.get("xfId", "0") if named else "0"
    if not place.isdecimal() or int(place) >= len(styles):
        return _Normal(None, {})
    return _Normal(place, styles[int(place)].attributes)


def _cell_style(built: Element, places: Mapping[str, list[int]], formats: NumberFormats, normal: _Normal) -> StyleEntry:
    """A built cell style in the user's numbers, resting on the user's Normal and saying where it departs from it."""
    entry = StyleEntry.of(built)
    attributes = dict(entry.attributes)
    attributes["numFmtId"] = formats.number(attributes["numFmtId"])
    for name, numbered in _PARTS_OF_A_STYLE.items():
        attributes[name] = str(places[numbered][int(attributes[name])])
    del attributes["xfId"]
    if normal.place is not None:
        attributes["xfId"] = normal.place
    differs = (flag for name, flag in _FLAGS.items() if attributes[name] != normal.attributes.get(name, "0"))
    return StyleEntry(entry.local, attributes | dict.fromkeys(differs, "1"), entry.children)


def _differential(built: Element, formats: NumberFormats) -> StyleEntry:
    """A built conditional style with its number format in the user's numbers."""
    entry = StyleEntry.of(built)
    return StyleEntry(entry.local, entry.attributes, tuple(_renumbered(child, formats) for child in entry.children))


def _renumbered(child: StyleEntry, formats: NumberFormats) -> StyleEntry:
    if child.local != "numFmt":
        return child
    number = formats.number(child.attributes["numFmtId"], child.attributes["formatCode"])
    return StyleEntry(child.local, {**child.attributes, "numFmtId": number})
