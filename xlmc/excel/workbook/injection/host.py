"""The workbook that result sheets go into, as it is without those of earlier runs.

Result sheets are found by the name that marks each of them; whatever only they lead to is theirs, too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.app_properties import unlist_sheets
from xlmc.excel.workbook.injection.book_edit import drop_pointers, marked_sheets, sheet_list, without_sheets
from xlmc.excel.workbook.injection.content_types import Roles, drop_types, roles
from xlmc.excel.workbook.injection.part_numbers import claimed_names, free_tables, reached
from xlmc.excel.workbook.injection.splice import MAIN, Element, SplicedXml, as_utf8, parse_spans
from xlmc.excel.workbook.injection.strict import STRICT_MAIN
from xlmc.excel.workbook.injection.style_numbers import styles_from
from xlmc.excel.workbook.package import CONTENT_TYPES, Relationship, relationships, rels_part
from xlmc.excel.workbook.safe_xml import REPAIR, tree

__all__ = ["Host", "refuse_unwritable", "remove_result_sheets", "result_sheets"]


@dataclass(frozen=True, slots=True)
class Host:
    """The user's workbook: its parts, their roles, the names of its sheets, and its defined names."""

    parts: Mapping[str, bytes]
    role: Roles
    sheets: tuple[str, ...]
    names: tuple[str, ...]
    is_strict: bool

    @classmethod
    def of(cls, parts: Mapping[str, bytes]) -> Host:
        role = roles(parts)
        root = parse_spans(as_utf8(parts[role.workbook], role.workbook), role.workbook)
        if root.namespace not in (MAIN, STRICT_MAIN):
            hint = "Save it as an Excel Workbook (.xlsx) or Macro-Enabled Workbook (.xlsm)"
            raise WorkbookError("the workbook is in a form to which no sheets can be added", hint=hint)
        names = root.find("definedNames")
        return cls(
            parts=parts,
            role=role,
            sheets=tuple(sheet.attributes.get("name", "") for sheet in sheet_list(root, role.workbook).children),
            names=tuple(name.attributes.get("name", "") for name in (names.children if names else ())),
            is_strict=root.namespace == STRICT_MAIN,
        )

    def styles_from(self, least: int) -> set[int]:
        """Return the numbers of cell styles, from this one on, that the user's sheets name."""
        pointers = relationships(self.parts, self.role.workbook).values()
        sheets = {each.target for each in pointers if each.kind.endswith("sheet") and each.target in self.parts}
        return set().union(*(styles_from(as_utf8(self.parts[sheet], sheet), least) for sheet in sheets))


def refuse_unwritable(parts: Mapping[str, bytes]) -> None:
    """Refuse, before a run, a workbook that could be read but that no sheets could be added to.

    Raises:
        WorkbookError: the workbook part, its pointers, the content types, the styles or a table are damaged.
    """
    user = Host.of(remove_result_sheets(parts))
    claimed_names(user.parts)
    for part in (CONTENT_TYPES, user.role.rels, user.role.styles):
        if part is not None:
            root = SplicedXml(user.parts[part], part).root
            if part == user.role.styles and root.local != "styleSheet":
                raise WorkbookError(f"{part} is no styles part", hint=REPAIR)
    free_tables({}, user.parts, user.role.workbook, user.names)


def remove_result_sheets(parts: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the user's own parts: the package without its result sheets and whatever only they lead to.

    Of what is left, only content types, the workbook part with its pointers, and the list of sheets in
    docProps/app.xml change. Styles stay, and the next run uses them again. A calculation chain that names cells of
    result sheets (Excel has saved the file since) goes as well: Excel makes a new one when it opens the file.

    Raises:
        WorkbookError: the package is damaged.
    """
    role = roles(parts)
    document = SplicedXml(parts[role.workbook], role.workbook)
    gone = marked_sheets(document.root, role.workbook)
    if not gone:
        return dict(parts)
    sheets = document.root.find("sheets")
    assert sheets is not None  # it holds the marked ones
    marked = [sheets.children[index] for index in gone]
    pointers = relationships(parts, role.workbook)
    ids = {sheet.foreign("id") or "" for sheet in marked} | _stale_chains(parts, pointers, marked)
    remaining = {
        **parts,
        role.workbook: without_sheets(document, gone),
        role.rels: drop_pointers(parts[role.rels], role.rels, ids),
    }
    dropped = _only_reached_from([pointers[i].target for i in ids if i in pointers], parts, remaining)
    remaining = {name: content for name, content in remaining.items() if name not in dropped}
    remaining[CONTENT_TYPES] = drop_types(parts[CONTENT_TYPES], dropped, remaining)
    if role.properties is not None:
        present, removed = _names(sheets.children), _names(marked)
        with suppress(WorkbookError):  # damaged: no more than a list for file managers, it stays as it is
            remaining[role.properties] = unlist_sheets(parts[role.properties], role.properties, present, removed)
    return remaining


def result_sheets(parts: Mapping[str, bytes]) -> list[str]:
    """Return the parts of the result sheets, in their order.

    Raises:
        WorkbookError: the package is damaged.
    """
    role = roles(parts)
    root = parse_spans(as_utf8(parts[role.workbook], role.workbook), role.workbook)
    sheets, pointers = sheet_list(root, role.workbook).children, relationships(parts, role.workbook)
    return [pointers[sheets[index].foreign("id") or ""].target for index in marked_sheets(root, role.workbook)]


def _stale_chains(
    parts: Mapping[str, bytes], pointers: Mapping[str, Relationship], sheets: Iterable[Element]
) -> set[str]:
    """Return the ids of calculation chains that name cells of these sheets."""
    numbers = {sheet.attributes.get("sheetId") for sheet in sheets}
    chains = [(i, r.target) for i, r in pointers.items() if r.kind == "calcChain" and r.target in parts]
    return {i for i, part in chains if any(cell.get("i") in numbers for cell in tree(parts[part], part))}


def _only_reached_from(starts: Collection[str], before: Mapping[str, bytes], after: Mapping[str, bytes]) -> set[str]:
    """Return the parts, and their rels parts, that nothing leads to any more now that nothing leads to `starts`."""
    lost = set(reached(before, *starts)) - set(reached(after, ""))
    pointers = {rels_part(part).casefold() for part in lost}
    return lost | {name for name in before if name.casefold() in pointers}


def _names(sheets: Iterable[Element]) -> list[str]:
    return [sheet.attributes.get("name", "") for sheet in sheets]
