"""The short searches: heavy tails, narrow filters, jumps, rounded angles, forecasts that amplify."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case, Floats
from xlmc.analysis.studies.stability.digit_findings import Finding, Level, Where
from xlmc.analysis.studies.stability.quadrant import arctangents, guards
from xlmc.analysis.studies.stability.rewriting import angles_in_degrees, without_quotient
from xlmc.engine.graph.nodes import Constant, uses
from xlmc.engine.passes.random_rounding import formula_of, numbers_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.lookup.search_and_pick import POSITION
from xlmc.montecarlo.number_text import count_text, number_text, styled_text
from xlmc.montecarlo.statistics.heavy_tails import heavy_tail

__all__ = ["amplifying_forecasts", "heavy_tails", "jumps", "narrow_filters", "rounded_angles"]

_LIMIT: Final = 1e3
"""Relative change of the forecast per relative change of the assumptions, all together, in the median trial."""

_FEW: Final = 1e-3
"""Share of accepted trials, of all."""

_LEFT: Final = 0.1
"""A share of the larger angle: a difference above it loses less than a digit."""

_NEAREST: Final = 20
"""Trials nearest to where the condition changes."""

_LEAST_SHARE: Final = 0.01
"""A share of the cell's central range: a smaller jump is not reported."""


def heavy_tails(case: Case) -> Iterator[Finding]:
    """Distributions with such heavy tails that a mean or a standard deviation never converges.

    These are looked for in forecasts, among accepted trials, and in cells that filters look at, among all trials. The
    tail is measured by Hill's estimator of its index α: P(|x - median| > t) falls as t^-α. The mean exists above 1, the
    standard deviation above 2. A quotient whose divisor goes through 0 has α = 1.
    """
    for forecast in case.model.forecasts:
        x = np.asarray(case.run[forecast.name].values)
        if (pair := heavy_tail(x)) is not None:
            index, _ = pair
            effect = f"{_statistic(*pair)} as far as these trials show: more trials do not help; report percentiles"
            yield _finding(case, Level.DOUBTFUL, forecast.cell, forecast.name, index, effect, None)
    for filter_ in case.model.filters:
        x = case.number(case.node[filter_.cell])[case.special : case.first_accepted]
        if (pair := heavy_tail(x)) is not None:
            index, _ = pair
            host = _quotient_of(case, filter_.cell)
            better = without_quotient(case, filter_, host) if host is not None else None
            effect = (
                "a filter only compares it with limits, so the forecasts are not affected; its mean and SD mean nothing"
            )
            yield _finding(case, Level.NOTE, filter_.cell, filter_.name, index, effect, better)


def _statistic(index: float, error: float) -> str:
    if index + 2 * error < 1:
        return "neither its mean nor its SD converges"
    return f"its SD does not converge{', and its mean hardly or not at all' if index - 2 * error <= 1 else ''}"


def _quotient_of(case: Case, cell: Cell) -> ir.Expression | None:
    """Return the formula behind a cell that may only refer to it."""
    formulas = case.lowering.graph.formulas
    tree: ir.Expression | None = case.trees.formula(cell) if cell in formulas else None
    while isinstance(tree, Cell):
        tree = case.trees.formula(tree) if tree in formulas else None
    return tree


def _finding(
    case: Case, level: Level, cell: Cell, name: str, index: float, effect: str, better: ir.Expression | None
) -> Finding:
    return Finding(
        level,
        "tail",
        cell,
        name,
        case.trees.written_formula(cell),
        f"it has a heavy tail: large values t become rare only as t^-{styled_text(index, '.1f')} does, "
        "as those of a quotient whose "
        "divisor goes through 0",
        effect,
        (),
        case.trees.offer_formula(better, cell),
        1 / index,
    )


def amplifying_forecasts(case: Case) -> Iterator[Finding]:
    """Return the forecasts that amplify a thousand times and more in half of the trials."""
    for forecast in case.model.forecasts:
        one = case.derivatives.forecasts[forecast.name]
        with np.errstate(all="ignore"):
            moved = np.abs(one.gradient * case.derivatives.points)
            amplified = np.nansum(moved, axis=1) / np.maximum(np.abs(one.value), 0.01 * case.scale(forecast.cell))
        known = amplified[np.isfinite(amplified)]
        if not known.size or np.median(known) < _LIMIT:
            continue
        through = case.derivatives.names[int(np.nansum(moved, axis=0).argmax())]
        factor = float(np.median(known))
        percent = f"{number_text(float(f'{factor:.2g}'))} %"
        yield Finding(
            Level.NOTE,
            "amplification",
            forecast.cell,
            forecast.name,
            case.trees.written_formula(forecast.cell),
            f"it changes by {percent} when its assumptions change by 1 %, mostly through {through!r}",
            "this comes from the problem itself: no other formula and no more digits reduce it; other evidence does",
            (),
            None,
            factor,
        )


def narrow_filters(case: Case) -> Iterator[Finding]:
    """One finding where the filters together accept less than a thousandth."""
    run = case.run
    if not run.model.filters or run.accepted >= _FEW * run.trials:
        return
    rejected = {row.name: int(count) for row, count in zip(run.model.filters, run.tally.rejected, strict=True)}
    worst = max(rejected, key=lambda name: rejected[name])
    filter_ = next(row for row in run.model.filters if row.name == worst)
    effect = "the answer comes from the edge of the ranges" if run.accepted else "there is no answer"
    yield Finding(
        Level.WRONG if not run.accepted else Level.DOUBTFUL,
        "filter",
        filter_.cell,
        worst,
        case.trees.written_formula(filter_.cell),
        f"the filters accept {count_text(run.accepted)} of {count_text(run.trials)} trials; {worst!r} "
        f"rejects most, {count_text(rejected[worst])}",
        f"{effect}: check whether ranges, evidence and model contradict each other",
        (),
        None,
        1.0 - run.accepted / run.trials,
    )


