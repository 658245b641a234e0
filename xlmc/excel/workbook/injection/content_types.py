"""`[Content_Types].xml`, which says what kind of part each part is, by its name (Override) or its extension (Default).

And the five parts of a package that adding sheets may change, found by the role they play, not by their name.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.splice import Element, SplicedXml, render
from xlmc.excel.workbook.package import CONTENT_TYPES, relationships, rels_part, stored_part
from xlmc.excel.workbook.safe_xml import REPAIR

__all__ = ["Roles", "add_types", "drop_types", "roles", "types_of"]


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of the parts that may change; `styles` and `properties` (docProps/app.xml) are None if absent."""

    workbook: str
    rels: str
    styles: str | None
    properties: str | None

    @property
    def changing(self) -> frozenset[str]:
        """The names of all that are there, content types included: at most five."""
        return frozenset({CONTENT_TYPES, self.workbook, self.rels, self.styles or "", self.properties or ""} - {""})


def roles(parts: Mapping[str, bytes]) -> Roles:
    """Return the roles in this package.

    Raises:
        WorkbookError: the package does not say which part is the workbook, or lacks its content types.
    """
    workbook = _target(parts, "", "officeDocument")
    rels = None if workbook is None else stored_part(parts, rels_part(workbook))
    if workbook is None or rels is None or CONTENT_TYPES not in parts:
        raise WorkbookError("the package does not say where its workbook is", hint=REPAIR)
    return Roles(
        workbook=workbook,
        rels=rels,
        styles=_target(parts, workbook, "styles"),
        properties=_target(parts, "", "extended-properties") or _target(parts, "", "extendedProperties"),
    )


def _target(parts: Mapping[str, bytes], part: str, kind: str) -> str | None:
    result = (r.target for r in relationships(parts, part).values() if r.kind == kind and r.target in parts)
    return next(result, None)


def types_of(xml: bytes, names: Collection[str]) -> dict[str, str]:
    """Return the content type of each named part.

    Raises:
        KeyError: a part of unknown type, which a built workbook does not hold.
        WorkbookError: the part is not XML.
    """
    root = SplicedXml(xml, CONTENT_TYPES).root
    overrides, defaults = _overrides(root), _defaults(root)
    result = {}
    for name in names:
        element = overrides.get(_part_name(name)) or defaults[_extension(name)]
        result[name] = element.attributes["ContentType"]
    return result


def add_types(xml: bytes, types: Mapping[str, str]) -> bytes:
    """Add these parts' types to the part: pictures by extension where that is still free, others by name.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, CONTENT_TYPES)
    root = document.root
    prefix, stated = document.prefix(root), _stated(root)
    for name, content_type in types.items():
        extension = _extension(name)
        if extension not in ("xml", "rels") and extension not in stated:
            default = {"Extension": extension, "ContentType": content_type}
            document.before(root.children[0], render(f"{prefix}Default", default))
            stated[extension] = content_type
        elif stated.get(extension) != content_type:
            document.append(root, render(f"{prefix}Override", {"PartName": f"/{name}", "ContentType": content_type}))
    return document.result()


def drop_types(xml: bytes, dropped: Collection[str], remaining: Collection[str]) -> bytes:
    """Return the part without the dropped parts, and without extensions that only they had.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, CONTENT_TYPES)
    overrides, defaults = _overrides(document.root), _defaults(document.root)
    unused = {_extension(name) for name in dropped} - {_extension(name) for name in remaining}
    gone = [overrides.get(_part_name(name)) for name in dropped] + [defaults.get(extension) for extension in unused]
    for element in gone:
        if element is not None:
            document.remove(element)
    return document.result()


def _overrides(root: Element) -> dict[str, Element]:
    return {element.attributes.get("PartName", "").casefold(): element for element in root.find_all("Override")}


def _defaults(root: Element) -> dict[str, Element]:
    return {element.attributes.get("Extension", "").casefold(): element for element in root.find_all("Default")}


def _stated(root: Element) -> dict[str, str | None]:
    return {extension: element.attributes.get("ContentType") for extension, element in _defaults(root).items()}


def _part_name(name: str) -> str:
    return f"/{name}".casefold()


def _extension(name: str) -> str:
    return name.rpartition(".")[2].casefold()
