"""The XML namespaces of an Excel workbook that injection has to know by name."""

from __future__ import annotations

__all__ = ["MAIN", "OFFICE_RELATIONSHIPS"]

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE_RELATIONSHIPS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
