"""Put result sheets into the user's workbook without disturbing anything else in it, and take them out again.

The sheets come as a workbook of their own that XlsxWriter built. Their parts are added under free names; of the
user's parts only content types, the workbook part with its pointers, styles and docProps/app.xml are extended, by
splicing; every other part stays byte for byte as it was. `original_hash` is the fingerprint of the user's own parts.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.app_properties import list_sheets, unlist_sheets
from xlmc.excel.workbook.injection.book_edit import (
    NewSheet,
    add_pointers,
    add_sheets,
    drop_pointers,
    mark,
    marked_names,
    marked_sheets,
    sheet_list,
    without_sheets,
)
from xlmc.excel.workbook.injection.content_types import Roles, add_types, drop_types, roles, types_of
from xlmc.excel.workbook.injection.formula_values import without_formula_values
from xlmc.excel.workbook.injection.part_numbers import claimed_names, free_names, free_part_names, free_tables, reached
from xlmc.excel.workbook.injection.result_sheet import (
    BuiltBook,
    BuiltSheet,
    Carrier,
    Renames,
    read_built,
    relative_target,
)
from xlmc.excel.workbook.injection.splice import MAIN, OFFICE_RELATIONSHIPS, Element, SplicedXml, as_utf8, parse_spans
from xlmc.excel.workbook.injection.strict import STRICT_MAIN, strict_part, strict_type
from xlmc.excel.workbook.injection.style_numbers import styles_from
from xlmc.excel.workbook.injection.styles_merge import PLAIN, StyleMap, merge_styles, same_styles
from xlmc.excel.workbook.package import CONTENT_TYPES, Relationship, hash_parts, relationships, rels_part
from xlmc.excel.workbook.safe_xml import REPAIR, tree

__all__ = ["inject", "marked_names", "original_hash", "refuse_unwritable", "remove_result_sheets", "result_sheets"]

_STYLES = "xl/styles.xml"
_STYLES_POINTER = f"{OFFICE_RELATIONSHIPS}/styles"
_TYPES_OF_OUR_OWN = {
    "rels": "application/vnd.openxmlformats-package.relationships+xml",
    "styles": "application/vnd.openxmlformats-officedocument.spreadsheetml.styles+xml",
}


def inject(
    host: Mapping[str, bytes], sheets: Mapping[str, bytes], *, replace: bool = True, marked: bool = True
) -> dict[str, bytes]:
    """Return the parts of the user's workbook with result sheets behind its own.

    The same host and sheets always give the same parts, in the same order. Where the user has a sheet called
    `Results`, ours is called `Results (2)`, and everything that refers to it says so.

    Args:
        host: all parts of the user's workbook, as `read_parts` gives them.
        sheets: the parts of a workbook built by XlsxWriter that holds the result sheets and nothing else. All are
            worksheets, its defined names belong to one each, and it has no dynamic array formulas and no pictures in
            cells.
        replace: take out the result sheets of earlier runs first.
        marked: mark them as result sheets, which the next run takes out; else they are the user's own from now on.

    Raises:
        WorkbookError: the host is damaged, or of a kind that cannot be extended.
        ValueError: `sheets` holds what it must not.
    """
    user = _User.of(remove_result_sheets(host) if replace else host)
    built = read_built(sheets)
    names = free_names([sheet.name for sheet in built.sheets], user.sheets)
    taken = claimed_names(user.parts)
    styles = _Styles.merged(user, built, taken)
    carrier = _carrier(user, built, names, styles.numbers, taken)
    rels, pointers = add_pointers(user.parts[user.role.rels], user.role.rels, _targets(user, carrier, styles))
    added = [_new_sheet(*found, names, carrier.renames, marked) for found in zip(built.sheets, pointers, strict=False)]
    carried = carrier.parts()
    if user.is_strict:
        carried = {name: strict_part(content) if _is_xml(name) else content for name, content in carried.items()}
    changed = {
        CONTENT_TYPES: add_types(user.parts[CONTENT_TYPES], _types(carrier, carried, styles)),
        user.role.workbook: add_sheets(user.parts[user.role.workbook], user.role.workbook, added),
        user.role.rels: rels,
        styles.part: styles.xml,
        **_list_names(user, list(names.values())),
    }
    return {**user.parts, **changed, **carried}


@dataclass(frozen=True, slots=True)
class _User:
    """The user's workbook: its parts, their roles, the names of its sheets, and its defined names."""

    parts: Mapping[str, bytes]
    role: Roles
    sheets: tuple[str, ...]
    names: tuple[str, ...]
    is_strict: bool

    @classmethod
    def of(cls, parts: Mapping[str, bytes]) -> _User:
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


