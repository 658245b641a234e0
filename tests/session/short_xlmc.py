"""The command line with short result workbooks, as a program of its own: `python -m short_xlmc simulate …`."""

from __future__ import annotations

from xlmc.cli import main
from xlmc.outputs.sheets import book

_WRITTEN = ("Results", "Trials", "Record")

if __name__ == "__main__":
    book.SHEETS = tuple(sheet for sheet in book.SHEETS if sheet.name in _WRITTEN)
    main()
