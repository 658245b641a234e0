"""The files that a run can be written to: one list for `simulate` and `report`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from xlmc.errors import XlmcError

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["NOT_WRITTEN", "Outputs", "output_options"]

NOT_WRITTEN = 2

F = TypeVar("F", bound=Callable[..., Any])

_PATH = click.Path(path_type=Path)
_OPTIONS = (
    click.option("--html", type=_PATH, metavar="PAGE.html", help="Write the results as one web page."),
    click.option("--json", "json_path", type=_PATH, metavar="FILE.json", help="Write all results as JSON."),
    click.option(
        "--extract",
        type=_PATH,
        multiple=True,
        metavar="FILE.csv|FILE.parquet",
        help="Write the accepted trials; may be given again.",
    ),
)


def output_options(command: F) -> F:
    """Adds the options; the command is given `html`, `json_path` and `extract`."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


@dataclass(frozen=True, slots=True)
class Outputs:
    """The files asked for.

    Attributes:
        book: the result workbook.
        run: a saved run.
        html: a page for a browser.
        json: all results.
        extract: the accepted trials.
    """

    book: Path | None = None
    run: Path | None = None
    html: Path | None = None
    json: Path | None = None
    extract: tuple[Path, ...] = ()

    def check(self, source: Path) -> None:
        """Refuse before a run what could not be written after it.

        Args:
            source: the workbook that is run.

        Raises:
            WorkbookError: a name has another ending than it must, its folder is missing, or it may not be written.
            SimulationError: a library is missing.
        """
        if self.book is not None:
            from xlmc.report.save import check_book_path

            check_book_path(self.book, source)
        if self.run is not None:
            from xlmc.saved.keeping import check_run_path

            check_run_path(self.run)
        if self.html is not None:
            from xlmc.report.html import check_page_path

            check_page_path(self.html)
        if self.json is not None:
            from xlmc.report.document import check_json_path

            check_json_path(self.json)
        for path in self.extract:
            from xlmc.report.extract import check_extract_path

            check_extract_path(path)
        for other in (self.run, self.html, self.json, *self.extract):
            if other is not None:
                from xlmc.workbook.writer import check_folder

                check_folder(other)

    def write(self, run: Simulation) -> bool:
        """Write them all, and say where they are; whether all could be.

        One that cannot be written is told of, and the others are written all the same: the run may have taken hours.
        """
        written = True
        for path, said, write in self._files(run):
            try:
                write(path)
            except XlmcError as error:
                click.echo(f"xlmc: {error}", err=True)
                written = False
            else:
                click.echo(f"{said} {path}")
        if self.extract and run.kept_inputs < run.accepted:
            kept = f"draws of {run.kept_inputs:,} of {run.accepted:,} accepted trials were kept"
            for path in self.extract:
                click.echo(f"note: {path}: {kept}; the others are blank", err=True)
        return written

    def _files(self, run: Simulation) -> Iterator[tuple[Path, str, Callable[[Path], object]]]:
        """Each with what is said of it, and what writes it."""
        if self.book is not None:
            yield self.book, "Results are in", run.save
        if self.run is not None:
            yield self.run, "The run is saved in", run.keep
        if self.html is not None:
            yield self.html, "The page is", run.save_page
        if self.json is not None:
            yield self.json, "Results as JSON are in", run.save_json
        for path in self.extract:
            yield path, "Accepted trials are in", run.extract
