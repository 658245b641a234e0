"""The stress of a beam with an uncertain load, as people write such a workbook, with other contents in some cells."""

from __future__ import annotations

import openpyxl
from openpyxl.utils import get_column_letter
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.table import Table

__all__ = ["beam"]

INPUTS = [
    [
        "Name",
        "Value",
        "Distribution",
        "Low",
        "Likeliest",
        "High",
        "Mean",
        "Std dev",
        "Data",
        "±",
        "± %",
        "Units",
        "Frozen",
    ],
    ["load", 40, "Triangular", 20, 35, 60, None, None, None, None, None, "kN", None],
    ["strength", 300, "Normal", None, None, None, 300, 20, None, None, None, "MPa", None],
    ["section", 900, "Uniform", 850, None, 950, None, None, None, None, None, "cm³", None],
    ["span", 6, None, 5.9, None, 6.1, None, None, None, None, None, "m", None],
]
ANSWERS = [
    ["Name", "Cell", "Units", "Threshold", "Range %"],
    ["stress", "=Model!B3", "MPa", 200, None],
    ["margin", "=Model!B4", "MPa", 0, None],
]
TESTS = [["Name", "Cell", "At least", "At most", "Because", "Use"], ["stands", "=Model!B4", 0, None, "it stands", None]]
PAIRS = [["First", "Second", "Correlation"], ["load", "span", 0.3]]
SETTINGS = [["Setting", "Value"], ["Trials", 500], ["Seed", 7]]
MODEL = {"B2": "=load*span/4", "B3": "=B2/section*1000", "B4": "=strength-B3", "D1": 5, "D2": 3, "D3": 2}
NAMES = {"load": "Inputs!$B$2", "strength": "Inputs!$B$3", "section": "Inputs!$B$4", "span": "Inputs!$B$5"}

TABLES = {
    "xlmc_assumptions": ("Inputs", 1, INPUTS),
    "xlmc_forecasts": ("Answers", 1, ANSWERS),
    "xlmc_filters": ("Answers", 6, TESTS),
    "xlmc_correlations": ("Answers", 10, PAIRS),
    "xlmc_settings": ("Answers", 14, SETTINGS),
}


def beam(path, changes):
    """Write the stress of a beam, with other contents in some cells."""
    made = openpyxl.Workbook()
    made.active.title = "Inputs"
    made.create_sheet("Model")
    made.create_sheet("Answers")
    for sheet, top, rows in TABLES.values():
        for down, row in enumerate(rows):
            for across, value in enumerate(row):
                made[sheet].cell(top + down, 1 + across, value)
    for place, value in MODEL.items():
        made["Model"][place] = value
    for name, text in NAMES.items():
        made.defined_names[name] = DefinedName(name, attr_text=text)
    for place, value in changes.items():
        sheet, _, cell = place.partition("!")
        made[sheet][cell] = value
    for table, (sheet, top, rows) in TABLES.items():
        last = f"{get_column_letter(len(rows[0]))}{top + len(rows) - 1}"
        made[sheet].add_table(Table(displayName=table, ref=f"A{top}:{last}"))
    made.save(path)
    return path
