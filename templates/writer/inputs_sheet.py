"""Sheet `Inputs`: the assumptions table, and the inputs that are held fixed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

from templates.description import ALL_CHECKS, RULE_OF_TYRES, DataTable, Input, Template
from templates.vehicles import name_cell
from templates.writer.cached import Values
from templates.writer.page import (
    add_table,
    begin_sheet,
    fit_row,
    fit_to_pages,
    guard,
    repeat_header,
    write_formula,
    write_label,
)
from templates.writer.places import HEADER_ROW, MOST_CAPTIONS, VALUE_COLUMN, Place, data_places, name_cells
from templates.writer.styles import Styles

__all__ = ["draw_inputs", "draw_waiting"]

_DISTRIBUTIONS = ("Uniform", "Normal", "Triangular", "Trapezoid")
_BEFORE = ("Name", "Symbol", "Cell name", "Value", "Units", "Distribution")
_SOURCE_WIDTH = 84
_BEFORE_WIDTHS = (40, 12, 13, 13, 11, 13)
_COLUMN_WIDTH, _FROZEN_WIDTH = 12, 9
_PLAIN = ("CoV %", "Probability", "Shape", "Trials", "Data")
"""Parameter columns whose numbers are no values of the assumption, and are not shown as such."""
_PARAMETERS = (
    "Uniform: Low, High. Normal: Mean, Std dev. Triangular: Low, Likeliest, High. "
    "Trapezoid: Low, Low likeliest, High likeliest, High. Further columns open with the + above the headings."
)
_OTHER_FIELDS = (
    "Uniform: Low, High. Normal: Mean, Std dev. Triangular: Low, Likeliest, High. For another one, add the columns of "
    "its parameters to the table."
)
_ALWAYS_SHOWN = 2
"""Of the parameter columns, Low and High; the others fold away until a distribution needs them."""


def _headers(template: Template) -> tuple[str, ...]:
    """The headings of its table of assumptions."""
    return (*_BEFORE, *template.columns, "Frozen", "Source")


def _widths(template: Template) -> tuple[float, ...]:
    return (*_BEFORE_WIDTHS, *(_COLUMN_WIDTH for _ in template.columns), _FROZEN_WIDTH, _SOURCE_WIDTH)


def _distributions(template: Template) -> list[str]:
    """The usual ones, and those that the template has beside them."""
    return [*dict.fromkeys((*_DISTRIBUTIONS, *(given.distribution for given in template.assumptions)))]


def _frozen(template: Template) -> int:
    """The column of Frozen, after those of the parameters."""
    return len(_BEFORE) + len(template.columns)


def draw_inputs(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet; `values` are what the formulas give at the base case."""
    begin_sheet(sheet, styles, template.title, template.subtitle, _widths(template))
    _draw_status(sheet, styles, template, values)
    _draw_vehicles(sheet, styles, template)
    _draw_table(sheet, styles, template, "xlmc_assumptions", template.assumptions, at, values)
    _draw_fixed(sheet, styles, "Held fixed", template.constants, at, values)
    _draw_fixed(sheet, styles, "Optional: leave blank what does not apply", template.optional, at, values)
    for table, top in zip(template.data, data_places(template), strict=True):
        _draw_data(sheet, styles, table, top)
    repeat_header(sheet, HEADER_ROW, 1)
    fit_to_pages(sheet)


def draw_waiting(sheet: Worksheet, styles: Styles, template: Template, at: dict[str, Place], values: Values) -> None:
    """Write the sheet of the inputs that wait: a second table of assumptions, its rows without values and frozen."""
    begin_sheet(sheet, styles, template.title, template.waiting_note, _widths(template))
    _draw_table(sheet, styles, template, "xlmc_assumptions_more", template.waiting, at, values)
    repeat_header(sheet, HEADER_ROW, 1)
    fit_to_pages(sheet)


def _draw_table(
    sheet: Worksheet,
    styles: Styles,
    template: Template,
    name: str,
    rows: Sequence[Input],
    at: dict[str, Place],
    values: Values,
) -> None:
    """Write a table of assumptions of this name below its header."""
    _fold_columns(sheet, template)
    sheet.set_row(HEADER_ROW, 32)
    add_table(sheet, styles, name, HEADER_ROW, _headers(template), len(rows))
    for given in rows:
        _draw_assumption(sheet, styles, template, given, at[given.symbol][1], values)
    _guard_table(sheet, styles, template, HEADER_ROW + 1, HEADER_ROW + len(rows))
    open_rows = [at[given.symbol][1] for given in rows if not isinstance(given.frozen, str)]
    for _, run in groupby(enumerate(open_rows), lambda pair: pair[1] - pair[0]):
        numbers = [row for _, row in run]
        _offer_frozen(sheet, template, numbers[0], numbers[-1])


