"""Assumptions, forecasts, filters, checks, correlations and settings: what a workbook asks of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import DefinitionError, ErrorCode, FormulaError, Notice
from xlmc.excel.address import Area, Cell, InFormula
from xlmc.excel.formula.ir import Expression
from xlmc.excel.workbook.workbook import CellValue
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.feeds import Feeding
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.run_settings import USUAL, Settings
from xlmc.montecarlo.definitions.stating import Kind, Role, Which
from xlmc.montecarlo.distributions import FAMILIES, Family
from xlmc.montecarlo.sampling.draws import Draw

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.scenarios import Scenario

__all__ = [
    "CUTOFFS",
    "DIALOG",
    "Assumption",
    "Check",
    "Copula",
    "Correlation",
    "DataRange",
    "Decision",
    "Definitions",
    "Filter",
    "Forecast",
    "Parameter",
    "Settings",
    "Solve",
    "StatedNumber",
]

Parameter = float | Cell
"""A number, or the cell that holds it because that cell holds a formula (it may then vary with other assumptions)."""


DIALOG: Final = "Crystal Ball"
"""The source, and the note, of what a dialog of Crystal Ball defines."""

CUTOFFS: Final = {"lower_cutoff": "Lower cutoff", "upper_cutoff": "Upper cutoff"}
"""Key of a cutoff -> its heading."""

_FIRST_DATE: Final = 10_000.0
"""Days: from 1927 on. A smaller number in the row of a date is a span, such as its standard deviation."""

_ENDS: Final = {"low", "high", "likeliest", "low_likeliest", "high_likeliest", "top", "bottom", "midpoint", *CUTOFFS}
_OF_QUANTITY: Final = frozenset({*_ENDS, "base", "mean", "std_dev", "location", "scale", "deductible", "limit"})
"""Parameters that are in the unit of what is drawn; others, such as shapes and rates, are not."""


@dataclass(frozen=True, slots=True)
class StatedNumber:
    """A number that a formula computes, as people read it: `180,000 (=Estimate!B2)`.

    Attributes:
        value: at the base case; None where it is not known.
        source: the formula, or its cell.
    """

    value: float | None
    source: str

    def written(self, form: Form) -> str:
        """Write the number with its source."""
        return self.source if self.value is None else f"{form.number(self.value)} ({self.source})"


@dataclass(frozen=True, slots=True)
class DataRange:
    """The data that a distribution is made from.

    Attributes:
        area: where they stand.
        rows: what stands there, row by row; None in a blank cell.
        cumulative: their weights are sums of those up to their row.
        bandwidth: of a smoothed distribution, where it is given.
        text: what they are, for people, where that is more than the area.
    """

    area: Area
    rows: tuple[tuple[Parameter | None, ...], ...]
    cumulative: bool = False
    bandwidth: Parameter | None = None
    text: str = ""

    @property
    def cells(self) -> Iterator[Cell]:
        """The cells that hold formulas."""
        for value in (*(value for row in self.rows for value in row), self.bandwidth):
            if isinstance(value, Cell):
                yield value


@dataclass(frozen=True, slots=True)
class Assumption:
    """An uncertain input: its cell, its distribution, and why.

    Attributes:
        distribution: the family's name as `xlmc.montecarlo.distributions.FAMILIES` spells it.
        given: key of a parameter of the family (`low`, `high`, …) or of a cutoff -> value. A parameter that is left out
            has its default, and a cutoff that is left out cuts nothing off.
        base: the cell's own value, the base case.
        frozen: held at `base`, not drawn.
        row: where it is defined.
        notes: the table's other columns, echoed in the record.
        own_family: built for this row; None if `FAMILIES` has it, or where a cell of the data awaits calculation.
        data: what the distribution is built from; None for one that has parameters alone.
        call: the call of a formula that a row of a table stands for; None elsewhere.
        checked: how it is drawn by the numbers that the row held as it was read, which are a distribution; None if
            one was not known then. A run checks all numbers that are not these, whoever gives them.
        stated: key of a parameter or cutoff that a formula computes -> its value at the base case, and the formula.
        form: how the values of its cell are written.
        uncertain: it varies from lack of knowledge: it has one value, which nobody knows. Others vary by scatter.
        stream: the name that its random numbers are drawn by, where that is another: of a draw in a cell the call,
            `Sheet!B7#1`, so that its label may change. People may call the assumption by it, too.
    """

    name: str
    cell: Cell
    distribution: str
    given: Mapping[str, Parameter]
    row: Cell
    base: float | None = None
    units: str = ""
    source: str = ""
    frozen: bool = False
    notes: Mapping[str, str] = field(default_factory=dict)
    own_family: Family | None = None
    data: DataRange | None = None
    call: InFormula | None = None
    checked: Draw | None = field(default=None, compare=False, repr=False)
    stated: Mapping[str, StatedNumber] = field(default_factory=dict, compare=False, repr=False)
    form: Form = field(default=PLAIN, compare=False, repr=False)
    uncertain: bool = False
    stream: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """What people may call it: its name, and that of its stream."""
        return (self.name, self.stream) if self.stream else (self.name,)

    @property
    def family(self) -> Family:
        """What it is drawn from, given the parameters."""
        return FAMILIES[self.distribution] if self.own_family is None else self.own_family

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Key of each parameter that is given -> value."""
        return {key: value for key, value in self.given.items() if key not in CUTOFFS}

    @property
    def cutoffs(self) -> dict[str, Parameter]:
        """Key of each cutoff that is given -> value."""
        return {key: self.given[key] for key in CUTOFFS if key in self.given}

    @property
    def headings(self) -> dict[str, str]:
        """Key of each parameter and cutoff that is given -> its heading, in the family's order."""
        every = {spec.key: spec.heading for spec in self.family.parameters} | CUTOFFS
        return {key: heading for key, heading in every.items() if key in self.given}

    @property
    def formulas(self) -> dict[str, Cell]:
        """Key of a parameter or cutoff that a formula computes -> the formula's cell."""
        return {key: value for key, value in self.given.items() if isinstance(value, Cell)}

    def with_numbers(self, numbers: Mapping[str, Parameter | None]) -> Assumption:
        """Return the assumption with these parameters and cutoffs instead of its own; None takes a cutoff away."""
        given = {key: value for key, value in {**self.given, **numbers}.items() if value is not None}
        stated = {key: text for key, text in self.stated.items() if key not in numbers}
        return replace(self, given=given, stated=stated)

    def text_of(self, key: str) -> str:
        """Write a parameter or cutoff that is given, with its formula where one computes it."""
        value, stated = self.given[key], self.stated.get(key)
        if stated is not None:
            return stated.written(PLAIN if stated.value is None else self.form_of(key, stated.value))
        return str(value) if isinstance(value, Cell) else self.form_of(key, value).number(value, typed=True)

    def form_of(self, key: str, value: float) -> Form:
        """Return how a number is written: as its cell where it is a value of the quantity itself, or a distance of
        such; of days where it is a value alone.
        """
        of_quantity = key in _OF_QUANTITY or (key[:1] == "p" and key[1:2].isdigit())
        is_day = self.form.kind is Kind.DATE and self.form.shows != "span"
        return self.form if (value >= _FIRST_DATE if is_day else of_quantity) else PLAIN

    @property
    def cells(self) -> tuple[Cell, ...]:
        """The cells whose formulas compute its data, parameters and cutoffs."""
        return (*(() if self.data is None else self.data.cells), *self.formulas.values())


