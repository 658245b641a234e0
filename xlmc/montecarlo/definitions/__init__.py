"""What a workbook asks of a run (assumptions, forecasts, filters, checks, correlations, settings), and its readers."""
