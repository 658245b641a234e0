"""Calls in cells that stand for assumptions: `=10+RiskNormal(5,1)*2`, `=CB.Uniform(0,1)`, `=NORM.INV(RAND(),5,1)`.

Each call is an assumption of its own. It is called as it names itself, or else by the label beside its cell, and drawn
by its own name or by that of the call: `Sheet!Cell#k` for the k-th call of the cell, from the left and from 1. In the
formula a cell of its own stands instead of the call; an argument that is an expression
becomes such a cell, too. So the rest of a run sees nothing but assumptions and formulas.

Formulas also mark answers, by `RiskOutput` or by a cell that shows results of theirs, and `RiskCorrmat` names matrices
of rank correlations.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.labels import Label, label_of
from xlmc.excel.workbook.workbook import Formula, Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Assumption, Forecast
from xlmc.montecarlo.definitions.in_cells.call_arguments import number_of
from xlmc.montecarlo.definitions.in_cells.reading import CellReading
from xlmc.montecarlo.definitions.in_cells.result_functions import mentions_result
from xlmc.montecarlo.definitions.in_cells.suspects import InCells, suspects, without_texts
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.identity import Claims
from xlmc.montecarlo.definitions.tables.table_rows import static_value
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.number_text import number_text

__all__ = ["in_cell_forecasts", "read_in_cells"]

_OUTPUT: Final = re.compile(r"RiskOutput\s*\(", re.IGNORECASE)


def read_in_cells(
    workbook: Workbook,
    computed: Computed,
    lognorm: str,
    claims: Claims,
    findings: Findings,
    tabulated: int = 1,
) -> InCells:
    """Every call in the formulas of a workbook.

    Args:
        workbook: to look through.
        computed: which cells something gives a value.
        lognorm: whose `RiskLognorm` is meant, `@RISK` or `XLRisk`.
        claims: takes the names of assumptions; those of the tables are taken, and so are the calls that rows stand for.
        findings: takes remarks, and the rows that stand for a call that is not there.
        tabulated: which of its values every `RiskSimtable` gives, from 1.
    """
    result = InCells()
    resolver = Resolver(workbook, claims.cells)
    bases: dict[Cell, float | None] = {}
    rows = {call: cell for call, (_, cell) in claims.calls.items()}
    for cell, formula in suspects(workbook):
        reading = CellReading(workbook, computed, lognorm, bases, cell, rows, tabulated)
        try:
            result.rewritten[cell] = reading.rewrite(resolver.formula(cell, formula))
            _take(reading, result, claims, findings)
        except (FormulaError, DefinitionError) as error:
            result.rewritten[cell] = refused = _about(error, cell, formula)
            if _OUTPUT.search(formula.text) and not reading.asked:  # others are reported if anything needs the cell
                findings.problems.append(DefinitionError(refused.message, where=cell, hint=refused.hint))
            if reading.unavailable or (not reading.asked and mentions_result(without_texts(formula.text))):
                result.unavailable[cell] = reading.unavailable or refused.message
        if reading.asked:
            result.results[cell] = reading.asked
        if reading.shown is not None and (reading.asked or not isinstance(result.rewritten[cell], FormulaError)):
            result.shown[cell] = reading.shown
    _refuse_simulations(workbook, result)
    for call, (name, cell) in claims.calls.items():
        if call not in result.taken:
            message = f"the row {name!r} replaces the call {call}, and there is no such call"
            findings.problem(message, claims.cells[cell], "Correct Call in and Call, or clear both")
    return result


def _refuse_simulations(workbook: Workbook, reading: InCells) -> None:
    """Take results of a simulation that no value of a `RiskSimtable` makes for unavailable."""
    most = max((len(values) for tables in reading.simtables.values() for values in tables), default=1)
    for cell, asked in reading.results.items():
        for each in asked:
            number = (
                None if each.simulation is None else number_of(each.simulation, lambda at: static_value(at, workbook))
            )
            if number is not None and number not in range(1, most + 1):
                of = "RiskSimtable has no values" if most == 1 else f"RiskSimtable has {most} values"
                reading.unavailable.setdefault(
                    cell, f"{each.function} asks for simulation {number_text(number)}, and {of}"
                )


def _take(reading: CellReading, result: InCells, claims: Claims, findings: Findings) -> None:
    """Add what one cell says."""
    host = reading.host
    result.rewritten |= reading.trees
    result.taken |= reading.taken
    result.shifted |= {site: (host, tree) for site, tree in reading.shifted.items()}
    alone = reading.draws_alone(result.rewritten[host])
    for position in sorted(reading.draws):
        draw = reading.draws[position]
        assumption = replace(draw.assumption, name=_free_name(draw.assumption, claims, findings))
        if draw.properties.name is None:
            assumption = _labelled(assumption, reading.label, alone, claims)
        result.assumptions.append(assumption)
        result.draws[assumption.name] = draw
    for name in reading.idle:
        result.idle.setdefault(name, host)
    if reading.output is not None:
        result.outputs[host] = reading.output
    if reading.has_lognorm:
        result.lognorms.append(host)
    if reading.simtables:
        result.simtables[host] = reading.simtables


def _free_name(assumption: Assumption, claims: Claims, findings: Findings) -> str:
    """Return the draw's own name, followed by its cell where another draw has that name."""
    name = assumption.name
    if name_key(name) in claims.names:
        name = f"{name} ({assumption.cell})"
        message = f"another assumption is called {assumption.name!r}; this one is called {name!r}"
        findings.notice(message, assumption.row)
    return claims.take_name(name, assumption.row)


