"""Search a workbook for digits that are wrong, and for numbers that do not mean what they seem to mean."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.stability.averaged_directions import averaged_directions
from xlmc.analysis.studies.stability.case import Case
from xlmc.analysis.studies.stability.detectors import (
    amplifying_forecasts,
    heavy_tails,
    jumps,
    narrow_filters,
    rounded_angles,
)
from xlmc.analysis.studies.stability.digit_findings import CellDigits, Finding, Level, Stability
from xlmc.analysis.studies.stability.edges import domain_edges
from xlmc.analysis.studies.stability.extent import Extent
from xlmc.analysis.studies.stability.quadrant import lost_quadrants
from xlmc.analysis.studies.stability.repeated_steps import as_one
from xlmc.analysis.studies.stability.rounding_errors import cell_digits, lost_digits
from xlmc.analysis.studies.stability.starts import dependence_on_starts
from xlmc.analysis.studies.steps import Steps, Tell
from xlmc.engine.graph.nodes import Apply
from xlmc.engine.passes.derivatives.sweep import owners
from xlmc.errors import SimulationError
from xlmc.montecarlo.simulation.simulate import simulate

if TYPE_CHECKING:
    from xlmc.excel.address import Cell
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["stability"]

_DETECTORS: Final[Mapping[str, Callable[[Case], Iterable[Finding]]]] = {
    "lost quadrants": lost_quadrants,
    "averaged directions": averaged_directions,
    "lost digits": lost_digits,
    "heavy tails": heavy_tails,
    "narrow filters": narrow_filters,
    "edges of domains": domain_edges,
    "jumps": jumps,
    "starts of iterations": dependence_on_starts,
    "angles": rounded_angles,
    "amplification": amplifying_forecasts,
}
"""What is looked for -> what finds it."""


def stability(
    model: CompiledModel,
    *,
    trials: int | None = None,
    seed: int | None = None,
    jobs: int = 1,
    tell: Tell | None = None,
) -> Stability:
    """Look through the cells that a model needs.

    A first Ctrl-C ends it with what was found by then (`Stability.ended`), the run with the blocks of trials in
    progress.

    Args:
        model: the workbook.
        trials: of the run that is looked at; by default the book's own.
        seed: of it.
        jobs: threads or processes.
        tell: called before every step with what it is, how many are left, and how long they may take.

    Raises:
        SimulationError: an argument is out of its range.
        FormulaError: the arrays of the workbook are too large to be looked at.
    """
    if model.definitions.python:
        hint = "Write the model as formulas of a workbook, which can be computed again with 50 digits"
        raise SimulationError("A function of Python has no formulas to look through", where=model.path, hint=hint)
    extent = Extent(model)
    with Steps(tell) as steps:
        steps.begin("a run")
        run = steps.first_run(partial(simulate, model, trials=trials, seed=seed, jobs=jobs, keep_interrupted=True))
        steps.can_end()
        case = Case(extent, run, run.settings.seed)
        steps.expect(len(_DETECTORS) + 1)
        findings: list[Finding] = []
        left = dict(_DETECTORS)
        for name, detector in steps.each(_DETECTORS.items()):
            steps.begin(name)
            with steps.left_at_once():
                findings += list(detector(case))
                del left[name]
        cells: tuple[CellDigits, ...] = ()
        if not steps.ended:
            steps.begin("what every cell amplifies")
            with steps.left_at_once():
                cells = tuple(cell_digits(case))
        ended = steps.why_ended if left or not cells else ""
    ranked = sorted(
        as_one(case, _first_causes(case, findings), _OF_DIGITS), key=lambda finding: (finding.level, -finding.size)
    )
    return Stability(run, tuple(ranked), cells, _unchecked_functions(case), case.n, case.recomputed, ended, tuple(left))


_OF_DIGITS: Final = frozenset({"division", "cancellation", "rounding"})
_OF_NUMBERS: Final = frozenset({"tail", "amplification"})


def _first_causes(case: Case, findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings without those on numbers whose digits are wrong anyway."""
    result = list(findings)
    lost = [one.cell for one in result if one.level is Level.WRONG and one.kind in _OF_DIGITS]
    reached = {cell for cell in (one.cell for one in result) if any(part in case.upstream(cell) for part in lost)}
    return [one for one in result if one.kind not in _OF_NUMBERS or one.cell not in reached]


def _unchecked_functions(case: Case) -> tuple[tuple[Cell, tuple[str, ...]], ...]:
    """Return the cells that hold functions which were not computed with 50 digits."""
    dag, whose = case.lowering.dag, owners(case.lowering)
    whose |= {node: dag.hosts[at] for node in case.dag.closed if (at := bisect_right(dag.ends, node)) < len(dag.hosts)}
    result: dict[Cell, list[str]] = {}
    for node in sorted(case.unchecked):
        formula = dag.origins.get(node, dag.nodes[node])
        if isinstance(formula, Apply) and node in whose:
            names = result.setdefault(whose[node], [])
            if formula.function.name not in names:
                names.append(formula.function.name)
    return tuple((cell, tuple(names)) for cell, names in result.items())
