"""What a person should know about a workbook before trusting a simulation of it."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping

from xlmc.errors import Notice
from xlmc.workbook.package import relationships
from xlmc.workbook.safe_xml import is_true
from xlmc.workbook.structure import Structure

__all__ = ["workbook_notices"]


def workbook_notices(parts: Mapping[str, bytes], structure: Structure, name: str) -> Iterator[Notice]:
    """Notices on the workbook called `name` as a whole."""
    for stray in structure.strays:
        yield Notice(stray.message, name)
    for message in (*_on_calculation(structure.calculation), *_on_links(parts, structure), *_on_signature(parts)):
        yield Notice(message, name)


def _on_calculation(settings: Mapping[str, str]) -> Iterator[str]:
    if not is_true(settings.get("fullPrecision", "1")):
        yield "Excel calculates this workbook with precision as displayed; xlmc calculates with full precision"
    if settings.get("calcMode") == "manual":
        yield "calculation is set to manual: the values Excel saved may be older than the formulas and inputs"
    if is_true(settings.get("iterate")):
        yield "iterative calculation is on: xlmc does not calculate circular references"


def _on_links(parts: Mapping[str, bytes], structure: Structure) -> Iterator[str]:
    links = [rel.target for rel in structure.relationships.values() if rel.kind == "externalLink"]
    if links:
        files = [rel.target for link in links for rel in relationships(parts, link).values() if rel.external]
        named = ", ".join(dict.fromkeys(posixpath.basename(file.replace("\\", "/")) for file in files))
        yield f"the workbook links to other files, which xlmc does not open{f': {named}' if named else ''}"


def _on_signature(parts: Mapping[str, bytes]) -> Iterator[str]:
    if any(rel.type.endswith("/digital-signature/origin") for rel in relationships(parts).values()):
        yield "the workbook is digitally signed: a copy with results in it will not carry a valid signature"
