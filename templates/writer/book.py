"""The whole workbook: its four sheets, its defined names, and nothing that changes from one build to the next."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from xlsxwriter.workbook import Workbook

from templates.description import Template
from templates.writer.guide_sheet import draw_guide
from templates.writer.inputs_sheet import draw_inputs
from templates.writer.model_sheet import draw_model
from templates.writer.places import places, reference
from templates.writer.results_sheet import draw_results_wanted
from templates.writer.styles import Styles

__all__ = ["write_book"]

_CREATED = datetime(2001, 1, 1, tzinfo=UTC)
"""A fixed date, so that building twice gives the same file."""


def write_book(template: Template, path: Path) -> None:
    """Write the template as an Excel workbook, with the values of its base case cached in every formula cell.

    Raises:
        KeyError: the template's `evaluate` leaves out an equation, or a forecast or filter names none.
    """
    at, values = places(template), template.base_values()
    with Workbook(path) as workbook:
        workbook.set_properties({"title": template.title, "subject": template.subtitle, "created": _CREATED})
        workbook.set_size(2400, 1400)
        styles = Styles(workbook)
        inputs, model, wanted, guide = map(workbook.add_worksheet, ("Inputs", "Model", "Results wanted", "Guide"))
        draw_inputs(inputs, styles, template, at, values)
        draw_model(model, styles, template, at, values)
        draw_results_wanted(wanted, styles, template, at, values)
        draw_guide(guide, styles, template)
        for symbol, place in at.items():
            workbook.define_name(symbol, f"={reference(place, absolute=True)}")
