"""Filters that accept almost nothing: the answer then rests on the rim of the ranges."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from xlmc.studies.stability.case import Case
from xlmc.studies.stability.findings import Finding, Level

__all__ = ["narrow_filters"]

_FEW: Final = 1e-3
"""Accepted of all trials."""


def narrow_filters(case: Case) -> Iterator[Finding]:
    """One finding where the filters together accept less than a thousandth."""
    run = case.run
    if not run.model.filters or run.accepted >= _FEW * run.trials:
        return
    rejected = {row.name: int(count) for row, count in zip(run.model.filters, run.tally.rejected, strict=True)}
    worst = max(rejected, key=lambda name: rejected[name])
    filter_ = next(row for row in run.model.filters if row.name == worst)
    effect = "the answer rests on a rim of the ranges" if run.accepted else "there is no answer"
    yield Finding(
        Level.WRONG if not run.accepted else Level.DOUBTFUL,
        "filter",
        filter_.cell,
        worst,
        case.trees.written(filter_.cell),
        f"the filters accept {run.accepted:,} of {run.trials:,} trials; {worst!r} rejects most, {rejected[worst]:,}",
        f"{effect}: look whether these, the evidence or the model contradict each other",
        (),
        None,
        1.0 - run.accepted / run.trials,
    )
