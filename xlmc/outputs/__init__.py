"""Results as people read them: sheets in the workbook, and the summary that the command line prints."""

from __future__ import annotations

from xlmc.outputs.sheets.save import save
from xlmc.outputs.summary import ERROR_SENTENCE, SummaryRow, summarise, summary_text

__all__ = ["ERROR_SENTENCE", "SummaryRow", "save", "summarise", "summary_text"]
