"""What must be unique in a workbook, and what is free there: names of sheets, of parts and of tables.

Also how formulas write the names of sheets and how these are changed in them, and which parts a part leads to.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count

from xlmc.excel.workbook.package import CONTENT_TYPES, folded_names, relationships, rels_part
from xlmc.excel.workbook.safe_xml import tree

__all__ = [
    "TableNumbers",
    "claimed_names",
    "free_names",
    "free_part_names",
    "free_table_name",
    "free_tables",
    "quoted",
    "reached",
    "rename_in_formula",
    "tables_in",
]

_LONGEST = 31  # characters in a sheet name, Excel's limit

_TOKEN = re.compile(
    r"""
    (?P<text>"(?:[^"]|"")*")            # "text", which may look like a reference
  | '(?P<quoted>(?:[^']|'')*)'!         # 'My sheet'!
  | (?<![\w.\]\#])(?P<bare>[\w.\\]+)!   # Sheet!, but neither [1]Sheet! of another workbook nor #REF!
  | (?<![\w.\]])(?P<table>[\w.\\]+)(?=\[)   # Table[
    """,
    re.VERBOSE,
)


def free_names(wanted: Sequence[str], taken: Collection[str]) -> dict[str, str]:
    """Choose a sheet name for each one wanted: itself, or `Results (2)` where the workbook has a sheet of that name."""
    used = {name.casefold() for name in taken}
    result: dict[str, str] = {}
    for name in wanted:
        result[name] = next(candidate for candidate in _numbered(name) if candidate.casefold() not in used)
        used.add(result[name].casefold())
    return result


def free_table_name(wanted: str, taken: Collection[str]) -> str:
    """Choose a table name: the name itself, or `Trials_2`. `taken` holds folded names of tables and of defined names
    alike.
    """
    candidates = (wanted if number == 1 else f"{wanted}_{number}" for number in count(1))
    return next(candidate for candidate in candidates if candidate.casefold() not in taken)


def quoted(name: str) -> str:
    """Write the name as a formula may always do: `O'Hara -> 'O''Hara'`."""
    return "'" + name.replace("'", "''") + "'"


def rename_in_formula(formula: str, sheets: Mapping[str, str], tables: Mapping[str, str]) -> str:
    """Return the formula with sheets and tables called by their new names; strings and other workbooks' sheets stay.

    Keys of both mappings are folded old names.
    """

    def new(match: re.Match[str]) -> str:
        if match["text"] is not None:
            return match[0]
        if match["table"] is not None:
            return tables.get(match["table"].casefold(), match[0])
        name = match["bare"] if match["quoted"] is None else match["quoted"].replace("''", "'")
        changed = sheets.get(name.casefold())
        return match[0] if changed is None else f"{quoted(changed)}!"

    return _TOKEN.sub(new, formula)


def _numbered(name: str) -> Iterator[str]:
    yield name
    for number in count(2):
        suffix = f" ({number})"
        yield name[: _LONGEST - len(suffix)] + suffix


def reached(parts: Mapping[str, bytes], *starts: str) -> list[str]:
    """Return the parts themselves and all they lead to, nearest first, each once. `""` is the package, and not in the
    list.

    Raises:
        WorkbookError: a rels part is not XML.
    """
    result, names = dict.fromkeys(starts), folded_names(parts)
    queue = list(starts)
    for part in queue:
        new = [target for target in _pointed_to(parts, part, names) if target not in result]
        result |= dict.fromkeys(new)
        queue += new
    return [part for part in result if part]


def _pointed_to(parts: Mapping[str, bytes], part: str, names: Mapping[str, str] | None = None) -> list[str]:
    """Return the parts in this package that one part points to, each once; `names` as for `relationships`.

    Raises:
        WorkbookError: the rels part is not XML.
    """
    targets = (rel.target for rel in relationships(parts, part, names).values() if not rel.external)
    return list(dict.fromkeys(target for target in targets if target in parts))


_NUMBERED = re.compile(r"(.*?)([0-9]*)(\.[^./]*)?", re.DOTALL)


@dataclass(frozen=True, slots=True)
class TableNumbers:
    """New ids of tables by the part that holds them, and new names, where they change, by folded old name."""

    ids: Mapping[str, int] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)


def claimed_names(parts: Mapping[str, bytes]) -> set[str]:
    """Names that a new part must not take: those of the parts, and those that content types and pointers speak of.

    A content type or a pointer of a part that is not there is a common leftover; a new part of its name would have two
    content types, or be taken for what the pointer meant.

    Raises:
        WorkbookError: the content types or a rels part are not XML.
    """
    types = tree(parts[CONTENT_TYPES], CONTENT_TYPES).findall("{*}Override")
    spoken = {each.get("PartName", "").removeprefix("/") for each in types}
    folded = {name.casefold() for name in parts if name.casefold().endswith(".rels")}
    sources = [part for part in ("", *parts) if rels_part(part).casefold() in folded]
    names = folded_names(parts)
    pointed = {
        each.target for part in sources for each in relationships(parts, part, names).values() if not each.external
    }
    return {*parts, *spoken, *pointed} - {""}


def free_part_names(wanted: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """Return new part names by old, numbered on from those taken: `xl/charts/chart1.xml -> xl/charts/chart7.xml`.

    Part names differ by more than case, and a picture's number is used once whatever its format.
    """
    last: dict[str, int] = {}
    for name in taken:
        stem, number, _ = _split(name)
        last[stem.casefold()] = max(last.get(stem.casefold(), 0), number)
    result = {}
    for name in wanted:
        stem, _, extension = _split(name)
        number = last[stem.casefold()] = last.get(stem.casefold(), 0) + 1
        result[name] = f"{stem}{number}{extension}"
    return result


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
    present = list(tables_in(parts, workbook))
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


def tables_in(parts: Mapping[str, bytes], workbook: str) -> Iterator[Mapping[str, str]]:
    """Return the attributes of every table of the workbook."""
    for sheet in _pointed_to(parts, workbook):
        for rel in relationships(parts, sheet).values():
            if rel.kind == "table" and rel.target in parts:
                yield tree(parts[rel.target], rel.target).attrib


def _split(name: str) -> tuple[str, int, str]:
    match = _NUMBERED.fullmatch(name)
    assert match is not None  # the pattern takes any text
    return match[1], int(match[2] or 0), match[3] or ""
