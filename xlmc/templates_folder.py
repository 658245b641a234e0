"""The templates people start from: in the wheel beside the package, in a checkout beside it one folder up."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from xlmc.errors import WorkbookError
from xlmc.workbook.package import read_parts

__all__ = ["Template", "templates"]

_SUBJECT = "{http://purl.org/dc/elements/1.1/}subject"


@dataclass(frozen=True, slots=True)
class Template:
    """One template: its file, and one line on what it answers (the subject in its document properties)."""

    path: Path
    summary: str


def templates() -> dict[str, Template]:
    """Every template by name.

    Raises:
        WorkbookError: the folder is missing from the installation.
    """
    package = Path(__file__).parent
    for folder in (package / "templates", package.parent / "templates"):
        books = sorted(folder.glob("*.xlsx"))
        if books:
            return {book.stem: Template(book, _summary(book)) for book in books}
    raise WorkbookError("the templates are missing", where=package, hint="install xlmc again")


def _summary(book: Path) -> str:
    core = read_parts(book.read_bytes()).get("docProps/core.xml", b"<none/>")
    return ElementTree.fromstring(core).findtext(_SUBJECT, default="")
