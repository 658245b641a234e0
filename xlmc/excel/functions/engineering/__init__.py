"""Excel's category Engineering."""
