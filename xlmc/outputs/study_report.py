"""What a study found, as blocks, and the files it is written to: the terminal and all of them show the same blocks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import sealed_json, sealed_parts, sealed_text
from xlmc.excel.workbook.target import Target, refuse_other_ending, refuse_same_file
from xlmc.excel.workbook.writer import package_bytes, write_workbook
from xlmc.montecarlo.definitions.number_styles import as_programs_read
from xlmc.montecarlo.statistics.estimate import finite_json
from xlmc.outputs.document.parts import Block, Document, Paragraph
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import CREATED, Styles

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.exact_book import ExactBook

__all__ = ["TWO_LOOPS_NOT_KEPT", "Files", "StudyReport", "book_parts"]

_DOCUMENTS: Final = (".pdf", ".docx")
_ENDINGS: Final = (".xlsx", ".html", ".htm", *_DOCUMENTS, ".json")
_PICTURE: Final = ".png"
_UNDRAWN: Final = (".xlsx", ".json")
_OF_RUN: Final = (".csv", ".parquet", ".xlmcrun")


@dataclass(frozen=True, slots=True)
class StudyReport:
    """What a study found.

    Attributes:
        title: what it is.
        below: of which book, from how many trials.
        blocks: all of it, from the top down.
        sheet: the name of its sheet.
        as_json: gives all that was found, as JSON holds it.
        run: the run of the workbook itself; None where the study has none, or several.
        on_sheet: the blocks of its sheet; None for all.
        add_sheets: adds further sheets to its workbook.
        drawn: the figure as a picture, for the endings that have one.
    """

    title: str
    below: str
    blocks: Sequence[Block]
    sheet: str
    as_json: Callable[[], dict[str, object]]
    run: RunResult | None = None
    on_sheet: Sequence[Block] | None = None
    add_sheets: Callable[[ExactBook, Styles], None] | None = None
    drawn: Callable[[], bytes] | None = None

    def json(self) -> dict[str, object]:
        """Return all that was found for programs, whose texts have the usual signs of thousands and decimals."""
        with as_programs_read():
            return self.as_json()


TWO_LOOPS_NOT_KEPT: Final = (
    "The command gives the same trials again, to the last bit; a .csv or .parquet file has them, each with its outer "
    "draw"
)
"""What to do instead of keeping a run in two loops."""


class Files:
    """The files that a report is written to, each by its ending.

    Args:
        paths: where to.
        sources: the workbooks that were studied, which are never written to.
        overwrite: replace files that are not ours, too.
        of_run: the study has a run, whose trials can be written, and which can be saved.
        not_kept: what to do instead of saving a run that cannot be; empty where it can.
        drawn: the study has a figure, which matplotlib draws.
        functions: a person's own, whose file is never written to either.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        sources: Sequence[Path],
        *,
        overwrite: bool,
        of_run: bool = False,
        not_kept: str = "",
        drawn: bool = False,
        functions: OwnFunctions | None = None,
    ) -> None:
        self._read = (*sources, *(() if functions is None else (functions.path,)))
        self._paths, self._sources, self._overwrite, self._drawn = paths, sources, overwrite, drawn
        runs = () if not of_run else _OF_RUN[:2] if not_kept else _OF_RUN
        self._endings, self._not_kept = (*([_PICTURE] if drawn else []), *_ENDINGS, *runs), not_kept

    @property
    def show_figures(self) -> bool:
        """Whether a file shows the figure that matplotlib draws."""
        return self._drawn and any(path.suffix.casefold() not in _UNDRAWN for path in self._paths)

    def check(self) -> None:
        """See that every file can be written, before anything is run.

        Raises:
            TakenError: a file is not ours to replace, is a workbook that is studied, or a program has it open.
            WorkbookError: a file has an ending that is not written, its folder is not there, or it is named twice.
            SimulationError: a library is missing.
        """
        refuse_same_file(self._paths)
        for path in self._paths:
            if self._not_kept and path.suffix.casefold() == _OF_RUN[-1]:
                raise WorkbookError("This run cannot be kept", where=path, hint=self._not_kept)
            refuse_other_ending(path, self._endings)
            if path.suffix.casefold() in _DOCUMENTS:
                from xlmc.outputs.document import check_report_path

                check_report_path(path)
            elif path.suffix.casefold() in _OF_RUN[:2]:
                from xlmc.outputs.extract import check_extract_path

                check_extract_path(path)
            self._target(path).check()
            if self.show_figures and find_spec("matplotlib") is None:
                hint = 'Install it with `pip install "matplotlib>=3.8"`, or ask for .xlsx'
                raise WorkbookError("drawing needs matplotlib, which is not installed", where=path, hint=hint)

    def _target(self, path: Path) -> Target:
        return Target(path, self._sources[0].name, self._overwrite, read=self._read)

    def writers(self, report: StudyReport) -> Iterator[tuple[Path, Callable[[], Path]]]:
        """Each file with what writes it; an untouched file of ours is replaced.

        What writes it raises `TakenError` where the file is not ours to replace or has become a workbook that is
        studied, and `WorkbookError` where it cannot be written.
        """
        for path in self._paths:
            yield path, partial(self._write, report, path)

    def _write(self, report: StudyReport, path: Path) -> Path:
        name, ending = self._sources[0].name, path.suffix.casefold()
        if ending in _OF_RUN and report.run is not None:
            return self._write_run(report.run, path, ending)
        if ending in _DOCUMENTS:
            content = _document(report, ending)
        elif ending == _PICTURE:
            assert report.drawn is not None
            content = report.drawn()
        elif ending in (".html", ".htm"):
            content = sealed_text(_page(report).encode(), ending, name)
        elif ending == ".json":
            content = sealed_json(finite_json(report.json()), name)
        else:
            content = package_bytes(sealed_parts(book_parts(report), "xl/worksheets/sheet1.xml", name))
        write_workbook(path, content, self._target(path).check)
        return path

    def _write_run(self, run: RunResult, path: Path, ending: str) -> Path:
        if ending == ".xlmcrun":
            from xlmc.analysis.results.saved import keep

            return keep(run, path, overwrite=self._overwrite)
        from xlmc.outputs.extract import extract

        if run.plan.outer and run.kept_inputs < run.accepted:
            hint = "Give keep_trials=True to xlmc.uncertainty"
            raise WorkbookError("The draws of the trials were not kept", where=path, hint=hint)
        return extract(run, path, overwrite=self._overwrite)


