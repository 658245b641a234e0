"""What a call in a cell draws, whichever program it was written for, and its base case.

A draw that does not name its base case has its mean for one, as @RISK shows it between simulations.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.definitions import DataRange, Parameter
from xlmc.montecarlo.definitions.in_cells.call_arguments import elements, is_left_out, rows_of_trees
from xlmc.montecarlo.definitions.in_cells.theory import Distribution
from xlmc.montecarlo.definitions.tables.data import data_family
from xlmc.montecarlo.distributions import FAMILIES, Family, Truncated
from xlmc.montecarlo.distributions.base import Member
from xlmc.montecarlo.distributions.quadrature import gauss_legendre
from xlmc.montecarlo.distributions.truncated import Slice

__all__ = [
    "Arguments",
    "Drawn",
    "MatrixRow",
    "Partner",
    "Properties",
    "Signature",
    "base_of",
    "built_family",
    "percentile_cutoffs",
]

Arguments = Mapping[str, ir.Expression]
"""The arguments of a call by what they are called."""

_NODES: Final = 256
"""Points of the Gauss-Legendre rule over the probabilities of a distribution that is cut off."""

Cutoffs = tuple[Parameter | None, Parameter | None]


@dataclass(frozen=True, slots=True)
class MatrixRow:
    """The row of a rank correlation matrix that a draw belongs to, counted from 1; `instance` tells copies apart."""

    area: Area
    position: int
    instance: str


@dataclass(frozen=True, slots=True)
class Partner:
    """@RISK's older way to correlate: draws that depend on one that is independent, all known by one name.

    Attributes:
        name: theirs.
        coefficient: the rank correlation of a dependent draw with the independent one; None for the latter.
    """

    name: str
    coefficient: ir.Expression | None = None


@dataclass(frozen=True, slots=True)
class Properties:
    """What a call says of its draw beside the distribution.

    Attributes:
        lower, upper: cutoffs of the distribution before it is shifted.
        shifted_cutoffs: they are cutoffs after it.
        percents: cutoffs as the probabilities below them.
        shift: is added to each draw.
        name: by which the draw is known.
        static: the base case.
        locked: the draw is held at the base case.
        units: for the report.
        matrix: its correlations.
        copula: its place in a copula.
        partner: the draw whose rank it follows, or is followed by, in @RISK's older way.
        idle: property functions without an effect here.
    """

    lower: ir.Expression | None = None
    upper: ir.Expression | None = None
    shifted_cutoffs: bool = False
    percents: tuple[float, float] | None = None
    shift: ir.Expression | None = None
    name: ir.Expression | None = None
    static: ir.Expression | None = None
    locked: bool = False
    units: ir.Expression | None = None
    matrix: MatrixRow | None = None
    copula: MatrixRow | None = None
    partner: Partner | None = None
    idle: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Drawn:
    """What a call draws.

    Attributes:
        function: its name as its program spells it.
        family: of the draw.
        parameters: the family's parameter key -> tree.
        data: what the family is built from, row by row; empty for one that has parameters alone.
        sources: the arguments that hold the data.
        grid: how many rows and columns of independent draws the call gives.
        text: the call as written, every operation in brackets.
    """

    function: str
    family: Family
    parameters: Arguments
    data: tuple[tuple[ir.Expression, ...], ...] = ()
    sources: tuple[ir.Expression, ...] = ()
    properties: Properties = field(default_factory=Properties)
    grid: tuple[int, int] | None = None
    text: str = ""


@dataclass(frozen=True, slots=True)
class Signature:
    """How a function's arguments make a distribution.

    Attributes:
        family: its name.
        takes: what the arguments are, in order: keys of the family's parameters; `x`, `p` or `data` for lists that it
            is built from; other names for `computed` to use.
        fixed: parameters that the function does not have.
        computed: parameters that follow from the arguments.
    """

    family: str
    takes: tuple[str, ...]
    fixed: Mapping[str, float] = field(default_factory=dict)
    computed: Mapping[str, Callable[[Arguments], ir.Expression]] = field(default_factory=dict)

    def drawn(self, function: str, arguments: tuple[ir.Expression, ...], properties: Properties) -> Drawn:
        """Return the draw that these arguments, one for each of `takes`, describe.

        Raises:
            FormulaError: one is left out, or lists differ in length.
        """
        for name, argument in zip(self.takes, arguments, strict=True):
            if is_left_out(argument):
                raise FormulaError(f"{function} leaves out its argument {name!r}", hint="fill it in")
        given = dict(zip(self.takes, arguments, strict=True))
        family = FAMILIES[self.family]
        parameters: dict[str, ir.Expression] = {key: ir.Number(value) for key, value in self.fixed.items()}
        parameters |= {key: made(given) for key, made in self.computed.items()}
        parameters |= {key: given[key] for key in family.keys if key in given}
        if "data" in given:
            source = given["data"]
            return Drawn(function, family, parameters, tuple(rows_of_trees(source)), (source,), properties)
        sources = tuple(given[name] for name in ("x", "p") if name in given)
        return Drawn(function, family, parameters, _listed(function, sources), sources, properties)


def _listed(function: str, sources: tuple[ir.Expression, ...]) -> tuple[tuple[ir.Expression, ...], ...]:
    """Return lists side by side as rows.

    Raises:
        FormulaError: they differ in length.
    """
    columns = [tuple(elements(source)) for source in sources]
    if len({len(column) for column in columns}) > 1:
        lengths = " and ".join(str(len(column)) for column in columns)
        raise FormulaError(f"the lists of {function} have {lengths} elements", hint="give lists of the same length")
    return tuple(zip(*columns, strict=True))


def built_family(drawn: Drawn, data: DataRange | None, saved: Callable[[Cell], float | None]) -> Family:
    """Return the family of a draw within another, with its data.

    Raises:
        FormulaError: a cell of the data is not a number, or they are not a distribution.
    """
    if data is None:
        return drawn.family
    family = _built(drawn.family, data, saved)
    if family is None:
        hint = "give it lists of numbers, or cells that hold numbers"
        raise FormulaError(f"the data of {drawn.function} are not a distribution", hint=hint)
    return family


def base_of(
    family: Family,
    numbers: Mapping[str, float | None],
    data: DataRange | None,
    cutoffs: Cutoffs,
    limits: tuple[float | None, ...],
    saved: Callable[[Cell], float | None],
) -> float | None:
    """Return the mean; None if a number is not known before the workbook is calculated, or there is no finite mean.

    Args:
        family: of the draw; without its data.
        numbers: its parameters.
        data: what the family is built from.
        cutoffs: as the run needs them.
        limits: the same as numbers.
        saved: the number that a cell holds.
    """
    known = {key: number for key, number in numbers.items() if number is not None}
    unknown = len(known) < len(numbers) or any(
        cutoff is not None and limit is None for cutoff, limit in zip(cutoffs, limits, strict=True)
    )
    built = family if data is None else _built(family, data, saved)
    if unknown or built is None:
        return None
    if all(limit is None for limit in limits):
        mean = np.nan if built.fault(**known) else float(built.mean(**known))
    else:
        lower, upper = (end if limit is None else limit for limit, end in zip(limits, (-np.inf, np.inf), strict=True))
        mean = _mean_between(built, lower, upper, known)
    return mean if np.isfinite(mean) else None


def _built(family: Family, data: DataRange, saved: Callable[[Cell], float | None]) -> Family | None:
    """Return the family with its data; None if a cell is not calculated yet, or they are not a distribution.

    Of the latter the model tells when it is made.
    """
    values = {cell: saved(cell) for cell in data.cells}
    numbers = {cell: value for cell, value in values.items() if value is not None}
    if len(numbers) < len(values):
        return None
    try:
        return data_family(family, data, numbers.__getitem__)
    except DefinitionError:
        return None


def _mean_between(family: Family, lower: float, upper: float, known: Mapping[str, float]) -> float:
    cut = Truncated(family)
    if cut.fault(lower, upper, **known):
        return np.nan
    values = family.bind((), known)
    piece = Distribution(Slice(Member(family, values), lower, upper))
    if piece.is_discrete:
        return piece.mean()
    nodes, weights = gauss_legendre(_NODES)
    return float(weights @ cut.ppf((nodes + 1) / 2, lower, upper, *values) / 2)


def percentile_cutoffs(drawn: Drawn, numbers: Mapping[str, float | None], percents: tuple[float, float]) -> Cutoffs:
    """Return the cutoffs below which these probabilities lie; None for one at an end.

    Raises:
        FormulaError: a parameter is not a number that is known before the workbook is calculated.
    """
    known = {key: number for key, number in numbers.items() if number is not None}
    if len(known) < len(numbers) or drawn.data or drawn.family.fault(**known):
        hint = "cut off at values with RiskTruncate, or give the parameters as numbers"
        raise FormulaError(f"RiskTruncateP of {drawn.function} needs parameters that are fixed numbers", hint=hint)
    values = drawn.family.bind((), known)
    low, high = percents
    return (
        None if low == 0 else float(drawn.family.ppf(low, *values)),
        None if high == 1 else float(drawn.family.ppf(high, *values)),
    )