def _labelled(assumption: Assumption, label: Label, alone: bool, claims: Claims) -> Assumption:
    """Return a draw under the label beside its cell, drawn by the name of its call: `Price`, or `Price #2` for the
    second call of a formula that is more than one call.

    Where another assumption has that name, the cell follows; without a label it keeps the name of its call.
    """
    if not label.name:
        return assumption
    stream, cell = assumption.name, assumption.row
    name = label.name if alone else f"{label.name} #{stream.rpartition('#')[2]}"
    if name_key(name) in claims.names:
        name = f"{name} ({cell})"
    if name_key(name) in claims.names:
        return assumption
    claims.names[name_key(stream)] = name, cell  # by which it may be called, too
    return replace(assumption, name=claims.take_name(name, cell), stream=stream, units=assumption.units or label.unit)


def _about(error: FormulaError | DefinitionError, cell: Cell, formula: Formula) -> FormulaError:
    """Return the error with this cell as its location; one about a cell that the formula names says so."""
    if isinstance(error, FormulaError):
        text = formula.text if error.text is None else error.text
        return FormulaError(error.message, where=cell, hint=error.hint, text=text, span=error.span)
    return FormulaError(f"{error.message} ({error.where})", where=cell, hint=error.hint, text=formula.text)


def in_cell_forecasts(
    workbook: Workbook,
    reading: InCells,
    assumptions: Iterable[Assumption],
    computed: Computed,
    central: float,
    claims: Claims,
    findings: Findings,
) -> list[Forecast]:
    """Return the cells with `RiskOutput`, then those of which `RiskMean(B9)` and its like show results.

    Args:
        workbook: whose labels the cells are called by where the calls do not name them.
        reading: the calls of the workbook.
        assumptions: all, about which results may be asked for by their names.
        computed: which cells something gives a value.
        central: the share of the central range.
        claims: takes their names and cells; the rows of tables have taken theirs.
        findings: takes remarks.
    """
    outputs = []
    for cell, output in reading.outputs.items():
        if cell not in claims.cells:
            label = Label() if output.name else label_of(workbook, cell)
            name = _take_forecast(output.name or label.name or str(cell), cell, claims, findings)
            outputs.append(Forecast(name, cell, cell, output.units or label.unit, central))
    shown = []
    inputs = by_names(assumptions)
    for cell, asked in reading.results.items():
        for each in asked:
            for of in each.forecasts:
                if isinstance(of, str) and name_key(of) in inputs and name_key(of) not in claims.names:
                    shown.append(
                        _of_input(inputs[name_key(of)], reading, each.function, cell, central, claims, findings)
                    )
                elif isinstance(of, str):
                    _remark_on_name(of, each.function, cell, claims, findings)
                elif not computed.at_all(of):
                    message = f"{each.function} asks for results of {of}, which nothing computes: nothing is shown"
                    findings.notice(message, cell)
                elif of not in claims.cells:
                    message = f"{of} is taken for a forecast, because {each.function} shows results of it"
                    findings.notice(message, cell)
                    label = label_of(workbook, of)
                    name = _take_forecast(label.name or str(of), of, claims, findings)
                    shown.append(Forecast(name, of, cell, label.unit, central))
    return [*outputs, *shown]


def _of_input(
    of: Assumption, reading: InCells, function: str, cell: Cell, central: float, claims: Claims, findings: Findings
) -> Forecast:
    """Make a forecast of a draw itself, shifted where its call says so."""
    message = f"the draws of {of.name!r} are taken for a forecast, because {function} shows results of them"
    findings.notice(message, cell)
    site = of.cell
    if site in reading.shifted:
        host, tree = reading.shifted[site]
        site = InFormula.of(host, f"{of.name} shifted")
        reading.rewritten[site] = tree
    if site not in claims.cells:
        claims.take_cell(site, cell)
    return Forecast(claims.take_name(of.name, cell), site, cell, of.units, central)


def _take_forecast(name: str, cell: Cell, claims: Claims, findings: Findings) -> str:
    """Take the cell, and the name, with its cell behind it where another has that name."""
    claims.take_cell(cell, cell)
    if name_key(name) in claims.names:
        findings.notice(f"another forecast is called {name!r}; this one is called '{name} ({cell})'", cell)
        name = f"{name} ({cell})"
    return claims.take_name(name, cell)


def _remark_on_name(name: str, function: str, cell: Cell, claims: Claims, findings: Findings) -> None:
    if name_key(name) not in claims.names:
        message = f"{function} asks for results of {name!r}, and no forecast is called so: nothing is shown"
        findings.notice(message, cell)
