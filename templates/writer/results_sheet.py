"""Sheet `Results wanted`: forecasts, filters, checks, correlations, settings.

All tables begin in column A and none is wider than the one above it: Excel can then insert rows into any of them.
"""

from __future__ import annotations

from collections.abc import Sequence

from xlsxwriter.worksheet import Worksheet

from templates.description import ALL_CHECKS, CorrelationRow, FilterRow, ForecastRow, Role, Template
from templates.vehicles import names_a_vehicle
from templates.writer.cached import Values
from templates.writer.page import add_table, begin_sheet, fit_row, fit_to_pages, guard, write_formula, write_label
from templates.writer.places import Place, reference
from templates.writer.styles import Styles

__all__ = ["draw_results_wanted"]

_FORECASTS = ("Name", "Cell", "Units", "Range %", "Threshold", "Symbol", "Note")
_STATED = ("Report to", "Kind", "Role")
_FILTERS = ("Name", "Cell", "At least", "At most", "Above", "Below", "Because")
_CHECKS = ("Name", "Cell", "Because")
_CORRELATIONS = ("First", "Second", "Correlation")
_SETTINGS = ("Setting", "Value")
_LOGICAL = '"TRUE";"TRUE";"FALSE"'
"""How LibreOffice shows a logical that a formula points at, instead of 1; Excel has its own words.

It is the format of a condition, not of the cell: LibreOffice would save the cell as a number then.
"""
_WIDTHS = (38, 22, 12, 12, 12, 12, 76, 34)
_STATED_WIDTHS = (12, 12, 14)
_ONLY_FOR = 7
"""Column of the last of both headings that only a template needs in which a filter is about one forecast."""
_SUBTITLE = (
    "What a run reports, which trials it keeps, and how many trials it runs. The Cell columns point to sheet Model."
)
_ROOM = 3
"""Blank rows below a table, into which Excel lets it grow by typing."""
_POINTS = "This formula says which quantity the row speaks of. Change it only to ask for another one."


def draw_results_wanted(
    sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values
) -> None:
    """Write the sheet; `values` are what the formulas give at the base case."""
    one_forecast = any(kept.only_for for kept in template.filters)
    widths = _WIDTHS if one_forecast else _WIDTHS[:_ONLY_FOR]
    begin_sheet(sheet, styles, template.title, _SUBTITLE, (*widths, *_STATED_WIDTHS))
    row = _draw_forecasts(sheet, styles, template, at, values, 3)
    row = _draw_filters(sheet, styles, template, at, values, row + _ROOM)
    row = _draw_checks(sheet, styles, template, at, values, row + _ROOM)
    row = _draw_correlations(sheet, styles, template, at, values, row + _ROOM)
    _draw_settings(sheet, styles, template.settings, values, row + _ROOM)
    fit_to_pages(sheet)


def _head(sheet: Worksheet, styles: Styles, row: int, title: str, remark: str, values: Values) -> None:
    sheet.write_string(row, 0, title, styles("heading"))
    write_label(sheet, row, 1, remark, styles("remark"), values, asks=True)


def _draw_forecasts(
    sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values, top: int
) -> int:
    """Write the table under its heading in row `top`; the row below it is returned, here and in the others."""
    remark = "Range % is the central range reported; a Threshold also reports the probability of exceeding it."
    _head(sheet, styles, top, "Forecasts", remark, values)
    only_if = {kept.only_for: kept.name for kept in template.filters if kept.only_for}
    headers = (*_FORECASTS, *["Only if"] * bool(only_if), *_STATED)
    add_table(sheet, styles, "xlmc_forecasts", top + 1, headers, len(template.forecasts))
    equations = {equation.symbol: equation for equation in template.equations}
    for row, forecast in enumerate(template.forecasts, top + 2):
        _draw_forecast(sheet, styles, forecast, row, equations[forecast.symbol].notation, values)
        if only_if:
            sheet.write_string(row, _ONLY_FOR, only_if.get(forecast.name, ""), styles("text"))
        _draw_stated(sheet, styles, forecast, row, len(headers) - len(_STATED))
        shown = styles("answer", equations[forecast.symbol].number_format)
        write_formula(sheet, row, 1, reference(at[forecast.symbol]), shown, values)
    guard(sheet, (top + 2, 1, top + 1 + len(template.forecasts), 1), "A formula", _POINTS)
    return top + 2 + len(template.forecasts)


