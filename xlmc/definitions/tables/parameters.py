"""The distribution of an assumption row: its parameters and cutoffs, each from a table cell of its own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from xlmc.address import Cell
from xlmc.definitions.findings import Findings
from xlmc.definitions.model import Parameter
from xlmc.definitions.tables.fields import parameter, static_value
from xlmc.definitions.tables.percentiles import is_percentile
from xlmc.definitions.tables.tables import Row
from xlmc.distributions import FAMILIES, Family, ParameterSpec, Truncated
from xlmc.distributions.base import show
from xlmc.distributions.naming import plain
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Workbook

__all__ = ["CUTOFFS", "DATA", "PARAMETER_HEADINGS", "Given", "given_parameters", "range_of", "remark_on_range"]

CUTOFFS = {"lower_cutoff": "Lower cutoff", "upper_cutoff": "Upper cutoff"}

DATA = "Data"

_OURS = (heading for family in FAMILIES.values() for spec in family.parameters for heading in spec.headings)

PARAMETER_HEADINGS = tuple(dict.fromkeys((*_OURS, DATA)))
"""Every column that means a parameter of some distribution, beside percentiles: filled in, it is no note."""

_LIMITS = frozenset({"low", "minimum", "min", "high", "maximum", "max"})


@dataclass(frozen=True, slots=True)
class Given:
    """The parameters and cutoffs of a row by key, as a run needs them.

    Attributes:
        places: the table's own cells that hold them; the row's first cell for one that is left to its default.
    """

    parameters: dict[str, Parameter]
    cutoffs: dict[str, Parameter]
    places: dict[str, Cell]


def given_parameters(row: Row, family: Family, findings: Findings) -> Given:
    """The family's parameters and the cutoffs in this row; every mistake is recorded on its own."""
    parameters: dict[str, Parameter] = {
        spec.key: spec.default
        for spec in family.parameters
        if spec.default is not None and not any(map(row.filled, spec.headings))
    }
    given = Given(parameters, {}, dict.fromkeys(parameters, row.where))
    required = (spec for spec in family.parameters if spec.key not in parameters)
    headings = {spec.key: findings.attempt(_heading_of, row, family, spec) for spec in required}
    headings |= {key: heading for key, heading in CUTOFFS.items() if row.filled(heading)}
    for key, heading in headings.items():
        value = None if heading is None else findings.attempt(parameter, row, heading)
        if heading is not None and value is not None:
            given.places[key] = row.cell(heading)
            (given.cutoffs if key in CUTOFFS else given.parameters)[key] = value
    _refuse_unused(row, family, findings)
    return given


def range_of(family: Family, given: Given, workbook: Workbook) -> tuple[float, float] | None:
    """Check the rules of the family on the numbers as they are now, typed in or as Excel cached them.

    A run checks dynamic ones in every trial.

    Returns:
        The least and the largest draw; None where a number is not known.

    Raises:
        DefinitionError: a rule is broken; it names the cell of the parameter to look at first.
    """
    numbers: dict[str, float] = {}
    for key, value in (given.parameters | given.cutoffs).items():
        number = static_value(value, workbook)
        if number is None:
            return None
        numbers[key] = number
    lower, upper = numbers.pop("lower_cutoff", -math.inf), numbers.pop("upper_cutoff", math.inf)
    fault = Truncated(family).fault(lower, upper, **numbers) if given.cutoffs else family.fault(**numbers)
    if fault is not None:
        raise DefinitionError(fault.message, where=given.places[fault.key], hint=fault.hint)
    low, high = family.support(**numbers)
    return max(float(low), lower), min(float(high), upper)


def remark_on_range(
    family: Family,
    ends: tuple[float, float],
    places: Mapping[str, Cell],
    base: float | None,
    cell: Cell,
    findings: Findings,
) -> None:
    """Point out what is allowed but may be a slip: a constant, a base case that could never be drawn.

    Args:
        family: of the assumption.
        ends: the least and the largest draw.
        places: where its parameters stand, by key.
        base: the base case, if there is any.
        cell: of the assumption.
        findings: takes the remarks.
    """
    low, high = ends
    if low == high:
        both = "Low and High are both" if {"low", "high"} <= {*family.keys} else "Every draw is"
        where = places[family.keys[0]] if family.keys else cell
        findings.notice(f"{both} {show(low)}: the assumption does not vary", where)
    if base is not None and not low <= base <= high:
        reach = f"{show(low)} to {show(high)}"
        findings.notice(f"The base case ({show(base)}) lies outside the distribution ({reach})", cell)


def _heading_of(row: Row, family: Family, spec: ParameterSpec) -> str:
    """The one column that gives the parameter in this row.

    Raises:
        DefinitionError: none does, or two do.
    """
    filled = [heading for heading in spec.headings if row.filled(heading)]
    if len(filled) > 1:
        message = f"{spec.heading} is given twice, as {row.heading(filled[0])} and as {row.heading(filled[1])}"
        raise DefinitionError(message, where=row.cell(filled[1]), hint="Clear one of them")
    if filled:
        return filled[0]
    present = [heading for heading in spec.headings if row.has(heading)]
    if present:
        message = f"{family.name} needs {row.heading(present[0])}, and this cell is blank"
        raise DefinitionError(message, where=row.cell(present[0]), hint="Type a number, or a formula that gives one")
    message = f"{family.name} needs {spec.heading}, and the table has no such column"
    raise DefinitionError(message, where=row.where, hint=f"Add a column {spec.heading}")


def _refuse_unused(row: Row, family: Family, findings: Findings) -> None:
    """A number that is silently ignored would mislead: whoever gives a Normal a Low believes that it ends there."""
    used = {plain(heading) for spec in family.parameters for heading in spec.headings}
    used |= {plain(DATA)} if family.data else set()
    for heading in (*PARAMETER_HEADINGS, *filter(is_percentile, row.headings)):
        if plain(heading) in used or not row.filled(heading):
            continue
        hint = "Clear the cell, or choose a distribution that has this parameter"
        if plain(heading) in _LIMITS:
            hint = "Clear the cell; to cut the distribution off, use Lower cutoff and Upper cutoff"
        findings.problem(f"{family.name} has no {row.heading(heading)}", row.cell(heading), hint)
