"""Which cells hold dynamic-array formulas: what the `cm` attribute of a cell points to in `xl/metadata.xml`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.workbook.safe_xml import is_true, tree

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["dynamic_array_marks"]

_DYNAMIC = "XLDAPR"


def dynamic_array_marks(xml: bytes, part: str) -> frozenset[str]:
    """The values of `cm` that mark a dynamic-array formula.

    `cm` counts cell metadata from 1; each names records (`rc`) of a type `t`, counted from 1, with a value `v`,
    counted from 0, among that type's own.

    Raises:
        WorkbookError: the part is not XML.
    """
    root = tree(xml, part)
    types = [element.get("name") for element in root.findall("{*}metadataTypes/{*}metadataType")]
    spilling = _spilling_records(root)
    wanted = {(str(types.index(_DYNAMIC) + 1), str(v)) for v in spilling} if _DYNAMIC in types else set()
    return frozenset(
        str(number)
        for number, block in enumerate(root.findall("{*}cellMetadata/{*}bk"), 1)
        if any((record.get("t"), record.get("v")) in wanted for record in block.findall("{*}rc"))
    )


def _spilling_records(root: Element) -> list[int]:
    future = next((found for found in root.findall("{*}futureMetadata") if found.get("name") == _DYNAMIC), ())
    return [number for number, block in enumerate(future) if _spills(block)]


def _spills(block: Element) -> bool:
    return any(is_true(found.get("fDynamic")) for found in block.iterfind(".//{*}dynamicArrayProperties"))
