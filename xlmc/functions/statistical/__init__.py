"""Excel's category Statistical."""
