"""A study of methods as a document: the recommendation, the figures, and the tables but for that of all runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from xlmc.analysis.studies.methods import Study, recommendation
from xlmc.outputs.document import parts
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.methods_page import ENDS, svg
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, Work
from xlmc.outputs.study_report import column_widths

__all__ = ["document"]

_WIDTH: Final = 170.0
"""The width of a figure, in millimetres."""

_FIGURES: Final[tuple[tuple[Work, str], ...]] = (("seconds", "time"), ("evaluations", "evaluations of the workbook"))


def document(study: Study) -> parts.Document:
    """Make the document; it has no date, for what a study finds depends on no clock but the machine's speed."""
    title, name = "Methods of uncertainty analysis", study.model.workbook.name
    blocks: list[parts.Block] = [parts.Paragraph(name)]
    blocks += [parts.Paragraph(each.replace("`", "")) for each in recommendation(study)]
    blocks.append(parts.Heading("Speed against accuracy"))
    blocks += [parts.Paragraph(each, "small") for each in (HOW_TO_READ if study.varying else ())]
    for work, what in _FIGURES:
        drawn = parts.Drawing(svg(study, work), f"Error of each method against {what}", _WIDTH)
        blocks.append(parts.Figure(drawn, f"Speed against accuracy: {what}."))
    blocks += _table(methods_tables.error_table(study))
    blocks += _lines("What each method says of itself, and cannot do", methods_tables.cannot_lines(study))
    for each in (
        methods_tables.bounds_table(study),
        methods_tables.reference_table(study),
        methods_tables.forecast_table(study),
    ):
        blocks += _table(each)
    blocks += _lines(ENDS, methods_tables.ends_lines(study))
    return parts.Document(title, "", None, title, name, (), tuple(blocks))


def _table(table: methods_tables.Table) -> list[parts.Block]:
    if not table.rows:
        return []
    right = frozenset(range(table.right, len(table.headings)))
    widths = column_widths(table.headings, table.rows)
    return [parts.Heading(table.title), parts.Table("", table.headings, table.rows, widths, right)]


def _lines(title: str, lines: Sequence[tuple[str, str]]) -> list[parts.Block]:
    if not lines:
        return []
    return [parts.Heading(title), parts.Table("", ("Method", "In words"), tuple(lines), (1.0, 3.0))]
