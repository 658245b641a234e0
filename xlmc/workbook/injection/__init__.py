"""How result sheets get into a workbook: one file for each part of the package, or each number, that has to fit."""
