"""Columns too long for memory: flat files in the temporary folder, read through the page cache.

Flat files rather than Parquet: they need no further library, any rank of a column can be read where it stands, and a
column is an ordinary array to whoever reads it. Parquet is a format to hand results on in, not to work in.
"""

from xlmc.montecarlo.columns.column_store import Columns, ColumnStore, Folder, free_disk, on_disk, release
from xlmc.montecarlo.columns.passes import PART, RUN, ascending, holds_nan, numbers, pairwise_sum, parts, passed, picked

__all__ = [
    "PART",
    "RUN",
    "ColumnStore",
    "Columns",
    "Folder",
    "ascending",
    "free_disk",
    "holds_nan",
    "numbers",
    "on_disk",
    "pairwise_sum",
    "parts",
    "passed",
    "picked",
    "release",
]
