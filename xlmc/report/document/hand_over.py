"""Writes the report of a run to a file: `.pdf` or `.docx`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.definitions.definitions import CaseDetails, name_key
from xlmc.errors import SimulationError, WorkbookError
from xlmc.report.document.parts import Document
from xlmc.report.document.report_sections import SECTIONS, describe
from xlmc.report.document.typeset import pdf_bytes
from xlmc.report.document.word import docx_bytes
from xlmc.workbook.target import Target
from xlmc.workbook.writer import check_folder, write_workbook

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = [
    "PAPERS",
    "SECTIONS",
    "Choice",
    "case_details",
    "check_document_path",
    "document_bytes",
    "save_document",
    "today",
]

PAPERS: Final = ("letter", "a4")

_WRITERS: Final[Mapping[str, tuple[Callable[[Document], bytes], tuple[str, ...]]]] = {
    ".pdf": (pdf_bytes, ("typst",)),
    ".docx": (docx_bytes, ("typst", "docx")),
}
"""Ending -> what writes such a file, and the libraries that it needs."""


@dataclass(frozen=True, slots=True)
class Choice:
    """What the report holds.

    Attributes:
        sections: of SECTIONS; empty for all.
        forecasts: names; empty for all.
        paper: one of PAPERS.
        case: what the cover says; a field that is empty is that of the workbook's table `xlmc_case`.
    """

    sections: Sequence[str] = ()
    forecasts: Sequence[str] = ()
    paper: str = "letter"
    case: CaseDetails = field(default_factory=CaseDetails)

    def check(self, simulation: Simulation | None = None) -> None:
        """Refuse what cannot be had.

        Args:
            simulation: the run, where there is one already.

        Raises:
            SimulationError: there is no such section, paper or forecast, or the date is none.
        """
        for section in self.sections:
            if section not in SECTIONS:
                hint = f"choose among {', '.join(SECTIONS)}"
                raise SimulationError(f"the report has no section {section!r}", hint=hint)
        if self.paper not in PAPERS:
            raise SimulationError(f"there is no paper {self.paper!r}", hint=f"choose {' or '.join(PAPERS)}")
        if self.case.date:
            _day(self.case.date)
        if simulation is not None:
            self.names(simulation)

    def names(self, simulation: Simulation) -> list[str]:
        """The names of the forecasts asked for, as the workbook writes them.

        Raises:
            SimulationError: there is no such forecast.
        """
        known = {name_key(name): name for name in simulation.results}
        for asked in self.forecasts:
            if name_key(asked) not in known:
                hint = f"choose among {', '.join(known.values())}"
                raise SimulationError(f"there is no forecast {asked!r}", hint=hint)
        return [known[name_key(asked)] for asked in self.forecasts] or list(known.values())


def save_document(
    simulation: Simulation,
    path: Path,
    choice: Choice | None = None,
    *,
    command: str | None = None,
    overwrite: bool = False,
) -> Path:
    """Write the report whole or not at all.

    Args:
        simulation: the finished run.
        path: where to; its ending, `.pdf` or `.docx`, says how.
        choice: what the report holds; all of it by default.
        command: what the person typed, for the record.
        overwrite: replace a file that is there: a report bears no mark of who wrote it.

    Returns:
        The path.

    Raises:
        TakenError: there is a file already.
        WorkbookError: the ending is another, or the file cannot be written.
        SimulationError: a library is missing, or the choice cannot be had.
    """
    check_document_path(path)
    choice = choice or Choice()
    choice.check(simulation)
    target = Target(path, simulation.model.workbook.name, overwrite)
    target.check()
    case = _merged(choice.case, simulation.model.definitions.case)
    document = describe(
        simulation,
        case,
        date=_day(case.date) if case.date else today(),
        paper=choice.paper,
        sections=choice.sections or tuple(SECTIONS),
        forecasts=choice.names(simulation),
        command=command,
    )
    write_workbook(path, document_bytes(document, path.suffix), target.check)
    return path


def document_bytes(document: Document, ending: str) -> bytes:
    """A document as a file with that ending.

    Raises:
        SimulationError: a library is missing.
    """
    write, _ = _WRITERS[ending.casefold()]
    return write(document)


def check_document_path(path: Path) -> None:
    """Refuse, before a long run, a file of another kind, one that `check_folder` refuses, or a missing library.

    Raises:
        WorkbookError: the ending is another, or the folder cannot be written to.
        SimulationError: a library is missing.
    """
    found = _WRITERS.get(path.suffix.casefold())
    if found is None:
        hint = f"Name it '{path.stem or 'report'}.pdf' or '{path.stem or 'report'}.docx'"
        raise WorkbookError("a report must end in .pdf or .docx", where=path, hint=hint)
    if any(find_spec(library) is None for library in found[1]):
        message = f"a report as {path.suffix} needs Typst and python-docx, which are not installed"
        raise SimulationError(message, hint="Install them: pip install 'xlmc[report]'")
    check_folder(path)


def case_details(given: Mapping[str, str]) -> CaseDetails:
    """What is said of a case, by field.

    Raises:
        SimulationError: there is no such field.
    """
    for key in given:
        if key not in CaseDetails.__slots__:
            raise SimulationError(f"a case has no {key!r}", hint=f"choose among {', '.join(CaseDetails.__slots__)}")
    return CaseDetails(**given)


def _merged(given: CaseDetails, own: CaseDetails) -> CaseDetails:
    """What was given, and what the workbook says where nothing was."""
    filled = {key: getattr(given, key) for key in CaseDetails.__slots__ if getattr(given, key)}
    return replace(own, **filled)


def _day(text: str) -> tuple[int, int, int]:
    try:
        found = date.fromisoformat(text)
    except ValueError:
        raise SimulationError(f"{text!r} is no date", hint="write it YYYY-MM-DD") from None
    return found.year, found.month, found.day


def today() -> tuple[int, int, int]:
    """The day on which a document is written: year, month, day."""
    now = date.today()
    return now.year, now.month, now.day
