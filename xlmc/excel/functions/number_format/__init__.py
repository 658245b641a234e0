"""Excel's number formats: `#,##0.00;[Red](#,##0.00)`, `# ?/?`, `0.0E+00`, `yyyy-mm-dd hh:mm`.

A format text becomes tokens (`tokens`), these become up to four sections (`sections`), and each section becomes one
layout: of numbers (`numbers`), of dates and times (`date_times`), or of what needs no digit placeholders
(`placeholders`). A layout writes a number without its sign; `sections` chooses the section that writes it, and decides
whether a minus goes before.
"""

from __future__ import annotations

from xlmc.excel.functions.number_format.sections import NumberFormat, parse_format
from xlmc.excel.functions.number_format.tokens import FormatError, UnknownFormat

__all__ = ["FormatError", "NumberFormat", "UnknownFormat", "parse_format"]
