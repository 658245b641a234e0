"""The files that `simulate` and `report` can write a run to: their options, the checks before the run, the writing."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar, cast

import click

from xlmc.cli.options import OneOf
from xlmc.cli.terminal import say
from xlmc.cli.writing import written_or_told
from xlmc.errors import WorkbookError

if TYPE_CHECKING:
    from xlmc.api import Simulation
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document import Wanted

__all__ = ["Outputs", "Reports", "Wishes", "output_options", "results_beside"]

F = TypeVar("F", bound=Callable[..., Any])

_PATH = click.Path(readable=False, path_type=Path)  # a file that may not be read is refused later, with a hint
_FILES = (
    click.option("--html", type=_PATH, metavar="PAGE.html", help="Write the results as one web page."),
    click.option("--json", "json_path", type=_PATH, metavar="FILE.json", help="Write all results as JSON."),
    click.option(
        "--extract",
        type=_PATH,
        multiple=True,
        metavar="FILE.csv|FILE.parquet",
        help="Write the accepted trials; may be given several times.",
    ),
    click.option("--pdf", type=_PATH, metavar="REPORT.pdf", help="Write the report to hand over, as PDF."),
    click.option("--docx", type=_PATH, metavar="REPORT.docx", help="Write the same report as a Word file."),
)

_WISHES = (
    click.option(
        "--case",
        "case",
        multiple=True,
        metavar="FIELD=TEXT",
        help="On the report's first page, such as 'Case number=2026-17'; may be given several times. Replaces what"
        " the table xlmc_case says.",
    ),
    click.option("--sections", metavar="NAME,NAME", help="Sections of the report.  [default: all]"),
    click.option(
        "--forecasts",
        "report_forecasts",
        multiple=True,
        metavar="FORECAST",
        help="A forecast that the report is about; may be given several times.  [default: all]",
    ),
    click.option("--paper", type=OneOf("letter", "a4"), default="letter", show_default=True, help="Paper size."),
)
"""What the reports are to hold: each is a field of `Wishes`, and is named where they are refused without a report."""

_OVERWRITE = click.option(
    "--overwrite",
    is_flag=True,
    help="Replace existing files, whoever wrote them. Without it only files that xlmc wrote for BOOK, and"
    " that nobody has changed since.",
)


def output_options(command: F) -> F:
    """Add the options; the command is given `html`, `json_path`, `extract`, `overwrite`, `reports` and `wishes`."""

    @wraps(command)
    def packed(*args: Any, pdf: Path | None, docx: Path | None, **others: Any) -> Any:
        wishes = Wishes(**{name: others.pop(name) for name in Wishes._fields})
        return command(*args, reports=Reports(pdf, docx), wishes=wishes, **others)

    found: Any = packed
    for option in reversed((*_FILES, *_WISHES, _OVERWRITE)):
        found = option(found)
    return cast(F, found)


class Reports(NamedTuple):
    """The reports asked for."""

    pdf: Path | None = None
    docx: Path | None = None

    @property
    def paths(self) -> list[Path]:
        return [path for path in self if path is not None]

    def check(self) -> None:
        """Refuse a report that could not be written.

        Raises:
            WorkbookError: it has another ending than it must, or its folder is missing.
            SimulationError: a library is missing.
        """
        from xlmc.outputs.document import check_report_path

        for path, ending in ((self.pdf, ".pdf"), (self.docx, ".docx")):
            if path is None:
                continue
            if path.suffix.casefold() != ending:
                hint = f"Name it '{path.stem or 'report'}{ending}'"
                raise WorkbookError(f"the report must end in {ending}", where=path, hint=hint)
            check_report_path(path)


class Wishes(NamedTuple):
    """What the reports are to hold, as it was typed: a field for each of `_WISHES`; see `report.document.Wanted`."""

    case: tuple[str, ...] = ()
    sections: str | None = None
    report_forecasts: tuple[str, ...] = ()
    paper: str = "letter"

    def wanted(self) -> Wanted:
        """What they mean.

        Raises:
            SimulationError: a field of the case has no name, or there is no such section.
        """
        from xlmc.outputs.document import Wanted, check_wanted, fields_from

        sections = () if self.sections is None else tuple(name.strip() for name in self.sections.split(","))
        wanted = Wanted(fields_from(self.case), sections, self.report_forecasts, self.paper)
        check_wanted(wanted)
        return wanted


class Outputs(NamedTuple):
    """The files asked for.

    Attributes:
        source: the workbook or the saved run that they come from.
        name: of the workbook.
        book: the result workbook.
        run: a saved run.
        html: a page for a browser.
        json: all results.
        extract: the accepted trials.
        overwrite: replace files that are not ours too.
        in_place: the result workbook is the workbook itself.
        named: the person gave the result workbook its name; another one is numbered on where it is taken.
        reports: the reports to hand over.
        wishes: what they are to hold.
        beside: the saved run that the page shows beside this one.
    """

    source: Path
    name: str
    book: Path | None = None
    run: Path | None = None
    html: Path | None = None
    json: Path | None = None
    extract: tuple[Path, ...] = ()
    overwrite: bool = False
    in_place: bool = False
    named: bool = True
    reports: Reports = Reports()
    wishes: Wishes = Wishes()
    beside: Path | None = None

    def check_against(self, model: CompiledModel) -> None:
        """Refuse what cannot be written about this workbook.

        Raises:
            DefinitionError: its table `xlmc_case` is not what it must be.
            SimulationError: it has no such forecast.
            WorkbookError: it is damaged so that no sheets can be added to it.
        """
        if self.book is not None:
            from xlmc.excel.workbook.inject import refuse_unwritable

            refuse_unwritable(model.workbook.parts)
        if self.reports.paths:
            from xlmc.outputs.document import check_wanted_of

            check_wanted_of(self.wishes.wanted(), model)
        elif self.book is not None:
            from xlmc.outputs.case_fields import case_of

            case_of(model.workbook, {})

    def check(self, like: Path) -> Outputs:
        """The files as they will be written; a file that could not be written after the run is refused before it.

        A result workbook that the person did not name gets a free name where its own is taken, and a note says so.

        Args:
            like: a workbook whose ending the result workbook must have.

        Raises:
            WorkbookError: a name has another ending than it must, its folder is missing, it may not be written, it is
                not ours to replace, it is the source, or it is given twice.
            SimulationError: a library is missing.
        """
        from xlmc.excel.workbook.target import Target, refuse_same_file

        self._check_endings(like)
        for path in self._others:
            Target(path, self.name, self.overwrite, read=self._read).check()
        found = self._with_book()
        refuse_same_file([path for path in (found.book, *self._others) if path is not None])
        return found

    @property
    def _others(self) -> list[Path]:
        """All but the result workbook."""
        return [path for path in (self.run, self.html, self.json, *self.reports, *self.extract) if path is not None]

    def _check_endings(self, like: Path) -> None:
        for path in (self.book, *self._others):
            if path is not None and os.path.isdir(path) and (self.named or path != self.book):
                raise WorkbookError("this is a folder, not a file", where=path, hint="Name a file")
        if self.book is not None:
            from xlmc.outputs.sheets.save import check_ending

            check_ending(self.book, like)
        if self.run is not None:
            from xlmc.analysis.results.saved.keeping import check_run_path

            check_run_path(self.run)
        if self.html is not None:
            from xlmc.outputs.page import check_page_path

            check_page_path(self.html)
        if self.json is not None:
            from xlmc.outputs.json_document import check_json_path

            check_json_path(self.json)
        if self.reports.paths:
            self.reports.check()
            self.wishes.wanted()
        elif self.wishes != Wishes():
            raise click.UsageError("--case, --sections, --forecasts and --paper are of a report: give --pdf or --docx.")
        for path in self.extract:
            from xlmc.outputs.extract import check_extract_path

            check_extract_path(path)

    @property
    def _read(self) -> list[Path]:
        """The files that are read: no output may replace them."""
        return [path for path in (self.source, self.beside) if path is not None]

    def _with_book(self) -> Outputs:
        from xlmc.excel.workbook.target import Target, free_target, refuse_read
        from xlmc.excel.workbook.writer import check_folder, refuse_if_open

        if self.book is None:
            return self
        if self.in_place:
            check_folder(self.book)
            refuse_if_open(self.book)
            return self
        refuse_read(self.book, self._read, "--in-place writes the result sheets into it")
        if self.named or self.overwrite:
            Target(self.book, self.name, self.overwrite).check()
            return self
        found, reason = free_target(self.book, self.name)
        if reason is not None:
            say(f"note: {self.book}: {reason}; it stays as it is, and results go to {found}.", err=True)
        return self._replace(book=found)

    def write(self, run: RunResult) -> tuple[bool, list[str]]:
        """Write them all: whether all could be, and what to say of where they are when the answer has been printed.

        If one cannot be written, that is said, and the others are written all the same: the run may have taken hours.
        Where a name was taken since the run began, or a program holds the file, a free name beside it is used.
        """
        from xlmc.api import Simulation

        written, lines = True, []
        for path, said, write in self._files(Simulation(run)):
            found = written_or_told(path, partial(self._write_beside, path, write))
            if found is None:
                written = False
            else:
                lines.append(f"{said} {found}")
        if self.extract and run.kept_inputs < run.accepted:
            kept = f"the draws of {run.kept_inputs:,} of {run.accepted:,} accepted trials were kept"
            for path in self.extract:
                say(f"note: {path}: {kept}; the others are blank", err=True)
        return written, lines

    def _write_beside(self, path: Path, write: _Write) -> Path:
        from xlmc.excel.workbook.target import free_target, refuse_read
        from xlmc.excel.workbook.writer import TakenError

        try:
            if not (self.in_place and path == self.book):
                refuse_read(path, self._read)  # it may have become a link to one during the run
            write(path, overwrite=self.overwrite or (self.in_place and path == self.book))
        except TakenError as taken:
            beside = results_beside(path) if path == self.book and self.in_place else path
            found, _ = free_target(beside, self.name, after=path)
            write(found)
            say(f"note: {path}: {taken.message}; it stays as it is, and {found} was written instead.", err=True)
            return found
        return path

    def _files(self, run: Simulation) -> Iterator[tuple[Path, str, _Write]]:
        """Each file with the words that announce it, and the function that writes it."""
        if self.book is not None:
            yield self.book, "Results are in", run.save
        if self.run is not None:
            yield self.run, "The run is saved in", run.keep
        if self.html is not None:
            yield self.html, "The page is", partial(run.save_page, beside=self._second())
        if self.json is not None:
            yield self.json, "Results as JSON are in", run.save_json
        for path in self.reports.paths:
            yield path, "The report is", partial(self._write_report, run)
        for path in self.extract:
            yield path, "Accepted trials are in", run.extract

    def _second(self) -> Simulation | None:
        """The run that stands beside the one that is written.

        Raises:
            WorkbookError: it cannot be read.
        """
        from xlmc.api import open_run

        return None if self.beside is None else open_run(self.beside)

    def _write_report(self, run: Simulation, path: Path, *, overwrite: bool = False) -> Path:
        found = self.wishes.wanted()
        return run.save_report(
            path,
            case=found.case,
            sections=found.sections,
            forecasts=found.forecasts,
            paper=found.paper,
            overwrite=overwrite,
        )


class _Write(Protocol):
    """What writes a run to a file."""

    def __call__(self, path: Path, *, overwrite: bool = False) -> Path: ...


def results_beside(source: Path, ending: str | None = None) -> Path:
    """The file that the results of a workbook or a saved run go to by default: `case.xlsx -> case-results.xlsx`."""
    from xlmc.excel.workbook.target import copy_ending

    return source.with_name(f"{source.stem}-results{copy_ending(source) if ending is None else ending}")
