"""A cheap look at whether the digits of the answers are there: a few hundred accepted trials, with random rounding.

It runs with every simulation. `xlmc stability` says more: which cell it is, why, and what to write instead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.nodes import Input
from xlmc.engine.passes.random_rounding import RandomRounding, closure, evaluate, formula_of, numbers_of, term_sizes
from xlmc.excel.functions.budget import TooLargeError
from xlmc.montecarlo.number_text import count_text, counted_text, number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["DUST", "MOST_OF_SPREAD", "lost_digits"]

Floats = NDArray[np.float64]

_TRIALS: Final = 256
_REPLICAS: Final = 1

_MOST_NODES: Final = 10_000
"""Operations that the forecasts need: some half a second. Larger books are left to `xlmc stability`."""

_MOST_CELLS: Final = 100_000
"""Cells of all arrays among them."""

_VISIBLE: Final = 1e-3
"""A share of a forecast's central range, or of its value where that is larger: a larger change is visible."""

DUST: Final = 1e-12
"""A share of the largest number that was added or subtracted on the way: a result below it counts as 0."""

MOST_OF_SPREAD: Final = 0.1
"""The largest error in the median trial, as a share of the true central range; above it the spread is rounding."""

_WORTH_A_LOOK: Final = 3e-14
"""A share of a number: a smaller error makes no spread that anybody would notice."""

_CONFIRMED_SPREAD: Final = 15
"""Trials that are computed again with 50 digits for a spread."""

_CONFIRMED: Final = 3
"""Trials that are computed again with 50 digits before anybody is warned."""

_SHARE: Final = 0.01
"""A share of the trials examined: a few that are next to a jump say nothing about the digits."""


def lost_digits(model: CompiledModel, inputs: Mapping[str, Floats]) -> list[str]:
    """Sentences on the forecasts whose digits rounding has taken.

    Args:
        model: the workbook.
        inputs: assumption -> its accepted draws, `(m,)`; the first few hundred are looked at.
    """
    draws = {a.name: inputs[a.name][:_TRIALS] for a in model.live}
    n = next((column.size for column in draws.values()), 0)
    if not n:
        return []
    nodes = {forecast.name: model.lowering.cell(forecast.cell) for forecast in model.forecasts}
    needed = closure(model.lowering.dag, list(nodes.values()))
    if len(needed) > _MOST_NODES or sum(_cells(model.lowering.dag.sizes[node]) for node in needed) > _MOST_CELLS:
        return []
    try:
        return _lost(model, draws, n, nodes, needed)
    except TooLargeError:
        return []


def _cells(size: tuple[int, ...] | None) -> int:
    return 1 if size is None else abs(size[0] * size[1])


def _lost(
    model: CompiledModel, draws: Mapping[str, Floats], n: int, nodes: Mapping[str, int], needed: Sequence[int]
) -> list[str]:
    """Return the sentences of `lost_digits` on forecasts at these nodes, which need those at `needed`."""
    plain = evaluate(model.lowering.dag, needed, draws)
    lost = {name: np.zeros(n, bool) for name in nodes}
    blurred: dict[str, int] = {}
    for replica in range(_REPLICAS):
        result = evaluate(model.lowering.dag, needed, draws, RandomRounding(replica))
        for name, node in nodes.items():
            one, other = numbers_of(plain[node], n), numbers_of(result[node], n)
            lost[name] |= _off(one, other)
            if _is_blurred(one, other):
                blurred[name] = node
    lost = {name: where for name, where in lost.items() if np.count_nonzero(where) > _SHARE * n}
    still = {name: node for name, node in nodes.items() if _stands_still(model, node, numbers_of(plain[node], n))}
    if not lost and not blurred and not still:
        return []
    dust = term_sizes(model.lowering.dag, needed, plain)
    sentences = [
        f"the digits of {name!r} cannot be trusted: rounding alone moves it by more than a thousandth of its central "
        f"range in {count_text(int(np.count_nonzero(where)))} of {counted_text(n, 'accepted trial')} "
        f"(xlmc stability says where)"
        for name, where in lost.items()
        if _is_confirmed(model, nodes[name], draws, numbers_of(plain[nodes[name]], n), where, DUST * dust[nodes[name]])
    ]
    sentences += [
        f"the digits of {name!r} cannot be trusted: it shows {number_text(shown)} in all trials, and "
        "with 50 digits it is "
        f"{number_text(exact)} in the first (xlmc stability says where)"
        for name, node in still.items()
        for shown, exact in _absorbed(model, node, draws, numbers_of(plain[node], n), DUST * dust[node])
    ]
    others = {name: node for name, node in blurred.items() if not any(repr(name) in sentence for sentence in sentences)}
    return sentences + [
        f"the digits of {name!r} cannot be trusted: its spread comes from rounding. In the median trial rounding moves "
        f"it by {number_text(error, 1)}, and its true central range is {number_text(width, 1)} wide "
        "(xlmc stability says where)"
        for name, node in others.items()
        for error, width in _blur(model, node, draws, numbers_of(plain[node], n))
        if width > 0 and error > MOST_OF_SPREAD * width
    ]


