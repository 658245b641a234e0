"""`xlmc check`: what a workbook asks for, as understood, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.definitions.model import Correlation, Definitions
    from xlmc.run.model import Model
    from xlmc.workbook.model import Workbook

__all__ = ["check"]


@click.command()
@click.argument("book", type=click.Path(path_type=Path))
def check(book: Path) -> None:
    """Show the assumptions, forecasts and filters of BOOK as understood, and every problem with its cell.

    Checks that fail and cells in error at the base case stand first.
    """
    from xlmc.cli.base_lines import show_base_case
    from xlmc.cli.printing import notices
    from xlmc.definitions.reader import read_definitions
    from xlmc.errors import XlmcError
    from xlmc.evaluation.engines import ENGINES
    from xlmc.run.filter_values import filter_faults
    from xlmc.run.model import Model
    from xlmc.workbook.reader import read_workbook

    workbook = read_workbook(book)
    definitions = read_definitions(workbook, ENGINES)
    problems: list[XlmcError] = list(definitions.problems)
    model: Model | None = None
    if not problems:
        try:
            model = Model(workbook, definitions, book)
            problems += filter_faults(model)
        except XlmcError as error:
            problems.append(error)
    faults = [] if model is None else show_base_case(model)
    _show_definitions(definitions if model is None else model.definitions, model)
    if model is not None:
        _show_need(model, workbook)
        notices(model.notices)
    elif definitions.problems:
        notices((*workbook.notices, *definitions.notices))
    for problem in problems:
        say(f"problem: {problem}", err=True)
    if problems:
        say(f"{len(problems)} problem{'s' * (len(problems) > 1)} found; nothing can be run yet.", err=True)
        raise click.exceptions.Exit(2)
    for fault in faults:
        say(f"warning: {fault}; an answer must not be used as it stands.", err=True)
    if faults:
        raise click.exceptions.Exit(1)
    say("No problem found.")


def _show_definitions(definitions: Definitions, model: Model | None) -> None:
    from xlmc.cli.printing import table
    from xlmc.report.summary import percent
    from xlmc.results.record.wording import distribution_text, limits_text

    table(
        "Assumptions",
        ("Name", "Cell", "Units", "Distribution", ""),
        [(a.name, str(a.cell), a.units, distribution_text(a), "frozen" * a.frozen) for a in definitions.assumptions],
    )
    table(
        "Forecasts",
        ("Name", "Cell", "Units", "Central range"),
        [(f.name, str(f.cell), f.units, percent(f.central)) for f in definitions.forecasts],
    )
    if definitions.filters:
        rows = [(f.name, str(f.cell), limits_text(f), f.because) for f in definitions.filters]
        table("Filters", ("Name", "Cell", "Keeps", "Because"), rows)
    if definitions.checks:
        table("Checks", ("Name", "Cell", "Because"), [(c.name, str(c.cell), c.because) for c in definitions.checks])
    if definitions.correlations:
        pairs = [(c.first, c.second, f"{c.value:g}", _drawn_with(model, c)) for c in definitions.correlations]
        table("Rank correlations", ("First", "Second", "Asked for", "Drawn with"), pairs, right=(2, 3))


def _drawn_with(model: Model | None, correlation: Correlation) -> str:
    from xlmc.run.correlating import used

    found = None if model is None else used(model.groups, correlation.first, correlation.second)
    return "-" if found is None else f"{found:.3g}"


def _show_need(model: Model, workbook: Workbook) -> None:
    formulas = sum(c.formula is not None for sheet in workbook.sheets.values() for c in sheet.cells.values())
    needed, varying = model.scene.graph.formulas, model.scene.graph.varying
    count = sum(cell in varying for cell in needed)
    said = f"Of {formulas} formula cells the forecasts and filters need {len(needed)}; {count} vary with an assumption."
    say(paragraph(said))
    if model.scene.idle:
        say(paragraph("Not needed by the scene: " + ", ".join(a.name for a in model.scene.idle) + "."))
