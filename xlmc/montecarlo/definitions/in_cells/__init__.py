"""Definitions in the formulas of cells, in the words of @RISK, Crystal Ball and Excel."""
