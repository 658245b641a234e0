"""Workbooks of a person's own with xlmc's tables in them."""
