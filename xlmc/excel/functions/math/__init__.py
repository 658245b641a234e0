"""Excel's category Math and trigonometry."""
