"""The sheet of distributions that were fitted to columns: assumptions with cells of their own, and their correlations.

Where the parameters are uncertain they are assumptions themselves, marked so, and the rows of the quantities take them
from their cells.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from xlsxwriter.utility import xl_rowcol_to_cell

from xlmc.analysis.studies.fitting import parameter_texts, rounded_value
from xlmc.analysis.studies.fitting.columns import ColumnFit, Fits
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.workbook import Workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.definitions.tables.assumptions import UNCERTAINTY
from xlmc.montecarlo.statistics import rank_correlation
from xlmc.outputs.sheets.exact_book import ExactBook
from xlmc.outputs.sheets.styles import CREATED

__all__ = ["SHEET", "with_fits"]

SHEET: Final = "Fitted"

_POSITIVE: Final = ("Std dev", "Scale", "Shape", "Rate", "Alpha", "Beta", "Degrees of freedom")
"""Parameters that are above 0 whatever the values are: they are drawn from a Lognormal."""

_FIXED: Final = ("Trials", "Low", "High", "Likeliest", "Location")
"""Whole numbers, and ends, which a bootstrap says nothing of: they stay as they were fitted."""

_TOP: Final = 4
"""The row of the first table's headings, counted from 0."""

_CLEAR: Final = 3.0
"""Errors from 0 of a rank correlation of two columns' parameters that is written."""

Cells = dict[str, "float | str"]


def with_fits(book: Workbook | None, fits: Fits, source: str) -> bytes:
    """Return a workbook with the sheet behind its own; a new one where there is none.

    Args:
        book: that is to have the sheet.
        fits: of the columns; those of texts, and those that could not be fitted, have no row.
        source: where the values come from.
    """
    with ExactBook() as made:
        made.set_properties({"created": CREATED})
        _write(made, made.add_worksheet(SHEET), fits, source)
    parts: dict[str, bytes] = made.parts
    if book is None:
        return package_bytes(parts)
    return checked_bytes(inject(book.parts, parts, replace=False, marked=False), book.parts)


def _write(made: Any, sheet: Any, fits: Fits, source: str) -> None:
    bold, header = made.add_format({"bold": True, "font_size": 14}), made.add_format({"bold": True})
    drawn = made.add_format({"bg_color": "#E6F4E6"})
    fitted = [each for each in fits.columns if each.best is not None]
    uncertain = [row for each in fitted for row in _parameters(each, source)]
    rows = [*uncertain, *(_quantity(each, source, uncertain) for each in fitted)]
    headings = ["Name", "Value", "Distribution"]
    headings += [heading for row in rows for heading in row if heading not in (*headings, UNCERTAINTY, "Source")]
    headings = list(dict.fromkeys([*headings, *([UNCERTAINTY] if uncertain else []), "Source"]))
    sheet.write_string(0, 0, "Distributions fitted to measurements", bold)
    sheet.write_string(1, 0, f"From {source}. Let your formulas use the cells under Value.")
    sheet.set_column(0, 0, 34)
    sheet.set_column(1, len(headings) - 2, 14)
    sheet.set_column(len(headings) - 1, len(headings) - 1, 60)
    sheet.write_string(_TOP - 1, 0, "Assumptions", header)
    place = {str(row["Name"]): number for number, row in enumerate(rows, _TOP + 1)}
    for number, row in enumerate(rows, _TOP + 1):
        for column, heading in enumerate(headings):
            entry = row.get(heading, "")
            if isinstance(entry, str) and entry.startswith("\0"):  # the cell of an uncertain parameter
                at = place[entry[1:]]
                sheet.write_formula(number, column, f"={xl_rowcol_to_cell(at, 1)}", None, rows[at - _TOP - 1]["Value"])
            elif isinstance(entry, str):
                sheet.write_string(number, column, entry) if entry else sheet.write_blank(number, column, None)
            else:
                sheet.write_number(number, column, entry, drawn if heading == "Value" else None)
    _table(sheet, "xlmc_assumptions", _TOP, len(rows), headings)
    pairs = [*_correlations(fits), *_parameter_correlations(fits)]
    top = _TOP + len(rows) + 3
    if pairs:
        sheet.write_string(top - 1, 0, "Rank correlations", header)
        for number, (first, second, value) in enumerate(pairs, top + 1):
            sheet.write_string(number, 0, first)
            sheet.write_string(number, 1, second)
            sheet.write_number(number, 2, value)
        _table(sheet, "xlmc_correlations", top, len(pairs), ["First", "Second", "Correlation"])


def _table(sheet: Any, name: str, top: int, rows: int, headings: list[str]) -> None:
    columns = [{"header": heading} for heading in headings]
    sheet.add_table(top, 0, top + rows, len(headings) - 1, {"name": name, "columns": columns, "autofilter": False})


def _quantity(each: ColumnFit, source: str, uncertain: list[Cells]) -> Cells:
    """Return the row of a quantity; its uncertain parameters are references to their rows."""
    best = each.best
    assert best is not None
    names = {str(row["Name"]) for row in uncertain}
    row: Cells = {
        "Name": each.name,
        "Value": rounded_value(best, float(np.median(each.values))),
        "Distribution": best.name,
    }
    for heading, text in parameter_texts(best).items():
        named = _parameter_name(each, heading)
        row[heading] = f"\0{named}" if named in names else float(text)
    if uncertain:
        row[UNCERTAINTY] = "Variable"
    return row | {"Source": f"fitted by maximum likelihood to {source}, {each.name}, n = {each.values.size}"}


def _parameter_name(each: ColumnFit, heading: str) -> str:
    return f"{each.name}: {heading}"


def _parameters(each: ColumnFit, source: str) -> Iterator[Cells]:
    """Yield a row for each parameter that the bootstrap moves."""
    best = each.best
    assert best is not None
    for heading, values in (each.repeated or {}).items():
        spread, value = float(values.std(ddof=1)), best.parameters[heading]
        if not spread > 0.0 or heading in _FIXED:
            continue
        positive = heading in _POSITIVE and value > 0.0 and bool(np.all(values > 0.0))
        yield {
            "Name": _parameter_name(each, heading),
            "Value": float(f"{value:.8g}"),
            "Distribution": "Lognormal" if positive else "Normal",
            "Mean": float(f"{value:.8g}"),
            "Std dev": float(f"{spread:.4g}"),
            **({"Lower cutoff": 0.0, "Upper cutoff": 1.0} if heading == "Probability" else {}),
            UNCERTAINTY: "Uncertain",
            "Source": f"bootstrap of {values.size} samples of {source}, {each.name}",
        }


def _correlations(fits: Fits) -> Iterator[tuple[str, str, float]]:
    for pair in fits.pairs:
        yield pair.first, pair.second, round(pair.correlation.value, 4)


def _parameter_correlations(fits: Fits) -> Iterator[tuple[str, str, float]]:
    """Yield the rank correlations of the parameters of one column, and clear ones of different columns."""
    repeated: Mapping[tuple[str, str], NDArray[np.float64]] = {
        (each.name, heading): values
        for each in fits.columns
        for heading, values in (each.repeated or {}).items()
        if values.std() > 0.0
    }
    for (first, of_first), (second, of_second) in combinations(repeated, 2):
        estimate = rank_correlation(repeated[first, of_first], repeated[second, of_second])
        clear = estimate.error is not None and abs(estimate.value) > _CLEAR * estimate.error
        if clear:
            yield f"{first}: {of_first}", f"{second}: {of_second}", round(estimate.value, 4)
