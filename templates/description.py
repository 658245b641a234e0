"""What a template says, apart from how it is drawn.

A template is a description: inputs, equations in the order a reader follows them, the results wanted of a run, a
diagram of the scene, a guide. What differs between units is written with both (see `editions`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from templates.editions import Both

__all__ = [
    "ALL_CHECKS",
    "PARAMETER_COLUMNS",
    "RULE_OF_TYRES",
    "CorrelationRow",
    "Curve",
    "DataTable",
    "Diagram",
    "Equation",
    "EvidenceRow",
    "FilterRow",
    "ForecastRow",
    "GuideSection",
    "Input",
    "Look",
    "PastedTable",
    "Role",
    "Section",
    "Template",
    "TestTable",
]

ALL_CHECKS = "checks_hold"
"""Symbol of the TRUE/FALSE equation, in every template, that says whether each physics check holds."""

RULE_OF_TYRES = "tyres_matter"
"""Symbol of the text, in impact templates, that says that the tyres' impulse is no longer small; or a dash."""

PARAMETER_COLUMNS = (
    "Low",
    "High",
    "Likeliest",
    "Low likeliest",
    "High likeliest",
    "Mean",
    "Std dev",
    "Lower cutoff",
    "Upper cutoff",
)
"""The parameter columns of `xlmc_assumptions` in most templates: enough for Uniform, Normal, Triangular, Trapezoid."""

Number = float | Both
"""A number; in a description of both editions, one or two."""

Parameter = Number | str
"""A number; or a formula such as `=eta`, or for the column Data the defined name of a table."""


class Role(Enum):
    """What an equation's cell is to its reader; the writer gives each role its own look."""

    STEP = "step"
    ANSWER = "answer"
    CHECK = "check"


@dataclass(frozen=True, slots=True)
class Input:
    """A number the engineer gives.

    Attributes:
        symbol: the cell's defined name, as formulas use it (`alpha_1`).
        notation: the same as the paper prints it (`α1`).
        base: the value of the cell; None for an optional input that is left blank.
        parameters: column of `xlmc_assumptions` -> value; empty for an input that is held fixed.
        frozen: an assumption that is held at its base value until the engineer, or a formula, says otherwise.
        choices: the only values the cell may take, where there are such.
    """

    symbol: str
    notation: str
    name: str
    unit: str
    base: Number | None
    source: str
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    distribution: str = "Uniform"
    number_format: str = "General"
    frozen: bool | str = False
    choices: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Equation:
    """A quantity computed from those above it.

    Attributes:
        formula: as Excel takes it, without `=`, in terms of symbols.
        reference: the equation of the source it comes from; a prime marks a rewritten form.
        note: what was rewritten and why, or how to read the result.
    """

    symbol: str
    notation: str
    name: str
    unit: str
    formula: str
    reference: str = ""
    note: str = ""
    role: Role = Role.STEP
    number_format: str = "0.0000"


@dataclass(frozen=True, slots=True)
class Section:
    """Equations that belong together, under one heading."""

    title: str
    equations: tuple[Equation, ...]


@dataclass(frozen=True, slots=True)
class ForecastRow:
    """A row of `xlmc_forecasts`; `symbol` is the equation whose cell is the answer.

    Attributes:
        kind: what its numbers are, such as yes/no; empty for plain numbers.
        stated: what it is to the question: lower bound, upper bound or diagnostic; empty for an answer.
    """

    name: str
    symbol: str
    unit: str
    central_percent: float | None = 51
    threshold: float | None = None
    kind: str = ""
    stated: str = ""


@dataclass(frozen=True, slots=True)
class FilterRow:
    """A row of `xlmc_filters`; a limit that is None is a blank cell. `only_for` names the one forecast it is about."""

    name: str
    symbol: str
    because: str
    at_least: Number | None = None
    at_most: Number | None = None
    above: Number | None = None
    below: Number | None = None
    only_for: str = ""


@dataclass(frozen=True, slots=True)
class EvidenceRow:
    """A row of `xlmc_evidence`: a reading of the quantity `symbol`, None while there is none.

    Attributes:
        error: the kind of error, such as Normal.
        off_by: column of the table -> how far the reading may be off.
        use: whether trials are kept by it.
        named: defined name of the cell of the reading, where a formula reads it; else empty.
    """

    name: str
    symbol: str
    reading: Number | None
    error: str
    off_by: Mapping[str, Number]
    source: str
    use: bool = True
    named: str = ""


@dataclass(frozen=True, slots=True)
class CorrelationRow:
    """A row of `xlmc_correlations`; `first` and `second` are symbols of assumptions. A correlation of 0 is none."""

    first: str
    second: str
    correlation: float


@dataclass(frozen=True, slots=True)
class GuideSection:
    """A heading of the guide sheet, its paragraphs, and a table (first row = headers) where `rows` is not empty."""

    title: str
    paragraphs: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()


