"""Assumptions, forecasts, correlations and filters that Crystal Ball's dialogs keep in hidden parts of a workbook."""
