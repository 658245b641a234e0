"""The engine `formulas`: slow, independent, for comparison."""
