"""A workbook with one forecast of each kind, ranges given by formulas, and values from 1E-9 to 1E12."""

from __future__ import annotations

import openpyxl
from workbook_files import add_tables

__all__ = ["FORECASTS", "write_book"]

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
