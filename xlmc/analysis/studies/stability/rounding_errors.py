"""Cells whose rounding errors are larger than rounding the assumptions would make them, or that are large at all.

A cell is named where it loses more than the cells that it depends on; cells that depend on it only pass the loss on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Bools, Case, Floats
from xlmc.analysis.studies.stability.culprits import (
    Cancellation,
    Division,
    cancellation,
    culprit,
    divisions,
    left_of,
    only_assumption,
    zeros,
)
from xlmc.analysis.studies.stability.digit_findings import CellDigits, Finding, Level, Where
from xlmc.analysis.studies.stability.rewriting import of_small_changes, same, without_cosine
from xlmc.analysis.studies.stability.stable_forms import LOGARITHMS
from xlmc.analysis.studies.stability.steadying import steady_form
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.diagnostics.digit_watch import DUST, MOST_OF_SPREAD
from xlmc.montecarlo.number_text import number_text, styled_text

__all__ = ["cell_digits", "lost_digits"]

_EXCESS: Final = 10.0
"""Times the error that rounding the assumptions brings: from here on the form of the formula is to blame. Formulas
that are well written stay below 7 in the worst of some thousand trials."""

_NOTICED: Final = 3e-14
"""A share of a central range: two of sixteen digits. Less than that is not worth another formula."""

_VISIBLE: Final = 1e-6
"""A share of a central range: an error of this size is reported, whatever its cause."""

_UNUSABLE: Final = 1e-3
"""A share of a central range: with an error of this size the numbers must not be used."""

_WORST: Final = 12
"""Trials that are computed again with 50 digits for a cell."""

_HANDED_ON: Final = 3.0
"""A cell is the source where its loss is so many times the largest among what it depends on."""

_SHOWING: Final = 20

_SIZE_OF_NOTHING: Final = 1e6
"""The size of a finding that shows a number where there is none: it is ranked before errors that are smaller."""

_STEEP: Final = frozenset({"ACOS", "ASIN"})

_SMALL: Final = 0.2

_LEAST: Final = 0.01
"""A share of a central range: a change is divided by no less than that where the value itself goes through 0."""

_TRIALS: Final = 24


@dataclass(frozen=True, slots=True, eq=False)
class _Loss:
    """One cell: its errors, `(n,)`, as shares of its size, and of what rounding the assumptions alone would bring."""

    cell: Cell
    error: Floats
    excess: Floats

    @property
    def worst(self) -> float:
        return float(np.nanmax(self.error, initial=0.0))

    @property
    def most(self) -> float:
        return float(np.nanmax(self.excess, initial=0.0))


def _losses(case: Case) -> dict[Cell, _Loss]:
    result = {}
    for cell in case.cells:
        error = case.errors[case.node[cell]]
        inherent = case.inherent(cell)
        with np.errstate(all="ignore"):
            excess = np.where((inherent > 0) & np.isfinite(inherent), error / inherent, 0.0)
        result[cell] = _Loss(cell, error / _size(case, cell), excess)
    return result


def _size(case: Case, cell: Cell) -> Floats:
    """Return what an error is measured against, `(n,)`: the central range, or the value where that is larger."""
    return np.fmax(np.abs(case.number(case.node[cell])), case.scale(cell))


def lost_digits(case: Case) -> Iterator[Finding]:
    """Return the cells that lose digits themselves."""
    losses = _losses(case)
    named: set[Cell] = set()
    for cell, loss in losses.items():
        before = [losses[part] for part in case.lowering.graph.needs.get(cell, ()) if part in losses]
        excess, error = (max((getattr(b, name) for b in before), default=0.0) for name in ("most", "worst"))
        by_form = loss.most >= _EXCESS and loss.worst >= _NOTICED and loss.most >= _HANDED_ON * excess
        by_size = loss.worst >= _VISIBLE and loss.worst >= 10 * _HANDED_ON * error
        if by_form or by_size:
            finding = _finding(case, loss, by_form)
            if finding is not None:
                named.add(cell)
                yield finding
    for answer in _answers(case):
        if not named & case.upstream(answer) and (source := _absorbed(case, answer)) is not None:
            named.add(source)
            yield _of_absorbed(case, source, answer)


def _answers(case: Case) -> list[Cell]:
    """Return the cells of forecasts and filters that vary with an assumption."""
    rows = [*(each.cell for each in case.model.forecasts), *(each.cell for each in case.model.filters)]
    return [
        cell for cell in dict.fromkeys(rows) if cell in case.lowering.graph.formulas and case.inputs_of(case.node[cell])
    ]


def _absorbed(case: Case, answer: Cell) -> Cell | None:
    """Return the first cell on the way to an answer that is visibly off in most trials; None if the answer is not.

    What is absorbed whole shows no error by random rounding: 1-COS(x) of a tiny x is 0, and 1 and 0 are exact.
    """
    if _off(case, answer)[0] < _VISIBLE:
        return None
    upstream = case.upstream(answer)
    return next(cell for cell in case.cells if cell in upstream and _off(case, cell)[0] >= _VISIBLE)


def _off(case: Case, cell: Cell) -> tuple[float, float, float]:
    """How far off a cell is by 50 digits, as a share of its value, in the median of some trials; in such a trial, what
    it shows, and what it is. A 0 that rounding has moved is not off.
    """
    node = case.node[cell]
    result = []
    for trial in _some_trials(case, _WORST):
        shown, exact = float(case.number(node)[trial]), case.exact_number(node, trial)
        size = max(abs(shown), abs(exact))
        is_zero = exact == 0.0 and abs(shown) <= DUST * case.term_sizes[node]
        if np.isfinite(size):
            result.append((0.0 if is_zero or not size else abs(shown - exact) / size, shown, exact))
    return sorted(result)[len(result) // 2] if result else (0.0, 0.0, 0.0)


def _of_absorbed(case: Case, cell: Cell, answer: Cell) -> Finding:
    """Return the finding on a cell that absorbs what an answer needs."""
    share, shown, exact = _off(case, answer)
    what, instead, ranges = _explain(case, cell, _some_trials(case, _WORST))
    title = case.trees.title(answer) or str(answer)
    return Finding(
        Level.WRONG if share >= _UNUSABLE else Level.DOUBTFUL,
        "rounding" if what is None else what[0],
        cell,
        case.trees.title(cell),
        case.trees.written_formula(cell),
        f"{case.trees.title(cell) or cell} loses digits" if what is None else what[1],
        f"rounding takes all digits of a part: {title!r} shows {number_text(shown)} in a trial in "
        f"which it is {number_text(exact)}",
        ranges,
        instead,
        share,
    )


def _finding(case: Case, loss: _Loss, by_form: bool) -> Finding | None:
    """Return the finding, where 50 digits confirm it."""
    cell, node = loss.cell, case.node[loss.cell]
    measure = loss.excess if by_form and loss.worst < _VISIBLE else loss.error
    worst = [int(trial) for trial in np.argsort(np.nan_to_num(measure))[::-1][:_WORST]]
    shown = case.number(node)
    off, share, missing = 0.0, 0.0, False
    of = "central range"
    size = _size(case, cell)
    for trial in worst:
        exact = case.exact_number(node, trial)
        if np.isnan(exact) != np.isnan(shown[trial]):
            missing |= not _is_missing_before(case, cell, trial)
        elif not np.isnan(exact) and not (exact == 0 and abs(shown[trial]) <= DUST * case.term_sizes[node]):
            error = abs(float(shown[trial]) - exact)
            off = max(off, error)
            if error / float(size[trial]) > share:
                share = error / float(size[trial])
                of = "value" if size[trial] > case.scale(cell) else "central range"
    inherent = float(np.nanmax(case.inherent(cell)[worst]))
    times = off / inherent if inherent > 0 else float("inf")
    if not missing and share < _VISIBLE and (times < _EXCESS / 3 or share < _NOTICED / 3):
        return None
    bad = np.asarray(loss.error >= _UNUSABLE)
    random = bool(bad[case.special :].any())
    blurred = _spread(case, cell)
    level = Level.WRONG if ((share >= _UNUSABLE or missing) and random) or blurred.is_rounding else Level.DOUBTFUL
    what, instead, ranges = _explain(case, cell, worst)
    return Finding(
        level,
        "rounding" if what is None else what[0],
        cell,
        case.trees.title(cell),
        case.trees.written_formula(cell),
        f"{case.trees.title(cell) or cell} loses digits" if what is None else what[1],
        _effect(case, cell, share, of, loss, missing, random, blurred),
        ranges or case.where(_where(case, loss, by_form), node),
        instead,
        _SIZE_OF_NOTHING if missing else share if level is Level.WRONG else loss.most,
    )


def _where(case: Case, loss: _Loss, by_form: bool) -> Bools:
    """Return the trials that show it: those near the worst, but not too few of those drawn at random."""
    measure, least, near = (loss.excess, _EXCESS, 0.3) if by_form else (loss.error, _VISIBLE, 0.1)
    mask = np.asarray(measure >= max(least, near * float(np.nanmax(measure))))
    drawn = np.nan_to_num(measure[case.special :])
    if mask[case.special :].sum() < _SHOWING and drawn.size:
        some = np.sort(drawn)[-min(_SHOWING, drawn.size)]
        mask[case.special :] |= drawn >= max(least, some)
    return mask


def _is_missing_before(case: Case, cell: Cell, trial: int) -> bool:
    """Whether a number that the cell needs is there already where it should not be."""
    needs = [case.node[part] for part in case.lowering.graph.needs.get(cell, ()) if part in case.node]
    return any(np.isnan(case.exact_number(node, trial)) != np.isnan(case.number(node)[trial]) for node in needs)


def _effect(
    case: Case, cell: Cell, share: float, of: str, loss: _Loss, missing: bool, random: bool, blurred: _Spread
) -> str:
    reached = [repr(name) for name in case.forecasts_of([cell]) if name != case.trees.title(cell)]
    on = f"; {', '.join(reached)} depend{'s' * (len(reached) == 1)} on it" if reached else ""
    at = "" if random or not (missing or share >= _UNUSABLE) else " (at the base case or an end of a range)"
    if missing:
        return f"it shows a number and no error where the formula, computed exactly, has no value{at}{on}"
    digits = f"rounding makes it wrong by up to {number_text(share, 1)} of its {of}{at}"
    if share >= _UNUSABLE:
        return f"{digits}: the digits shown are wrong{on}"
    if blurred.is_rounding:
        return f"{digits}, and {blurred}: its spread comes from rounding{on}"
    return f"{digits}, {styled_text(loss.most, '.0f')} times what rounding the assumptions alone would do{on}"


def _explain(
    case: Case, cell: Cell, worst: Sequence[int]
) -> tuple[tuple[str, str] | None, str | None, tuple[Where, ...]]:
    """Why, as a kind and a sentence; a better form; and the range of the one assumption to blame."""
    small = [division for division in divisions(case, cell) if division.least < _SMALL]
    better = without_cosine(case, cell, small[0].factor) if small else None
    if better is not None and same(case, cell, better):
        sentence, ranges = _division(case, cell, small[0])
        return ("division", sentence), case.trees.offer_formula(better, cell), ranges
    guilty = culprit(case, cell, worst)
    if isinstance(guilty, ir.Call) and guilty.name in LOGARITHMS:
        return _of_logarithm(case, cell, guilty, worst), _better(case, cell, guilty, worst), ()
    if isinstance(guilty, ir.Binary) and guilty.operator in "+-":
        lost = Cancellation(guilty, min(left_of(case, cell, guilty, trial) for trial in worst))
        if lost.left < _SMALL:
            return _of_near_equals(case, cell, lost), _better(case, cell, guilty, worst), ()
    if isinstance(guilty, ir.Call) and guilty.name in _STEEP:
        return _of_steep(case, cell, guilty), _better(case, cell, guilty, worst), ()
    if small:
        sentence, ranges = _division(case, cell, small[0])
        return ("division", sentence), None, ranges
    most = cancellation(case, cell, worst[0])
    if most is not None and most.left < _SMALL:
        return _of_near_equals(case, cell, most), _better(case, cell, most.tree, worst), ()
    if guilty is not None and not isinstance(guilty, ir.Let | ir.Lambda | ir.Invoke):
        return ("rounding", f"{case.trees.text(guilty, cell)} loses digits"), _better(case, cell, guilty, worst), ()
    return None, None, ()


def _of_near_equals(case: Case, cell: Cell, lost: Cancellation) -> tuple[str, str]:
    return "cancellation", (
        f"{case.trees.text(lost.tree, cell)} is a difference of nearly equal numbers: it is as small as "
        f"{number_text(lost.left, 1)} of its terms, and their leading digits cancel"
    )


def _of_logarithm(case: Case, cell: Cell, part: ir.Call, worst: Sequence[int]) -> tuple[str, str]:
    argument = case.trees.text(part.arguments[0], cell)
    node = case.trees.node_of(part.arguments[0], cell)
    off = min((abs(case.exact_number(node, trial) - 1) for trial in worst), default=0.0) if node is not None else 0.0
    return "cancellation", (
        f"{argument} is rounded to 16 digits, and {part.name} uses only its difference from 1, which is as small as "
        f"{number_text(off, 1)}: most of the digits are lost"
    )


def _of_steep(case: Case, cell: Cell, part: ir.Call) -> tuple[str, str]:
    argument = case.trees.text(part.arguments[0], cell)
    return "rounding", f"{argument} is rounded to 16 digits, and near 1 and -1 {part.name} is so steep that this shows"


def _better(case: Case, cell: Cell, part: ir.Expression, worst: Sequence[int]) -> str | None:
    known = of_small_changes(case, cell)
    return case.trees.offer_formula(steady_form(case, cell, part, worst) if known is None else known, cell)


def _division(case: Case, cell: Cell, division: Division) -> tuple[str, tuple[Where, ...]]:
    factor = case.trees.text(division.factor, cell)
    values = np.abs(case.number(division.node))
    trial = int(np.nanargmin(values))
    sentence = f"it divides by {factor}, which gets as small as {number_text(values[trial], 2)}"
    name = only_assumption(case, division.node)
    if name is None:
        return sentence, case.where(np.asarray(values <= 2 * division.least * np.nanmedian(values)), division.node)
    units = next(a.units for a in case.model.live if a.name == name)
    draws = case.draws[name]
    sentence += f" at {name} = {number_text(draws[trial])} {units}".rstrip()
    known = zeros(case, division.node, name)
    if known:
        near = min(known, key=partial(_distance, float(draws.min()), float(draws.max())))
        sentence += f" and is 0 at {number_text(near, 12)} {units}".rstrip()
    limit = max(2 * float(values[trial]), min(0.1, 0.5 * float(np.nanmedian(values))))
    here = draws[values <= limit]
    return sentence, (Where(name, float(here.min()), float(here.max()), units),) if here.size else ()


def _distance(low: float, high: float, x: float) -> float:
    return max(low - x, x - high, 0.0)


def cell_digits(case: Case) -> Iterator[CellDigits]:
    """Measure what every needed cell that holds numbers amplifies and loses."""
    losses = _losses(case)
    unchecked = case.unchecked
    for cell in case.cells:
        values = case.number(case.node[cell])
        if not np.isfinite(values).any():
            continue
        moved, total = case.moved(cell)
        with np.errstate(all="ignore"):
            amplified = moved / np.maximum(np.abs(values), case.scale(cell) * _LEAST)
        amplified = amplified[np.isfinite(amplified)]
        through = case.derivatives.names[int(total.argmax())] if total.size and total.any() else ""
        is_zero = _is_zero(case, cell, losses[cell])
        yield CellDigits(
            cell,
            case.trees.title(cell),
            float(np.median(amplified)) if amplified.size else 0.0,
            float(np.quantile(amplified, 0.99)) if amplified.size else 0.0,
            through,
            0.0 if is_zero else losses[cell].worst,
            0.0 if is_zero else losses[cell].most,
            case.node[cell] not in unchecked,
        )


def _is_zero(case: Case, cell: Cell, loss: _Loss) -> bool:
    """Whether a cell holds nothing but the last digits of a 0, which are no share of anything."""
    node = case.node[cell]
    if loss.worst < _VISIBLE or np.nanmax(np.abs(case.number(node))) > DUST * case.term_sizes[node]:
        return False
    return case.exact_number(node, int(np.nanargmax(loss.error))) == 0


@dataclass(frozen=True, slots=True)
class _Spread:
    """What some trials computed again with 50 digits show.

    Attributes:
        error: how far off the cell is by rounding, in the median of them.
        width: of the central half of the exact values.
    """

    error: float
    width: float

    @property
    def is_rounding(self) -> bool:
        """Whether the digits that are printed of the spread are rounding, where there is a spread."""
        return self.width > 0 and self.error > MOST_OF_SPREAD * self.width

    def __str__(self) -> str:
        return (
            f"in the median trial by {number_text(self.error, 1)}, while its true central range is "
            f"{number_text(self.width, 1)} wide"
        )


def _spread(case: Case, cell: Cell) -> _Spread:
    """Compute the spread of a cell in accepted trials, or in drawn ones where none is accepted."""
    trials = _some_trials(case, _TRIALS)
    node = case.node[cell]
    shown = case.number(node)[trials]
    exact = np.array([case.exact_number(node, trial) for trial in trials])
    known = np.isfinite(shown) & np.isfinite(exact)
    if known.sum() < 2:
        return _Spread(0.0, 0.0)
    low, high = np.quantile(exact[known], [0.245, 0.755])
    return _Spread(float(np.median(np.abs(shown - exact)[known])), float(high - low))


def _some_trials(case: Case, count: int) -> list[int]:
    """Choose some accepted trials, or drawn ones where too few are accepted, evenly spaced."""
    first = case.first_accepted if case.n - case.first_accepted >= count else case.special
    return sorted({int(trial) for trial in np.linspace(first, case.n - 1, count)}) if case.n > first else []
