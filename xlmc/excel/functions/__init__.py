"""Excel's functions: `registry` holds one row each, the modules beside it one category each, `families` all of them."""

from xlmc.excel.functions.registry import Function, Kind

__all__ = ["Function", "Kind"]
