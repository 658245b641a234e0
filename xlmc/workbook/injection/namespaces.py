"""The XML namespaces of an Excel workbook that injection has to know by name."""

from __future__ import annotations

__all__ = ["MAIN", "OFFICE_RELATIONSHIPS", "PACKAGE_RELATIONSHIPS", "STRICT_MAIN"]

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
STRICT_MAIN = "http://purl.oclc.org/ooxml/spreadsheetml/main"
OFFICE_RELATIONSHIPS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE_RELATIONSHIPS = "http://schemas.openxmlformats.org/package/2006/relationships"
