"""Tell the user's own parts from those xlmc added: take result sheets out again, and fingerprint what is left."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping

from xlmc.workbook.injection.app_properties import unlist_sheets
from xlmc.workbook.injection.book_edit import drop_pointers, sheet_list
from xlmc.workbook.injection.book_prune import marked_sheets, without_sheets
from xlmc.workbook.injection.cached_values import without_formula_values
from xlmc.workbook.injection.content_types import drop_types
from xlmc.workbook.injection.reach import reached
from xlmc.workbook.injection.roles import CONTENT_TYPES, roles
from xlmc.workbook.injection.spans import Element, as_utf8, parse_spans
from xlmc.workbook.injection.splice import SplicedXml
from xlmc.workbook.package import Relationship, hash_parts, relationships, rels_part
from xlmc.workbook.safe_xml import tree

__all__ = ["original_hash", "remove_result_sheets", "result_sheets"]


def remove_result_sheets(parts: Mapping[str, bytes]) -> dict[str, bytes]:
    """The user's own parts: the package without its result sheets and whatever only they lead to.

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
    marked = [sheets.children[place] for place in gone]
    pointers = relationships(parts, role.workbook)
    ids = {sheet.foreign("id") or "" for sheet in marked} | _stale_chains(parts, pointers, marked)
    kept = {
        **parts,
        role.workbook: without_sheets(document, gone),
        role.rels: drop_pointers(parts[role.rels], role.rels, ids),
    }
    dropped = _only_reached_from([pointers[i].target for i in ids if i in pointers], parts, kept)
    kept = {name: content for name, content in kept.items() if name not in dropped}
    kept[CONTENT_TYPES] = drop_types(parts[CONTENT_TYPES], dropped, kept)
    if role.properties is not None:
        present, removed = _names(sheets.children), _names(marked)
        kept[role.properties] = unlist_sheets(parts[role.properties], role.properties, present, removed)
    return kept


def result_sheets(parts: Mapping[str, bytes]) -> list[str]:
    """The parts of the result sheets, in their order.

    Raises:
        WorkbookError: the package is damaged.
    """
    role = roles(parts)
    root = parse_spans(as_utf8(parts[role.workbook], role.workbook), role.workbook)
    sheets, pointers = sheet_list(root, role.workbook).children, relationships(parts, role.workbook)
    return [pointers[sheets[place].foreign("id") or ""].target for place in marked_sheets(root, role.workbook)]


def original_hash(parts: Mapping[str, bytes]) -> str:
    """One SHA-256 (lower-case hex) for a workbook and for every result workbook made from it.

    It is `package.hash_parts` over the user's own parts (`remove_result_sheets`), byte for byte, but for the five
    that injection may change: content types, styles and docProps/app.xml are left out; of the workbook part and its
    pointers it takes what they say (sheets, defined names, calculation settings, …, in a canonical form), without
    window positions and without the pointer to the styles. Where functions of @RISK or Crystal Ball stand in cells,
    whose results a run fills in, it takes no values of formulas either.

    Raises:
        WorkbookError: the package is damaged.
    """
    own = without_formula_values(remove_result_sheets(parts))
    role = roles(own)
    untouched = {name: content for name, content in own.items() if name not in role.changing}
    said = _said(parse_spans(as_utf8(own[role.workbook], role.workbook), role.workbook))
    pointers = relationships(own, role.workbook).items()
    leads = sorted([i, r.type, r.target, r.external] for i, r in pointers if r.kind != "styles")
    return hash_parts({**untouched, role.workbook: _canonical(said), role.rels: _canonical(leads)})


def _said(root: Element) -> list[object]:
    """What the workbook part says, but for its windows; no names and an empty list of names are one and the same."""
    children = [child for child in root.children if child.local != "bookViews"]
    return [child.canonical() for child in children if child.local != "definedNames" or child.children]


def _canonical(said: object) -> bytes:
    return json.dumps(said, ensure_ascii=True, separators=(",", ":")).encode()


def _stale_chains(
    parts: Mapping[str, bytes], pointers: Mapping[str, Relationship], sheets: Iterable[Element]
) -> set[str]:
    """The ids of calculation chains that name cells of these sheets."""
    numbers = {sheet.attributes.get("sheetId") for sheet in sheets}
    chains = [(i, r.target) for i, r in pointers.items() if r.kind == "calcChain" and r.target in parts]
    return {i for i, part in chains if any(cell.get("i") in numbers for cell in tree(parts[part], part))}


def _only_reached_from(starts: Collection[str], before: Mapping[str, bytes], after: Mapping[str, bytes]) -> set[str]:
    """The parts, and their rels parts, that nothing leads to any more now that nothing leads to `starts`."""
    lost = set(reached(before, *starts)) - set(reached(after, ""))
    pointers = {rels_part(part).casefold() for part in lost}
    return lost | {name for name in before if name.casefold() in pointers}


def _names(sheets: Iterable[Element]) -> list[str]:
    return [sheet.attributes.get("name", "") for sheet in sheets]
