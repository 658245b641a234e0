"""Findings on a step that a sheet repeats, such as an unstable recurrence: one for all of its cells."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from xlmc.analysis.studies.stability.case import Case
from xlmc.analysis.studies.stability.digit_findings import Finding
from xlmc.analysis.studies.stability.formula_trees import parts_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir

__all__ = ["as_one"]


def as_one(case: Case, findings: Iterable[Finding], kinds: Collection[str]) -> list[Finding]:
    """Return the findings with one in the place of those on cells that repeat a step, each with the result of another.

    Cells repeat a step where their formulas differ in numbers and references alone. The worst finding stays, and says
    of how many cells it is.

    Args:
        case: the evidence.
        findings: any.
        kinds: of those that a step hands on.
    """
    chains: list[list[Finding]] = []
    for finding in findings:
        chain = next((chain for chain in chains if finding.kind in kinds and _continues(case, chain, finding)), None)
        if chain is None:
            chains.append([finding])
        else:
            chain.append(finding)
    return [_worst(case, chain) for chain in chains]


def _continues(case: Case, chain: list[Finding], finding: Finding) -> bool:
    """Whether a finding is on a cell that needs one of the chain, or that one of these needs, by the same step."""
    first = chain[0]
    if first.kind != finding.kind or first.cell.sheet != finding.cell.sheet:
        return False
    if _step(case, first.cell) != _step(case, finding.cell):
        return False
    needed = case.upstream(finding.cell)
    return any(one.cell in needed or finding.cell in case.upstream(one.cell) for one in chain)


def _step(case: Case, cell: Cell) -> tuple[str, ...]:
    """Return the operators and functions of a formula, in order."""
    return tuple(_name(part) for part in parts_of(case.trees.formula(cell)))


def _name(part: ir.Expression) -> str:
    match part:
        case ir.Binary(operator, _, _) | ir.Unary(operator, _):
            return operator
        case ir.Call(name, arguments):
            return f"{name}({len(arguments)})"
        case _:
            return type(part).__name__


def _worst(case: Case, chain: list[Finding]) -> Finding:
    worst = min(chain, key=lambda one: (one.level, -one.size))
    if len(chain) == 1:
        return worst
    order = sorted((one.cell for one in chain), key=lambda cell: len(case.upstream(cell)))
    addition = f"; {len(chain)} cells repeat this step, from {order[0]} to {order[-1]}, and each loses more"
    return replace(worst, what=f"{worst.what}{addition}")
