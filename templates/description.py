"""What a template says, apart from how it is drawn.

A template is a description: inputs, equations in the order a reader follows them, the results wanted of a run, a guide,
and a hand-written function of the same equations that gives the values the cells show before Excel recalculates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "PARAMETER_COLUMNS",
    "Equation",
    "Evaluate",
    "FilterRow",
    "ForecastRow",
    "GuideSection",
    "Input",
    "Role",
    "Section",
    "Template",
]

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
"""The parameter columns of `xlmc_assumptions`: enough for Uniform, Normal, Triangular and Trapezoid."""

Evaluate = Callable[[Mapping[str, ArrayLike]], dict[str, NDArray[np.generic]]]
"""`{symbol: (n,) or a number}` of every input -> `{symbol: (n,) or 0-d}` of every equation."""


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
        parameters: column of `xlmc_assumptions` -> value; empty for an input that is held fixed.
    """

    symbol: str
    notation: str
    name: str
    unit: str
    base: float
    source: str
    parameters: Mapping[str, float] = field(default_factory=dict)
    distribution: str = "Uniform"
    number_format: str = "General"


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
    """A row of `xlmc_forecasts`; `symbol` is the equation whose cell is the answer."""

    name: str
    symbol: str
    unit: str
    central_percent: float | None = 51
    threshold: float | None = None


@dataclass(frozen=True, slots=True)
class FilterRow:
    """A row of `xlmc_filters`; a limit that is None is a blank cell."""

    name: str
    symbol: str
    because: str
    at_least: float | None = None
    at_most: float | None = None
    above: float | None = None
    below: float | None = None


@dataclass(frozen=True, slots=True)
class GuideSection:
    """A heading of the guide sheet, its paragraphs, and a table (first row = headers) where `rows` is not empty."""

    title: str
    paragraphs: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Template:
    """A whole workbook."""

    title: str
    subtitle: str
    assumptions: tuple[Input, ...]
    constants: tuple[Input, ...]
    sections: tuple[Section, ...]
    forecasts: tuple[ForecastRow, ...]
    filters: tuple[FilterRow, ...]
    settings: tuple[tuple[str, float], ...]
    correlation_note: str
    guide: tuple[GuideSection, ...]
    all_checks: str
    """Symbol of the TRUE/FALSE equation that says whether every physics check holds."""
    evaluate: Evaluate

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Uncertain and fixed inputs together."""
        return self.assumptions + self.constants

    @property
    def equations(self) -> tuple[Equation, ...]:
        """All equations, in the order of the sheet."""
        return tuple(equation for section in self.sections for equation in section.equations)

    def base_values(self) -> dict[str, float | bool]:
        """The value every cell shows at the base case, by symbol."""
        base = {given.symbol: given.base for given in self.inputs}
        return base | {symbol: value.item() for symbol, value in self.evaluate(base).items()}
