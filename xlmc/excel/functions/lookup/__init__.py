"""Excel's category Lookup and reference."""
