"""Saved runs: a finished run in one file, with the workbook it was made from, to be opened as a `RunResult` again.

The file is a zip package whose entries are stored as they are: `workbook` (the bytes of the workbook), `fed/0` and so
on (the workbooks that fed it), `columns/0.npy` and so on, and `run.json`, which has the settings, the counts, and a
SHA-256 of every other entry.
"""

from __future__ import annotations

from xlmc.analysis.results.saved.archive import SUFFIX
from xlmc.analysis.results.saved.keeping import keep
from xlmc.analysis.results.saved.opening import is_saved_run, open_run, refuse_other_function

__all__ = ["SUFFIX", "is_saved_run", "keep", "open_run", "refuse_other_function"]
