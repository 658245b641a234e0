"""The report to hand over: five to ten pages, as PDF or as a Word file, both from one description of the document."""

from xlmc.outputs.case_fields import fields_from
from xlmc.outputs.document.build import PAPERS, Wanted, check_wanted, check_wanted_of, further_sections
from xlmc.outputs.document.report_file import check_report_path, document_bytes, save_report
from xlmc.outputs.document.sections import SECTIONS

__all__ = [
    "PAPERS",
    "SECTIONS",
    "Wanted",
    "check_report_path",
    "check_wanted",
    "check_wanted_of",
    "document_bytes",
    "fields_from",
    "further_sections",
    "save_report",
]
