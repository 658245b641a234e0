"""The five parts of a package that adding sheets may change, found by the role they play, not by their name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from xlmc.errors import WorkbookError
from xlmc.workbook.package import relationships, rels_part
from xlmc.workbook.safe_xml import REPAIR

__all__ = ["CONTENT_TYPES", "Roles", "roles"]

CONTENT_TYPES = "[Content_Types].xml"


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of the parts that may change; `styles` and `properties` (docProps/app.xml) are None where absent."""

    workbook: str
    rels: str
    styles: str | None
    properties: str | None

    @property
    def changing(self) -> frozenset[str]:
        """The names of all that are there, content types included: at most five."""
        return frozenset({CONTENT_TYPES, self.workbook, self.rels, self.styles or "", self.properties or ""} - {""})


def roles(parts: Mapping[str, bytes]) -> Roles:
    """The roles in this package.

    Raises:
        WorkbookError: the package does not say which part is the workbook, or lacks its content types.
    """
    workbook = _target(parts, "", "officeDocument")
    rels = None if workbook is None else _stored(parts, rels_part(workbook))
    if workbook is None or rels is None or CONTENT_TYPES not in parts:
        raise WorkbookError("the package does not say where its workbook is", hint=REPAIR)
    return Roles(
        workbook=workbook,
        rels=rels,
        styles=_target(parts, workbook, "styles"),
        properties=_target(parts, "", "extended-properties"),
    )


def _target(parts: Mapping[str, bytes], part: str, kind: str) -> str | None:
    found = (r.target for r in relationships(parts, part).values() if r.kind == kind and r.target in parts)
    return next(found, None)


def _stored(parts: Mapping[str, bytes], name: str) -> str | None:
    return next((stored for stored in parts if stored.casefold() == name.casefold()), None)
