"""`docProps/app.xml`: the list of sheets that file managers show.

`HeadingPairs` says how many titles of each kind there are (`Worksheets`, 3, in the language of the Excel that saved
it), `TitlesOfParts` then holds all titles one after another. A list that does not add up, or names none of the
workbook's sheets, was stale before: it stays as it is.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from html import escape
from itertools import islice

from xlmc.excel.workbook.injection.part_numbers import quoted
from xlmc.excel.workbook.injection.splice import Element, SplicedXml, render

__all__ = ["list_sheets", "unlist_sheets"]


@dataclass(frozen=True, slots=True)
class _Group:
    """One kind of title. `pair` are the two variants that hold its heading and its count."""

    pair: tuple[Element, Element]
    count: Element
    titles: Sequence[Element]


def list_sheets(xml: bytes, part: str, present: Collection[str], added: Sequence[str]) -> bytes:
    """Return the part with the added sheets listed behind those present.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    groups = _groups(document.root)
    group = _sheet_group(groups, present)
    if group is None:
        return xml
    tag = document.prefix(group.titles[-1]) + "lpstr"
    for name in added:
        document.after(group.titles[-1], render(tag, {}, escape(name, quote=False)))
    document.write_text(group.count, str(len(group.titles) + len(added)))
    _resize(document, 2 * len(groups), sum(len(g.titles) for g in groups) + len(added))
    return document.result()


def unlist_sheets(xml: bytes, part: str, present: Collection[str], removed: Collection[str]) -> bytes:
    """Return the part without the removed sheets, and without the named ranges on them (`Results!Print_Titles`).

    Args:
        xml: the part.
        part: its name.
        present: all sheets of the workbook, the removed ones too.
        removed: the sheets that go.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    groups = _groups(document.root)
    group = _sheet_group(groups, present)
    if group is None:
        return xml
    left = [_unlist(document, g, removed, is_sheets=g is group) for g in groups]
    _resize(document, 2 * sum(1 for titles in left if titles), sum(left))
    return document.result()


def _unlist(document: SplicedXml, group: _Group, removed: Collection[str], *, is_sheets: bool) -> int:
    """How many of the group's titles stay; a group that loses its last goes with its heading."""
    names = _fold(removed)
    scopes = tuple(f"{form}!".casefold() for name in removed for form in (name, quoted(name)))
    gone = [
        title
        for title in group.titles
        if (title.text.casefold() in names if is_sheets else title.text.casefold().startswith(scopes))
    ]
    for title in gone:
        document.remove(title)
    if gone and len(gone) == len(group.titles):
        for variant in group.pair:
            document.remove(variant)
    elif gone:
        document.write_text(group.count, str(len(group.titles) - len(gone)))
    return len(group.titles) - len(gone)


def _groups(root: Element) -> list[_Group]:
    headings, titles = _vector(root, "HeadingPairs"), _vector(root, "TitlesOfParts")
    if headings is None or titles is None or len(headings.children) % 2:
        return []
    pairs = list(zip(headings.children[::2], headings.children[1::2], strict=True))
    counts = [variant.find("i4") for _, variant in pairs]
    sizes = [int(count.text) for count in counts if count is not None and count.text.strip().isdecimal()]
    if len(sizes) != len(pairs) or sum(sizes) != len(titles.children):
        return []
    remaining = iter(titles.children)
    return [
        _Group(pair, count, list(islice(remaining, size)))
        for pair, count, size in zip(pairs, counts, sizes, strict=True)
        if count is not None
    ]


def _sheet_group(groups: Iterable[_Group], sheets: Collection[str]) -> _Group | None:
    names = _fold(sheets)
    return next((g for g in groups if not names.isdisjoint(_fold(title.text for title in g.titles))), None)


def _resize(document: SplicedXml, headings: int, titles: int) -> None:
    for name, size in (("HeadingPairs", headings), ("TitlesOfParts", titles)):
        vector = _vector(document.root, name)
        assert vector is not None  # its groups have just been read
        document.set(vector, "size", size)


def _vector(root: Element, local: str) -> Element | None:
    holder = root.find(local)
    return next((child for child in holder.children if child.local == "vector"), None) if holder else None


def _fold(names: Iterable[str]) -> set[str]:
    return {name.casefold() for name in names}
