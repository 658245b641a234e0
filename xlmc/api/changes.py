"""What a model in Python differs in from that of its workbook."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from xlmc.errors import SimulationError

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.scenarios import Scenario
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Changes", "run_of_a_file"]


@dataclass(frozen=True, slots=True)
class Changes:
    """What a model differs in from that of its workbook.

    Attributes:
        own: the model of the workbook.
        scenario: all changes.
    """

    own: CompiledModel
    scenario: Scenario

    @property
    def words(self) -> str:
        """The changes, as results say them."""
        from xlmc.analysis.results.statements.scenarios_in_words import changes_text

        return changes_text(self.scenario, self.own.definitions)

    def named_in(self, run: RunResult) -> RunResult:
        """Return the run with the sentence that it is none of the workbook as it is."""
        from xlmc.montecarlo.simulation.simulation import ChangedFrom

        book = self.own.workbook
        return replace(run, changed_from=ChangedFrom(book.name, book.sha256, tuple(self.words.split("; "))))


def run_of_a_file(run: RunResult, changes: Changes | None) -> RunResult:
    """Return the run of a workbook that says what was run: a copy with the changes typed in, where there are any.

    Raises:
        DefinitionError: a table lacks a column for a change.
        WorkbookError: a cell that changes holds a formula.
    """
    if changes is None:
        return run
    from xlmc.analysis.studies.scenario_workbook import edited_workbook
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.model.loading import build_model

    if changes.own.definitions.feeding is not None:
        hint = "Type the changes into the workbooks first, and run these"
        raise SimulationError("no file holds the workbooks of this run with their changes", hint=hint)
    book = read_workbook(
        edited_workbook(changes.own, changes.scenario).data, changes.own.workbook.name, changes.own.workbook.functions
    )
    model = build_model(book, changes.own.path, python=changes.own.definitions.python)
    return replace(run, model=model.changed(book, replace(model.definitions, settings=run.model.definitions.settings)))
