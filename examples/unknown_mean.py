"""Write `unknown-mean.xlsx`: a skid on a road whose mean friction nobody knows, after Figures 3 and 4 of
SAE 2001-01-3347.

    python examples/unknown_mean.py [folder]

Each vehicle, tyre and surface has a mean friction and a scatter of its own (Figure 3), and in a crash they are not
known. The mean is said to lie between .70 and .85 (Figure 4), the scatter between .03 and .07; both are Uncertain.
Friction itself is Variable: from stop to stop it scatters about that mean. For `xlmc uncertainty`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import xlsxwriter

__all__ = ["ASSUMPTIONS", "write"]

COLUMNS = ("Name", "Value", "Units", "Kind of uncertainty", "Distribution", "Low", "High", "Mean", "Std dev", "Source")

ASSUMPTIONS = (
    ("Mean friction", 0.775, "", "Uncertain", "Uniform", 0.70, 0.85, None, None, "SAE 2001-01-3347, Figure 4"),
    ("Scatter of friction", 0.05, "", "Uncertain", "Uniform", 0.03, 0.07, None, None, "As the curves of Figure 3"),
    ("Friction", 0.775, "", "Variable", "Normal", None, None, "=B2", "=B3", "Goudie et al.: skids vary normally"),
    ("Skid", 100.0, "ft", "Uncertain", "Uniform", 98.0, 102.0, None, None, "Measured once, to two feet"),
)

FORECASTS = (
    ("Friction of the skid", "=Inputs!B4", "", None),
    ("Speed", "=SQRT(2*32.174*Inputs!B4*Inputs!B5)*3600/5280", "mph", 50.0),
)


def write(path: Path) -> None:
    """Write the workbook."""
    with xlsxwriter.Workbook(path) as book:
        inputs, model = book.add_worksheet("Inputs"), book.add_worksheet("Model")
        inputs.write_row(0, 0, COLUMNS)
        for row, cells in enumerate(ASSUMPTIONS, 1):
            for column, cell in enumerate(cells):
                if isinstance(cell, str) and cell.startswith("="):
                    inputs.write_formula(row, column, cell, None, ASSUMPTIONS[int(cell[-1]) - 2][1])
                elif cell is not None:
                    inputs.write(row, column, cell)
        _table(inputs, "xlmc_assumptions", COLUMNS, len(ASSUMPTIONS))
        columns = ("Name", "Value", "Units", "Threshold")
        model.write_row(0, 0, columns)
        for row, (name, formula, units, threshold) in enumerate(FORECASTS, 1):
            model.write_row(row, 0, (name,))
            model.write_formula(row, 1, formula)
            model.write_row(row, 2, (units, threshold))
        _table(model, "xlmc_forecasts", columns, len(FORECASTS))
        inputs.set_column(0, 9, 18)
        model.set_column(0, 3, 18)


def _table(sheet: xlsxwriter.worksheet.Worksheet, name: str, columns: tuple[str, ...], rows: int) -> None:
    heads = [{"header": each} for each in columns]
    sheet.add_table(0, 0, rows, len(columns) - 1, {"name": name, "columns": heads})


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "unknown-mean.xlsx")
