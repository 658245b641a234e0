"""What `xlmc methods` measured, written to files: a picture, a page, a workbook or a document, by their endings."""

from __future__ import annotations

import io
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from xlmc.analysis.studies.methods import Study
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import sealed_json, sealed_parts, sealed_text
from xlmc.excel.workbook.target import Target, refuse_other_ending, refuse_same_file
from xlmc.excel.workbook.writer import package_bytes, write_workbook
from xlmc.montecarlo.statistics.estimate import finite_json

__all__ = ["ENDINGS", "check_targets", "save_methods"]


ENDINGS: Final = (".png", ".html", ".xlsx", ".pdf", ".docx", ".json")
_UNDRAWN: Final = (".xlsx", ".json")
_DOCUMENTS: Final = (".pdf", ".docx")


def check_targets(paths: Sequence[Path], source: Path, *, overwrite: bool = False) -> None:
    """See that every file can be written, before anything is measured.

    Raises:
        TakenError: a file is not ours to replace, is the workbook itself, or a program has it open.
        WorkbookError: an ending is unknown, a folder is not there, a file is named twice, or there is nothing to draw
            with.
        SimulationError: a library that writes documents is missing.
    """
    refuse_same_file(paths)
    for path in paths:
        refuse_other_ending(path, ENDINGS)
        ending = path.suffix.casefold()
        if ending in _DOCUMENTS:
            from xlmc.outputs.document import check_report_path

            check_report_path(path)
        Target(path, source.name, overwrite, read=[source]).check()
        if ending not in _UNDRAWN and find_spec("matplotlib") is None:
            hint = "Install it with `pip install 'xlmc[plots]'`, or ask for .xlsx"
            raise WorkbookError("drawing needs matplotlib, which is not installed", where=path, hint=hint)


def save_methods(study: Study, path: Path, *, overwrite: bool = False) -> Path:
    """Write a study in the form that the ending of the path says; an untouched page or workbook of ours is replaced.

    Args:
        study: what was measured.
        path: where to; it ends in one of `ENDINGS`.
        overwrite: replace any other file, too.

    Raises:
        TakenError: the file is not ours to replace.
        WorkbookError: it cannot be written.
    """
    check_targets([path], study.model.path, overwrite=overwrite)
    target = Target(path, study.model.path.name, overwrite, read=[study.model.path])
    write_workbook(path, _content_with_seal(study, path.suffix.casefold()), target.check)
    return path


def _content_with_seal(study: Study, ending: str) -> bytes:
    """Seal the content; a picture and a document have no seal."""
    name = study.model.path.name
    if ending == ".xlsx":
        from xlmc.outputs.methods.methods_workbook import book

        return package_bytes(sealed_parts(book(study), "xl/worksheets/sheet1.xml", name))
    if ending == ".json":
        from xlmc.outputs.methods.methods_json import study_json

        return sealed_json(finite_json(study_json(study)), name)
    if ending == ".html":
        from xlmc.outputs.methods.methods_page import page

        return sealed_text(page(study).encode(), ending, name)
    if ending in _DOCUMENTS:
        from xlmc.outputs.document import document_bytes
        from xlmc.outputs.methods.methods_document import document

        return document_bytes(document(study), ending)
    from xlmc.outputs.methods.matplotlib_figure import draw

    drawn = io.BytesIO()
    draw(study).savefig(drawn, format="png", dpi=130)
    return drawn.getvalue()
