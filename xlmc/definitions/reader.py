"""Everything a workbook asks of a run, read from its reserved tables."""

from __future__ import annotations

from xlmc.definitions.assumptions import read_assumptions
from xlmc.definitions.computed import Computed
from xlmc.definitions.correlations import read_correlations
from xlmc.definitions.filters import read_filters
from xlmc.definitions.findings import Findings
from xlmc.definitions.forecasts import read_forecasts
from xlmc.definitions.identity import Claims
from xlmc.definitions.model import Definitions, name_key
from xlmc.definitions.settings import read_settings
from xlmc.definitions.tables import DefinitionTable, definition_tables, holds_rows
from xlmc.workbook.model import Workbook

__all__ = ["read_definitions"]


def read_definitions(workbook: Workbook) -> Definitions:
    """What the tables `xlmc_assumptions`, `xlmc_forecasts`, … of a workbook say.

    Nothing is raised for a mistake in them: all mistakes are in `problems`, each with its cell and what to do.
    """
    findings = Findings()
    tables = definition_tables(workbook, findings)
    if not any(tables.values()):
        _say_how_to_begin(workbook, findings)
        return Definitions(notices=tuple(findings.notices), problems=tuple(findings.problems))

    uncertain, answers, tests = Claims("assumption"), Claims("forecast"), Claims("filter")
    settings, central = read_settings(workbook, tables["xlmc_settings"], findings)
    computed = Computed(workbook, drawn=uncertain.cells)
    assumptions = read_assumptions(workbook, tables["xlmc_assumptions"], computed, uncertain, findings)
    forecasts = read_forecasts(workbook, tables["xlmc_forecasts"], computed, central, answers, findings)
    filters = read_filters(workbook, tables["xlmc_filters"], computed, tests, findings)
    names = {key: name for key, (name, _) in uncertain.names.items()}
    frozen = [name_key(each.name) for each in assumptions if each.frozen]
    correlations = read_correlations(workbook, tables["xlmc_correlations"], names, frozen, findings)
    _refuse_none(workbook, "assumption", tables["xlmc_assumptions"], findings)
    _refuse_none(workbook, "forecast", tables["xlmc_forecasts"], findings)
    return Definitions(
        assumptions=assumptions,
        forecasts=forecasts,
        filters=filters,
        correlations=correlations,
        settings=settings,
        notices=tuple(findings.notices),
        problems=tuple(findings.problems),
    )


def _say_how_to_begin(workbook: Workbook, findings: Findings) -> None:
    findings.problem(
        "The workbook holds no xlmc tables, so there is nothing to run",
        workbook.name,
        "Insert ▸ Table, then name it xlmc_assumptions, xlmc_forecasts or xlmc_filters under Table Design;"
        " or start from a template with xlmc new",
    )


def _refuse_none(workbook: Workbook, what: str, tables: list[DefinitionTable], findings: Findings) -> None:
    """Without a forecast there is no answer, and without an assumption it does not vary."""
    if any(holds_rows(workbook, table) for table in tables):
        return
    if tables:
        findings.problem(f"The table {tables[0].table.name} holds no {what}", tables[0].where, "Fill in a row")
    else:
        findings.problem(f"The workbook defines no {what}", workbook.name, f"Add a table named xlmc_{what}s")
