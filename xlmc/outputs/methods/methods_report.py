"""A study of methods as blocks: the recommendation, the figures, what each method says of itself, the tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Final

from xlmc.analysis.studies.methods import Study, recommendation
from xlmc.outputs.document.parts import Block, Drawing, Figure, Heading, Paragraph, Table, blocks_of
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.matplotlib_figure import png, svg
from xlmc.outputs.methods.methods_json import study_json
from xlmc.outputs.methods.methods_workbook import add_sheets
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, Work
from xlmc.outputs.study_report import StudyReport

__all__ = ["in_short", "methods_report"]

_ENDS: Final = "Where the optimised bounds are reached: points that the workbook accepts"
_CANNOT: Final = "What each method says of itself, and cannot do"
_WIDTH: Final = 170.0
"""The width of a figure, in millimetres."""

_WORKS: Final[tuple[tuple[Work, str], ...]] = (("seconds", "time"), ("evaluations", "evaluations of the workbook"))


def methods_report(study: Study, *, figures: bool) -> StudyReport:
    """Make the report; matplotlib draws its figures where they are wanted, which takes some seconds."""
    first = _filled([methods_tables.error_table(study)])
    rest = _filled([methods_tables.bounds_table(study), methods_tables.reference_table(study)])
    long = _filled([methods_tables.forecast_table(study), methods_tables.length_table(study)])
    recommended = blocks_of(each.replace("`", "") for each in recommendation(study))
    words = _lines(_CANNOT, "Method", methods_tables.cannot_lines(study))
    ends = _lines(_ENDS, "Bound", methods_tables.ends_lines(study))
    drawn = _figures(study) if figures else []
    return StudyReport(
        "Methods of uncertainty analysis",
        study.model.workbook.name,
        (*recommended, *drawn, *first, *words, *rest, *long, *ends),
        "Methods",
        partial(study_json, study),
        on_sheet=(*recommended, *first, *rest, *words, *ends),
        add_sheets=partial(add_sheets, study),
        drawn=partial(png, study),
    )


def in_short(study: Study) -> list[Block]:
    """Return what the terminal shows before the recommendation: the tables, and what the methods cannot do."""
    tables = (
        methods_tables.reference_table(study),
        methods_tables.error_table(study),
        methods_tables.bounds_table(study),
    )
    words = [Paragraph(f"{name}: {message}.") for name, message in methods_tables.cannot_lines(study)]
    return [*_filled(tables), *words]


def _figures(study: Study) -> list[Block]:
    result: list[Block] = [Heading("Speed against accuracy")]
    result += [Paragraph(each, "small") for each in (HOW_TO_READ if study.varying else ())]
    for work, what in _WORKS:
        drawn = Drawing(svg(study, work), f"Error of each method against {what}", _WIDTH)
        result.append(Figure(drawn, f"Speed against accuracy: {what}."))
    return result


def _filled(tables: Iterable[Table]) -> list[Block]:
    return [table for table in tables if table.rows]


def _lines(title: str, head: str, lines: Sequence[tuple[str, str]]) -> list[Block]:
    """Make a table of two columns, the second of which is wrapped."""
    return [Table(title, (head, "In words"), tuple(lines), widths=(1.0, 3.0))] if lines else []
