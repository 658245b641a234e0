"""The files that `simulate` and `report` can write a run to: their options, the checks before the run, the writing."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol, TypeVar, cast

import click

from xlmc.cli.options import FilePath, OneOf
from xlmc.cli.terminal import say
from xlmc.cli.writing import written_or_reported
from xlmc.excel.workbook.package import WORKBOOKS

if TYPE_CHECKING:
    from xlmc.api import Simulation
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document import Wanted

__all__ = ["Outputs", "ReportContents", "output_options", "results_beside", "with_files", "with_options"]

F = TypeVar("F", bound=Callable[..., Any])


class _Kind(NamedTuple):
    """A kind of file that a run is written to.

    Attributes:
        noun: what it is called in a message.
        endings: of its files, the usual one first.
        announced: the words before its name when it was written.
        check: refuses a file that could not be written after the run.
    """

    noun: str
    endings: tuple[str, ...]
    announced: str
    check: Callable[[Path], None]


def _check_page(path: Path) -> None:
    from xlmc.outputs.page import check_page_path

    check_page_path(path)


def _check_report(path: Path) -> None:
    from xlmc.outputs.document import check_report_path

    check_report_path(path)


def _check_trials(path: Path) -> None:
    from xlmc.outputs.extract import check_extract_path

    check_extract_path(path)


def _check_folder(path: Path) -> None:
    from xlmc.excel.workbook.writer import check_folder

    check_folder(path)


_BOOK = _Kind("a result workbook", WORKBOOKS, "Results are in", _check_folder)
_RUN = _Kind("a saved run", (".xlmcrun",), "The run is saved in", _check_folder)
_PAGE = _Kind("the page", (".html", ".htm"), "The page is", _check_page)
_JSON = _Kind("JSON", (".json",), "Results as JSON are in", _check_folder)
_PDF = _Kind("the report", (".pdf",), "The report is", _check_report)
_DOCX = _Kind("the report", (".docx",), "The report is", _check_report)
_TRIALS = _Kind("a table of trials", (".csv", ".parquet"), "Accepted trials are in", _check_trials)

_KINDS: Final = (_BOOK, _RUN, _PAGE, _JSON, _PDF, _DOCX, _TRIALS)
"""In the order in which they are written."""

_ALIASES: Final = {
    "html": (_PAGE, click.option("--html", type=FilePath(), metavar="PAGE.html", help="Also write the page.")),
    "json_path": (
        _JSON,
        click.option("--json", "json_path", type=FilePath(), metavar="FILE.json", help="Also write JSON."),
    ),
    "extract": (
        _TRIALS,
        click.option(
            "--extract",
            type=FilePath(),
            multiple=True,
            metavar="FILE.csv|FILE.parquet",
            help="Also write the accepted trials; may be given several times.",
        ),
    ),
    "pdf": (_PDF, click.option("--pdf", type=FilePath(), metavar="REPORT.pdf", help="Also write the report, as PDF.")),
    "docx": (
        _DOCX,
        click.option("--docx", type=FilePath(), metavar="REPORT.docx", help="Also write the report for Word."),
    ),
    "save_run": (
        _RUN,
        click.option("--save-run", type=FilePath(), metavar="FILE.xlmcrun", help="Also save the run."),
    ),
}
"""Options from the time when each kind of file had one: with them alone the default is written, too."""

_CONTENTS = (
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
"""Options for what reports hold, each a field of `ReportContents`; a command without a report refuses them by name."""

_OVERWRITE = click.option(
    "--overwrite",
    is_flag=True,
    help="Replace existing files, whoever wrote them. Without it only files that xlmc wrote for BOOK, and"
    " that nobody has changed since.",
)


def output_options(default: str, *, without: Collection[str] = ()) -> Callable[[F], F]:
    """Add the options; the command is given the files as `output` and `also`, `overwrite`, and `contents`.

    Args:
        default: what is written when nothing is named, for the help.
        without: aliases that the command does not have.
    """
    text = (
        "What to write, by its ending: a result workbook (.xlsx), a report (.pdf, .docx), a page (.html), all results"
        " (.json), the accepted trials (.csv, .parquet), the run itself (.xlmcrun). May be given several times; only"
        f" what is named is written.  [default: {default}]"
    )
    names = [name for name in _ALIASES if name not in without]

    def add(command: F) -> F:
        @wraps(command)
        def packed(*args: Any, **others: Any) -> Any:
            contents = ReportContents(**{name: others.pop(name) for name in ReportContents._fields})
            return command(*args, contents=contents, **others)

        return with_files(text, names)(with_options(*_CONTENTS, _OVERWRITE)(cast(F, packed)))

    return add


def with_files(text: str, aliases: Iterable[str]) -> Callable[[F], F]:
    """Add `-o`, which is described by a text, and some options that stand for one kind of file each.

    The command is given the files of `-o` as `output`, the others as `also`.
    """
    names = list(aliases)
    option = click.option("-o", "--output", type=FilePath(), multiple=True, metavar="FILE", help=text)

    def add(command: F) -> F:
        @wraps(command)
        def packed(*args: Any, **others: Any) -> Any:
            also = tuple(_aliased({_ALIASES[name][0]: others.pop(name) for name in names}))
            return command(*args, also=also, **others)

        return with_options(option, *(_ALIASES[name][1] for name in names))(cast(F, packed))

    return add


def with_options(*options: Callable[[Any], Any]) -> Callable[[F], F]:
    """Add options, which the help lists in this order."""

    def add(command: F) -> F:
        value: Any = command
        for option in reversed(options):
            value = option(value)
        return cast(F, value)

    return add


def _aliased(given: Mapping[_Kind, Path | tuple[Path, ...] | None]) -> Iterator[Path]:
    """Each file of an option that stands for one kind.

    Raises:
        WorkbookError: it has the ending of another kind.
    """
    from xlmc.excel.workbook.target import refuse_other_ending

    for kind, result in given.items():
        for path in (result,) if isinstance(result, Path) else result or ():
            refuse_other_ending(path, kind.endings, kind.noun)
            yield path


class ReportContents(NamedTuple):
    """What the reports are to hold, as it was typed: a field for each of `_CONTENTS`; see `outputs.document.Wanted`."""

    case: tuple[str, ...] = ()
    sections: str | None = None
    report_forecasts: tuple[str, ...] = ()
    paper: str = "letter"

    def wanted(self) -> Wanted:
        """Return the wanted contents that these options describe.

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
        files: those that the person named, each of the kind that its ending says.
        default: a result workbook that the person did not name: another one is numbered on where it is taken.
        in_place: write the result sheets into the source itself, too.
        overwrite: replace files that are not ours too.
        contents: what the reports are to hold.
        beside: the saved run that the page shows beside this one.
        fed_by: the workbooks whose answers feed assumptions.
        functions: a person's own, which formulas call.
    """

    source: Path
    name: str
    files: tuple[Path, ...] = ()
    default: Path | None = None
    in_place: bool = False
    overwrite: bool = False
    contents: ReportContents = ReportContents()
    beside: Path | None = None
    fed_by: tuple[Path, ...] = ()
    functions: OwnFunctions | None = None

    def of(self, *kinds: _Kind) -> list[Path]:
        """Return the named files of some kinds."""
        return [path for path in self.files if path.suffix.casefold() in {e for kind in kinds for e in kind.endings}]

    @property
    def reports(self) -> list[Path]:
        """The reports to hand over."""
        return self.of(_PDF, _DOCX)

    @property
    def books(self) -> list[Path]:
        """The result workbooks that were named, and the source where its sheets are written into it."""
        return [*([self.source] if self.in_place else []), *self.of(_BOOK)]

    @property
    def runs(self) -> list[Path]:
        """The saved runs."""
        return self.of(_RUN)

    @property
    def trials(self) -> list[Path]:
        """The tables of accepted trials."""
        return self.of(_TRIALS)

    @property
    def is_one_page(self) -> bool:
        """Whether a page is all that is written."""
        return len(self.files) == len(self.of(_PAGE)) == 1 and self.default is None

    def check_against(self, model: CompiledModel) -> None:
        """Refuse what cannot be written about this workbook.

        Raises:
            DefinitionError: its table `xlmc_case` is not what it must be.
            SimulationError: it has no such forecast.
            WorkbookError: it is damaged so that no sheets can be added to it.
        """
        has_book = bool(self.default or self.books)
        if has_book:
            from xlmc.excel.workbook.injection.host import refuse_unwritable

            refuse_unwritable(model.workbook.parts)
        if self.reports:
            from xlmc.outputs.document import check_wanted_of

            check_wanted_of(self.contents.wanted(), model)
        elif has_book:
            from xlmc.outputs.case_fields import case_of

            case_of(model.workbook, {})

    def check(self, like: Path) -> Outputs:
        """Return the files as they will be written; a file that could not be written after the run is refused before
        it.

        A result workbook that the person did not name gets a free name where its own is taken, and a note says so.

        Args:
            like: a workbook whose ending the result workbook must have.

        Raises:
            WorkbookError: a name has an ending that xlmc does not write, its folder is missing, it may not be written,
                it is not ours to replace, it is the source, or it is given twice.
            SimulationError: a library is missing.
        """
        from xlmc.excel.workbook.target import refuse_other_ending, refuse_same_file
        from xlmc.outputs.sheets.save import check_ending

        endings = [ending for kind in _KINDS for ending in kind.endings]
        for path in self.files:
            refuse_other_ending(path, endings)
            next(kind for kind in _KINDS if path in self.of(kind)).check(path)
        for path in self.books:
            check_ending(path, like)
        if self.reports:
            self.contents.wanted()
        elif self.contents != ReportContents():
            raise click.UsageError(
                "--case, --sections, --forecasts and --paper are of a report: give -o REPORT.pdf or -o REPORT.docx."
            )
        result = self._with_free_default(like)
        for path in self._named:
            self._refuse_taken(path)
        refuse_same_file([*([result.default] if result.default else []), *self._named])
        return result

    @property
    def _named(self) -> list[Path]:
        """All files that are written but the default."""
        return [*self.books, *(path for path in self.files if path not in self.books)]

    def _refuse_taken(self, path: Path) -> None:
        from xlmc.excel.workbook.target import Target, refuse_read
        from xlmc.excel.workbook.writer import refuse_if_open

        if self._is_source(path):
            refuse_if_open(path)
        elif path in self.books:
            refuse_read(path, self._read, "--in-place writes the result sheets into it")
            Target(path, self.name, self.overwrite).check()
        else:
            Target(path, self.name, self.overwrite, read=self._read).check()

    def _is_source(self, path: Path) -> bool:
        return self.in_place and path == self.source

    @property
    def _read(self) -> list[Path]:
        """The files that are read: no output may replace them."""
        own = None if self.functions is None else self.functions.path
        return [path for path in (self.source, self.beside, *self.fed_by, own) if path is not None]

    def _with_free_default(self, like: Path) -> Outputs:
        from xlmc.errors import capitalised
        from xlmc.excel.workbook.target import Target, free_target, refuse_read
        from xlmc.outputs.sheets.save import check_ending

        if self.default is None:
            return self
        check_ending(self.default, like)
        refuse_read(self.default, self._read, "--in-place writes the result sheets into it")
        if self.overwrite:
            Target(self.default, self.name, self.overwrite).check()
            return self
        path, reason = free_target(self.default, self.name)
        if reason is not None:
            why = f"{self.default}: {capitalised(reason)}"
            say(f"warning: {why}; it stays as it is, and results go to {path}.", err=True)
        return self._replace(default=path)

    def write(self, run: RunResult) -> tuple[bool, list[str]]:
        """Write them all: whether all could be, and what to say of where they are when the answer has been printed.

        If one cannot be written, that is said, and the others are written all the same: the run may have taken hours.
        Where a name was taken since the run began, or a program holds the file, a free name beside it is used.
        """
        from xlmc.api import Simulation
        from xlmc.montecarlo.number_text import count_text, counted_text

        written, lines = True, []
        for path, label, write in self._files(Simulation(run)):
            result = written_or_reported(path, partial(self._write_beside, path, write))
            if result is None:
                written = False
            else:
                lines.append(f"{label} {result}")
        if run.kept_inputs < run.accepted:
            every = counted_text(run.accepted, "accepted trial")
            kept = f"the draws of {count_text(run.kept_inputs)} of {every} were kept"
            for path in self.trials:
                say(f"note: {path}: {kept}; the others are blank", err=True)
        return written, lines

    def _write_beside(self, path: Path, write: _Write) -> Path:
        from xlmc.errors import capitalised
        from xlmc.excel.workbook.target import free_target, refuse_read
        from xlmc.excel.workbook.writer import TakenError

        own = self._is_source(path)
        try:
            if not own:
                refuse_read(path, self._read)  # it may have become a link to one during the run
            write(path, overwrite=self.overwrite or own)
        except TakenError as taken:
            result, _ = free_target(results_beside(path) if own else path, self.name, after=path)
            write(result)
            say(
                f"note: {path}: {capitalised(taken.message)}; it stays as it is, and {result} was written instead.",
                err=True,
            )
            return result
        return path

    def _files(self, run: Simulation) -> Iterator[tuple[Path, str, _Write]]:
        """Each file with the words that announce it, and the function that writes it."""
        writers: dict[_Kind, _Write] = {
            _BOOK: run.save,
            _RUN: run.keep,
            _PAGE: partial(self._write_page, run),
            _JSON: run.save_json,
            _PDF: partial(self._write_report, run),
            _DOCX: partial(self._write_report, run),
            _TRIALS: run.extract,
        }
        if self.default is not None:
            yield self.default, _BOOK.announced, run.save
        for kind in _KINDS:
            for path in self.books if kind is _BOOK else self.of(kind):
                yield path, kind.announced, writers[kind]

    def _write_page(self, run: Simulation, path: Path, *, overwrite: bool = False) -> Path:
        return run.save_page(path, beside=self._second(), overwrite=overwrite)

    def _second(self) -> Simulation | None:
        """Return the run that stands beside the one that is written.

        Raises:
            WorkbookError: it cannot be read.
        """
        from xlmc.api import open_run

        own = None if self.functions is None else self.functions.path
        return None if self.beside is None else open_run(self.beside, functions=own)

    def _write_report(self, run: Simulation, path: Path, *, overwrite: bool = False) -> Path:
        wanted = self.contents.wanted()
        return run.save_report(
            path,
            case=wanted.case,
            sections=wanted.sections,
            forecasts=wanted.forecasts,
            paper=wanted.paper,
            overwrite=overwrite,
        )


class _Write(Protocol):
    """What writes a run to a file."""

    def __call__(self, path: Path, *, overwrite: bool = False) -> Path: ...


def results_beside(source: Path, ending: str | None = None) -> Path:
    """Name the file for the results of a workbook or a saved run by default: `case.xlsx -> case-results.xlsx`."""
    from xlmc.excel.workbook.target import copy_ending

    return source.with_name(f"{source.stem}-results{copy_ending(source) if ending is None else ending}")
