"""Checks, verification, replay and conversion of a workbook's file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from xlmc.api.models import functions_of
from xlmc.errors import DefinitionError, XlmcError
from xlmc.montecarlo.model import loading

if TYPE_CHECKING:
    from xlmc.analysis.studies.seek import Solutions
    from xlmc.analysis.studies.verify import Verification
    from xlmc.api.models import Model
    from xlmc.outputs.replay import Replayed

__all__ = ["check", "convert", "replay", "seek", "verify"]


def check(path: str | Path, *, functions: str | Path | None = None) -> tuple[XlmcError, ...]:
    """Return every problem of a workbook, each with its cell: what keeps it from being run, and impossible scenarios.

    Args:
        path: of the workbook.
        functions: a file of Python, which is run: its functions compute what formulas call by their names.

    Raises:
        WorkbookError: the file cannot be read.
    """
    from xlmc.analysis.studies.scenario_answers import scenario_faults
    from xlmc.engine.engines import ENGINES
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels

    own = functions_of(functions)
    problems = read_definitions(calculate_labels(read_workbook(path, functions=own)), ENGINES).problems
    if problems:
        return problems
    try:
        return tuple(scenario_faults(loading.load(path, functions=own)).values())
    except XlmcError as error:
        return (error,)


def seek(
    path: str | Path,
    cell: str,
    to: float,
    by: str,
    *,
    low: float | None = None,
    high: float | None = None,
    functions: str | Path | None = None,
) -> Solutions:
    """Find the values of one cell at which another is what it is to be, every other input as the workbook has it.

    Args:
        path: of the workbook, which need not have any table of xlmc.
        cell: the one with a formula, `Model!D9` or a defined name.
        to: what it is to be.
        by: the one to vary, without a formula; it may be an assumption.
        low: the least value of that; it comes with `high`. Without them the search goes outwards from its own value.
        high: the largest one.
        functions: as for `check`.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError: a cell is none, or the one does not depend on the other.
        SimulationError: an argument is out of its range, or an assumption has no base value.
        FormulaError: a cell between them cannot be computed.
    """
    from xlmc.analysis.studies.seek import seek

    return seek(path, cell, to, by, low=low, high=high, functions=functions_of(functions))


def verify(path: str | Path, *, everything: bool = False, functions: str | Path | None = None) -> Verification:
    """Compute the formulas of a workbook again at the base case, and compare with the values that Excel saved.

    Args:
        path: of the workbook.
        everything: every formula cell, not only those that forecasts and filters need.
        functions: as for `check`.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError: it defines neither a forecast nor a filter, and not everything is asked for.
    """
    from xlmc.analysis.studies.verify import verify
    from xlmc.engine.engines import ENGINES
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels

    workbook = read_workbook(path, functions=functions_of(functions))
    if everything:
        return verify(workbook)
    definitions = read_definitions(calculate_labels(workbook), ENGINES)
    if not definitions.forecasts and not definitions.filters:
        message, hint = "The workbook has no forecasts and no filters", "Give everything=True to check every formula"
        raise DefinitionError(message, where=workbook.name, hint=hint)
    return verify(workbook, definitions)


def replay(
    path: str | Path, *, jobs: int = 1, model: Model | None = None, functions: str | Path | None = None
) -> Replayed:
    """Repeat the run that a result workbook or a saved run records, and say whether it is identical.

    Args:
        path: a result workbook, or a saved run.
        jobs: threads or processes.
        model: of `xlmc.model`, where a function of Python computed the run.
        functions: the file of Python whose functions the run's formulas called: it must be the same.

    Raises:
        WorkbookError: the file cannot be read, or holds no record.
        XlmcError: its workbook cannot be run.
    """
    from xlmc.outputs.replay import replay

    python = None if model is None else model._compiled.definitions.python
    return replay(path, jobs=jobs, python=python, functions=functions_of(functions))


def convert(path: str | Path, to: str | Path, *, overwrite: bool = False, functions: str | Path | None = None) -> Path:
    """Write a copy of a workbook of Crystal Ball or @RISK with its definitions as tables, and give the path back.

    Raises:
        WorkbookError: there is nothing to convert, or the file cannot be written.
        DefinitionError, FormulaError: the workbook cannot be understood.
    """
    from xlmc.outputs.conversion.convert import convert

    convert(loading.load(path, functions=functions_of(functions)), Path(to), overwrite=overwrite)
    return Path(to)