@dataclass(frozen=True, slots=True)
class _Styles:
    """The styles part with the built styles in it; `new` where the user had none."""

    part: str
    xml: bytes
    numbers: StyleMap
    new: bool

    @classmethod
    def merged(cls, user: _User, built: BuiltBook, taken: Collection[str]) -> _Styles:
        part = user.role.styles
        if part is not None:
            return cls(part, *merge_styles(user.parts[part], part, built.styles, user.styles_from), new=False)
        is_taken = any(name.casefold() == _STYLES for name in taken)
        free = free_part_names([_STYLES], taken)[_STYLES] if is_taken else _STYLES
        xml, numbers = built.styles, same_styles(built.styles)
        if user.styles_from(1):
            xml, numbers = merge_styles(PLAIN, free, built.styles, user.styles_from)
        return cls(free, strict_part(xml) if user.is_strict else xml, numbers, new=True)


def _carrier(
    user: _User, built: BuiltBook, names: Mapping[str, str], styles: StyleMap, taken: Collection[str]
) -> Carrier:
    parts = free_part_names(reached(built.parts, *(sheet.part for sheet in built.sheets)), taken)
    types = types_of(built.parts[CONTENT_TYPES], parts)
    tables = free_tables(
        {part: built.parts[part] for part, kind in types.items() if kind.endswith(".table+xml")},
        user.parts,
        user.role.workbook,
        user.names,
    )
    sheets = {old.casefold(): new for old, new in names.items() if old != new}
    return Carrier(built, parts, types, styles, Renames(sheets, tables.names), tables)


def _targets(user: _User, carrier: Carrier, styles: _Styles) -> list[tuple[str, str]]:
    """Return what the workbook part has to point to, as (type, target): each sheet, then the styles if they are new."""
    workbook = user.role.workbook
    found = [(sheet.type, relative_target(workbook, carrier.names[sheet.part])) for sheet in carrier.built.sheets]
    found += [(_STYLES_POINTER, relative_target(workbook, styles.part))] if styles.new else []
    return [(strict_type(kind), target) for kind, target in found] if user.is_strict else found


def _is_xml(name: str) -> bool:
    return name.endswith((".xml", ".rels", ".vml"))


def _new_sheet(sheet: BuiltSheet, pointer: str, names: Mapping[str, str], renames: Renames, marked: bool) -> NewSheet:
    own = [dataclasses.replace(name, text=renames.formula(name.text)) for name in sheet.names]
    return NewSheet(names[sheet.name], pointer, sheet.state, (*own, *([mark(names[sheet.name])] if marked else [])))


def _types(carrier: Carrier, carried: Mapping[str, bytes], styles: _Styles) -> dict[str, str]:
    types = {new: carrier.types[old] for old, new in carrier.names.items()}
    types |= {part: _TYPES_OF_OUR_OWN["rels"] for part in carried if part not in types}
    return types | {styles.part: _TYPES_OF_OUR_OWN["styles"]} if styles.new else types


def _list_names(user: _User, added: Sequence[str]) -> dict[str, bytes]:
    part = user.role.properties
    if part is None:
        return {}
    try:
        return {part: list_sheets(user.parts[part], part, user.sheets, added)}
    except WorkbookError:  # damaged: no more than a list for file managers, it stays as it is
        return {}


def refuse_unwritable(parts: Mapping[str, bytes]) -> None:
    """Refuse, before a run, a workbook that could be read but that no sheets could be added to.

    Raises:
        WorkbookError: the workbook part, its pointers, the content types, the styles or a table are damaged.
    """
    user = _User.of(remove_result_sheets(parts))
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
    identity = _workbook_content(parse_spans(as_utf8(own[role.workbook], role.workbook), role.workbook))
    pointers = relationships(own, role.workbook).items()
    leads = sorted([i, r.type, r.target, r.external] for i, r in pointers if r.kind != "styles")
    return hash_parts({**untouched, role.workbook: _canonical(identity), role.rels: _canonical(leads)})


def _workbook_content(root: Element) -> list[object]:
    """Return what the workbook part says, but for its windows; no names and an empty list of names are the same."""
    children = [child for child in root.children if child.local != "bookViews"]
    return [child.canonical() for child in children if child.local != "definedNames" or child.children]


def _canonical(identity: object) -> bytes:
    return json.dumps(identity, ensure_ascii=True, separators=(",", ":")).encode()


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
