"""What a workbook's dialogs and calls define, as rows of tables: what each cell of a row holds.

Definitions that stand in tables already stay where they are. A row that stands for a call has a cell of its own, under
`Value`, that is drawn in the call's place; the formula with the call stays as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, InFormula
from xlmc.excel.formula import formula_text, ir
from xlmc.excel.formula.substitute import substitute
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import (
    CUTOFFS,
    DIALOG,
    Assumption,
    Correlation,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Parameter,
)
from xlmc.montecarlo.definitions.stating import Role
from xlmc.montecarlo.definitions.stopping import Precision
from xlmc.montecarlo.definitions.tables.assumptions import STREAM
from xlmc.montecarlo.definitions.tables.settings import LEAST_PERCENT
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.solved_member import SolvedMember

__all__ = ["Block", "Entry", "Formula", "NewRow", "NewTable", "new_tables", "text_of"]


@dataclass(frozen=True, slots=True)
class Formula:
    """A formula that is to be written: a tree in which the cells of calls are those calls; and its value, if known."""

    tree: ir.Expression
    value: object = None


@dataclass(frozen=True, slots=True)
class Block:
    """Numbers that a distribution is made from, to be written below the tables; the cell names their range."""

    rows: tuple[tuple[float | Formula | None, ...], ...]


Entry = str | float | bool | Formula | Block


@dataclass(frozen=True, slots=True)
class NewRow:
    """A row: heading -> what its cell holds.

    Attributes:
        what: for people: `assumption`, `forecast`, …
        name: of what it defines.
        where: the cell in the workbook.
        was: what said so there.
        call: that it stands for; its cell under Value is drawn instead.
    """

    cells: Mapping[str, Entry]
    what: str
    name: str
    where: object
    was: str
    call: InFormula | None = None


@dataclass(frozen=True, slots=True)
class NewTable:
    """A table: the start of its name, its headings in order, its rows."""

    kind: str
    rows: tuple[NewRow, ...]
    headings: tuple[str, ...] = field(default=())


def new_tables(workbook: Workbook, definitions: Definitions) -> list[NewTable]:
    """Make the tables for all that stands in none yet; those without rows are left out.

    Args:
        workbook: that was read.
        definitions: what it defines.
    """
    tables = [table.area for table in workbook.tables if table.name.casefold().startswith("xlmc")]

    def is_new(row: Cell) -> bool:
        return not any(row in area for area in tables)

    drawn = [each for each in definitions.assumptions if isinstance(each.cell, InFormula) or is_new(each.row)]
    calls = [each for each in drawn if isinstance(each.cell, InFormula)]
    joined = {name for copula in definitions.copulas for name in copula.names}  # no table says a copula
    rows = [each for each in calls if each.name not in joined and _can_be_a_row(each)]
    written = _Written(workbook, definitions)
    filters = [each for each in _filters(definitions) if is_new(each.row)]
    every = (*definitions.forecasts, *(each for each in definitions.left_out if isinstance(each, Forecast)))
    answers = [each for each in every if not isinstance(each.cell, InFormula)]  # no cell holds a draw of a formula
    made = [
        NewTable("xlmc_assumptions", tuple(map(written.dialog, (each for each in drawn if each not in calls)))),
        NewTable("xlmc_assumptions", tuple(map(written.call, rows))),
        NewTable("xlmc_forecasts", tuple(map(written.forecast, (f for f in answers if is_new(f.row))))),
        NewTable("xlmc_filters", tuple(map(written.filter, filters))),
        NewTable("xlmc_correlations", tuple(map(written.correlation, _new_pairs(definitions, is_new)))),
        NewTable("xlmc_decisions", tuple(map(written.decision, (d for d in definitions.decisions if is_new(d.row))))),
        NewTable("xlmc_settings", tuple(_settings(workbook, definitions))),
    ]
    return [NewTable(each.kind, each.rows, tuple(_headings(each.rows))) for each in made if each.rows]


def _settings(workbook: Workbook, definitions: Definitions) -> Iterator[NewRow]:
    """Return what a run of dialogs takes that no workbook of Crystal Ball holds, and the precision that dialogs ask
    for.
    """
    drawn = any(each.source == DIALOG for each in definitions.assumptions)
    if not drawn or any(table.name.casefold().startswith("xlmc_settings") for table in workbook.tables):
        return
    settings = definitions.settings
    names, goal = settings.stopping.forecasts, settings.stopping.goal
    rows: dict[str, Entry] = {} if goal is not None else {"Trials": float(settings.trials)}
    rows |= {"Seed": float(settings.seed), "Sampling": settings.sampling}
    own = tuple(rows)
    if isinstance(goal, Precision) and _can_be_rows(goal, names):
        width = {"Precision %": _percent(goal)} if goal.relative else {"Precision": goal.tolerance}
        rows |= {**width, "Precision of": ", ".join(goal.numbers), "Confidence %": 100.0 * goal.confidence}
        rows |= {"Look at": "; ".join(names)} if names else {}
    for name, value in rows.items():
        was = "xlmc's own; Crystal Ball's is not in the workbook" if name in own else "precision control"
        yield NewRow({"Setting": name, "Value": value}, "setting", name, "", was)


def _can_be_rows(goal: Precision, names: Iterable[str]) -> bool:
    """Whether rows of settings can say it: a share is not so small that it looks like a mistake; `;` parts names."""
    return not (goal.relative and _percent(goal) < LEAST_PERCENT) and not any(";" in name for name in names)


def _percent(goal: Precision) -> float:
    """Write a share in percent, as people do."""
    return float(f"{100.0 * goal.tolerance:.12g}")


def _new_pairs(definitions: Definitions, is_new: Callable[[Cell], bool]) -> Iterator[Correlation]:
    """Return the correlations of dialogs and of matrices; the row of one in a table lies in the table."""
    return (each for each in definitions.correlations if is_new(each.row))


def _filters(definitions: Definitions) -> list[Filter]:
    """All filters, those of forecasts that cannot be run among them."""
    filters = [*definitions.filters, *definitions.forecast_filters]
    for each in definitions.left_out:
        if isinstance(each, Filter):
            same = next(
                (at for at, other in enumerate(filters) if (other.name, other.row) == (each.name, each.row)), None
            )
            if same is None:
                filters.append(each)
            else:
                filters[same] = replace(filters[same], only_for=(*filters[same].only_for, *each.only_for))
    return filters


def _can_be_a_row(assumption: Assumption) -> bool:
    """Whether a row of a table can say it: a family that a table knows, by parameters, percentiles or data."""
    own = assumption.own_family
    return own is None or isinstance(own, SolvedMember) or assumption.data is not None


def _headings(rows: Iterable[NewRow]) -> dict[str, None]:
    """All headings that a row fills in, those that every row has in front."""
    result: dict[str, None] = {}
    for row in rows:
        result |= dict.fromkeys(heading for heading, entry in row.cells.items() if entry != "" or heading == "Value")
    if "Setting" in result:
        return result
    between = [each for each in result if each not in (*_FIRST, *_LAST)]
    return dict.fromkeys(each for each in (*_FIRST, *between, *_LAST) if each in result)


_FIRST = ("Name", "Value", "Cell", "Call in", "Call", "Distribution")
_ANSWER = ("Units", "Threshold", "Certainty from", "Certainty to", "Report to", "Kind", "Role")
_LAST = (*CUTOFFS.values(), *_ANSWER, "Frozen", "Source", "Only for", "Because", DIALOG)


class _Written:
    """Writes rows of one workbook."""

    def __init__(self, workbook: Workbook, definitions: Definitions) -> None:
        self._workbook, self._rewritten = workbook, definitions.rewritten

    def dialog(self, each: Assumption) -> NewRow:
        """Write the row of an assumption of a dialog."""
        cells: dict[str, Entry] = {"Name": each.name, "Cell": self._reference(each.cell), **self._distribution(each)}
        return NewRow(cells, "assumption", each.name, each.cell, _was(each.notes))

    def call(self, each: Assumption) -> NewRow:
        """Write the row of a call that draws."""
        assert isinstance(each.cell, InFormula)
        cells: dict[str, Entry] = {"Name": each.name}
        cells |= {"Value": "" if each.base is None else each.base, "Call in": self._reference(each.cell.host)}
        cells |= {"Call": _label(each.cell), **self._distribution(each)}
        cells |= {STREAM: each.stream} if each.stream else {}
        return NewRow(cells, "assumption", each.name, each.cell, _was(each.notes), each.cell)

    def forecast(self, each: Forecast) -> NewRow:
        """Write the row of a forecast."""
        cells: dict[str, Entry] = {"Name": each.name, "Cell": self._reference(each.cell), "Units": each.units}
        cells |= {} if each.threshold is None else {"Threshold": each.threshold}
        ends = zip(("Certainty from", "Certainty to"), each.asked or (), strict=False)
        cells |= {heading: end for heading, end in ends if math.isfinite(end)}
        cells |= {} if each.report_to is None else {"Report to": each.report_to}
        cells |= {} if each.kind is None else {"Kind": each.kind.value}
        cells |= {} if each.role is Role.ANSWER else {"Role": each.role.value}
        return NewRow(cells, "forecast", each.name, each.cell, _was(each.notes) or "an answer of the formula")

    def filter(self, each: Filter) -> NewRow:
        """Write the row of a filter of a forecast; a filter whose cell is a test of its own has it under Value."""
        cells: dict[str, Entry] = {"Name": each.name}
        test = self._rewritten.get(each.cell) if isinstance(each.cell, InFormula) else None
        if isinstance(test, FormulaError) or test is None:
            cells["Cell"] = self._reference(each.cell)
        else:
            cells["Value"] = Formula(test)
        limits = {"At least": each.at_least, "At most": each.at_most, "Above": each.above, "Below": each.below}
        cells |= {heading: self._parameter(limit) for heading, limit in limits.items() if limit is not None}
        cells |= {"Only for": "; ".join(each.only_for), "Because": each.because}
        return NewRow(cells, "filter", each.name, each.row, "the filter of a forecast")

    def correlation(self, each: Correlation) -> NewRow:
        """Write the row of a rank correlation. Its number may come from another program's computation."""
        cells: dict[str, Entry] = {
            "First": each.first,
            "Second": each.second,
            "Correlation": self._parameter(each.value),
        }
        return NewRow(cells, "correlation", f"{each.first} and {each.second}", each.row, "a rank correlation")

    def decision(self, each: Decision) -> NewRow:
        """Write the row of a decision variable, whose values lie a step apart."""
        low, second, high = each.values[0], each.values[1], each.values[-1]
        step = float(f"{second - low:.12g}")
        cells: dict[str, Entry] = {"Name": each.name, "Cell": self._reference(each.cell)}
        cells |= {"Low": low, "High": high, "Step": step}
        return NewRow(cells, "decision", each.name, each.cell, "a decision variable")

    def _distribution(self, each: Assumption) -> dict[str, Entry]:
        cells: dict[str, Entry] = {"Distribution": FAMILIES[each.distribution].name}
        cells |= {
            spec.headings[0]: self._parameter(each.parameters[spec.key])
            for spec in each.family.parameters
            if spec.key in each.parameters
        }
        if each.data is not None:
            rows = (tuple(None if v is None else self._number(v) for v in row) for row in each.data.rows)
            cells["Data"] = Block(tuple(rows))
            cells |= {"Cumulative": True} if each.data.cumulative else {}
            cells |= {} if each.data.bandwidth is None else {"Bandwidth": self._parameter(each.data.bandwidth)}
        cells |= {CUTOFFS[key]: self._parameter(value) for key, value in each.cutoffs.items()}
        cells |= {"Units": each.units, "Source": each.source}
        return cells | ({"Frozen": True} if each.frozen else {})

    def _number(self, value: Parameter) -> float | Formula:
        return self._formula(value) if isinstance(value, Cell) else value

    def _parameter(self, value: Parameter) -> Entry:
        return self._number(value)

    def _reference(self, cell: Cell) -> Formula:
        return Formula(cell, self._workbook.content(cell).value)

    def _formula(self, cell: Cell) -> Formula:
        """Return what a parameter is computed from; expressions in calls are written out."""
        value = None if isinstance(cell, InFormula) else self._workbook.content(cell).value
        return Formula(self._written_out(cell), value)

    def _written_out(self, cell: Cell) -> ir.Expression:
        expression = self._rewritten.get(cell) if isinstance(cell, InFormula) else None
        if expression is None or isinstance(expression, FormulaError):
            return cell

        def inner(part: ir.Expression) -> ir.Expression | None:
            return self._written_out(part) if isinstance(part, InFormula) and part != cell else None

        return substitute(expression, inner)


def _was(notes: Mapping[str, str]) -> str:
    return notes.get(DIALOG) or notes.get("Call") or ""


def _label(site: InFormula) -> str:
    return str(site).rpartition("#")[2]


def text_of(formula: Formula, calls: Mapping[Cell, str]) -> str:
    """Write the formula with its `=`; calls are the cells of their rows, by their addresses on the new sheet.

    Args:
        formula: to write.
        calls: a call -> the address that is drawn instead.
    """

    def name(cell: Cell | Area) -> str:
        return calls[cell] if isinstance(cell, InFormula) else str(cell)

    return f"={formula_text(formula.tree, name)}"
