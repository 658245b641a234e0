"""How what a study found shows itself in Python: printed in sentences, in a notebook with its tables and charts."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, Protocol

__all__ = ["Documents", "Shown"]


class Documents(Protocol):
    """What makes documents of studies."""

    def text(self, shown: Shown) -> str:
        """Return the title and the sentences of what was found."""

    def html(self, shown: Shown) -> str:
        """Return all of it as HTML."""

    def save(self, shown: Shown, path: Path, *, overwrite: bool) -> Path:
        """Write all of it to a file, in the form that its ending names."""


class Shown:
    """What a study found.

    Attributes:
        documents: what shows it; the layer that makes documents, which this one must not know, sets it.
    """

    __slots__ = ()
    documents: ClassVar[Documents | None] = None

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>" if self.documents is None else self.documents.text(self)

    def _repr_html_(self) -> str | None:
        """Return what a notebook shows: the blocks of the study's page."""
        return None if self.documents is None else self.documents.html(self)

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write what was found to a file, as the command of this study does, and return its path.

        Args:
            path: where to, by its ending: a sheet (`.xlsx`), a document (`.pdf`, `.docx`), a page (`.html`), `.json`.
            overwrite: replace a file that xlmc did not write for this workbook, or that was changed since.

        Raises:
            TakenError: the file is not ours to replace, is a workbook that was studied, or a program has it open.
            WorkbookError: the ending is not written, or the folder is not there.
            SimulationError: a library is missing.
        """
        if self.documents is None:
            raise RuntimeError("import xlmc first: it brings the documents of studies")
        return self.documents.save(self, Path(path), overwrite=overwrite)