def _draw_forecast(
    sheet: Worksheet, styles: Styles, forecast: ForecastRow, row: int, notation: str, values: Values
) -> None:
    _draw_name(sheet, styles, forecast.name, row, values)
    sheet.write_string(row, 2, forecast.unit, styles("centred"))
    _number(sheet, styles, row, 3, forecast.central_percent)
    _number(sheet, styles, row, 4, forecast.threshold)
    sheet.write_string(row, 5, notation, styles("centred"))
    sheet.write_blank(row, 6, None, styles("text"))
    if len(forecast.name) > _WIDTHS[0]:
        fit_row(sheet, row, [(forecast.name, _WIDTHS[0])])


def _draw_stated(sheet: Worksheet, styles: Styles, forecast: ForecastRow, row: int, left: int) -> None:
    """Write how the forecast is stated; a cell without a word stays blank, for the user."""
    sheet.write_blank(row, left, None, styles("text"))
    for column, word in enumerate((forecast.kind, forecast.stated), left + 1):
        if word:
            sheet.write_string(row, column, word, styles("text"))
        else:
            sheet.write_blank(row, column, None, styles("text"))


def _draw_filters(
    sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values, top: int
) -> int:
    remark = "A trial is kept when every row holds. Red: the base case itself would be rejected."
    _head(sheet, styles, top, "Filters", remark, values)
    one_forecast = any(kept.only_for for kept in template.filters)
    headers = (*_FILTERS, "Only for") if one_forecast else _FILTERS
    add_table(sheet, styles, "xlmc_filters", top + 1, headers, max(len(template.filters), 1))
    formats = {equation.symbol: equation.number_format for equation in template.equations}
    for row, kept in enumerate(template.filters, top + 2):
        _draw_filter(sheet, styles, kept, row, values)
        if one_forecast:
            write_label(sheet, row, _ONLY_FOR, kept.only_for, styles("open text"), values, asks=True)
        shown = styles("step", formats[kept.symbol])
        write_formula(sheet, row, 1, reference(at[kept.symbol]), shown, values)
    if not template.filters:
        for column, _ in enumerate(headers):
            sheet.write_blank(top + 2, column, None, styles("open text"))
        return top + 3
    last = top + 1 + len(template.filters)
    guard(sheet, (top + 2, 1, last, 1), "A formula", _POINTS)
    criteria = _rejected(top + 3)
    if one_forecast:
        criteria = f'=AND($H{top + 3}="",{criteria[1:]})'
    rule = {"type": "formula", "criteria": criteria, "format": styles("wrong")}
    sheet.conditional_format(top + 2, 1, last, 1, rule)
    return last + 1


def _draw_filter(sheet: Worksheet, styles: Styles, kept: FilterRow, row: int, values: Values) -> None:
    _draw_name(sheet, styles, kept.name, row, values)
    for column, limit in enumerate((kept.at_least, kept.at_most, kept.above, kept.below), 2):
        _number(sheet, styles, row, column, limit)
    sheet.write_string(row, 6, kept.because, styles("open text"))
    fit_row(sheet, row, [(kept.name, _WIDTHS[0]), (kept.because, _WIDTHS[6]), (kept.only_for, _WIDTHS[7])])


def _rejected(excel_row: int) -> str:
    """A conditional-format formula: the value in column B breaks a limit in C to F."""
    broken = (
        f"AND(ISNUMBER(${column}{excel_row}),$B{excel_row}{sign}${column}{excel_row})"
        for column, sign in (("C", "<"), ("D", ">"), ("E", "<="), ("F", ">="))
    )
    return f"=OR({','.join(broken)})"


