"""The whole workbook: its sheets, its defined names, and nothing that changes from one build to the next."""

from __future__ import annotations

from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path

from xlsxwriter.utility import xl_range_abs, xl_rowcol_to_cell
from xlsxwriter.workbook import Workbook

from templates.description import Template
from templates.vehicles import name_cell
from templates.writer.cached import Values, computed
from templates.writer.evidence_sheet import draw_evidence
from templates.writer.fixed_size import fix_chart_sizes
from templates.writer.guide_sheet import draw_guide
from templates.writer.inputs_sheet import draw_inputs, draw_waiting
from templates.writer.model_sheet import draw_model
from templates.writer.places import (
    CURVE,
    RECORD,
    TESTS,
    WAITING,
    data_places,
    drawing_sheet,
    name_cells,
    places,
    reference,
)
from templates.writer.record_sheet import draw_record
from templates.writer.results_sheet import draw_results_wanted
from templates.writer.scene_sheet import chart_size, draw_scene
from templates.writer.styles import Styles
from templates.writer.tests_sheet import draw_tests
from xlmc.excel.workbook.reader import read_workbook

__all__ = ["write_book"]

_CREATED = datetime(2001, 1, 1, tzinfo=UTC)
"""A fixed date, so that building twice gives the same file."""


def write_book(template: Template, path: Path, values: Values | None = None) -> None:
    """Write one edition of a template as an Excel workbook, the values of its base case cached in every formula cell.

    Args:
        template: what the workbook says, in the units of the edition.
        path: of the workbook.
        values: of its formula cells, where they are known; else xlmc computes them.

    Raises:
        KeyError: a forecast, filter or correlation names a symbol that there is not.
        FormulaError: a formula cannot be computed.
    """
    if values is None:
        draft = BytesIO()
        _write(template, draft, {})
        values = computed(read_workbook(draft.getvalue(), path.name))
    _write(template, path, values)
    fix_chart_sizes(path, [chart_size(each) for each in (template.diagram, template.curve) if each is not None])


def _write(template: Template, target: Path | BytesIO, values: Values) -> None:
    at = places(template)
    with Workbook(target, {"in_memory": isinstance(target, BytesIO)}) as workbook:
        workbook.set_properties(
            {
                "title": template.title,
                "subject": template.question,
                "comments": template.needs,
                "category": template.category,
                "created": _CREATED,
            }
        )
        workbook.set_size(2400, 1400)
        styles = Styles(workbook)
        inputs, model = map(workbook.add_worksheet, ("Inputs", "Model"))
        draw_inputs(inputs, styles, template, at, values)
        if template.waiting:
            draw_waiting(workbook.add_worksheet(WAITING), styles, template, at, values)
        if template.record is not None:
            draw_record(workbook.add_worksheet(RECORD), styles, template, at, values)
        if template.tests is not None:
            draw_tests(workbook.add_worksheet(TESTS), styles, template, at, values)
        draw_model(model, styles, template, at, values)
        if template.diagram is not None:
            draw_scene(workbook, workbook.add_worksheet(drawing_sheet(template)), styles, template.diagram, values)
        if template.curve is not None:
            draw_scene(workbook, workbook.add_worksheet(CURVE), styles, template.curve, values)
        if template.evidence:
            draw_evidence(workbook.add_worksheet("Evidence"), styles, template, at, values)
        wanted, guide = map(workbook.add_worksheet, ("Results wanted", "Guide"))
        draw_results_wanted(wanted, styles, template, at, values)
        draw_guide(guide, styles, template, values)
        for symbol, place in at.items():
            workbook.define_name(symbol, f"={reference(place, absolute=True)}")
        for table, top in zip(template.data, data_places(template), strict=True):
            area = xl_range_abs(top, 0, top + len(table.rows) - 1, len(table.columns) - 1)
            workbook.define_name(table.name, f"=Inputs!{area}")
        for j, (row, column) in enumerate(name_cells(template), 1):
            cell = xl_rowcol_to_cell(row, column, row_abs=True, col_abs=True)
            workbook.define_name(name_cell(j, template.named), f"=Inputs!{cell}")
