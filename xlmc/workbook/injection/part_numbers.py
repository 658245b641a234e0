"""Numbers that must be unique in a package, and which ones are free: of parts and of tables."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from xlmc.workbook.injection.reach import pointed_to
from xlmc.workbook.injection.sheet_names import free_table_name
from xlmc.workbook.package import relationships
from xlmc.workbook.safe_xml import tree

__all__ = ["TableNumbers", "free_part_names", "free_tables"]

_NUMBERED = re.compile(r"(.*?)([0-9]*)(\.[^./]*)?", re.DOTALL)


@dataclass(frozen=True, slots=True)
class TableNumbers:
    """New ids of tables by the part that holds them, and new names, where they change, by folded old name."""

    ids: Mapping[str, int] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)


def free_part_names(wanted: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """New part names by old, numbered on from those taken: `xl/charts/chart1.xml -> xl/charts/chart7.xml`.

    Part names differ by more than case, and a picture's number is used once whatever its format.
    """
    last: dict[str, int] = {}
    for name in taken:
        stem, number, _ = _split(name)
        last[stem.casefold()] = max(last.get(stem.casefold(), 0), number)
    found = {}
    for name in wanted:
        stem, _, extension = _split(name)
        number = last[stem.casefold()] = last.get(stem.casefold(), 0) + 1
        found[name] = f"{stem}{number}{extension}"
    return found


def free_tables(
    built: Mapping[str, bytes], parts: Mapping[str, bytes], workbook: str, names: Collection[str]
) -> TableNumbers:
    """Ids and names for the built tables that no table of the user's has.

    Args:
        built: the built parts that hold tables.
        parts: the user's parts.
        workbook: the user's workbook part.
        names: the user's defined names, which tables must not share.

    Raises:
        WorkbookError: a table of the user's is not XML.
    """
    present = list(_tables(parts, workbook))
    last = max((int(table.get("id", "")) for table in present if table.get("id", "").isdecimal()), default=0)
    taken = {name.casefold() for name in names} | {table.get("displayName", "").casefold() for table in present}
    ids, changed = {}, {}
    for part, xml in built.items():
        last += 1
        ids[part] = last
        name = tree(xml, part).attrib["displayName"]
        free = free_table_name(name, taken)
        taken.add(free.casefold())
        if free != name:
            changed[name.casefold()] = free
    return TableNumbers(ids, changed)


def _tables(parts: Mapping[str, bytes], workbook: str) -> Iterator[Mapping[str, str]]:
    """The attributes of every table of the workbook."""
    for sheet in pointed_to(parts, workbook):
        for rel in relationships(parts, sheet).values():
            if rel.kind == "table" and rel.target in parts:
                yield tree(parts[rel.target], rel.target).attrib


def _split(name: str) -> tuple[str, int, str]:
    match = _NUMBERED.fullmatch(name)
    assert match is not None  # the pattern takes any text
    return match[1], int(match[2] or 0), match[3] or ""
