"""Write a study to files: a picture, a page, a workbook, by their endings."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from xlmc.errors import WorkbookError
from xlmc.methods import Study
from xlmc.workbook.writer import refuse_if_open, write_workbook

__all__ = ["ENDINGS", "check_targets", "save_methods"]

ENDINGS: Final = (".png", ".html", ".xlsx")


def check_targets(paths: Iterable[Path], source: Path) -> None:
    """See that every file can be written, before anything is measured.

    Raises:
        WorkbookError: an ending is unknown, a folder is not there, a program has the file open, it is the workbook
            itself, or there is nothing to draw with.
    """
    for path in paths:
        ending = path.suffix.casefold()
        if ending not in ENDINGS:
            message = f"a study of methods is not written as {ending or 'a file without ending'}"
            raise WorkbookError(message, where=path, hint="Name a file that ends in .png, .html or .xlsx")
        if path.is_dir() or not os.access(path.parent, os.W_OK):
            hint = "Name a file in a folder that can be written to"
            raise WorkbookError("this cannot be written", where=path, hint=hint)
        if path.exists() and source.exists() and path.samefile(source):
            raise WorkbookError("this is the workbook itself", where=path, hint="Name another file")
        if ending == ".xlsx":
            refuse_if_open(path)
        elif find_spec("matplotlib") is None:
            hint = "Install it with `pip install 'xlmc[plots]'`, or ask for .xlsx"
            raise WorkbookError("there is no matplotlib here to draw with", where=path, hint=hint)


def save_methods(study: Study, path: Path) -> Path:
    """Write a study in the form that the ending of the path says; an existing file is replaced.

    Raises:
        WorkbookError: it cannot be written.
    """
    check_targets([path], study.model.path)
    write_workbook(path, _content(study, path.suffix.casefold()))
    return path


def _content(study: Study, ending: str) -> bytes:
    if ending == ".xlsx":
        from xlmc.report.methods.book import book

        return book(study)
    if ending == ".html":
        from xlmc.report.methods.page import page

        return page(study).encode()
    from xlmc.report.methods.figure import draw

    drawn = io.BytesIO()
    draw(study).savefig(drawn, format="png", dpi=130)
    return drawn.getvalue()
