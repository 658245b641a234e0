"""Everything a workbook asks of a run, read from its reserved tables and from calls in its cells."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.formula.ir import Expression
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.crystal_ball.from_dialogs import FromDialogs, may_hold_blocks
from xlmc.montecarlo.definitions.crystal_ball.lost_data import remark_on_lost_data
from xlmc.montecarlo.definitions.crystal_ball.precision_control import with_precision
from xlmc.montecarlo.definitions.crystal_ball.refused import refused_forecasts, refused_rows
from xlmc.montecarlo.definitions.definitions import (
    Copula,
    Correlation,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Settings,
)
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.in_cells.suspects import InCells, suspects
from xlmc.montecarlo.definitions.number_styles import in_style
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.assumptions import read_assumptions
from xlmc.montecarlo.definitions.tables.correlations import read_correlations
from xlmc.montecarlo.definitions.tables.decisions import read_decisions
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter, read_evidence
from xlmc.montecarlo.definitions.tables.filters import read_checks, read_filters
from xlmc.montecarlo.definitions.tables.forecasts import read_forecasts
from xlmc.montecarlo.definitions.tables.identity import Claims
from xlmc.montecarlo.definitions.tables.read_once import refuse_varying
from xlmc.montecarlo.definitions.tables.reserved_tables import (
    CONVERTED,
    DefinitionTable,
    definition_tables,
    likely_table,
)
from xlmc.montecarlo.definitions.tables.settings import read_settings
from xlmc.montecarlo.definitions.tables.solves import read_solves, refuse_taken
from xlmc.montecarlo.definitions.tables.table_rows import holds_rows
from xlmc.montecarlo.definitions.unavailable import (
    TABLE_REASON,
    TablesOfRun,
    faults_of,
    remark_on_tables,
    remark_on_unavailable,
    tables_of_run,
)
from xlmc.montecarlo.definitions.xlrisk_sheet import read_xlrisk
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.scenarios import Scenario

__all__ = ["COMPUTED_BY", "NO_SWITCHES", "number_style_of", "read_definitions"]

NO_SWITCHES: Final[Mapping[str, bool]] = MappingProxyType({})

SAVE_AGAIN: Final = "Open the workbook in Excel with Crystal Ball, and save it again"


COMPUTED_BY: Final = "Computed by"
"""The heading of what computes a forecast or a filter that no formula computes."""


def number_style_of(workbook: Workbook) -> str:
    """Return the setting Number style of a workbook of which no more is asked; empty without one."""
    findings = Findings()
    settings, _, _ = read_settings(workbook, definition_tables(workbook, findings)["xlmc_settings"], (), findings)
    return settings.number_style


def read_definitions(
    workbook: Workbook,
    engines: Collection[str],
    tabulated: int = 1,
    switched: Mapping[str, bool] = NO_SWITCHES,
    python: Mapping[Cell, Expression] | None = None,
) -> Definitions:
    """Read what the tables `xlmc_assumptions`, `xlmc_forecasts`, … of a workbook say, and calls such as `RiskNormal`.

    Nothing is raised for a mistake in them: all mistakes are in `problems`, each with its cell and what to do.

    Args:
        workbook: that was read.
        engines: the names that its setting Engine may have.
        tabulated: which of its values every `RiskSimtable` gives, from 1.
        switched: filters and evidence that are used, or not, whatever their column Use says, by the keys of their
            names.
        python: the cells that a function of Python computes, each with the call; None for none.
    """
    findings = Findings()
    tables = definition_tables(workbook, findings)
    settings = read_settings(workbook, tables["xlmc_settings"], engines, findings)
    with in_style(settings[0].number_style):
        return _definitions(workbook, tables, settings, findings, tabulated, switched, python or {})


def _definitions(
    workbook: Workbook,
    tables: Mapping[str, list[DefinitionTable]],
    found_settings: tuple[Settings, float, Collection[str]],
    findings: Findings,
    tabulated: int,
    switched: Mapping[str, bool],
    python: Mapping[Cell, Expression],
) -> Definitions:
    """Return what the tables say beside the settings; see `read_definitions`."""
    settings, central, stated = found_settings
    uncertain, answers, tests = Claims("assumption"), Claims("forecast"), Claims("filter")
    solves = read_solves(workbook, tables["xlmc_solve"], Computed(workbook, drawn=()), findings)
    computed = Computed(workbook, drawn=uncertain.cells, python={*python, *(each.by for each in solves)})
    assumptions = read_assumptions(workbook, tables["xlmc_assumptions"], computed, uncertain, findings)
    forecasts = read_forecasts(workbook, tables["xlmc_forecasts"], computed, central, answers, findings)
    rows = read_filters(workbook, tables["xlmc_filters"], computed, tests, findings, switched)
    _refuse_without_function((*forecasts, *rows), python, findings)
    evidence = read_evidence(workbook, tables["xlmc_evidence"], computed, rows, findings, switched)
    unused = tuple(each for each in rows if not each.used)
    filters = *(each for each in rows if each.used), *(as_filter(each) for each in evidence if each.used)
    checks = read_checks(workbook, tables["xlmc_checks"], computed, Claims("check"), findings)
    if tables[CONVERTED]:
        refused_cells = refused_rows(workbook, tables[CONVERTED], uncertain.cells, findings)
        dialogs = FromDialogs(rewritten={**refused_cells}, stored=True)
    elif may_hold_blocks(workbook):
        from xlmc.montecarlo.definitions.crystal_ball.dialogs import read_dialogs  # few workbooks have them

        dialogs = read_dialogs(workbook, computed, central, uncertain, answers, findings)
    else:
        dialogs = FromDialogs()
    of_xlrisk = Findings()
    xlrisk = read_xlrisk(workbook, of_xlrisk)
    lognorm = settings.lognorm or ("@RISK" if xlrisk is None else "XLRisk")
    if any(True for _ in suspects(workbook)) or uncertain.calls:
        from xlmc.montecarlo.definitions.in_cells.calls import read_in_cells  # few workbooks have them

        calls = read_in_cells(workbook, computed, lognorm, uncertain, findings, tabulated)
    else:
        calls = InCells()
    if xlrisk is not None and calls:
        settings = xlrisk.settings(settings, stated, of_xlrisk)
        findings.add(of_xlrisk)
    if not dialogs.stored:
        remark_on_lost_data(workbook, bool(calls or any(tables.values())), findings)
    if not (dialogs or calls or any(tables.values())):
        remark_on_tables(workbook.data_tables, TablesOfRun(), findings)
        if not findings.problems:
            _say_how_to_begin(workbook, findings)
        return Definitions(notices=tuple(findings.notices), problems=tuple(findings.problems))

    names = {key: name for key, (name, _) in uncertain.names.items()}
    assumptions = *assumptions, *dialogs.assumptions, *calls.assumptions
    frozen = [each.name for each in assumptions if each.frozen]
    correlations = read_correlations(
        workbook, tables["xlmc_correlations"], tables["xlmc_correlation_matrix"], names, frozen, findings
    )
    correlations = *correlations, *_take_pairs(correlations, dialogs.correlations, findings)
    more, copulas = _joined(workbook, calls, correlations, findings)
    if xlrisk is not None:
        forecasts = *forecasts, *xlrisk.forecasts(computed, central, answers, findings)
    forecasts = *forecasts, *dialogs.forecasts
    if calls:
        from xlmc.montecarlo.definitions.in_cells.calls import in_cell_forecasts

        in_cells = in_cell_forecasts(workbook, calls, assumptions, computed, central, answers, findings)
        forecasts = *forecasts, *in_cells
    filters, own = _by_reach((*filters, *dialogs.filters), forecasts, answers, findings)
    _remark_on_calls(calls, settings, findings)
    decisions = read_decisions(workbook, tables["xlmc_decisions"], computed, findings)
    decisions = *decisions, *_not_in(decisions, dialogs.decisions)
    decisions = tuple(replace(each, base=each.value_of(workbook.content(each.cell).value)) for each in decisions)
    refuse_taken(solves, {each.cell: each.row for each in assumptions}, findings)
    drawn = {each.cell for each in assumptions if not each.frozen}
    what_if = tables_of_run(workbook, drawn, calls.shown.keys() | calls.unavailable.keys(), calls.rewritten)
    remark_on_tables(workbook.data_tables, what_if, findings)
    unavailable = {**calls.unavailable, **dict.fromkeys(faults_of(workbook, what_if.stale), TABLE_REASON)}
    remark_on_unavailable(calls.unavailable, findings)
    rewritten = {**dialogs.rewritten, **calls.rewritten, **faults_of(workbook, what_if.varying), **python}
    refuse_varying(workbook, tables, assumptions, rewritten, findings)
    asked = forecasts
    refused = tuple(DefinitionError(damage, where=workbook.name, hint=SAVE_AGAIN) for damage in dialogs.damages)
    if dialogs.refused:
        result = refused_forecasts(workbook, dialogs.refused, rewritten, assumptions, forecasts, filters, own, findings)
        refused = *refused, *result.values()
        forecasts = tuple(each for each in forecasts if each.name not in result)
    if refused and not forecasts:
        findings.problems += refused
    own, left_out = _parted(own, asked, forecasts)
    settings = with_precision(settings, stated, dialogs.precisions, forecasts, findings)
    if not (calls.assumptions or dialogs.assumptions):
        _refuse_no_assumption(workbook, calls, tables["xlmc_assumptions"], findings)
    if calls and not (forecasts or tables["xlmc_forecasts"] or refused):
        _say_how_to_mark(workbook, findings)
    elif not (forecasts or refused):
        _refuse_none(workbook, "forecast", tables["xlmc_forecasts"], findings)
    scenarios: tuple[Scenario, ...] = ()
    if calls.simtables:
        from xlmc.montecarlo.definitions.in_cells.stand_ins import simtable_scenarios

        scenarios = tuple(simtable_scenarios(calls.simtables, findings))
    if tables["xlmc_scenarios"]:
        from xlmc.montecarlo.definitions.tables.scenario_rows import read_scenarios

        scenarios = *read_scenarios(workbook, tables, assumptions, (*filters, *own, *unused), findings), *scenarios
    return Definitions(
        assumptions=assumptions,
        forecasts=forecasts,
        filters=filters,
        correlations=(*correlations, *more),
        copulas=copulas,
        settings=settings,
        notices=tuple(findings.notices),
        problems=tuple(findings.problems),
        rewritten=rewritten,
        results=calls.shown,
        unavailable=unavailable,
        checks=checks,
        evidence=evidence,
        refused=refused,
        scenarios=scenarios,
        forecast_filters=own,
        left_out=left_out,
        unused=unused,
        switches=dict(_switches([*rows, *evidence])),
        python=python,
        solves=solves,
        decisions=decisions,
    )


def _joined(
    workbook: Workbook, calls: InCells, correlations: Iterable[Correlation], findings: Findings
) -> tuple[list[Correlation], tuple[Copula, ...]]:
    """Return the correlations between draws in cells, beside those of tables, and the copulas that join them."""
    if not calls.assumptions:
        return [], ()
    from xlmc.montecarlo.definitions.in_cells.joined_draws import in_cell_copulas, in_cell_correlations

    more = in_cell_correlations(workbook, calls.assumptions, calls.draws, correlations, findings)
    return more, in_cell_copulas(workbook, calls.assumptions, calls.draws, (*correlations, *more), findings)


def _not_in(known: Iterable[Decision], more: Iterable[Decision]) -> Iterator[Decision]:
    """Return decisions of dialogs whose cells no row of a table has; of one name, those behind the first by cell."""
    cells, names = {each.cell for each in known}, {name_key(each.name) for each in known}
    for each in more:
        if each.cell not in cells:
            name = f"{each.name} ({each.cell})" if name_key(each.name) in names else each.name
            names.add(name_key(name))
            yield replace(each, name=name)


def _switches(rows: Iterable[Filter | Evidence]) -> Iterator[tuple[str, tuple[Cell, bool]]]:
    """Return the rows that can be used or not; see `Definitions`."""
    for each in rows:
        if each.can_be_used:
            yield each.name, (each.row, each.used)


def _refuse_without_function(rows: Iterable[Forecast | Filter], python: Container[Cell], findings: Findings) -> None:
    """Refuse numbers that a function of Python computed, where that function is not at hand."""
    lost = [each for each in rows if COMPUTED_BY in each.notes and each.cell not in python]
    if lost:
        names = ", ".join(dict.fromkeys(repr(each.name) for each in lost))
        hint = (
            "Run it from Python, where the function is: xlmc.model(function, …); a saved run is opened beside it: "
            "xlmc.open_run(path, model)"
        )
        by = lost[0].notes[COMPUTED_BY]
        findings.problem(f"The {by} computes {names}, and a workbook does not hold it", lost[0].cell, hint)


def _remark_on_calls(calls: InCells, settings: Settings, findings: Findings) -> None:
    for name, cell in calls.idle.items():
        findings.notice(f"{name} has no effect: every draw has its own stream, by its name and the run's seed", cell)
    if calls.lognorms and not settings.lognorm:
        message = (
            "RiskLognorm is read as @RISK's: its numbers are the mean and standard deviation of the draw. XLRisk means "
            "those of the logarithm: for that, set Lognorm to XLRisk in the table xlmc_settings"
        )
        findings.notice(message, calls.lognorms[0])


def _take_pairs(taken: Sequence[Correlation], more: Iterable[Correlation], findings: Findings) -> Iterator[Correlation]:
    """Return the correlations of dialogs that no row of a table is about."""
    rows = {frozenset((row.first, row.second)): row for row in taken}
    for each in more:
        row = rows.get(frozenset((each.first, each.second)))
        if row is None:
            yield each
        else:
            message = f"{each.first!r} and {each.second!r} are correlated by this row and by Crystal Ball ({each.row})"
            findings.problem(message, row.row, "Keep one of them")


def _by_reach(
    filters: Iterable[Filter], forecasts: Sequence[Forecast], claims: Claims, findings: Findings
) -> tuple[tuple[Filter, ...], tuple[Filter, ...]]:
    """Return the filters of all forecasts, and those of some only, with these forecasts as they are called.

    `claims` has the names of forecasts whose rows have mistakes, too.
    """
    names = {key: name for key, (name, _) in claims.names.items()}
    names |= {name_key(each.name): each.name for each in forecasts}
    everywhere: list[Filter] = []
    own: list[Filter] = []
    for each in filters:
        unknown = [name for name in each.only_for if name_key(name) not in names]
        if unknown:
            hint = did_you_mean(unknown[0], names.values()) if names else "Define the forecast first"
            findings.problem(f"Only for names {unknown[0]!r}, and no forecast is called so", each.row, hint)
        elif each.only_for:
            called = dict.fromkeys(names[name_key(name)] for name in each.only_for)
            own.append(replace(each, only_for=tuple(called)))
        else:
            everywhere.append(each)
    return tuple(everywhere), tuple(own)


def _parted(
    own: Iterable[Filter], every: Iterable[Forecast], left: Sequence[Forecast]
) -> tuple[tuple[Filter, ...], tuple[Forecast | Filter, ...]]:
    """Return the filters of some forecasts only, of those that can be run; the other forecasts, and filters
    of theirs.
    """
    names = {each.name for each in left}
    wanted_filters: list[Filter] = []
    out: list[Forecast | Filter] = [each for each in every if each.name not in names]
    for each in own:
        for result, wanted in ((wanted_filters, True), (out, False)):
            of = tuple(name for name in each.only_for if (name in names) == wanted)
            if of:
                result.append(replace(each, only_for=of))
    return tuple(wanted_filters), tuple(out)


def _refuse_no_assumption(
    workbook: Workbook, calls: InCells, tables: list[DefinitionTable], findings: Findings
) -> None:
    """Say why no cell draws, where calls were meant to."""
    refused = [error for error in calls.refused if not any(error.where == known.where for known in findings.problems)]
    if any(holds_rows(workbook, table) for table in tables):
        return
    findings.problems += [DefinitionError(error.message, where=error.where, hint=error.hint) for error in refused]
    if not any(calls.refused):
        _refuse_none(workbook, "assumption", tables, findings)


def _say_how_to_mark(workbook: Workbook, findings: Findings) -> None:
    if findings.problems:
        return  # the answer may be in a cell that cannot be read
    findings.problem(
        "The workbook draws at random, and marks no cell as an answer",
        workbook.name,
        'Write RiskOutput("its name")+ in front of the formula of the answer, or list it in a table xlmc_forecasts',
    )


def _say_how_to_begin(workbook: Workbook, findings: Findings) -> None:
    if _point_out_likely(workbook, _MODEL, findings):
        return
    findings.problem(
        "The workbook holds no xlmc tables, so there is nothing to run",
        workbook.name,
        f"xlmc prepare {workbook.name} adds xlmc_assumptions and the others, with rows for its inputs and answers;"
        " xlmc new lists templates",
    )


_MODEL: Final = ("xlmc_assumptions", "xlmc_forecasts", "xlmc_filters")


def _point_out_likely(workbook: Workbook, kinds: Iterable[str], findings: Findings) -> bool:
    """Tell of tables that only lack the name of a reserved one; whether there are any."""
    result = [(kind, table) for kind in kinds if (table := likely_table(workbook, kind)) is not None]
    for kind, table in result:
        message = f"The table {table.name} has the headings of {kind}, and is not read under its name"
        where = Cell(table.area.sheet, table.area.top, table.area.left)
        findings.problem(message, where, f"Rename it {kind} (click into it, then Table Design ▸ Table Name)")
    return bool(result)


def _refuse_none(workbook: Workbook, what: str, tables: list[DefinitionTable], findings: Findings) -> None:
    """Without a forecast there is no answer, and without an assumption it does not vary."""
    if any(holds_rows(workbook, table) for table in tables):
        return
    if tables:
        findings.problem(f"The table {tables[0].table.name} holds no {what}", tables[0].where, "Fill in a row")
    elif not _point_out_likely(workbook, [f"xlmc_{what}s"], findings):
        hint = f"xlmc prepare {workbook.name} adds a table xlmc_{what}s with rows to choose from"
        findings.problem(f"The workbook defines no {what}", workbook.name, hint)
