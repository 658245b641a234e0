"""Write what a study found as a workbook or a page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from xlmc.errors import WorkbookError
from xlmc.report.told import Told, book, page
from xlmc.workbook.package import read_parts
from xlmc.workbook.seal import sealed_parts, sealed_text
from xlmc.workbook.target import Target, is_same_file, refuse_same_file
from xlmc.workbook.writer import package_bytes, write_workbook

__all__ = ["Files"]


class Files:
    """The workbook and the page that are asked for; either may be None.

    Args:
        output: the workbook, which must end in .xlsx.
        html: the page, which must end in .html.
        sources: the workbooks that were studied, which are never written to.
        overwrite: replace files that are not ours, too.
    """

    def __init__(self, output: Path | None, html: Path | None, sources: Sequence[Path], *, overwrite: bool) -> None:
        self._endings = [(path, ending) for path, ending in ((output, ".xlsx"), (html, ".html")) if path is not None]
        self._sources, self._overwrite = sources, overwrite

    def check(self) -> None:
        """See that every file can be written, before anything is run.

        Raises:
            TakenError: a file is not ours to replace, or a program has it open.
            WorkbookError: an ending is another, a folder is not there, a file is a workbook that is studied, or is
                named twice.
        """
        refuse_same_file([path for path, _ in self._endings])
        for path, ending in self._endings:
            if path.suffix.casefold() != ending:
                kind = "the sheet" if ending == ".xlsx" else "the page"
                raise WorkbookError(
                    f"{kind} must end in {ending}", where=path, hint=f"Name a file that ends in {ending}"
                )
            if any(is_same_file(path, source) for source in self._sources):
                raise WorkbookError("this is the workbook itself", where=path, hint="Name another file")
            self._target(path).check()

    def _target(self, path: Path) -> Target:
        return Target(path, self._sources[0].name, self._overwrite)

    def write(self, told: Told, sheet: str) -> list[Path]:
        """Write them; an untouched file of ours is replaced.

        Raises:
            TakenError: a file is not ours to replace.
            WorkbookError: it cannot be written.
        """
        name = self._sources[0].name
        for path, ending in self._endings:
            if ending == ".html":
                content = sealed_text(page(told).encode(), ending, name)
            else:
                parts = read_parts(book(told, sheet))
                content = package_bytes(sealed_parts(parts, "xl/worksheets/sheet1.xml", name))
            write_workbook(path, content, self._target(path).check)
        return [path for path, _ in self._endings]
