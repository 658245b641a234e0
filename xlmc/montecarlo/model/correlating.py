"""Correlated assumptions: gathered in groups, and brought to the nearest correlations that are possible."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from xlmc.errors import Notice
from xlmc.montecarlo.definitions.definitions import Copula, Correlation
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers
from xlmc.montecarlo.number_text import number_text, styled_text
from xlmc.montecarlo.sampling.copula import GaussianCopula
from xlmc.montecarlo.sampling.copulas import Clayton, Frank, Gumbel, Joining, Reflected, SameTrials, StudentTCopula
from xlmc.montecarlo.sampling.draws import CorrelatedGroup, Draw

__all__ = [
    "CHANGED",
    "copula_groups",
    "copula_notices",
    "correlated_groups",
    "drawn_correlation",
    "repair_notices",
    "tie_notices",
]

_ROUNDING = 1e-9
"""An eigenvalue so little below 0 is one of 0."""

CHANGED = 5e-4
"""A correlation that moved by less is the one that was asked for: three decimals say all there is to say."""


def correlated_groups(correlations: Sequence[Correlation], draws: Mapping[str, Draw]) -> list[CorrelatedGroup]:
    """Gather the correlations among drawn assumptions in groups that have none between them.

    A pair of a group that no row names counts as uncorrelated, and a correlation of 0 is none: the draws are those of a
    workbook without its row, to the last bit. Correlations that contradict each other give way to the
    nearest ones that do not.

    Args:
        correlations: the rows.
        draws: name of a drawn assumption -> how it is drawn, at least of all that the rows name.
    """
    given = [c for c in correlations if c.first in draws and c.second in draws]
    pairs = {(c.first, c.second): c for c in given if c.value}
    groups = []
    for names in _connected(list(draws), list(pairs)):
        matrix, weights = np.eye(len(names)), np.zeros((len(names), len(names)))
        for each in given:
            if {each.first, each.second} <= set(names):
                i, j = names.index(each.first), names.index(each.second)
                matrix[i, j] = matrix[j, i] = each.number
                weights[i, j] = weights[j, i] = each.weight
        ties = [draws[name].ties() for name in names]
        groups.append(CorrelatedGroup(names, GaussianCopula(matrix, ties if any(ties) else (), weights)))
    return groups


def copula_groups(copulas: Sequence[Copula], drawn: Collection[str]) -> list[CorrelatedGroup]:
    """Return the assumptions that copulas join, those left out that are not drawn.

    Args:
        copulas: as defined.
        drawn: the names of all that is drawn.
    """
    groups = []
    for copula in copulas:
        drawn_indices = [i for i, name in enumerate(copula.names) if name in drawn]
        if len(drawn_indices) > 1:
            names = tuple(copula.names[i] for i in drawn_indices)
            groups.append(CorrelatedGroup(names, _joining(copula, drawn_indices), copula.row))
    return groups


def _joining(copula: Copula, drawn_indices: Sequence[int]) -> Joining:
    if copula.trials is not None:
        return SameTrials(copula.trials[list(drawn_indices)])
    if copula.kind in ("Gaussian", "t"):
        matrix = np.array(copula.matrix)[np.ix_(drawn_indices, drawn_indices)]
        if copula.parameter is None:
            return GaussianCopula(6 / np.pi * np.arcsin(matrix / 2))
        return StudentTCopula(matrix, copula.parameter)
    assert copula.parameter is not None
    families: dict[str, Callable[[int, float], Joining]] = {"Clayton": Clayton, "Gumbel": Gumbel, "Frank": Frank}
    joined = families[copula.kind](len(drawn_indices), copula.parameter)
    turned = [copula.turned[i] for i in drawn_indices]
    return Reflected(joined, turned) if any(turned) else joined


def copula_notices(groups: Sequence[CorrelatedGroup], copulas: Sequence[Copula]) -> Iterator[Notice]:
    """Return what is drawn with the copulas of a workbook, and a notice if a matrix contradicts itself."""
    for copula in copulas:
        group = next((each for each in groups if each.where == copula.row), None)
        if group is None:
            continue
        of = (
            ""
            if copula.parameter is None
            else f" of {'theta' if not copula.matrix else 'df'} {number_text(copula.parameter)}"
        )
        reflected = {(): "", (False, False): "", (True, True): "R", (True, False): "RX", (False, True): "RY"}[
            copula.turned[:2] or ()
        ]
        named = ", ".join(map(repr, copula.names[:-1]))
        message = f"{named} and {copula.names[-1]!r} are joined by the copula {copula.kind}{reflected}{of}"
        if group.copula.repaired:
            message += (
                "; no variables can have all of its correlations at once, so the nearest that they can have are used"
            )
        yield Notice(message, copula.row)


def drawn_correlation(groups: Sequence[CorrelatedGroup], first: str, second: str) -> float | None:
    """Return the rank correlation that two assumptions, by name, are drawn with; None if one of them is not drawn."""
    for group in groups:
        if first in group.names and second in group.names:
            return float(group.copula.spearman[group.names.index(first), group.names.index(second)])
    return None


def tie_notices(
    groups: Sequence[CorrelatedGroup],
    correlations: Sequence[Correlation],
    draws: Mapping[str, Draw],
) -> Iterator[Notice]:
    """Find the correlations that assumptions with few values cannot have, and those that are not known beforehand.

    Args:
        groups: of correlated assumptions.
        correlations: the rows.
        draws: name of an assumption in them -> how it is drawn.
    """
    for row in correlations:
        pair = row.first, row.second
        group = next((each for each in groups if set(pair) <= set(each.names)), None)
        if group is None or not row.value:
            continue
        i, j = (group.names.index(name) for name in pair)
        wanted = float(group.copula.wanted[i, j])
        if abs(wanted - row.number) >= CHANGED:
            yield _out_of_reach(row, wanted, float(group.copula.spearman[i, j]))
        vary = [each for name, each in zip(pair, (row.first, row.second), strict=True) if _takes_few(draws[name])]
        if vary:
            message = (
                f"{' and '.join(map(repr, vary))} may take few values, and the parameters vary from trial to trial: "
                f"equal draws share ranks, so the rank correlation of {row.first!r} and {row.second!r} may be nearer "
                f"to 0 than the {show(row.number)} that was asked for; Assumptions shows what the accepted trials have"
            )
            yield Notice(message, row.row)


def _takes_few(draw: Draw) -> bool:
    return isinstance(draw.family, WholeNumbers) and not draw.fixed


def _out_of_reach(row: Correlation, wanted: float, drawn: float) -> Notice:
    used = (
        "that"
        if abs(drawn - wanted) < CHANGED
        else f"{number_text(drawn, 3)}, for the other correlations leave no more"
    )
    message = (
        f"{row.first!r} and {row.second!r} cannot have the rank correlation {show(row.number)}: equal draws share "
        f"ranks, and with the few values that one of them takes, {number_text(wanted, 3)} is the "
        f"{'most' if row.number > 0 else 'least'} that any two can have; they are drawn with {used}"
    )
    return Notice(message, row.row)


def repair_notices(groups: Sequence[CorrelatedGroup], correlations: Sequence[Correlation]) -> Iterator[Notice]:
    """Say what was changed, group by group, the largest change first.

    Args:
        groups: of correlated assumptions.
        correlations: the rows.
    """
    asked = {frozenset((c.first, c.second)): c for c in correlations}
    for group in groups:
        if group.copula.repaired and group.where is None:
            yield _repair(group, asked)


def _repair(group: CorrelatedGroup, asked: dict[frozenset[str], Correlation]) -> Notice:
    changes = []
    for i, j in combinations(range(len(group.names)), 2):
        row = asked.get(frozenset((group.names[i], group.names[j])))
        before, after = float(group.copula.wanted[i, j]), float(group.copula.spearman[i, j])
        pair = f"{group.names[i]!r} and {group.names[j]!r} {number_text(before)} → {styled_text(after, '.3f')}"
        row_text = "in no row, which counts as 0" if row is None else str(row.row)
        changes.append((-abs(after - before), f"{pair} ({row_text})"))
    changes.sort()
    reported = [text for change, text in changes if -change >= CHANGED] or [changes[0][1]]
    rows = [row.row for pair, row in asked.items() if pair <= set(group.names)]
    never = np.linalg.eigvalsh(group.copula.wanted)[0] < -_ROUNDING
    why = (
        "no assumptions can have all of these correlations at once, so the nearest ones that they can have are used"
        if never
        else "these correlations cannot all be drawn at once in the one way that xlmc has, a Gaussian copula, so the "
        "nearest ones that can are used"
    )
    if any(row.weight for row in asked.values() if {row.first, row.second} <= set(group.names)):
        why += ", as their adjustment weights say"
    message = f"{why}; the largest change is {number_text(-changes[0][0], 2)}: {'; '.join(reported)}"
    return Notice(message, rows[0])


def _connected(order: Sequence[str], pairs: Sequence[tuple[str, str]]) -> list[tuple[str, ...]]:
    """Return the names that pairs join, directly or through others, in groups of two or more."""
    group = {name: {name} for name in order}
    for first, second in pairs:
        joined = group[first] | group[second]
        for name in joined:
            group[name] = joined
    distinct = {id(names): names for names in group.values() if len(names) > 1}
    return [tuple(name for name in order if name in names) for names in distinct.values()]
