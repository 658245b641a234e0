"""The xlsx package: read formulas, cached values, names, tables and array flags; write results back into it."""
