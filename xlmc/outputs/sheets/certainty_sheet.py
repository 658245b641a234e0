"""The sheet Certainty: results in words, how certain their ranges are, and cells that count any other range.

*Certainty* is Crystal Ball's word for the share of the trials in a range. Where a person types the ends of a range,
formulas count the trials on the sheet Trials, and so the first ones alone where not all are there. The numbers that the
formulas show at first are counted here, over the same trials. The formulas compare numbers with `>=` and `<=`, which is
exact; a criterion of COUNTIFS is a text of 15 digits.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from xlmc.analysis.results.statements.sentences import meaning, stated_range, statements
from xlmc.montecarlo.definitions.stating import NOT_ROUNDED
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.montecarlo.statistics import proportion
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.content.certainty import certainty_blocks
from xlmc.outputs.sheets.xlsx_writer import write_blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page
    from xlmc.outputs.sheets.trials_sheet import TrialsAt

__all__ = ["LAST", "WIDTHS", "write_certainty"]


WIDTHS = (44, 38, 13, 13, 12, 12, 12)

LAST = len(WIDTHS) - 1

_ROW = 15.75

_PERCENT = "0.0%"

_Z = "1.96"


def write_certainty(page: Page, simulation: RunResult, trials: TrialsAt) -> None:
    """Write the sheet; `trials` is where the trials stand that its formulas count."""
    name = simulation.model.workbook.name
    page.height = _ROW
    page.title("Certainty", f"{name}: {counted_text(simulation.accepted, 'accepted trial')}")
    if stated := statements(simulation):
        page.heading("In words")
        for statement in stated:
            page.wide(f"{statement.text}.", "quote", LAST)
        page.row += 1
        page.wide(meaning(simulation.model.workbook, stated), "remark", LAST)
    page.heading("Certainty of ranges")
    write_blocks(page, certainty_blocks(simulation, simulation.results), last=LAST)
    _write_own_ranges(page, simulation, trials)
    page.set_up_printing(name)


def _write_own_ranges(page: Page, simulation: RunResult, trials: TrialsAt) -> None:
    """Write a line for each forecast that has a number on the sheet Trials; nothing where there is none."""
    results = [
        (index, result, simulation.forecasts[name][: trials.shown])
        for index, (name, result) in enumerate(simulation.results.items())
    ]
    results = [each for each in results if not np.isnan(each[2]).all() and each[1].kind not in NOT_ROUNDED]
    if not results:
        return
    from xlsxwriter.utility import xl_range_formula

    page.heading("Certainty of a range of your own")
    page.wide(_instructions(simulation, trials), "paragraph", LAST)
    heads = ["Forecast", "Units", "From", "to", "Certainty", "Trials"]
    errors = simulation.plan.size == 0
    page.table([*heads[:5], "±", heads[5]] if errors else heads, [])
    for index, result, values in results:
        _write_line(page, result, values, xl_range_formula(*trials.column(index)), errors)


def _instructions(simulation: RunResult, trials: TrialsAt) -> str:
    which = f"all {counted_text(trials.shown, 'accepted trial')}"
    if trials.shown < simulation.accepted:
        every = counted_text(simulation.accepted, "accepted trial")
        which = f"the first {count_text(trials.shown)} of {every}, which stand"
    else:
        which += ", which stand"
    message = (
        f"Type the ends of a range into the yellow cells; an empty cell means no limit. Formulas count {which} on "
    )
    message += "sheet Trials; both ends belong to the range."
    if simulation.plan.size:
        return f"{message} These trials depend on each other (see Sampling in the Record), so no error is given."
    return message


def _write_line(page: Page, result: ForecastResult, values: NDArray[np.float64], column: str, errors: bool) -> None:
    from xlsxwriter.utility import xl_rowcol_to_cell

    definition, row = result.definition, page.row
    spoken = stated_range(result)
    assert spoken is not None  # there are numbers
    known = values[~np.isnan(values)]
    share = proportion(int(np.count_nonzero((known >= spoken.low) & (known <= spoken.high))), known.size)
    ends = [
        Shown(end if math.isfinite(end) else None, cells.exact(end, result.form).format, "typed")
        for end in (spoken.low, spoken.high)
    ]
    page.line([Shown(definition.name, look="name"), Shown(definition.units), *ends])
    low, high = xl_rowcol_to_cell(row, 2), xl_rowcol_to_cell(row, 3)
    certainty, trials = xl_rowcol_to_cell(row, 4), xl_rowcol_to_cell(row, 6 if errors else 5)
    inside = f'ISNUMBER({column})*((({low}="")+({column}>={low}))>0)*((({high}="")+({column}<={high}))>0)'
    page.formula(row, 4, f"=SUMPRODUCT({inside})/{trials}", Shown(share.value, _PERCENT, "answer"))
    if errors:
        least = f"{_Z}/(2*({trials}+{_Z}^2))"
        formula = f"=MAX(SQRT({certainty}*(1-{certainty})/{trials}),{least})"
        page.formula(row, 5, formula, Shown(_error(share.value, known.size), _PERCENT, "error"))
    page.formula(row, 6 if errors else 5, f"=COUNT({column})", Shown(known.size, cells.count(0).format))


def _error(share: float, trials: int) -> float:
    """Return the standard error of a share as the sheet's formula computes it, with 1.96 for the normal quantile."""
    return max(math.sqrt(share * (1.0 - share) / trials), 1.96 / (2.0 * (trials + 1.96**2)))
