"""Write a run's page into a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from xlmc.errors import WorkbookError
from xlmc.report.page.page import page_text
from xlmc.workbook.seal import sealed_text
from xlmc.workbook.target import Target
from xlmc.workbook.writer import check_folder, write_workbook

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["check_page_path", "save_page"]

ENDINGS = (".html", ".htm")


def save_page(simulation: Simulation, path: Path, *, command: str | None = None, overwrite: bool = False) -> Path:
    """Write the page whole or not at all; an untouched page of the same workbook is replaced.

    Args:
        simulation: the finished run.
        path: where to; it ends in `.html` or `.htm`.
        command: what the person typed, for the record.
        overwrite: replace any other file too.

    Returns:
        The path.

    Raises:
        TakenError: the file is not ours to replace.
        WorkbookError: the file has another ending, or cannot be written.
    """
    check_page_path(path)
    target = Target(path, simulation.model.workbook.name, overwrite)
    target.check()
    # Half of a surrogate pair, which a damaged name can hold, has no UTF-8: the browser shows a reference's mark.
    text = page_text(simulation, command=command).encode("utf-8", "xmlcharrefreplace")
    write_workbook(path, sealed_text(text, ".html", target.book), target.check)
    return path


def check_page_path(path: Path) -> None:
    """Refuse, before a long run, what no page can be written to: another kind of file, and what `check_folder` refuses.

    Raises:
        WorkbookError: it is one of these.
    """
    if path.suffix.casefold() not in ENDINGS:
        hint = f"Name it '{path.stem or 'results'}.html'"
        raise WorkbookError("the page must end in .html", where=path, hint=hint)
    check_folder(path)
