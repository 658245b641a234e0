"""A look at a whole package before it replaces a file: what would make Excel, or another program, repair it.

Faults that the workbook had before are the person's own and stay; `checked_bytes` refuses those that are new.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar
from xml.parsers import expat

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.part_numbers import tables_in
from xlmc.excel.workbook.injection.splice import as_utf8, parse_spans
from xlmc.excel.workbook.injection.style_numbers import styles_from
from xlmc.excel.workbook.package import CONTENT_TYPES, relationships, rels_part
from xlmc.excel.workbook.safe_xml import REPAIR, tree
from xlmc.excel.workbook.writer import SMALL, package_bytes

__all__ = ["checked_bytes", "faults"]

_XML = (".xml", ".rels", ".vml")
_MOST_NAMED = 5

_Value = TypeVar("_Value", str, tuple[str, str])


def checked_bytes(parts: Mapping[str, bytes], before: Mapping[str, bytes], level: int = SMALL) -> bytes:
    """Pack the parts of a workbook once they are found whole.

    Args:
        parts: of the workbook to write.
        before: the parts of the workbook as it was read.
        level: how they are packed, as for `package_bytes`.

    Raises:
        WorkbookError: the package would have a fault that it did not have before.
    """
    changed = {name for name, content in parts.items() if before.get(name) != content}
    result = faults(parts, changed)
    if result:
        had = set(faults(before, before.keys() & changed))
        result = [fault for fault in result if fault not in had]
    if result:
        more = f"; and {len(result) - _MOST_NAMED} more" if len(result) > _MOST_NAMED else ""
        named = "; ".join(fault[:200] for fault in result[:_MOST_NAMED])
        raise WorkbookError(f"the file that was to be written would be damaged: {named}{more}", hint=REPAIR)
    return package_bytes(parts, level)


def faults(parts: Mapping[str, bytes], looked_at: Iterable[str]) -> list[str]:
    """Yield what is wrong with a package, a sentence each, the same for the same fault.

    Args:
        parts: of the package.
        looked_at: the parts whose XML, pointers and styles are checked; content types, sheets and names always are.

    Raises:
        WorkbookError: one of the parts that every package needs is missing or no XML.
    """
    role = roles(parts)
    names = sorted(name for name in looked_at if name in parts)
    result = [*_content_type_faults(parts), *_sheet_faults(parts, role.workbook), *_table_faults(parts, role.workbook)]
    entries = _cell_styles(parts, role.styles)
    for name in names:
        result += _xml_faults(name, parts[name])
        result += _style_faults(name, parts[name], entries)
    sources = [*("" for name in names if name == rels_part("")), *(name for name in parts if rels_part(name) in names)]
    for source in sources:
        result += _pointer_faults(parts, source)
    return result


def _content_type_faults(parts: Mapping[str, bytes]) -> Iterator[str]:
    """Each part has one content type."""
    root = tree(parts[CONTENT_TYPES], CONTENT_TYPES)
    overrides = [each.get("PartName", "").casefold() for each in root.findall("{*}Override")]
    defaults = [each.get("Extension", "").casefold() for each in root.findall("{*}Default")]
    yield from (f"{CONTENT_TYPES} names {name} twice" for name in _repeated(overrides))
    yield from (f"{CONTENT_TYPES} names the ending {name!r} twice" for name in _repeated(defaults))
    stated, by_ending = set(overrides), set(defaults)
    for name in parts:
        declared = f"/{name}".casefold() in stated or name.rpartition(".")[2].casefold() in by_ending
        if name != CONTENT_TYPES and not declared:
            yield f"{CONTENT_TYPES} does not say what {name} is"


def _sheet_faults(parts: Mapping[str, bytes], workbook: str) -> Iterator[str]:
    """Names, numbers and pointers of sheets are there once; names of the workbook belong to sheets that exist."""
    root = parse_spans(as_utf8(parts[workbook], workbook), workbook)
    holder = root.find("sheets")
    sheets = [] if holder is None else holder.children
    for what, values in (
        ("name", [sheet.attributes.get("name", "").casefold() for sheet in sheets]),
        ("number", [sheet.attributes.get("sheetId", "") for sheet in sheets]),
        ("pointer", [sheet.foreign("id") or "" for sheet in sheets]),
    ):
        yield from (f"two sheets have the {what} {value!r}" for value in _repeated(values) if value)
    known = relationships(parts, workbook)
    for sheet in sheets:
        name = sheet.foreign("id")
        pointer = known.get(name or "")
        if name != "" and (pointer is None or pointer.target not in parts):  # "": a module sheet of the 1990s
            yield f"the sheet {sheet.attributes.get('name', '')!r} has no part"
    names = root.find("definedNames")
    declared = [
        (each.attributes.get("name", "").casefold(), each.attributes.get("localSheetId", ""))
        for each in (names.children if names else ())
    ]
    yield from (f"the name {name!r} is defined twice for one sheet" for name, _ in _repeated(declared))
    for name, index in declared:
        if index.isdecimal() and int(index) >= len(sheets):
            yield f"the name {name!r} belongs to a sheet that does not exist"


def _table_faults(parts: Mapping[str, bytes], workbook: str) -> Iterator[str]:
    """Tables have numbers and names of their own."""
    result = list(tables_in(parts, workbook))
    yield from (f"two tables have the number {value!r}" for value in _repeated([each.get("id", "") for each in result]))
    names = [each.get("displayName", "").casefold() for each in result]
    yield from (f"two tables have the name {value!r}" for value in _repeated(names))


def _cell_styles(parts: Mapping[str, bytes], styles: str | None) -> int | None:
    """How many cell styles there are; None without a styles part."""
    if styles is None:
        return None
    formats = tree(parts[styles], styles).find("{*}cellXfs")
    return 0 if formats is None else len(formats)


def _style_faults(name: str, xml: bytes, entries: int | None) -> Iterator[str]:
    if entries is None or "/worksheets/" not in f"/{name}":
        return
    result = styles_from(xml, max(entries, 1))
    if result:
        yield f"{name} uses the cell style {min(result)}, which is not there"


def _xml_faults(name: str, xml: bytes) -> Iterator[str]:
    if not name.endswith(_XML):
        return
    try:
        expat.ParserCreate().Parse(xml, True)
    except expat.ExpatError as error:
        yield f"{name} is not well-formed XML ({error})"


def _pointer_faults(parts: Mapping[str, bytes], source: str) -> Iterator[str]:
    """Check that the pointers of one part have ids of their own and lead to parts that are there."""
    rels = rels_part(source)
    raw = [(each.get("Id", ""), each.get("Target", "")) for each in tree(parts[rels], rels).findall("{*}Relationship")]
    yield from (f"{rels} has the id {name!r} twice" for name in _repeated([name for name, _ in raw]))
    inside = {name for name, target in raw if target.startswith("#")}  # a link within the workbook
    for name, pointer in relationships(parts, source).items():
        if not pointer.external and pointer.target not in parts and name not in inside:
            yield f"{rels} points with {name!r} to {pointer.target}, which is not there"


def _repeated(values: Iterable[_Value]) -> list[_Value]:
    return [value for value, times in Counter(values).items() if times > 1]
