"""The report to hand over: a few pages that another expert can repeat, as PDF and for a word processor.

`report_sections` says once what the document holds; `typeset` and `word` write it, so that the two cannot disagree.
"""

from xlmc.report.document.hand_over import (
    PAPERS,
    SECTIONS,
    Choice,
    case_details,
    check_document_path,
    document_bytes,
    save_document,
    today,
)

__all__ = [
    "PAPERS",
    "SECTIONS",
    "Choice",
    "case_details",
    "check_document_path",
    "document_bytes",
    "save_document",
    "today",
]
