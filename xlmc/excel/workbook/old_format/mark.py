"""The mark of a workbook whose cells were converted from an `.xls`; it stays where results are written into it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

__all__ = ["old_workbook_notices", "with_mark"]

_PROPERTIES: Final = "docProps/core.xml"
"""The part that holds the mark, as a comment. xlmc keeps it; a program that saves the workbook drops the mark."""

_SAID: Final = "xlmc: converted from an old Excel workbook (.xls) by"
_MACROS: Final = ", without its macros"
_MARK: Final = re.compile(
    rb"<!--%b (?P<by>LibreOffice[/\d.]*)(?P<macros>%b)?-->" % (re.escape(_SAID.encode()), _MACROS.encode())
)
_VERSION: Final = re.compile(rb"<Application>(LibreOffice/[\d.]+)")


def with_mark(parts: Mapping[str, bytes], macros: bool) -> dict[str, bytes]:
    """Return the parts with the mark, which names the LibreOffice that wrote them, and whether macros were left out."""
    if _PROPERTIES not in parts:
        return dict(parts)
    by = _VERSION.search(parts.get("docProps/app.xml", b""))
    mark = f"<!--{_SAID} {by[1].decode() if by else 'LibreOffice'}{_MACROS * macros}-->"
    return {**parts, _PROPERTIES: parts[_PROPERTIES] + mark.encode()}


def old_workbook_notices(parts: Mapping[str, bytes]) -> Iterator[str]:
    """Return the notices about a workbook that was an `.xls`, also of one with results in it."""
    found = _MARK.search(parts.get(_PROPERTIES, b""))
    if found is not None:
        by = found["by"].decode().replace("/", " ")
        what = f"the cells were converted from an old Excel workbook (.xls) by {by}"
        yield f"{what}; xlmc verify compares the formulas with what Excel saved"
        if found["macros"]:
            yield "the macros of the old Excel workbook (.xls) are left out of what xlmc writes"
