"""Definitions in the reserved tables of a workbook, `xlmc_assumptions` and its like."""
