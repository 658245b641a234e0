"""What `xlmc methods` measured, as tables, a figure, a page and a workbook."""

from __future__ import annotations

from xlmc.report.methods.save import check_targets, save_methods

__all__ = ["check_targets", "save_methods"]
