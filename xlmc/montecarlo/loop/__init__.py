"""A run: a model of the workbook, trials in, accepted trials out."""
