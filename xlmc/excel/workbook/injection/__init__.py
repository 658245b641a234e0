"""How result sheets get into a workbook: a module for each part of the package that has to be changed."""