def _fold_columns(sheet: Worksheet, template: Template) -> None:
    """Fold away the parameter columns of a crash template that few rows use; other fields use all that they have."""
    if template.group:
        return
    first, frozen = len(_BEFORE) + _ALWAYS_SHOWN, _frozen(template)
    sheet.set_column(first, frozen - 1, _COLUMN_WIDTH, None, {"level": 1, "hidden": True})
    sheet.set_column(frozen, frozen, _FROZEN_WIDTH, None, {"collapsed": True})


def _draw_status(sheet: Worksheet, styles: Styles, template: Template, values: Values) -> None:
    check = template.checks
    good, bad = f"All {check}s hold at the base case", f"A {check} fails at the base case: see sheet Model"
    formula = f'IF(IFERROR({ALL_CHECKS},FALSE),"{good}","{bad}")'
    if RULE_OF_TYRES in {equation.symbol for equation in template.equations}:
        formula += f'&IF(IFERROR({RULE_OF_TYRES},"–")="–","",". "&{RULE_OF_TYRES})'
    write_formula(sheet, 2, 0, formula, styles("status"), values)
    guard(sheet, (2, 0, 2, 0), "A formula", "This line tells whether the checks of sheet Model hold.", final=True)
    rule = {"type": "formula", "criteria": f"=NOT(IFERROR({ALL_CHECKS},FALSE))", "format": styles("wrong")}
    sheet.conditional_format(2, 0, 2, 2, rule)


def _draw_vehicles(sheet: Worksheet, styles: Styles, template: Template) -> None:
    """The name of each vehicle, or phase, from which all labels take it."""
    cells = name_cells(template)
    if not cells:
        return
    sheet.set_row(cells[0][0], 20)
    of = template.named
    sheet.write_string(cells[0][0], 0, f"{of.capitalize()}s, as every label calls them", styles("heading"))
    for j, (name, (row, column)) in enumerate(zip(template.vehicles, cells, strict=True), 1):
        if len(cells) <= MOST_CAPTIONS:
            sheet.write_string(row, column - 1, name_cell(j, of), styles("centred"))
        sheet.write_string(row, column, name, styles("name"))
        others = "".join(f",{name_cell(k, of)}<>{name_cell(j, of)}" for k, _ in enumerate(cells, 1) if k != j)
        rule = {
            "validate": "custom",
            "value": f'=AND(TRIM({name_cell(j, of)})<>""{others})',
            "ignore_blank": False,
            "error_title": f"Name of a {of}",
            "error_message": f"Each {of} needs a name of its own: assumptions and forecasts are told apart by it.",
        }
        sheet.data_validation(row, column, row, column, rule)


def _draw_assumption(
    sheet: Worksheet, styles: Styles, template: Template, given: Input, row: int, values: Values
) -> None:
    shown = given.number_format
    _draw_name(sheet, styles, given, row, values)
    if given.base is None:
        sheet.write_blank(row, VALUE_COLUMN, None, styles("assumption", shown))
    else:
        sheet.write_number(row, VALUE_COLUMN, given.base, styles("assumption", shown))
    sheet.write_string(row, 5, given.distribution, styles("open centred"))
    for column, header in enumerate(template.columns, len(_BEFORE)):
        look = styles("number", "General" if header in _PLAIN else shown)
        _draw_parameter(sheet, row, column, given.parameters.get(header), look, values)
    frozen = _frozen(template)
    if isinstance(given.frozen, str):
        write_formula(sheet, row, frozen, given.frozen.removeprefix("="), styles("centred"), values)
        guard(sheet, (row, frozen, row, frozen), "A formula", "It holds this input where another sheet replaces it.")
    elif given.frozen:
        sheet.write_string(row, frozen, "TRUE", styles("open centred"))
    else:
        sheet.write_blank(row, frozen, None, styles("open centred"))
    sheet.write_string(row, frozen + 1, given.source, styles("open text"))
    fit_row(sheet, row, [(given.name, _BEFORE_WIDTHS[0]), (given.source, _SOURCE_WIDTH)])


