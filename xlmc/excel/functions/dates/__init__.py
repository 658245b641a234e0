"""Excel's category Date and time."""
