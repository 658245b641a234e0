"""What Crystal Ball's dialogs define, as assumptions, forecasts, filters and correlations.

What cannot be read for certain is never taken for a constant: its cell is *refused*, and so is every forecast that
needs it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Final, TypeVar

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import formula_text, ir
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.crystal_ball.distribution_text import Distribution, distribution_of
from xlmc.montecarlo.definitions.crystal_ball.from_dialogs import UNPROVEN, FromDialogs
from xlmc.montecarlo.definitions.crystal_ball.hidden_blocks import Blocks, read_blocks
from xlmc.montecarlo.definitions.crystal_ball.object_names import ObjectNames, UnreadableError
from xlmc.montecarlo.definitions.crystal_ball.stored_objects import (
    NAME,
    OF_COEFFICIENTS,
    OF_NAMES,
    OF_PARAMETERS,
    CellReference,
    ForecastFilter,
    Stored,
    StoredAssumption,
    StoredCorrelation,
    StoredDecision,
    StoredForecast,
    StoredOther,
)
from xlmc.montecarlo.definitions.definitions import (
    DIALOG,
    Assumption,
    Correlation,
    Decision,
    Filter,
    Forecast,
    Parameter,
)
from xlmc.montecarlo.definitions.in_cells.suspects import holds_call
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.decisions import values_between
from xlmc.montecarlo.definitions.tables.identity import Claims
from xlmc.montecarlo.definitions.tables.table_rows import number_in, static_value
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.parameters import range_text, show
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["read_dialogs"]

_INFERRED: Final = "What their numbers mean was inferred from one file: compare once in Crystal Ball"
_CURE: Final = "Define the cell in the table xlmc_assumptions, or look it up in Crystal Ball"
_NORMAL: Final = {2: "mean", 3: "std_dev"}
"""Codes of the parameters of a Normal that may come from cells; those of other families are unknown."""

_T = TypeVar("_T", StoredAssumption, StoredForecast, StoredDecision)
_Key = tuple[str, str]


def read_dialogs(
    workbook: Workbook,
    computed: Computed,
    central: float,
    assumptions: Claims,
    forecasts: Claims,
    findings: Findings,
) -> FromDialogs:
    """Return what Crystal Ball's dialogs define in a workbook.

    Args:
        workbook: that may hold Crystal Ball's data.
        computed: which cells something gives a value.
        central: the share of the central range.
        assumptions: take names and cells; the rows of tables have taken theirs.
        forecasts: likewise.
        findings: takes mistakes and remarks.
    """
    blocks = read_blocks(workbook)
    if not (blocks.present or blocks.damages):
        return FromDialogs()
    return _Dialogs(workbook, computed, central, assumptions, forecasts, findings).read(blocks)


class _Dialogs:
    def __init__(
        self,
        workbook: Workbook,
        computed: Computed,
        central: float,
        assumptions: Claims,
        forecasts: Claims,
        findings: Findings,
    ) -> None:
        self._workbook, self._computed, self._central, self._findings = workbook, computed, central, findings
        self._names = ObjectNames(workbook)
        self._uncertain, self._answers = assumptions, forecasts
        self._taken = dict(assumptions.cells)  # by rows of tables
        self._read = FromDialogs()
        self._drawn: dict[_Key, str] = {}
        self._places = {name: number for number, name in enumerate(workbook.sheets)}

    def read(self, blocks: Blocks) -> FromDialogs:
        stored = blocks.objects
        self._read.stored = True
        for damage in blocks.damages:
            self._read.damages.append(str(damage))
        for sheet, each, cell in self._placed(stored, StoredAssumption):
            self._assumption(sheet, each, cell)
        for sheet, forecast, cell in self._placed(stored, StoredForecast):
            self._forecast(sheet, forecast, cell)
        known = {(sheet, each.guid): each for sheet, each in stored if isinstance(each, StoredAssumption)}
        for sheet, one in stored:
            if isinstance(one, StoredCorrelation):
                self._findings.attempt(self._correlation, sheet, one, known)
        self._refuse_missing(stored)
        self._remark_on_decisions(stored)
        self._remark_on_others(each for _, each in stored)
        if self._read.assumptions:
            self._findings.notice(_RUN_PREFERENCES, self._workbook.name)
        return self._read

    def _placed(self, stored: Iterable[tuple[str, Stored]], kind: type[_T]) -> list[tuple[str, _T, Cell]]:
        """Return the objects of a kind with their sheets and cells, by sheet, row and column; those of no cell left
        out.
        """
        result, gone = [], []
        for sheet, each in stored:
            if isinstance(each, kind):
                cell = self._names.cell_of(sheet, each.guid)
                if cell is None:
                    gone.append(repr(each.name))
                else:
                    result.append((sheet, each, cell))
        if gone:
            message = f"Crystal Ball's {_WORDS[kind]} {', '.join(gone)} was deleted with its cell, and is left out"
            self._findings.notice(message, self._workbook.name)
        return sorted(result, key=lambda item: (self._places[item[2].sheet], item[2].row, item[2].column))

    # assumptions

    def _assumption(self, sheet: str, stored: StoredAssumption, cell: Cell) -> None:
        name = self._shown(sheet, stored.name, stored.references, cell)
        formula = self._workbook.content(cell).formula
        if formula is not None and holds_call(formula.text):
            message = f"the formula draws by a call of its own, and Crystal Ball's old assumption {name!r} is left out"
            self._findings.notice(message, cell)
            return
        if cell in self._taken:
            self._refuse_twice(stored, name, cell)
            return
        rewritten: dict[Cell, ir.Expression] = {}
        try:
            read = distribution_of(stored)
            base = self._base(cell)
            given = self._given(sheet, stored, read, cell, rewritten)
            checked = self._checked(name, read, given)
        except (UnreadableError, DefinitionError) as error:
            reason = error.message if isinstance(error, DefinitionError) else str(error)
            self._refuse(cell, f"Crystal Ball's assumption {name!r} ({stored.text}) cannot be read: {reason}")
            return
        if cell in self._uncertain.cells:
            other = self._uncertain.cells[cell]
            hint = "Delete one of them in Crystal Ball"
            self._findings.problem(f"Crystal Ball has two assumptions on {cell}, one of them {name!r}", other, hint)
            return
        if not read.met:
            self._findings.notice(f"the distribution of {name!r} is {stored.text}; {UNPROVEN}", cell)
        self._uncertain.take_cell(cell, cell)
        name = _free_name(name, cell, self._uncertain, self._findings)
        self._drawn[sheet, stored.guid] = name
        self._read.rewritten |= rewritten
        self._read.assumptions.append(
            Assumption(
                name=name,
                cell=cell,
                distribution=read.family,
                given=given,
                row=cell,
                base=base,
                source=DIALOG,
                notes={DIALOG: stored.text},
                checked=checked,
            )
        )

    def _refuse_twice(self, stored: StoredAssumption, name: str, cell: Cell) -> None:
        """Look up a row of a table on the cell of an assumption: it is the cure where that cannot be read, else a
        mistake.
        """
        row = self._taken[cell]
        try:
            distribution_of(stored)
        except UnreadableError as error:
            self._findings.notice(f"the row {row} replaces Crystal Ball's assumption {name!r}: {error}", cell)
            return
        message = f"{cell} has two assumptions: the row {row}, and {name!r} from Crystal Ball's dialogs"
        self._findings.problem(message, row, "Delete the row, or clear the assumption in Crystal Ball")

    def _base(self, cell: Cell) -> float | None:
        """Return the cell's own value.

        Raises:
            UnreadableError, DefinitionError: a formula computes it, or it is no number.
        """
        if self._computed.by_formula(cell):
            raise UnreadableError("its cell holds a formula, which every draw would overwrite")
        content = self._workbook.content(cell)
        return None if content.is_blank else number_in("its cell", content, cell)

    def _given(
        self,
        sheet: str,
        stored: StoredAssumption,
        read: Distribution,
        cell: Cell,
        rewritten: dict[Cell, ir.Expression],
    ) -> dict[str, Parameter]:
        """Return the parameters and cutoffs: numbers, or cells where they come from cells.

        Raises:
            UnreadableError: a reference leads nowhere, or it cannot be said what it gives.
        """
        saved = {**read.parameters, **read.cutoffs}
        given: dict[str, Parameter] = dict(saved)
        for reference in stored.references:
            if reference.kind in OF_NAMES:
                continue
            if reference.kind != OF_PARAMETERS:
                raise UnreadableError(f"it refers to a cell for {reference.kind}, which is not known")
            tree = self._names.reference(sheet, reference.key)
            key = self._key_of(reference, read, saved, tree)
            if isinstance(given[key], Cell):
                raise UnreadableError(f"two cells give its {key.replace('_', ' ')}")
            if isinstance(tree, Cell):
                given[key] = tree
            else:
                given[key] = site = InFormula.of(cell, key.replace("_", " "))
                rewritten[site] = tree
        return given

    def _key_of(
        self, reference: CellReference, read: Distribution, saved: Mapping[str, float], tree: ir.Expression
    ) -> str:
        """Which parameter a reference gives.

        Raises:
            UnreadableError: the code is not known, and the saved values do not tell.
        """
        if read.family == "Normal" and reference.code in _NORMAL:
            return _NORMAL[reference.code]
        value = static_value(tree, self._workbook) if isinstance(tree, Cell) else None
        keys = [key for key, number in saved.items() if number == value]
        if len(keys) != 1:
            where = formula_text(tree)
            raise UnreadableError(f"it takes a parameter from {where}, and it is not clear which")
        return keys[0]

    def _checked(self, name: str, read: Distribution, given: Mapping[str, Parameter]) -> Draw | None:
        """How it is drawn, where all its numbers are known.

        Raises:
            UnreadableError: they are not a distribution.
        """
        values = {key: value for key, value in given.items() if not isinstance(value, Cell)}
        if len(values) < len(given):
            return None
        draw = Draw.of(name, FAMILIES[read.family], values)
        if (fault := draw.fault()) is not None:
            raise UnreadableError(fault.message)
        return draw

    # forecasts

    def _forecast(self, sheet: str, stored: StoredForecast, cell: Cell) -> None:
        name = self._shown(sheet, stored.name, stored.references, cell)
        if cell in self._answers.cells:
            message = f"Crystal Ball's forecast {name!r} is left out: {self._answers.cells[cell]} defines one of {cell}"
            if stored.filter is None:
                self._findings.notice(message, cell)
            else:
                self._findings.problem(f"{message}, and its filter would be lost", cell, "Delete that row")
            return
        self._answers.take_cell(cell, cell)
        name = _free_name(name, cell, self._answers, self._findings)
        threshold, asked = self._limits(stored.certainty, name, cell)
        if stored.filter is not None:
            self._filter(stored.filter, name, cell)
        if stored.precision is not None:
            self._read.precisions[name] = stored.precision
        self._read.forecasts.append(
            Forecast(name, cell, cell, stored.units, self._central, threshold, {DIALOG: "a forecast"}, asked)
        )

    def _filter(self, stored: ForecastFilter, name: str, cell: Cell) -> None:
        """Take the filter of a forecast. The values that it discards lie inside or outside of its limits."""
        endless = not (math.isfinite(stored.low) or math.isfinite(stored.high))
        if not stored.inside and (endless or not stored.outside):
            self._findings.notice(f"Crystal Ball's filter of {name!r} is on, and discards nothing", cell)
            return
        if stored.inside:
            message = f"Crystal Ball's filter of {name!r} discards values inside its limits; {UNPROVEN}"
            self._findings.notice(message, cell)
        if stored.everywhere:
            message = f"Crystal Ball's filter of {name!r} discards the trial for all forecasts; {UNPROVEN}"
            self._findings.notice(message, cell)
        self._read.filters.append(
            replace(
                self._accepts_outside(stored, cell) if stored.inside else _accepts_inside(stored, cell),
                name=f"Filter of {name}",
                because="Crystal Ball's filter of this forecast",
                only_for=() if stored.everywhere else (name,),
            )
        )

    def _accepts_outside(self, stored: ForecastFilter, cell: Cell) -> Filter:
        """Write a test in a cell of its own, because a filter's limits cannot say `or`."""
        ends = [("<", stored.low)] * math.isfinite(stored.low) + [(">", stored.high)] * math.isfinite(stored.high)
        parts = [ir.Binary(sign, cell, ir.Number(end), all_bits=True) for sign, end in ends]
        site = InFormula.of(cell, "filter")
        self._read.rewritten[site] = ir.Call("OR", tuple(parts)) if parts else ir.Logical(value=False)
        return Filter("", site, cell)

    def _limits(
        self, certainty: tuple[float, float], name: str, cell: Cell
    ) -> tuple[float | None, tuple[float, float] | None]:
        """Return the threshold, or the range that is asked for, from the range that the certainty was last
        shown for.
        """
        low, high = certainty
        ends = [end for end in certainty if math.isfinite(end) and abs(end) < _BEYOND]
        if not ends:
            return None, None
        certainty_text = f"the certainty of {name!r} was last shown for values {range_text(low, high)}"
        if len(ends) == 1:
            self._findings.notice(f"{certainty_text}: its end is taken as the threshold", cell)
            return ends[0], None
        if low > high:
            self._findings.notice(f"{certainty_text}, which is not a range: it is left out", cell)
            return None, None
        self._findings.notice(f"{certainty_text}: the certainty of this range is reported", cell)
        return None, certainty

    # correlations

    def _correlation(self, sheet: str, stored: StoredCorrelation, known: Mapping[_Key, StoredAssumption]) -> None:
        """Take one.

        Raises:
            DefinitionError: its coefficient cannot be read, or an assumption has two of them.
        """
        ends = [self._end(sheet, end, known) for end in stored.ends]
        if None in ends:
            where = self._names.cell_of(sheet, stored.guid) or self._workbook.name
            message = "a correlation of Crystal Ball is left out: one of its assumptions is not there, or is not read"
            self._findings.notice(message, where)
            return
        first, second = (self._drawn[end] for end in ends if end is not None)
        value, where = self._coefficient(sheet, stored, first, second)
        if not -1 <= value <= 1:
            message = f"The rank correlation of {first!r} and {second!r} ({show(value)}) must lie between -1 and 1"
            raise DefinitionError(message, where=where, hint="Correct it")
        pair = {first, second}
        if len(pair) == 1:
            raise DefinitionError(
                f"{first!r} is correlated with itself", where=where, hint="Correct it in Crystal Ball"
            )
        if any({each.first, each.second} == pair for each in self._read.correlations):
            message = f"Crystal Ball correlates {first!r} and {second!r} twice"
            raise DefinitionError(message, where=where, hint="Keep one of the two correlations")
        refers = any(reference.kind == OF_COEFFICIENTS for reference in stored.references)
        coefficient_cell = where if refers and self._computed.by_formula(where) else value
        if coefficient_cell != 0:
            self._read.correlations.append(Correlation(first, second, coefficient_cell, where))

    def _end(self, sheet: str, end: tuple[str, str], known: Mapping[_Key, StoredAssumption]) -> _Key | None:
        """Return the assumption that is meant, if it was read; copies of a sheet have assumptions of the same GUIDs."""
        of_sheet, guid = end
        sheets = self._names.sheets_of(of_sheet)
        keys = [(name, guid) for name in ([sheet] if sheet in sheets else sheets) if (name, guid) in known]
        if not keys:
            keys = [key for key in known if key[1] == guid]
        return keys[0] if len(keys) == 1 and keys[0] in self._drawn else None

    def _coefficient(self, sheet: str, stored: StoredCorrelation, first: str, second: str) -> tuple[float, Cell]:
        own = self._names.cell_of(sheet, stored.guid)
        for reference in stored.references:
            if reference.kind != OF_COEFFICIENTS:
                continue
            try:
                tree = self._names.reference(sheet, reference.key)
            except UnreadableError as error:
                message = f"The correlation of {first!r} and {second!r} cannot be read: {error}"
                raise DefinitionError(message, where=own or sheet, hint=_CURE_OF_CORRELATION) from None
            if not isinstance(tree, Cell):
                message = (
                    f"The correlation of {first!r} and {second!r} comes from {formula_text(tree)}, not from a cell"
                )
                raise DefinitionError(message, where=own or sheet, hint=_CURE_OF_CORRELATION)
            content = self._workbook.content(tree)
            return number_in(f"The correlation of {first!r} and {second!r}", content, tree), tree
        at = own or next(a.cell for a in self._read.assumptions if a.name == first)
        return stored.coefficient, at

    # names and remarks

    def _shown(self, sheet: str, name: str, references: Iterable[CellReference], cell: Cell) -> str:
        """Return the name that Crystal Ball shows: its text, or what the cell or formula gives that it refers to."""
        if not name.startswith("="):
            return name.strip() or str(cell)
        for reference in references:
            if reference.kind in OF_NAMES and reference.code == NAME:
                try:
                    text = self._names.text(self._names.reference(sheet, reference.key))
                except UnreadableError:
                    break
                if text and text.strip():
                    return text.strip()
        self._findings.notice(f"the name of what Crystal Ball keeps here ({name}) cannot be read: it is its cell", cell)
        return str(cell)

    def _refuse(self, cell: Cell, message: str) -> None:
        self._read.rewritten[cell] = FormulaError(message, where=cell, hint=_CURE)

    def _refuse_missing(self, stored: list[tuple[str, Stored]]) -> None:
        """Tell of cells that a name marks as an object's and whose object is not there; a constant is refused, too."""
        known = {(sheet, each.guid) for sheet, each in stored if not isinstance(each, StoredOther)}
        missing: list[str] = []
        for sheet, guid, cell in self._names.objects():
            content = self._workbook.content(cell)
            if (sheet, guid) in known or cell in self._uncertain.cells or cell in self._answers.cells:
                continue
            missing.append(str(cell))
            if content.formula is None and cell not in self._read.rewritten:
                self._refuse(cell, "Crystal Ball kept something of this cell, and it is missing or damaged")
        if missing:
            what = "assumptions, forecasts with their filters, or correlations, and they are missing or damaged"
            self._read.damages.append(f"Crystal Ball kept something of {', '.join(dict.fromkeys(missing))}: {what}")

    def _remark_on_decisions(self, stored: list[tuple[str, Stored]]) -> None:
        result = self._placed(stored, StoredDecision)
        read, left = list[str](), list[str]()
        for sheet, each, cell in result:
            name = self._shown(sheet, each.name, each.references, cell)
            decision = None if self._computed.at_all(cell) else self._findings.attempt(_decided, name, each, cell)
            if decision is None:
                left.append(f"{name!r} ({cell})")
                continue
            assert each.steps is not None
            low, high, step = map(show, each.steps)
            read.append(f"{name!r} ({cell}, {low} to {high} in steps of {step})")
            self._read.decisions.append(decision)
        if read:
            takes = "a run takes what the cells of decision variables hold, and xlmc optimise finds the best values"
            self._findings.notice(f"{takes}: {', '.join(read)}. {_INFERRED}", result[0][2])
        if left:
            message = f"decision variables of Crystal Ball keep the values of their cells: {', '.join(left)}"
            self._findings.notice(message, result[0][2])

    def _remark_on_others(self, stored: Iterator[Stored]) -> None:
        kinds = dict.fromkeys(each.kind for each in stored if isinstance(each, StoredOther) and each.kind not in _PLAIN)
        if kinds:
            message = f"left in the workbook, as a run does not need it, is what Crystal Ball calls {', '.join(kinds)}"
            self._findings.notice(message, self._workbook.name)