def _document(report: StudyReport, ending: str) -> bytes:
    """Return the report as a document without a date: what a study finds depends on no clock."""
    from xlmc.outputs.document import document_bytes

    blocks = (Paragraph(report.below), *report.blocks)
    return document_bytes(Document(report.title, "", None, report.title, "", (), blocks), ending)


def _page(report: StudyReport) -> str:
    """Return the report as one HTML page that needs no other file."""
    from xlmc.outputs.document.html_writer import blocks_html
    from xlmc.outputs.page import plain_page

    return plain_page(report.title, report.below, blocks_html(report.blocks))


def book_parts(report: StudyReport) -> dict[str, bytes]:
    """Return the report as the parts of a workbook."""
    from xlmc.outputs.sheets.exact_book import ExactBook
    from xlmc.outputs.sheets.xlsx_writer import Charting, sheet_widths, write_blocks

    with ExactBook() as made:
        made.set_properties({"created": CREATED})
        styles = Styles(made)
        blocks = report.blocks if report.on_sheet is None else report.on_sheet
        written = Page(made.add_worksheet(report.sheet), styles, sheet_widths(blocks))

        @cache
        def numbers() -> Page:
            data = Page(made.add_worksheet("Numbers"), styles, ())
            data.sheet.hide()
            return data

        written.title(report.title, report.below)
        written.row += 1
        write_blocks(written, blocks, Charting(made, numbers))
        written.set_up_printing(report.title)
        if report.add_sheets is not None:
            report.add_sheets(made, styles)
        if numbers.cache_info().currsize:
            numbers().set_up_printing(report.title, repeat=0)
    parts: dict[str, bytes] = made.parts
    return parts
