"""The mark of a workbook whose cells LibreOffice converted from another format; results written into it leave it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from xlmc.excel.workbook.formats import FORMATS, OtherFormat

__all__ = ["converted_from", "other_format_notices", "with_mark"]

_PROPERTIES: Final = "docProps/core.xml"
"""The part that holds the mark, as a comment. xlmc keeps it; a program that saves the workbook drops the mark."""

_OPENING: Final = "xlmc: converted from"
_MACROS: Final = ", without its macros"
_MARK: Final = re.compile(
    rb"<!--%b (?P<what>%b) by (?P<by>LibreOffice[/\d.]*)(?P<macros>%b)?-->"
    % (_OPENING.encode(), b"|".join(re.escape(each.noun.encode()) for each in FORMATS), _MACROS.encode())
)
_VERSION: Final = re.compile(rb"<Application>(LibreOffice/[\d.]+)")


def with_mark(parts: Mapping[str, bytes], form: OtherFormat, macros: bool) -> dict[str, bytes]:
    """Return the parts with the mark: the format, the LibreOffice that wrote them, and whether macros were left out."""
    if _PROPERTIES not in parts:
        return dict(parts)
    by = _VERSION.search(parts.get("docProps/app.xml", b""))
    mark = f"<!--{_OPENING} {form.noun} by {by[1].decode() if by else 'LibreOffice'}{_MACROS * macros}-->"
    return {**parts, _PROPERTIES: parts[_PROPERTIES] + mark.encode()}


def converted_from(parts: Mapping[str, bytes]) -> OtherFormat | None:
    """Return the format from which LibreOffice converted a workbook; otherwise None."""
    match = _MARK.search(parts.get(_PROPERTIES, b""))
    return next(each for each in FORMATS if each.noun == match["what"].decode()) if match else None


def other_format_notices(parts: Mapping[str, bytes]) -> Iterator[str]:
    """Return the notices about a workbook that LibreOffice converted, also of one with results in it."""
    match = _MARK.search(parts.get(_PROPERTIES, b""))
    if match is not None:
        by = match["by"].decode().replace("/", " ")
        form = converted_from(parts)
        assert form is not None
        yield f"the cells were converted from {form.noun} by {by}; xlmc verify compares the formulas with {form.saved}"
        if match["macros"]:
            yield f"the macros of {form.name} are left out of what xlmc writes"