_RUN_PREFERENCES: Final = (
    "Crystal Ball keeps no run preferences in a workbook: trials, seed and sampling method are those of the command, "
    "of the table xlmc_settings, or xlmc's own (200,000 trials or until a precision is reached, seed 999, mc). Crystal "
    "Ball's habit is --sampling lhs500, with the seed of its run preferences"
)
_WORDS: Final = {StoredAssumption: "assumption", StoredForecast: "forecast", StoredDecision: "decision variable"}
_PLAIN: Final = ("SheetPreferences",)
_BEYOND: Final = 1e307
_CURE_OF_CORRELATION: Final = "Write it into the table xlmc_correlations, or correct it in Crystal Ball"


def _free_name(name: str, cell: Cell, claims: Claims, findings: Findings) -> str:
    """Return the name; with its cell behind it where another has it."""
    if name_key(name) in claims.names:
        findings.notice(f"another {claims.kind} is called {name!r}; this one is called '{name} ({cell})'", cell)
        name = f"{name} ({cell})"
    return claims.take_name(name, cell)


def _decided(name: str, stored: StoredDecision, cell: Cell) -> Decision | None:
    """Return the decision of a variable whose values lie a step apart; otherwise None.

    Raises:
        DefinitionError: it has too many values.
    """
    return None if stored.steps is None else Decision(name, cell, values_between(*stored.steps, cell), cell)


def _accepts_inside(stored: ForecastFilter, cell: Cell) -> Filter:
    at_least = stored.low if math.isfinite(stored.low) else None
    at_most = stored.high if math.isfinite(stored.high) else None
    return Filter("", cell, cell, at_least=at_least, at_most=at_most)