@dataclass(frozen=True, slots=True)
class Forecast:
    """An answer.

    Attributes:
        central: the share of its central range.
        threshold: to report P(> threshold) for.
        asked: both ends of a range, which belong to it, to report its certainty for; infinite where it has none.
        report_to: the resolution at which it is stated, in its units; None if its error alone decides.
        kind: what its numbers are; None if the row does not say.
        role: what it is to the question asked.
        form: how numbers in its cell are written.
    """

    name: str
    cell: Cell
    row: Cell
    units: str = ""
    central: float = 0.51
    threshold: float | None = None
    notes: Mapping[str, str] = field(default_factory=dict)
    asked: tuple[float, float] | None = None
    report_to: float | None = None
    kind: Kind | None = None
    role: Role = Role.ANSWER
    form: Form = field(default=PLAIN, compare=False, repr=False)

    @property
    def names(self) -> tuple[str, ...]:
        """What people may call it: its name, and its cell."""
        return self.name, str(self.cell)

    @property
    def says_how(self) -> bool:
        """Whether its row says how it is to be stated."""
        return self.report_to is not None or self.kind is not None or self.role is not Role.ANSWER


@dataclass(frozen=True, slots=True)
class Filter:
    """What makes a trial physically possible. With no limit at all the cell itself must be TRUE.

    Attributes:
        evidence: the row of `xlmc_evidence` that it comes from, which then says what it keeps; None for a row of
            `xlmc_filters`.
        only_for: names of the forecasts that it discards trials for; empty where it rejects them for all.
        used: whether the row counts; its column `Use` may switch it off.
        stated: key of a limit that a formula computes -> its value at the base case, and the formula.
        form: how the values of its cell are written.
    """

    name: str
    cell: Cell
    row: Cell
    at_least: Parameter | None = None
    at_most: Parameter | None = None
    above: Parameter | None = None
    below: Parameter | None = None
    because: str = ""
    notes: Mapping[str, str] = field(default_factory=dict)
    evidence: Evidence | None = None
    only_for: tuple[str, ...] = ()
    used: bool = True

    @property
    def can_be_used(self) -> bool:
        """Whether it counts where nothing switches it off, as every filter does."""
        return True

    stated: Mapping[str, StatedNumber] = field(default_factory=dict, compare=False, repr=False)
    form: Form = field(default=PLAIN, compare=False, repr=False)

    def text_of(self, key: str) -> str:
        """Write a limit that it has, with its formula where one computes it."""
        value, stated = getattr(self, key), self.stated.get(key)
        if stated is not None:
            return stated.written(self.form)
        return str(value) if isinstance(value, Cell) else self.form.number(value, typed=True)

    @property
    def formulas(self) -> dict[str, Cell]:
        """Key of a limit that a formula computes -> the formula's cell."""
        limits = {key: getattr(self, key) for key in ("at_least", "above", "at_most", "below")}
        return {key: value for key, value in limits.items() if isinstance(value, Cell)}


