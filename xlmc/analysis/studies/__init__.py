"""Further questions to a workbook, or to a run."""
