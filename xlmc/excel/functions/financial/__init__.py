"""Excel's category Financial."""
