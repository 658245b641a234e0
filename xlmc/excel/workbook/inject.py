"""Put result sheets into the user's workbook without disturbing anything else in it; `host` takes them out again.

The sheets come as a workbook of their own that XlsxWriter built. Their parts are added under free names; of the
user's parts only content types, the workbook part with its pointers, styles and docProps/app.xml are extended, by
splicing; every other part stays byte for byte as it was. `original_hash` is the fingerprint of the user's own parts.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.app_properties import list_sheets
from xlmc.excel.workbook.injection.book_edit import (
    NewSheet,
    add_pointers,
    add_sheets,
    mark,
    marked_names,
)
from xlmc.excel.workbook.injection.content_types import add_types, roles, types_of
from xlmc.excel.workbook.injection.formula_values import without_formula_values
from xlmc.excel.workbook.injection.host import Host, remove_result_sheets
from xlmc.excel.workbook.injection.part_numbers import claimed_names, free_names, free_part_names, free_tables, reached
from xlmc.excel.workbook.injection.result_sheet import (
    BuiltBook,
    BuiltSheet,
    Carrier,
    Renames,
    read_built,
)
from xlmc.excel.workbook.injection.splice import OFFICE_RELATIONSHIPS, Element, as_utf8, parse_spans
from xlmc.excel.workbook.injection.strict import strict_part, strict_type
from xlmc.excel.workbook.injection.styles_merge import PLAIN, StyleMap, merge_styles, same_styles
from xlmc.excel.workbook.package import CONTENT_TYPES, hash_parts, relationships, relative_target

__all__ = ["inject", "marked_names", "original_hash"]

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
    user = Host.of(remove_result_sheets(host) if replace else host)
    built = read_built(sheets)
    names = free_names([sheet.name for sheet in built.sheets], user.sheets)
    taken = claimed_names(user.parts)
    styles = _Styles.merged(user, built, taken)
    carrier = _carrier(user, built, names, styles.numbers, taken)
    rels, pointers = add_pointers(user.parts[user.role.rels], user.role.rels, _targets(user, carrier, styles))
    added = [
        _new_sheet(*result, names, carrier.renames, marked) for result in zip(built.sheets, pointers, strict=False)
    ]
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
class _Styles:
    """The styles part with the built styles in it; `new` where the user had none."""

    part: str
    xml: bytes
    numbers: StyleMap
    new: bool

    @classmethod
    def merged(cls, user: Host, built: BuiltBook, taken: Collection[str]) -> _Styles:
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
    user: Host, built: BuiltBook, names: Mapping[str, str], styles: StyleMap, taken: Collection[str]
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


def _targets(user: Host, carrier: Carrier, styles: _Styles) -> list[tuple[str, str]]:
    """Return what the workbook part has to point to, as (type, target): each sheet, then the styles if they are new."""
    workbook = user.role.workbook
    result = [(sheet.type, relative_target(workbook, carrier.names[sheet.part])) for sheet in carrier.built.sheets]
    result += [(_STYLES_POINTER, relative_target(workbook, styles.part))] if styles.new else []
    return [(strict_type(kind), target) for kind, target in result] if user.is_strict else result


def _is_xml(name: str) -> bool:
    return name.endswith((".xml", ".rels", ".vml"))


def _new_sheet(sheet: BuiltSheet, pointer: str, names: Mapping[str, str], renames: Renames, marked: bool) -> NewSheet:
    own = [dataclasses.replace(name, text=renames.formula(name.text)) for name in sheet.names]
    return NewSheet(names[sheet.name], pointer, sheet.state, (*own, *([mark(names[sheet.name])] if marked else [])))


def _types(carrier: Carrier, carried: Mapping[str, bytes], styles: _Styles) -> dict[str, str]:
    types = {new: carrier.types[old] for old, new in carrier.names.items()}
    types |= {part: _TYPES_OF_OUR_OWN["rels"] for part in carried if part not in types}
    return types | {styles.part: _TYPES_OF_OUR_OWN["styles"]} if styles.new else types


def _list_names(user: Host, added: Sequence[str]) -> dict[str, bytes]:
    part = user.role.properties
    if part is None:
        return {}
    try:
        return {part: list_sheets(user.parts[part], part, user.sheets, added)}
    except WorkbookError:  # damaged: no more than a list for file managers, it stays as it is
        return {}


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