@dataclass(frozen=True, slots=True)
class Check:
    """What must be TRUE wherever the model is used: at the base case, and in the accepted trials. It rejects nothing.

    Attributes:
        because: what it means when the cell is not TRUE, and where to look.
    """

    name: str
    cell: Cell
    row: Cell
    because: str = ""
    notes: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Solve:
    """A cell that is not typed in but solved for in every trial, so that another cell has a value.

    Attributes:
        cell: that is to have the value.
        to: the value.
        by: the cell that is solved for.
        low: the lower end of what it may be.
        high: the upper end.
        root: which of several values is taken; None to take none, and make such a trial an error.
        typed: `to`, `low` and `high`, where they are numbers -> the cell that holds it.
        form: how `to` is written, a number of `cell`.
        form_by: how `low` and `high` are written, numbers of `by`.
    """

    name: str
    cell: Cell
    to: Parameter
    by: Cell
    low: Parameter
    high: Parameter
    row: Cell
    root: Which | None = None
    typed: Mapping[str, Cell] = field(default_factory=dict)
    form: Form = field(default=PLAIN, compare=False, repr=False)
    form_by: Form = field(default=PLAIN, compare=False, repr=False)

    def form_of(self, key: str) -> Form:
        """Return how `to`, `low` or `high` is written."""
        return self.form if key == "to" else self.form_by

    def words(self, code: ErrorCode) -> str:
        """Say why a trial has no value: its cell is then this error."""
        ends = f"{_limit_text(self.low, self.form_by)} to {_limit_text(self.high, self.form_by)}"
        what = "several values" if code is ErrorCode.NUM else "no value"
        made = f"make{'s' * (code is not ErrorCode.NUM)} {self.cell} equal to {_limit_text(self.to, self.form)}"
        return f"{what} from {ends} {made}"


def _limit_text(given: Parameter, form: Form) -> str:
    return str(given) if isinstance(given, Cell) else form.number(given, typed=True)


@dataclass(frozen=True, slots=True)
class Decision:
    """A cell that a person decides on: a run takes what it holds, and a study tries its values.

    Attributes:
        values: those that a table of decisions tries: listed, or from the least to the largest.
        between: the least and the largest, where any value between them may be chosen; None where the values are all.
        listed: whether they were listed one by one, so that neighbours need not be alike.
        contents: of values that are texts, TRUE or FALSE what is typed into the cell, each at its value, from 0; else
            empty.
        base: the value that the cell holds; None for none, or no number.
        form: how the values of its cell are written.
    """

    name: str
    cell: Cell
    values: tuple[float, ...]
    row: Cell
    units: str = ""
    between: tuple[float, float] | None = None
    listed: bool = False
    contents: tuple[str | bool, ...] = ()
    base: float | None = None
    form: Form = field(default=PLAIN, compare=False, repr=False)

    def content(self, value: float) -> float | str | bool:
        """Return what is typed into the cell for a value."""
        return self.contents[int(value)] if self.contents else value

    def shown(self, value: float) -> str:
        """Write a value as the cell then shows it."""
        content = self.content(value)
        if isinstance(content, bool):
            return "TRUE" if content else "FALSE"
        return content if isinstance(content, str) else self.form.number(content)

    def value_of(self, content: CellValue) -> float | None:
        """Return the value that a cell's content is; None where it is none, or no number."""
        if self.contents:
            alike = [at for at, each in enumerate(self.contents) if each == content and type(each) is type(content)]
            return float(alike[0]) if alike else None
        is_number = isinstance(content, int | float) and not isinstance(content, ErrorCode)
        return float(content) if is_number else None  # type: ignore[arg-type]  # a number, as just seen

    @property
    def values_text(self) -> str:
        """The values in words: `5; 6`, `20 to 60 in steps of 10`, `0 to 1`."""
        if self.between is not None:
            return " to ".join(map(self.form.number, self.between))
        if self.listed or len(self.values) < 3:
            return "; ".join(map(self.shown, self.values))
        step = float(f"{self.values[1] - self.values[0]:.12g}")
        ends = " to ".join(map(self.form.number, (self.values[0], self.values[-1])))
        return f"{ends} in steps of {self.form.width(step)}"


