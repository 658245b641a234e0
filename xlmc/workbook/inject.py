"""Put result sheets into the user's workbook without disturbing anything else in it.

The sheets come as a workbook of their own that XlsxWriter built. Their parts are added under free names; of the
user's parts only content types, the workbook part with its pointers, styles and docProps/app.xml are extended, by
splicing; every other part stays byte for byte as it was.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.workbook.injection.app_properties import list_sheets
from xlmc.workbook.injection.book_edit import NewSheet, add_pointers, add_sheets, sheet_list
from xlmc.workbook.injection.book_prune import mark, marked_names
from xlmc.workbook.injection.built_book import BuiltBook, BuiltSheet, read_built
from xlmc.workbook.injection.content_types import add_types, types_of
from xlmc.workbook.injection.namespaces import MAIN, OFFICE_RELATIONSHIPS
from xlmc.workbook.injection.originals import original_hash, remove_result_sheets, result_sheets
from xlmc.workbook.injection.part_numbers import free_part_names, free_tables
from xlmc.workbook.injection.reach import reached
from xlmc.workbook.injection.result_parts import Carrier, relative_target
from xlmc.workbook.injection.result_sheet import Renames
from xlmc.workbook.injection.roles import CONTENT_TYPES, Roles, roles
from xlmc.workbook.injection.sheet_names import free_names
from xlmc.workbook.injection.spans import as_utf8, parse_spans
from xlmc.workbook.injection.styles_merge import StyleMap, merge_styles, same_styles
from xlmc.workbook.package import read_parts

__all__ = ["inject", "marked_names", "original_hash", "remove_result_sheets", "result_sheets"]

_STYLES = "xl/styles.xml"
_STYLES_POINTER = f"{OFFICE_RELATIONSHIPS}/styles"
_TYPES_OF_OUR_OWN = {
    "rels": "application/vnd.openxmlformats-package.relationships+xml",
    "styles": "application/vnd.openxmlformats-officedocument.spreadsheetml.styles+xml",
}


def inject(host: Mapping[str, bytes], sheets: bytes, *, replace: bool = True) -> dict[str, bytes]:
    """The parts of the user's workbook with result sheets behind its own.

    The same host and sheets always give the same parts, in the same order. Where the user has a sheet called
    `Results`, ours is called `Results (2)`, and everything that refers to it says so.

    Args:
        host: all parts of the user's workbook, as `read_parts` gives them.
        sheets: a workbook built by XlsxWriter that holds the result sheets and nothing else. All are worksheets, its
            defined names belong to one each, and it has no dynamic array formulas and no pictures in cells.
        replace: take out the result sheets of earlier runs first.

    Raises:
        WorkbookError: the host is damaged, or of a kind that cannot be extended.
        ValueError: `sheets` holds what it must not.
    """
    user = _User.of(remove_result_sheets(host) if replace else host)
    built = read_built(read_parts(sheets))
    names = free_names([sheet.name for sheet in built.sheets], user.sheets)
    styles = _Styles.merged(user, built)
    carrier = _carrier(user, built, names, styles.places)
    rels, pointers = add_pointers(user.parts[user.role.rels], user.role.rels, _targets(user, carrier, styles))
    added = [_placed(*found, names, carrier.renames) for found in zip(built.sheets, pointers, strict=False)]
    carried = carrier.parts()
    changed = {
        CONTENT_TYPES: add_types(user.parts[CONTENT_TYPES], _types(carrier, carried, styles)),
        user.role.workbook: add_sheets(user.parts[user.role.workbook], user.role.workbook, added),
        user.role.rels: rels,
        styles.part: styles.xml,
        **_listed(user, list(names.values())),
    }
    return {**user.parts, **changed, **carried}


@dataclass(frozen=True, slots=True)
class _User:
    """The user's workbook: its parts, their roles, the names of its sheets, and its defined names."""

    parts: Mapping[str, bytes]
    role: Roles
    sheets: tuple[str, ...]
    names: tuple[str, ...]

    @classmethod
    def of(cls, parts: Mapping[str, bytes]) -> _User:
        role = roles(parts)
        root = parse_spans(as_utf8(parts[role.workbook], role.workbook), role.workbook)
        if root.namespace != MAIN:
            hint = "Save it as an Excel Workbook (.xlsx) or Macro-Enabled Workbook (.xlsm)"
            raise WorkbookError("the workbook is a Strict Open XML file, to which no sheets can be added", hint=hint)
        names = root.find("definedNames")
        return cls(
            parts=parts,
            role=role,
            sheets=tuple(sheet.attributes.get("name", "") for sheet in sheet_list(root, role.workbook).children),
            names=tuple(name.attributes.get("name", "") for name in (names.children if names else ())),
        )


@dataclass(frozen=True, slots=True)
class _Styles:
    """The styles part with the built styles in it; `new` where the user had none."""

    part: str
    xml: bytes
    places: StyleMap
    new: bool

    @classmethod
    def merged(cls, user: _User, built: BuiltBook) -> _Styles:
        part = user.role.styles
        if part is not None:
            return cls(part, *merge_styles(user.parts[part], part, built.styles), new=False)
        taken = any(name.casefold() == _STYLES for name in user.parts)
        free = free_part_names([_STYLES], user.parts)[_STYLES] if taken else _STYLES
        return cls(free, built.styles, same_styles(built.styles), new=True)


def _carrier(user: _User, built: BuiltBook, names: Mapping[str, str], styles: StyleMap) -> Carrier:
    parts = free_part_names(reached(built.parts, *(sheet.part for sheet in built.sheets)), user.parts)
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
    """What the workbook part has to point to, as (type, target): each sheet, then the styles if they are new."""
    workbook = user.role.workbook
    found = [(sheet.type, relative_target(workbook, carrier.names[sheet.part])) for sheet in carrier.built.sheets]
    return [*found, (_STYLES_POINTER, relative_target(workbook, styles.part))] if styles.new else found


def _placed(sheet: BuiltSheet, pointer: str, names: Mapping[str, str], renames: Renames) -> NewSheet:
    own = [dataclasses.replace(name, text=renames.formula(name.text)) for name in sheet.names]
    return NewSheet(names[sheet.name], pointer, sheet.state, (*own, mark(names[sheet.name])))


def _types(carrier: Carrier, carried: Mapping[str, bytes], styles: _Styles) -> dict[str, str]:
    types = {new: carrier.types[old] for old, new in carrier.names.items()}
    types |= {part: _TYPES_OF_OUR_OWN["rels"] for part in carried if part not in types}
    return types | {styles.part: _TYPES_OF_OUR_OWN["styles"]} if styles.new else types


def _listed(user: _User, added: Sequence[str]) -> dict[str, bytes]:
    part = user.role.properties
    return {} if part is None else {part: list_sheets(user.parts[part], part, user.sheets, added)}
