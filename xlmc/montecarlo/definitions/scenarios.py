"""A scenario: a name, and what is other than in the workbook. Assumptions, filters and cells, changed one by one.

To change a table's row is to type other numbers into its cells. These classes only say what to change;
`xlmc.montecarlo.model.applied_changes.applied` gives the model that the workbook would have then.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellValue
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.forms import PLAIN, Form

__all__ = [
    "Band",
    "Change",
    "Correlated",
    "Drawn",
    "Frozen",
    "Limits",
    "Measured",
    "Numbers",
    "Range",
    "Redrawn",
    "Scenario",
    "Stated",
    "Switched",
    "Tabulated",
    "Typed",
]


@dataclass(frozen=True, slots=True)
class Frozen:
    """An assumption is not drawn: it is held at a value, or at its cell's own where that is None."""

    assumption: str
    value: float | None = None
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Drawn:
    """An assumption that the workbook holds frozen is drawn."""

    assumption: str
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Range:
    """An assumption lies from `low` to `high`; an end that is None stays as it is.

    A distribution with the parameters `low` and `high` gets these; any other is cut off there.
    """

    assumption: str
    low: float | None
    high: float | None
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Band:
    """An assumption is confined to a band of its distribution, such as its lowest tenth: from 0 to 10 percent."""

    assumption: str
    low: float
    high: float
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Numbers:
    """An assumption has other parameters or cutoffs: key -> number; None takes a cutoff away."""

    assumption: str
    values: Mapping[str, float | None]
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Redrawn:
    """An assumption is drawn from another distribution."""

    assumption: str
    distribution: Distribution
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Limits:
    """A filter has other limits: `at_least`, `at_most`, `above`, `below` -> number; None takes the limit away."""

    filter: str
    values: Mapping[str, float | None]
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Switched:
    """A filter, or a row of evidence, is used or not, as its column `Use` would say."""

    row: str
    used: bool
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Measured:
    """A row of evidence that is used has another reading or error: `reading`, or a key of `SIZES` -> number."""

    evidence: str
    values: Mapping[str, float]
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Stated:
    """A forecast is stated otherwise: its `threshold`, None for none, or its `central` range, in percent."""

    forecast: str
    values: Mapping[str, float | None]
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Correlated:
    """Two assumptions have another rank correlation than the workbook says; there must be one that it gives."""

    first: str
    second: str
    value: float
    where: Cell | None = None


@dataclass(frozen=True, slots=True)
class Typed:
    """Something else is typed into a cell; into that of a drawn assumption, another base value.

    Attributes:
        named: what a person calls the cell; empty for its address.
        of: the kind of the table that it is a cell of, the name of its row and its heading; None for other cells.
        form: how the values of the cell are written.
    """

    cell: Cell
    value: CellValue
    where: Cell | None = None
    named: str = ""
    of: tuple[str, str, str] | None = field(default=None, compare=False)
    form: Form = field(default=PLAIN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Tabulated:
    """Every `RiskSimtable` gives another of its values: the first, the second, …

    Attributes:
        values: in words, such as `S!B2 20`.
    """

    number: int
    values: str = ""
    where: Cell | None = None


Change = (
    Frozen
    | Drawn
    | Range
    | Band
    | Numbers
    | Redrawn
    | Limits
    | Switched
    | Measured
    | Stated
    | Correlated
    | Typed
    | Tabulated
)
"""One change. `where` is the cell that asks for it, for messages; None where a program does."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """A named set of changes.

    Attributes:
        row: where it is defined; None if a program made it.
    """

    name: str
    changes: tuple[Change, ...]
    note: str = ""
    row: Cell | None = None