def rounded_angles(case: Case) -> Iterator[Finding]:
    """Return the cells that subtract angles so, and in which little is left of them in some trials."""
    for cell in case.cells:
        left = min((_left(case, cell, part) for part in case.trees.parts(cell)), default=1.0)
        better = angles_in_degrees(case.trees.formula(cell)) if left < _LEFT else None
        if better is not None:
            yield Finding(
                Level.NOTE,
                "angles",
                cell,
                case.trees.title(cell),
                case.trees.written_formula(cell),
                "it subtracts angles after RADIANS, which rounds them; in degrees the difference is exact",
                f"as little as {number_text(left, 1)} of the angles is left, and the difference loses "
                "as many of their digits",
                (),
                case.trees.offer_formula(better, cell),
                1 / max(left, 1e-16),
            )


def _left(case: Case, cell: Cell, part: ir.Expression) -> float:
    """Return the smallest difference as a share of the larger angle; 1 where the part is none."""
    if angles_in_degrees(part) is None or not isinstance(part, ir.Binary) or part.operator != "-":
        return 1.0
    nodes = [case.trees.node_of(tree, cell) for tree in (part, part.left, part.right)]
    if any(node not in case.values for node in nodes):
        return 1.0
    difference, first, second = (np.abs(case.number(node)) for node in nodes if node is not None)
    with np.errstate(all="ignore"):
        return float(np.nanmin(difference / np.fmax(first, second)))


def jumps(case: Case) -> Iterator[Finding]:
    """Formulas that jump within the ranges, and by how much.

    These are an IF whose branches differ where its condition changes, and a lookup that finds different cells.
    """
    mending = _mending(case)
    for cell in case.cells:
        for part in case.trees.parts(cell):
            if isinstance(part, ir.Call) and part.name == "IF" and len(part.arguments) > 1:
                if _is_among(case, cell, part, mending):
                    continue
                finding = _of_choice(case, cell, part)
                if finding is not None:
                    yield finding
    for kink in case.derivatives.kinks:
        row = POSITION if kink.function == POSITION.name else function_named(kink.function)
        if row is not None and row.facts.jumps and kink.cell in case.node:
            text = f"{kink.function} finds {kink.branches} different cells among the trials"
            yield _jump_finding(case, kink.cell, text, "the result steps from one cell to the next", kink.share)


def _mending(case: Case) -> set[int]:
    """Return the choices that put the quadrant of an arctangent right: they jump so that the angle does not."""
    result: set[int] = set()
    for cell in case.cells:
        for one in arctangents(case, cell):
            if (case.number(one.divisor) < 0).any():
                for node in guards(case, one.node, one.divisor).holding:
                    result |= {node, *uses(formula_of(case.dag, node))}
    return result


def _is_among(case: Case, cell: Cell, part: ir.Call, mending: set[int]) -> bool:
    node = case.trees.node_of(part, cell)
    return node is not None and node in mending


def _of_choice(case: Case, cell: Cell, part: ir.Call) -> Finding | None:
    test = part.arguments[0]
    if not (isinstance(test, ir.Binary) and test.operator in ("<", "<=", ">", ">=")):
        return None
    branches = [*part.arguments[1:], ir.Number(0.0)][:2]
    left, right, yes, no = (_numbers(case, cell, tree) for tree in (test.left, test.right, *branches))
    if left is None or right is None or yes is None or no is None:
        return None
    gap = left - right
    known = np.isfinite(gap) & np.isfinite(yes) & np.isfinite(no)
    if not ((gap[known] > 0).any() and (gap[known] < 0).any()):
        return None
    drawn = known & (np.arange(case.n) >= case.special)
    nearest = np.argsort(np.where(drawn if drawn.any() else known, np.abs(gap), np.inf))[:_NEAREST]
    share = float(np.median(np.abs(yes - no)[nearest])) / case.scale(cell)
    if share < _LEAST_SHARE:
        return None
    near = np.zeros(case.n, bool)
    near[nearest] = True
    text = f"{case.trees.text(test, cell)} changes within the ranges, and the two branches of the IF differ there"
    effect = f"the choice jumps by about {number_text(share, 2)} of the central range of the cell"
    node = case.trees.node_of(test, cell)
    return _jump_finding(case, cell, text, effect, share, () if node is None else case.where(near, node))


def _numbers(case: Case, cell: Cell, tree: ir.Expression) -> Floats | None:
    node = case.trees.node_of(tree, cell)
    if node is None:
        return None
    formula = case.dag.nodes[node]
    if node in case.values:
        return case.number(node)
    return numbers_of(formula.value, case.n) if isinstance(formula, Constant) else None


def _jump_finding(
    case: Case,
    cell: Cell,
    what: str,
    effect: str,
    size: float,
    where: tuple[Where, ...] = (),
) -> Finding:
    return Finding(
        Level.NOTE,
        "jump",
        cell,
        case.trees.title(cell),
        case.trees.written_formula(cell),
        what,
        effect,
        where,
        None,
        size,
    )