def _stands_still(model: CompiledModel, node: int, plain: Floats) -> bool:
    """Whether a number is the same in all trials although it depends on an assumption."""
    if not np.isfinite(plain).all() or plain.size < 2 or (plain != plain[0]).any():
        return False
    dag = model.lowering.dag
    return any(isinstance(formula_of(dag, part), Input) for part in closure(dag, [node]))


def _absorbed(
    model: CompiledModel, node: int, draws: Mapping[str, Floats], plain: Floats, dust: float
) -> list[tuple[float, float]]:
    """Return what a number that stands still shows, and what it is; nothing where 50 digits give the same.

    Random rounding does not show it: 1-COS(x) of a tiny x is 0, and 1 and 0 are exact.
    """
    result = list(_exact(model, node, draws, np.arange(min(_CONFIRMED, plain.size))).values())
    shown = float(plain[0])
    off = [abs(shown - exact) > _VISIBLE * max(abs(shown), abs(exact)) for exact in result if math.isfinite(exact)]
    is_dust = not any(result) and abs(shown) <= dust
    return [(shown, result[0])] if off and all(off) and not is_dust else []


def _is_blurred(plain: Floats, moved: Floats) -> bool:
    """Whether rounding moves most trials by a visible part of what they spread over."""
    known = np.isfinite(plain) & np.isfinite(moved)
    if not known.any():
        return False
    half = plain[known] / 2
    low, high = np.quantile(half, [0.245, 0.755])
    by = float(np.median(np.abs(moved[known] / 2 - half)))
    return by > MOST_OF_SPREAD / 2 * (high - low) and by > _WORTH_A_LOOK * float(np.median(np.abs(half)))


def _blur(model: CompiledModel, node: int, draws: Mapping[str, Floats], plain: Floats) -> list[tuple[float, float]]:
    """How far off a number is in the median of some trials, and how wide the exact ones spread; empty if unknown."""
    exact = _exact(model, node, draws, np.flatnonzero(np.isfinite(plain))[:_CONFIRMED_SPREAD])
    known = {trial: number for trial, number in exact.items() if np.isfinite(number)}
    if len(known) < _CONFIRMED:
        return []
    values = np.array(list(known.values()))
    low, high = np.quantile(values, [0.245, 0.755])
    return [(float(np.median(np.abs(plain[list(known)] - values))), float(high - low))]


def _exact(model: CompiledModel, node: int, draws: Mapping[str, Floats], trials: NDArray[np.intp]) -> dict[int, float]:
    """Trial -> the number computed with 50 digits."""
    from xlmc.engine.passes.exact import Exact, as_double  # mpmath is slow to import, and hardly ever needed

    exact = Exact(model.lowering.dag, closure(model.lowering.dag, [node]))
    return {
        int(trial): as_double(exact.trial({key: float(column[trial]) for key, column in draws.items()})[node])
        for trial in trials
    }


def _is_confirmed(
    model: CompiledModel, node: int, draws: Mapping[str, Floats], plain: Floats, lost: NDArray[np.bool_], dust: float
) -> bool:
    """Whether 50 digits give another number in one of the first lost trials, 0 apart where dust stands for it."""
    trials = np.flatnonzero(lost)[:_CONFIRMED]
    result = list(_exact(model, node, draws, trials).values())
    off = _off(np.concatenate([plain, plain[trials]]), np.concatenate([plain, result]))[plain.size :]
    is_dust = (np.array(result) == 0) & (np.abs(plain[trials]) <= dust)
    return bool((off & ~is_dust).any())


def _off(plain: Floats, moved: Floats) -> NDArray[np.bool_]:
    """Return the trials in which a number visibly differs, or is a number in one evaluation only, `(n,)`."""
    known = np.isfinite(plain)
    if not known.any():
        return np.zeros(plain.size, bool)
    half, moved_half = plain / 2, moved / 2  # differences of halves are numbers, up to the largest
    low, high = np.quantile(half[known], [0.245, 0.755])
    with np.errstate(invalid="ignore"):
        far = np.abs(moved_half - half) > _VISIBLE * np.fmax(high - low, np.abs(half))
    return np.asarray(far | (np.isfinite(moved) != known))