def _draw_parameter(sheet: Worksheet, row: int, column: int, value: object, look: Format, values: Values) -> None:
    """Write a parameter: a number, a formula, the name of a table of data, or nothing."""
    match value:
        case None:
            sheet.write_blank(row, column, None, look)
        case str() if value.startswith("="):
            write_formula(sheet, row, column, value[1:], look, values)
            guard(sheet, (row, column, row, column), "A formula", "This parameter follows other cells.")
        case str():
            sheet.write_string(row, column, value, look)
        case _:
            sheet.write_number(row, column, value, look)


def _draw_data(sheet: Worksheet, styles: Styles, table: DataTable, top: int) -> None:
    """Write a table of data whose numbers begin in row `top`, under its headings and its title."""
    sheet.write_string(top - 2, 0, f"{table.title} ({table.name})", styles("heading"))
    for column, header in enumerate(table.columns):
        sheet.write_string(top - 1, column, header, styles("header"))
    for row, numbers in enumerate(table.rows, top):
        for column, (number, shown) in enumerate(zip(numbers, table.formats, strict=True)):
            sheet.write_number(row, column, number, styles("fixed", shown))
    sheet.write_string(top, len(table.columns), table.source, styles("remark"))


def _draw_name(sheet: Worksheet, styles: Styles, given: Input, row: int, values: Values) -> None:
    write_label(sheet, row, 0, given.name, styles("text"), values, asks=True)
    sheet.write_string(row, 1, given.notation, styles("centred"))
    sheet.write_string(row, 2, given.symbol, styles("centred"))
    sheet.write_string(row, 4, given.unit, styles("centred"))


def _guard_table(sheet: Worksheet, styles: Styles, template: Template, first: int, last: int) -> None:
    """Drop-down lists, and red for a base value outside its range."""
    sheet.data_validation(
        first,
        5,
        last,
        5,
        {
            "validate": "list",
            "source": _distributions(template),
            "input_title": "Distribution",
            "input_message": _OTHER_FIELDS if template.group else _PARAMETERS,
            "error_type": "warning",
            "error_title": "Distribution",
            "error_message": "Not in the list. Leave it only if your version of xlmc knows this distribution.",
        },
    )
    if template.columns[:2] != ("Low", "High"):
        return
    value, low, high = (f"${column}{first + 1}" for column in "DGH")
    outside = f"=OR(AND(ISNUMBER({low}),{value}<{low}),AND(ISNUMBER({high}),{value}>{high}))"
    rule = {"type": "formula", "criteria": outside, "format": styles("wrong")}
    sheet.conditional_format(first, VALUE_COLUMN, last, VALUE_COLUMN, rule)


def _offer_frozen(sheet: Worksheet, template: Template, first: int, last: int) -> None:
    """Offer TRUE and FALSE in these rows of the column Frozen."""
    rule = {
        "validate": "list",
        "source": ["TRUE", "FALSE"],
        "input_title": "Frozen",
        "input_message": "TRUE holds this input at its green value. Blank is FALSE.",
    }
    frozen = _frozen(template)
    sheet.data_validation(first, frozen, last, frozen, rule)


def _draw_fixed(
    sheet: Worksheet,
    styles: Styles,
    heading: str,
    given_values: tuple[Input, ...],
    at: dict[str, Place],
    values: Values,
) -> None:
    if not given_values:
        return
    top = at[given_values[0].symbol][1]
    sheet.write_string(top - 2, 0, heading, styles("heading"))
    for column, header in enumerate((*_BEFORE[:5], "Source")):
        sheet.write_string(top - 1, column, header, styles("header"))
    for given in given_values:
        row = at[given.symbol][1]
        _draw_name(sheet, styles, given, row, values)
        fit_row(sheet, row, [(given.name, _BEFORE_WIDTHS[0])])
        _draw_fixed_value(sheet, styles, given, row)
        write_label(sheet, row, 5, given.source, styles("remark"), values, asks=True)


def _draw_fixed_value(sheet: Worksheet, styles: Styles, given: Input, row: int) -> None:
    look = styles("fixed", given.number_format)
    if given.base is None:
        sheet.write_blank(row, VALUE_COLUMN, None, look)
    else:
        sheet.write_number(row, VALUE_COLUMN, given.base, look)
    if given.choices:
        listed = " or ".join(f"{choice:g}" for choice in given.choices)
        sheet.data_validation(
            row,
            VALUE_COLUMN,
            row,
            VALUE_COLUMN,
            {
                "validate": "list",
                "source": list(given.choices),
                "error_title": "Choice",
                "error_message": f"Type {listed}.",
            },
        )
