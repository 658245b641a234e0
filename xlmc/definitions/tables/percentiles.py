"""Percentiles in place of parameters: columns named `P10`, `P90`, `P2.5`."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from xlmc.definitions.tables.tables import Row
from xlmc.distributions import ByPercentiles, Family
from xlmc.distributions.naming import plain
from xlmc.errors import DefinitionError

__all__ = ["by_percentiles", "is_percentile", "with_percentiles"]

_HEADING = re.compile(r"p(\d{1,3}(?:\.\d+)?)")


def is_percentile(heading: str) -> bool:
    """Whether a column of that name holds percentiles."""
    return _HEADING.fullmatch(plain(heading)) is not None


def with_percentiles(row: Row, family: Family) -> Family:
    """The family with the row's percentiles in place of the parameters that it leaves blank; itself without any.

    Raises:
        DefinitionError: the row has more or fewer percentiles than blank parameters, or one outside 0 to 100.
    """
    headings = [heading for heading in row.headings if is_percentile(heading) and row.filled(heading)]
    if not (headings and family.roles):
        return family
    percents = [_percent(row, heading) for heading in headings]
    blank = [spec for spec in family.parameters if not any(row.filled(heading) for heading in spec.headings)]
    try:
        return by_percentiles(family, {*family.keys} - {spec.key for spec in blank}, percents)
    except ValueError:
        left = ", ".join(spec.heading for spec in blank) or "no parameter"
        message = f"{family.name} leaves {left} blank, and gives {', '.join(map(row.heading, headings))}"
        hint = "Give one percentile for each parameter that is left blank"
        raise DefinitionError(message, where=row.cell(headings[-1]), hint=hint) from None


def by_percentiles(family: Family, given: Collection[str], percents: Sequence[float]) -> ByPercentiles:
    """The family with percentiles in place of the parameters that are not given.

    Args:
        family: one whose parameters have roles.
        given: the keys of the parameters that are.
        percents: above 0 and below 100.

    Raises:
        ValueError: there are more or fewer percentiles than parameters left; one with a default may be left, too.
    """
    left = [spec for spec in family.parameters if spec.key not in given]
    required = [spec for spec in left if spec.default is None]
    if len(percents) == len(left):
        required = left
    if len(percents) != len(required):
        names = ", ".join(spec.heading for spec in left) or "no parameter"
        raise ValueError(f"{len(percents)} percentiles stand for {names}")
    unknown = {spec.key for spec in required}
    return ByPercentiles(family, tuple(key for key in family.keys if key not in unknown), tuple(sorted(percents)))


def _percent(row: Row, heading: str) -> float:
    match = _HEADING.fullmatch(plain(heading))
    percent = float(match[1]) if match else 0.0
    if not 0 < percent < 100:
        message = f"{row.heading(heading)} is no percentile"
        raise DefinitionError(message, where=row.cell(heading), hint="Percentiles lie above P0 and below P100")
    return percent
