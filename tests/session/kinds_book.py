"""A workbook with one forecast of each kind, ranges given by formulas, and values from 1E-9 to 1E12."""

from __future__ import annotations

import math

import openpyxl
from workbook_files import add_tables

__all__ = ["FORECASTS", "write_book", "write_full_book"]

FORECASTS = {
    "Speed": ("=B1^2/10", "General", "m", 100),
    "Cost": ("=B2*(1+B1/100)", '"$"#,##0', "", 260_000),
    "End": ("=B6+B1*3", "yyyy-mm-dd", "", 46_180),
    "Rate": ("=B7*0.8", "0.0%", "", 0.35),
    "Events": ("=B5+1", "General", "events", 4),
    "Avoided": ("=B1<36", "General", "", None),
    "Never": ("=B1>1000", "General", "", None),
    "Verdict": ('=IF(B1<28,"low",IF(B1<36,"middle","high"))', "General", "", None),
    "Tiny": ("=B4*2", "General", "m", 3e-9),
    "Huge": ("=B1*1E12/33", "General", "J", None),
    "Duration": ("=B1/240", "[h]:mm", "", None),
    "Fixed": ("=B2/8", '#,##0.00 "EUR"', "", None),
}
"""Name -> formula, number format, units, threshold."""

INPUTS = {"B1": 30, "B2": 200_000, "B3": 180_000, "B4": 2e-9, "B5": 3, "B6": 46_082, "B7": 0.4}

ASSUMPTIONS = [
    ["Name", "Cell", "Distribution", "Low", "High", "Rate"],
    ["Speed in", "=Model!B1", "Uniform", 25, 40, None],
    ["Cost in", "=Model!B2", "Uniform", "=Model!B3", "=Model!B3*1.4", None],
    ["Tiny in", "=Model!B4", "Uniform", 1e-9, 3e-9, None],
    ["Count", "=Model!B5", "Poisson", None, None, 3.5],
    ["Start", "=Model!B6", "Uniform", 46_000, 46_200, None],
    ["Share", "=Model!B7", "Uniform", 0.3, 0.5, None],
]


DECISIONS = [
    ["Name", "Cell", "Low", "High", "Step", "Values", "Units"],
    ["Order", "=Model!B30", 20, 40, 20, None, "pieces"],
    ["Price", "=Model!B31", None, None, None, "5; 6", None],
]
SCENARIOS = [
    ["Name", "Speed in High", "Cost in High", "Model!B31", "Share in", "Limit"],
    ["slower", 37, None, None, None, None],
    ["dearer", None, 300_000, 5.5, "0.35 to 0.45", None],
    ["known", None, None, None, 0.45, "at most 38"],
    ["cheap", None, None, 4, None, None],
]


def write_book(path, *, filtered, kinds=(), settings=()):
    """A workbook with a forecast of each kind; `kinds` are those that its column Kind names; more rows of settings."""
    book = openpyxl.Workbook()
    model, tables = book.active, book.create_sheet("Tables")
    model.title = "Model"
    for place, value in INPUTS.items():
        model[place] = value
    rows = [["Name", "Cell", "Units", "Threshold", "Kind"]]
    for row, (name, (formula, digits, units, threshold)) in enumerate(FORECASTS.items(), 10):
        model[f"B{row}"] = formula
        model[f"B{row}"].number_format = digits
        rows.append([name, f"=Model!B{row}", units, threshold, dict(kinds).get(name)])
    filled = {"xlmc_assumptions": ASSUMPTIONS, "xlmc_forecasts": rows}
    filled["xlmc_settings"] = [["Setting", "Value"], ["Trials", 4_000], *settings]
    if filtered:
        model["D1"] = "=B1+B5"
        filled["xlmc_filters"] = [["Name", "Cell", "At most", "Because"], ["Limit", "=Model!D1", 42, "measured"]]
    add_tables(tables, filled)
    book.save(path)
    return path


def write_full_book(path, *, filtered):
    """The same book with decisions, scenarios, and inputs that these change."""
    book = openpyxl.load_workbook(write_book(path, filtered=filtered))
    sheet = book["Model"]
    sheet["B30"], sheet["B31"] = 30, 5
    sheet["B10"], sheet["B11"] = "=B1^2/10*(1+B30/1000)", "=B2*(1+B1/100)-B30*B31*100"
    sheet["B6"].number_format, sheet["B7"].number_format = "yyyy-mm-dd", "0.0%"  # assumptions that are no bare numbers
    sheet["B2"].number_format = '"$"#,##0'
    sheet["B31"].number_format = '"$"#,##0.00'
    book["Tables"]["A7"] = "Share in"  # not as the name of a cell's heading
    for number in range(40):
        sheet.cell(number + 1, 8, round(20 + 5 * math.sin(number * 1.7), 3))
    scenarios = [row[:5] + row[5:] * filtered for row in SCENARIOS]
    add_tables(book.create_sheet("More"), {"xlmc_decisions": DECISIONS, "xlmc_scenarios": scenarios})
    book.save(path)
    return str(path)
