"""Draw a described template as an Excel workbook."""

from __future__ import annotations

from templates.writer.book import write_book

__all__ = ["write_book"]
