"""Excel's category Text."""
