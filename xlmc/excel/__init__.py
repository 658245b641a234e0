"""Workbooks and what their formulas mean: this layer works alone."""