def _draw_checks(
    sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values, top: int
) -> int:
    remark = "Must be TRUE at the base case and in the accepted trials; xlmc says so first where they are not."
    _head(sheet, styles, top, f"{template.checks.capitalize()}s", remark, values)
    checks = [each for each in template.equations if each.role is Role.CHECK and each.symbol != ALL_CHECKS]
    add_table(sheet, styles, "xlmc_checks", top + 1, _CHECKS, len(checks))
    for row, check in enumerate(checks, top + 2):
        _draw_name(sheet, styles, check.name, row, values)
        write_formula(sheet, row, 1, reference(at[check.symbol]), styles("check", "General"), values)
        write_label(sheet, row, 2, check.note, styles("overflowing"), values, asks=True)
        fit_row(sheet, row, [(check.name, _WIDTHS[0])])
    last = top + 1 + len(checks)
    guard(sheet, (top + 2, 1, last, 1), "A formula", _POINTS)
    for criteria, look in ((f"=NOT(IFERROR($B{top + 3},FALSE))", "wrong"), ("=TRUE", "as it is")):
        rule = {"type": "formula", "criteria": criteria, "format": styles(look, _LOGICAL)}
        sheet.conditional_format(top + 2, 1, last, 1, rule)
    return last + 1


def _draw_correlations(
    sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values, top: int
) -> int:
    _head(sheet, styles, top, "Correlations", template.correlation_note, values)
    rows = max(len(template.correlations), 1)
    add_table(sheet, styles, "xlmc_correlations", top + 1, _CORRELATIONS, rows)
    for row, pair in enumerate(template.correlations, top + 2):
        _draw_correlation(sheet, styles, pair, at, row, values)
    if not template.correlations:
        sheet.set_row(top + 2, 32)
        for column, look in enumerate(("open text", "open text", "number")):
            sheet.write_blank(top + 2, column, None, styles(look))
    sheet.data_validation(
        top + 2,
        2,
        top + 1 + rows,
        2,
        {
            "validate": "decimal",
            "criteria": "between",
            "minimum": -1,
            "maximum": 1,
            "error_title": "Correlation",
            "error_message": "A rank correlation lies between -1 and 1.",
        },
    )
    return top + 2 + rows


def _draw_correlation(
    sheet: Worksheet, styles: Styles, pair: CorrelationRow, at: dict[str, Place], row: int, values: Values
) -> None:
    sheet.set_row(row, 32)
    for column, symbol in enumerate((pair.first, pair.second)):
        write_formula(sheet, row, column, f"Inputs!A{at[symbol][1] + 1}", styles("text"), values)
    guard(sheet, (row, 0, row, 1), "A formula", "It says which assumption is meant. Change it only to name another.")
    sheet.write_number(row, 2, pair.correlation, styles("number"))


def _draw_settings(
    sheet: Worksheet, styles: Styles, settings: Sequence[tuple[str, float]], values: Values, top: int
) -> None:
    _head(sheet, styles, top, "Settings", "The same workbook and the same seed give the same answers.", values)
    add_table(sheet, styles, "xlmc_settings", top + 1, _SETTINGS, len(settings))
    for row, (setting, value) in enumerate(settings, top + 2):
        sheet.write_string(row, 0, setting, styles("text"))
        sheet.write_number(row, 1, value, styles("number", "0" if setting == "Seed" else "#,##0"))


def _draw_name(sheet: Worksheet, styles: Styles, name: str, row: int, values: Values) -> None:
    """The name of a row, yours to change; locked where it is a formula, as Excel marks formulas that are not."""
    look = "text" if names_a_vehicle(name) else "open text"
    write_label(sheet, row, 0, name, styles(look), values, asks=True)


def _number(sheet: Worksheet, styles: Styles, row: int, column: int, value: float | None) -> None:
    if value is None:
        sheet.write_blank(row, column, None, styles("number"))
    else:
        sheet.write_number(row, column, value, styles("number"))
