"""The scenarios that `RiskSimtable` asks for: with its second value, with its third, …

Every `RiskSimtable` of the workbook gives its first value in the workbook itself, and its n-th in the scenario of that
number, over the same random numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from xlmc.address import Cell
from xlmc.definitions.problems import Findings
from xlmc.definitions.scenarios import Scenario, Tabulated
from xlmc.formula import formula_text, ir

__all__ = ["simtable_scenarios"]


def simtable_scenarios(
    tables: Mapping[Cell, Sequence[Sequence[ir.Expression]]], findings: Findings
) -> Iterator[Scenario]:
    """The scenarios, in order; none where no table has a second value.

    Args:
        tables: the cells with `RiskSimtable` -> the values of each.
        findings: takes the notice that a run uses the first.
    """
    most = max((len(values) for found in tables.values() for values in found), default=1)
    if most == 1:
        return
    first = next(iter(tables))
    message = f"RiskSimtable has {most} values, and a run uses the first; simulate --scenarios runs the others, too"
    findings.notice(message, first)
    for number in range(2, most + 1):
        shown = "; ".join(
            f"{cell} {', '.join(formula_text(values[number - 1]) for values in found if number <= len(values))}"
            for cell, found in tables.items()
        )
        yield Scenario(f"simulation {number}", (Tabulated(number, shown, first),), row=first)
