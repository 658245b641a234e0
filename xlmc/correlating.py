"""Correlated assumptions: gathered in groups, and brought to the nearest correlations that are possible."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from xlmc.definitions import Correlation
from xlmc.definitions.model import name_key
from xlmc.errors import Notice
from xlmc.sampling import CorrelatedGroup, GaussianCopula

__all__ = ["CHANGED", "correlated_groups", "repair_notices", "used"]

CHANGED = 5e-4
"""A correlation that moved by less is the one that was asked for: three decimals say all there is to say."""


def correlated_groups(correlations: Sequence[Correlation], live: Sequence[str]) -> list[CorrelatedGroup]:
    """The correlations among drawn assumptions, gathered in groups that have none between them.

    A pair of a group that no row names counts as uncorrelated, and a correlation of 0 is none: the draws are those of a
    workbook without its row, to the last bit. Correlations that contradict each other give way to the
    nearest ones that do not.
    """
    order = [name_key(name) for name in live]
    pairs = {(name_key(c.first), name_key(c.second)): c for c in correlations if c.value}
    pairs = {pair: c for pair, c in pairs.items() if pair[0] in order and pair[1] in order}
    groups = []
    for names in _connected(order, list(pairs)):
        matrix = np.eye(len(names))
        for (first, second), correlation in pairs.items():
            if first in names:
                i, j = names.index(first), names.index(second)
                matrix[i, j] = matrix[j, i] = correlation.value
        groups.append(CorrelatedGroup(names, GaussianCopula(matrix)))
    return groups


def used(groups: Sequence[CorrelatedGroup], first: str, second: str) -> float | None:
    """The rank correlation that two assumptions, by name, are drawn with; None where one of them is not drawn."""
    for group in groups:
        if name_key(first) in group.names and name_key(second) in group.names:
            return float(group.copula.spearman[group.names.index(name_key(first)), group.names.index(name_key(second))])
    return None


def repair_notices(
    groups: Sequence[CorrelatedGroup], correlations: Sequence[Correlation], names: Sequence[str]
) -> Iterator[Notice]:
    """What was changed, group by group, the largest change first.

    Args:
        groups: of correlated assumptions.
        correlations: the rows.
        names: the drawn assumptions, as defined.
    """
    asked = {frozenset((name_key(c.first), name_key(c.second))): c for c in correlations}
    spelt = {name_key(name): name for name in names}
    for group in groups:
        if group.copula.repaired:
            yield _repair(group, asked, spelt)


def _repair(group: CorrelatedGroup, asked: dict[frozenset[str], Correlation], spelt: dict[str, str]) -> Notice:
    changes = []
    for i, j in combinations(range(len(group.names)), 2):
        row = asked.get(frozenset((group.names[i], group.names[j])))
        before, after = 0.0 if row is None else row.value, float(group.copula.spearman[i, j])
        pair = f"{spelt[group.names[i]]!r} and {spelt[group.names[j]]!r} {before:g} → {after:.3f}"
        place = "in no row, which counts as 0" if row is None else str(row.row)
        changes.append((-abs(after - before), f"{pair} ({place})"))
    changes.sort()
    told = [text for change, text in changes if -change >= CHANGED] or [changes[0][1]]
    rows = [row.row for pair, row in asked.items() if pair <= set(group.names)]
    message = (
        "no assumptions can have all of these correlations at once, so the nearest ones that they can have are used; "
        f"the largest change is {-changes[0][0]:.2g}: {'; '.join(told)}"
    )
    return Notice(message, rows[0])


def _connected(order: Sequence[str], pairs: Sequence[tuple[str, str]]) -> list[tuple[str, ...]]:
    """The names that pairs join, directly or through others, in groups of two or more."""
    group = {name: {name} for name in order}
    for first, second in pairs:
        joined = group[first] | group[second]
        for name in joined:
            group[name] = joined
    distinct = {id(names): names for names in group.values() if len(names) > 1}
    return [tuple(name for name in order if name in names) for names in distinct.values()]
