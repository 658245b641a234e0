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

__all__ = ["CUTOFFS", "DATA", "PARAMETER_HEADINGS", "Given", "given_parameters", "remark_on_range", "rules_kept"]

CUTOFFS = {"lower_cutoff": "Lower cutoff", "upper_cutoff": "Upper cutoff"}

DATA = "Data"

_OURS = (heading for family in FAMILIES.values() for spec in family.parameters for heading in spec.headings)

PARAMETER_HEADINGS = tuple(dict.fromkeys((*_OURS, DATA)))
"""Every column that means a parameter of some distribution, beside percentiles: filled in, it is no note."""

_LIMITS = frozenset({"low", "minimum", "min", "high", "maximum", "max"})


@dataclass(frozen=True, slots=True)
class Given:
    """The parameters and cutoffs of a row by key.

    Attributes:
        values: as a run needs them.
        places: the table's own cells that hold them; the row's first cell for one that is left to its default.
        numbers: what they are now, typed in or as Excel cached them; None where that is unknown.
    """

    values: Mapping[str, Parameter]
    places: Mapping[str, Cell]
    numbers: Mapping[str, float | None]

    def known(self) -> tuple[dict[str, float], float, float] | None:
        """The parameters and the two cutoffs as numbers; None unless every one is known."""
        numbers = {key: value for key, value in self.numbers.items() if value is not None}
        if len(numbers) < len(self.numbers):
            return None
        lower, upper = numbers.pop("lower_cutoff", -math.inf), numbers.pop("upper_cutoff", math.inf)
        return numbers, lower, upper


def given_parameters(row: Row, family: Family, findings: Findings) -> Given:
    """The family's parameters and the cutoffs in this row; every mistake is recorded on its own."""
    defaults = {spec.key: spec.default for spec in family.parameters if _is_left_out(row, spec)}
    required = (spec for spec in family.parameters if spec.key not in defaults)
    headings = {spec.key: findings.attempt(_heading_of, row, family, spec) for spec in required}
    headings |= {key: heading for key, heading in CUTOFFS.items() if row.filled(heading)}
    values: dict[str, Parameter] = {key: value for key, value in defaults.items() if value is not None}
    places: dict[str, Cell] = dict.fromkeys(values, row.where)
    for key, heading in headings.items():
        value = None if heading is None else findings.attempt(parameter, row, heading)
        if heading is not None and value is not None:
            values[key], places[key] = value, row.cell(heading)
    _refuse_unused(row, family, findings)
    return Given(values, places, {key: static_value(value, row.workbook) for key, value in values.items()})


def rules_kept(family: Family, given: Given) -> None:
    """Check the rules of the family on the numbers as they are now; a run checks dynamic ones in every trial.

    Raises:
        DefinitionError: a rule is broken; it names the cell of the parameter to look at first.
    """
    known = given.known()
    if known is None:
        return
    numbers, lower, upper = known
    cut = not given.places.keys().isdisjoint(CUTOFFS)
    fault = Truncated(family).fault(lower, upper, **numbers) if cut else family.fault(**numbers)
    if fault is not None:
        raise DefinitionError(fault.message, where=given.places[fault.key], hint=fault.hint)


def remark_on_range(family: Family, given: Given, base: float | None, cell: Cell, findings: Findings) -> None:
    """Point out what is allowed but may be a slip: a constant, a base case that could never be drawn."""
    known = given.known()
    if known is None:
        return
    numbers, lower, upper = known
    low, high = (float(end) for end in Truncated(family).support(lower, upper, **numbers))
    if low == high:
        where = given.places[family.keys[0]] if family.keys else cell
        ends = "Low and High are both" if {"low", "high"} <= {*family.keys} else "Every draw is"
        findings.notice(f"{ends} {show(low)}: the assumption does not vary", where)
    if base is not None and not low <= base <= high:
        reach = f"{show(low)} to {show(high)}"
        findings.notice(f"The base case ({show(base)}) lies outside the distribution ({reach})", cell)


def _is_left_out(row: Row, spec: ParameterSpec) -> bool:
    return spec.default is not None and not any(row.filled(heading) for heading in spec.headings)


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