class Look(Enum):
    """How a curve of the diagram is drawn; the first and the second vehicle have a colour each."""

    FIRST = "first"
    SECOND = "second"
    FIRST_PATH = "first path"
    SECOND_PATH = "second path"
    LINE = "line"
    REST = "rest"
    POINT = "point"


@dataclass(frozen=True, slots=True)
class Curve:
    """A polyline of the diagram; `points` are formulas of X and Y in terms of symbols."""

    name: str
    look: Look
    points: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Diagram:
    """A native chart drawn from cells.

    Attributes:
        plan: a plan view about the origin: both axes get the same scale, whatever the numbers.
    """

    title: str
    x_title: str
    y_title: str
    curves: tuple[Curve, ...]
    plan: bool = False
    remark: str = ""


@dataclass(frozen=True, slots=True)
class PastedTable:
    """A table that is pasted as it is, headings and all, and what is read from it.

    Attributes:
        columns: headings that it has until others are pasted over them, from column A on.
        width: room for so many columns.
        rows: room for so many.
        computed: heading, formula and number format of columns beside it; `{r}` is the row.
        read: quantities, each a named cell.
        subtitle: of its sheet.
    """

    columns: tuple[str, ...]
    width: int
    rows: int
    computed: tuple[tuple[str, str, str], ...]
    read: tuple[Equation, ...]
    subtitle: str


@dataclass(frozen=True, slots=True)
class TestTable:
    """Rows of tests, what is computed in each, what is read from all, and how the tests scatter.

    Attributes:
        columns: heading and number format of what is entered, from column A on.
        rows: room for so many.
        computed: heading, formula and number format of further columns; `{r}` is the row.
        read: quantities, each a named cell below the rows.
        scatter: uncertain inputs, a table of their own below these.
    """

    columns: tuple[tuple[str, str], ...]
    rows: int
    computed: tuple[tuple[str, str, str], ...]
    read: tuple[Equation, ...]
    scatter: tuple[Input, ...]
    subtitle: str


@dataclass(frozen=True, slots=True)
class DataTable:
    """A table of numbers on sheet Inputs, such as the values of a discrete distribution and their probabilities.

    Attributes:
        name: defined name of its cells.
        columns: headings.
        formats: the number format of each column.
        source: where the numbers come from.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    formats: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    source: str


@dataclass(frozen=True, slots=True)
class Template:
    """A whole workbook.

    Attributes:
        rung: its place on the ladder of models, the simplest 1; in its group.
        question: what it answers, one line.
        needs: the inputs it needs, one line.
        assumptions, constants: uncertain inputs; inputs held fixed.
        optional: inputs that may stay blank, or that only the drawing uses.
        vehicles: what the vehicles are called, where labels name them (see `vehicles.py`).
        named: what these names are of: `vehicle`, or `phase`.
        waiting: uncertain inputs that do nothing until they have a value; they have a sheet of their own.
        waiting_note: what that sheet says of them.
        record: a table that may be pasted; it has a sheet of its own.
        tests: rows of tests that may be entered; they have a sheet of their own.
        group: the field it belongs to; empty for the reconstruction of crashes, whose words its sheets have.
        columns: the parameter columns of its assumptions.
        data: tables that its distributions take.
        curve: a second drawing, of restitution against closing speed; it has a sheet of its own.
    """

    title: str
    subtitle: str
    rung: int
    question: str
    needs: str
    assumptions: tuple[Input, ...]
    constants: tuple[Input, ...]
    optional: tuple[Input, ...]
    sections: tuple[Section, ...]
    forecasts: tuple[ForecastRow, ...]
    filters: tuple[FilterRow, ...]
    settings: tuple[tuple[str, float], ...]
    correlations: tuple[CorrelationRow, ...]
    correlation_note: str
    guide: tuple[GuideSection, ...]
    diagram: Diagram | None = None
    vehicles: tuple[str, ...] = ()
    named: str = "vehicle"
    evidence: tuple[EvidenceRow, ...] = ()
    waiting: tuple[Input, ...] = ()
    waiting_note: str = ""
    record: PastedTable | None = None
    tests: TestTable | None = None
    group: str = ""
    columns: tuple[str, ...] = PARAMETER_COLUMNS
    data: tuple[DataTable, ...] = ()
    curve: Diagram | None = None

    @property
    def category(self) -> str:
        """What the workbook's properties say of its place: `rung 3`, or the group and the place in it."""
        return f"{self.group or 'rung'} {self.rung}"

    @property
    def checks(self) -> str:
        """What its checks are called."""
        return "check" if self.group else "physics check"

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Uncertain, fixed, optional and waiting inputs together, and the scatter of tests."""
        scatter = () if self.tests is None else self.tests.scatter
        return self.assumptions + self.constants + self.optional + self.waiting + scatter

    @property
    def read(self) -> tuple[Equation, ...]:
        """What is read from tables that are pasted or entered."""
        return tuple(each for table in (self.record, self.tests) if table is not None for each in table.read)

    @property
    def equations(self) -> tuple[Equation, ...]:
        """All equations, in the order of the sheet."""
        return tuple(equation for section in self.sections for equation in section.equations)
