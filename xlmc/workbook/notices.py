"""What a person should know about a workbook before trusting a simulation of it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from xlmc.errors import Notice
from xlmc.workbook.links import linked_files
from xlmc.workbook.package import relationships
from xlmc.workbook.safe_xml import is_true
from xlmc.workbook.structure import Structure

__all__ = ["workbook_notices"]

_SAVED_AT: Final = re.compile(rb"<dcterms:modified[^>]*>\s*(\d{4}-\d\d-\d\d)")


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
    if any(rel.kind == "externalLink" for rel in structure.relationships.values()):
        named = ", ".join(linked_files(parts, structure))
        yield (
            f"the workbook links to other files{f' ({named})' if named else ''}, which xlmc does not open: where a "
            f"formula reads them, it gets the value that Excel stored{_age(parts)}"
        )


def _age(parts: Mapping[str, bytes]) -> str:
    """The file does not say when its links were updated last: it was before it was saved."""
    found = _SAVED_AT.search(parts.get("docProps/core.xml", b""))
    return f", of {found[1].decode()} or older" if found else ", at a time that the file does not tell"


def _on_signature(parts: Mapping[str, bytes]) -> Iterator[str]:
    if any(rel.type.endswith("/digital-signature/origin") for rel in relationships(parts).values()):
        yield "the workbook is digitally signed: a copy with results in it will not carry a valid signature"