@dataclass(frozen=True, slots=True)
class Correlation:
    """A Spearman rank correlation between two assumptions, by name as defined; of a model, `value` is a number.

    `weight` says how much it is kept where correlations contradict each other: from 0, as any other, to 100, as it is.
    """

    first: str
    second: str
    value: Parameter
    row: Cell
    weight: float = 0.0

    @property
    def number(self) -> float:
        """The coefficient, which is a number once a model has been made."""
        assert not isinstance(self.value, Cell), "the formula of a correlation has not been computed"
        return self.value


@dataclass(frozen=True, slots=True)
class Copula:
    """How assumptions are joined beside rank correlations.

    Attributes:
        kind: `Gaussian`, `t`, `Clayton`, `Gumbel` or `Frank`; where there are trials, what these are of.
        names: of the assumptions, in order.
        row: the cell that names its kind.
        parameter: theta, or the degrees of freedom of t; None for Gaussian.
        matrix: of Gaussian and t, the correlations of the underlying variables, `(k, k)`; empty for others.
        turned: which assumptions are turned over, as those of ClaytonR are.
        trials: `(k, m)` values that stand together, one of which the assumptions take in each trial.
    """

    kind: str
    names: tuple[str, ...]
    row: Cell
    parameter: float | None = None
    matrix: tuple[tuple[float, ...], ...] = ()
    turned: tuple[bool, ...] = ()
    trials: NDArray[np.float64] | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Definitions:
    """Everything that a workbook asks of a run.

    `problems` are the mistakes found, each with its cell; a run is refused while there are any. `rewritten` are the
    formulas in which calls stand for assumptions (`=10+RiskNormal(5,1)`), with assumptions instead of the calls, or why
    a cell cannot be computed; `results` are the cells that show results of the run, each with its formula. The cells
    `unavailable` should, or belong to a what-if table of the run, and cannot be computed, each with the reason.
    `evidence` are the rows of `xlmc_evidence`; those that are used are also among `filters`. `refused` says why
    forecasts that the workbook asks for cannot be computed, and what else was lost, while the others can be run;
    `left_out` are these forecasts and what filters of theirs. `forecast_filters` are filters of some forecasts only,
    which are not among `filters`; `unused` are the rows of `xlmc_filters` that are switched off, which nothing else
    holds. `switches` are the names of the rows of filters and evidence that can be used or not, each with the first
    cell of its row, and whether it is used. `feeding` are the other workbooks whose answers feed assumptions, `python`
    the cells that a function of Python computes, each with the call. `solves` are the rows of `xlmc_solve`; in a model
    `rewritten` has their calls. `decisions` are the rows of `xlmc_decisions`.
    """

    assumptions: tuple[Assumption, ...] = ()
    forecasts: tuple[Forecast, ...] = ()
    filters: tuple[Filter, ...] = ()
    correlations: tuple[Correlation, ...] = ()
    copulas: tuple[Copula, ...] = ()
    settings: Settings = USUAL
    notices: tuple[Notice, ...] = ()
    problems: tuple[DefinitionError, ...] = ()
    rewritten: Mapping[Cell, Expression | FormulaError] = field(default_factory=dict)
    results: Mapping[Cell, Expression] = field(default_factory=dict)
    unavailable: Mapping[Cell, str] = field(default_factory=dict)
    checks: tuple[Check, ...] = ()
    evidence: tuple[Evidence, ...] = ()
    refused: tuple[DefinitionError, ...] = ()
    forecast_filters: tuple[Filter, ...] = ()
    scenarios: tuple[Scenario, ...] = ()
    left_out: tuple[Forecast | Filter, ...] = ()
    feeding: Feeding | None = None
    unused: tuple[Filter, ...] = ()
    switches: Mapping[str, tuple[Cell, bool]] = field(default_factory=dict)
    python: Mapping[Cell, Expression] = field(default_factory=dict)
    solves: tuple[Solve, ...] = ()
    decisions: tuple[Decision, ...] = ()

    def is_used(self, row: str) -> bool:
        """Return whether a filter or a row of evidence is used; see `switches`. What is no such row is not off."""
        return self.switches.get(row, (None, True))[1]
