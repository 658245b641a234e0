"""What was understood of a workbook, compiled: needed cells, draws, correlations, changes."""
