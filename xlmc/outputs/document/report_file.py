"""Write the report of a run to a file."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.errors import SimulationError, WorkbookError
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import check_folder, write_workbook
from xlmc.montecarlo.number_text import in_signs
from xlmc.outputs.document.build import Wanted, build
from xlmc.outputs.document.parts import Document
from xlmc.outputs.document.unbroken import in_units

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["check_report_path", "document_bytes", "save_report"]

_LIBRARIES: Final = {".pdf": {"typst": "typst"}, ".docx": {"docx": "python-docx", "typst": "typst"}}
"""Ending of a report -> what is imported to write it, and how that is called where it is installed from."""


def save_report(
    simulation: RunResult, path: Path, wanted: Wanted, *, command: str | None = None, overwrite: bool = False
) -> Path:
    """Write the report whole or not at all.

    A report bears no seal, because PDF/A allows none, and people edit Word files: no file is replaced unless asked.

    Args:
        simulation: the finished run.
        path: where to; it ends in `.pdf` or `.docx`.
        wanted: what the report is to hold.
        command: what the person typed, for the record.
        overwrite: replace a file that is there.

    Returns:
        The path.

    Raises:
        TakenError: there is a file.
        DefinitionError: the table `xlmc_case` is not what it must be.
        SimulationError: a library is missing, there is no such forecast, section or paper, or no font has a character.
        WorkbookError: the file has another ending, or cannot be written.
    """
    check_report_path(path)
    target = Target(path, simulation.model.workbook.name, overwrite, read=simulation.model.files)
    target.check()
    document = build(simulation, wanted, command=command)
    write_workbook(path, document_bytes(document, path.suffix), target.check)
    return path


def document_bytes(document: Document, ending: str) -> bytes:
    """Return a document as the bytes of a file with the ending `.pdf` or `.docx`.

    Raises:
        SimulationError: a library is missing, or no font has a character.
    """
    with in_signs(*document.signs), in_units(document.units):
        if ending.casefold() == ".pdf":
            from xlmc.outputs.document.typst_writer import pdf_bytes

            return pdf_bytes(document)
        from xlmc.outputs.document.docx_writer import docx_bytes

        return docx_bytes(document)


def check_report_path(path: Path) -> None:
    """Refuse, before a long run, a file of another kind, or one that `check_folder` refuses.

    Raises:
        SimulationError: a library is missing.
        WorkbookError: it is one of these.
    """
    libraries = _LIBRARIES.get(path.suffix.casefold())
    if libraries is None:
        hint = f"Name it '{path.stem or 'report'}.pdf' or '{path.stem or 'report'}.docx'"
        raise WorkbookError("a report must end in .pdf or .docx", where=path, hint=hint)
    for module, name in libraries.items():
        if find_spec(module) is None:
            hint = f'Install it: pip install "{name}"'
            raise SimulationError(f"reports need {name}, which is not installed", hint=hint)
    check_folder(path)
