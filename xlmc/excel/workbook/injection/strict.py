"""Strict Open XML (ISO/IEC 29500): the same elements as in other workbooks, under other namespaces.

What XlsxWriter builds is transitional; `strict_part` says it in the words of a strict package. Relationship types
change with the namespaces, content types and the namespace of rels parts do not. Shares that drawings count in whole
numbers are percentages there: a gap of `150` is `150%`, an opacity of `40000` is `40%`.
"""

from __future__ import annotations

import re
from typing import Final

__all__ = ["STRICT_MAIN", "strict_part", "strict_type"]

STRICT_MAIN: Final = "http://purl.oclc.org/ooxml/spreadsheetml/main"

_NAMESPACES: Final = {
    "http://schemas.openxmlformats.org/spreadsheetml/2006/main": STRICT_MAIN,
    "http://schemas.openxmlformats.org/officeDocument/2006/relationships": (
        "http://purl.oclc.org/ooxml/officeDocument/relationships"
    ),
    "http://schemas.openxmlformats.org/drawingml/2006/main": "http://purl.oclc.org/ooxml/drawingml/main",
    "http://schemas.openxmlformats.org/drawingml/2006/chart": "http://purl.oclc.org/ooxml/drawingml/chart",
    "http://schemas.openxmlformats.org/drawingml/2006/spreadsheetDrawing": (
        "http://purl.oclc.org/ooxml/drawingml/spreadsheetDrawing"
    ),
}
_TRANSITIONAL: Final = re.compile(rb"(?<=\")(%b)(?=[\"/])" % b"|".join(re.escape(old.encode()) for old in _NAMESPACES))
_PERCENT: Final = re.compile(rb'(<c:(?:gapWidth|overlap|holeSize) val="-?[0-9]+)(?=")')
_THOUSANDTHS: Final = re.compile(rb'(<a:(?:alpha|lumMod|lumOff|shade|tint|satMod) val="|<a:gs pos=")([0-9]+)(?=")')


def strict_part(xml: bytes) -> bytes:
    """Say a part that XlsxWriter built, or a rels part, in the namespaces and percentages of a strict package.

    >>> strict_part(b'<x xmlns:a="http://schemas.openxmlformats.org/drawingml/2006/main"><a:alpha val="40000"/></x>')
    b'<x xmlns:a="http://purl.oclc.org/ooxml/drawingml/main"><a:alpha val="40%"/></x>'
    """
    xml = _TRANSITIONAL.sub(lambda match: _NAMESPACES[match[1].decode()].encode(), xml)
    xml = _PERCENT.sub(rb"\1%", xml)
    return _THOUSANDTHS.sub(lambda result: b"%b%g%%" % (result[1], int(result[2]) / 1000), xml)


def strict_type(relationship: str) -> str:
    """Give the type of a relationship in a strict package: that of a worksheet, of styles, ….

    >>> strict_type("http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet")
    'http://purl.oclc.org/ooxml/officeDocument/relationships/worksheet'
    """
    return strict_part(f'"{relationship}"'.encode()).decode()[1:-1]
