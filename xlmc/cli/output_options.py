"""The files that a run can be written to beside its result workbook: one list for `simulate` and `report`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["Outputs", "output_options"]

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
        run: a saved run.
        html: a page for a browser.
        json: all results.
        extract: the accepted trials.
    """

    run: Path | None = None
    html: Path | None = None
    json: Path | None = None
    extract: tuple[Path, ...] = ()

    def __bool__(self) -> bool:
        return bool(self._paths)

    def check(self) -> None:
        """Refuse before a run what could not be written after it.

        Raises:
            WorkbookError: a name has another ending than it must, or its folder is missing.
            SimulationError: a library is missing.
        """
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
        for path in self._paths:
            from xlmc.workbook.writer import check_folder

            check_folder(path)

    @property
    def _paths(self) -> tuple[Path, ...]:
        return tuple(path for path in (self.run, self.html, self.json, *self.extract) if path is not None)

    def write(self, run: Simulation) -> None:
        """Write them all, and say where they are."""
        if self.run is not None:
            run.keep(self.run)
            click.echo(f"The run is saved in {self.run}")
        if self.html is not None:
            run.save_page(self.html)
            click.echo(f"The page is {self.html}")
        if self.json is not None:
            run.save_json(self.json)
            click.echo(f"Results as JSON are in {self.json}")
        for path in self.extract:
            run.extract(path)
            click.echo(f"Accepted trials are in {path}")
            if run.kept_inputs < run.accepted:
                kept = f"draws of {run.kept_inputs:,} of {run.accepted:,} accepted trials were kept"
                click.echo(f"note: {path}: {kept}; the others are blank", err=True)
